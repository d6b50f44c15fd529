"""The surface itself: closed by the word of another library, where the particles are, in each format as it was."""

from __future__ import annotations

import gzip
import io
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from pysplashsurf import bgeo as foreign_bgeo

from fontana import bgeo
from fontana.export.mesh_files import ENCODERS
from fontana.runs.cache import Cache
from fontana.surface import Mesh, SurfaceSettings, reconstruct

RADIUS = 0.025
AT_REST = np.zeros((1, 3), dtype=np.float32)


def as_trimesh(mesh: Mesh, merge: bool = False) -> trimesh.Trimesh:
    return trimesh.Trimesh(mesh.position, mesh.triangles, process=merge)


@pytest.fixture(scope="module")
def frames(splash: Path) -> dict[int, dict[str, np.ndarray]]:
    cache = Cache(splash)
    assert cache.particle_radius == RADIUS
    return {frame: cache.read(frame) for frame in cache.frames}


@pytest.fixture(scope="module")
def surface(frames) -> Mesh:
    return reconstruct(frames[12]["position"], frames[12]["velocity"], RADIUS, SurfaceSettings())


@pytest.mark.parametrize("cell_size", [0.75, 1.2])
@pytest.mark.parametrize("smoothing", [0, 25])
def test_every_frame_has_a_closed_surface(frames, cell_size: float, smoothing: int) -> None:
    for frame in frames.values():
        mesh = reconstruct(
            frame["position"], frame["velocity"], RADIUS, SurfaceSettings(cell_size=cell_size, smoothing=smoothing)
        )
        closed = as_trimesh(mesh)
        assert closed.is_watertight and closed.is_winding_consistent
        volume = len(frame["position"]) * (2 * RADIUS) ** 3
        assert 0.7 * volume < closed.volume < 1.3 * volume
        if smoothing:  # even where all vertices at one place are taken for one
            assert as_trimesh(mesh, merge=True).is_watertight
        assert np.isfinite(mesh.normal).all()
        assert mesh.left_out == 0


def test_it_encloses_the_particles_and_no_more(frames, surface) -> None:
    position = frames[12]["position"]
    assert (surface.position.min(axis=0) > position.min(axis=0) - 2.5 * RADIUS).all()
    assert (surface.position.max(axis=0) < position.max(axis=0) + 2.5 * RADIUS).all()


def block() -> np.ndarray:
    axis = (np.arange(8, dtype=np.float32) - 3.5) * 2 * RADIUS
    return np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)


def test_normals_point_outward_and_velocities_are_the_fluids() -> None:
    velocity = np.tile(np.array([[1.0, -2.0, 0.5]], dtype=np.float32), (len(block()), 1))
    mesh = reconstruct(block(), velocity, RADIUS, SurfaceSettings())
    assert (np.einsum("ij,ij->i", mesh.normal, mesh.position) > 0).all()
    assert np.allclose(np.linalg.norm(mesh.normal, axis=1), 1.0, atol=1e-4)
    assert np.allclose(mesh.velocity, velocity[0], atol=1e-4)


def test_smoothing_smooths() -> None:
    def roughness(smoothing: int) -> float:
        mesh = reconstruct(block(), np.zeros_like(block()), RADIUS, SurfaceSettings(smoothing=smoothing))
        return float(np.sum(as_trimesh(mesh).face_adjacency_angles ** 2) / as_trimesh(mesh).area)

    assert roughness(25) < 0.85 * roughness(0)


def test_a_lone_particle_is_a_drop_and_none_are_nothing() -> None:
    drop = reconstruct(AT_REST + 0.3, AT_REST, RADIUS, SurfaceSettings())
    assert as_trimesh(drop).is_watertight
    assert np.allclose(drop.position.mean(axis=0), 0.3, atol=0.2 * RADIUS)
    assert RADIUS < np.ptp(drop.position[:, 0]) < 3 * RADIUS
    nothing = reconstruct(AT_REST[:0], AT_REST[:0], RADIUS, SurfaceSettings())
    assert len(nothing.position) == len(nothing.triangles) == 0


@pytest.mark.parametrize(("distance", "left_out"), [(1e3, 0), (1e7, 1), (1e30, 1)])
def test_a_stray_particle_does_no_harm(distance: float, left_out: int) -> None:
    position = np.concatenate([block(), np.full((1, 3), distance, dtype=np.float32)])
    mesh = reconstruct(position, np.zeros_like(position), RADIUS, SurfaceSettings())
    assert as_trimesh(mesh).is_watertight
    assert mesh.left_out == left_out
    near = reconstruct(block(), np.zeros_like(block()), RADIUS, SurfaceSettings())
    assert abs(as_trimesh(mesh).volume - as_trimesh(near).volume) < 0.02 * as_trimesh(near).volume


def test_far_from_the_origin_it_is_closed_too() -> None:
    mesh = reconstruct(block() + np.float32(2000), np.zeros_like(block()), RADIUS, SurfaceSettings())
    assert as_trimesh(mesh).is_watertight


@pytest.mark.parametrize("suffix", [".obj", ".ply"])
def test_trimesh_reads_back_a_closed_mesh(surface, suffix: str) -> None:
    data = ENCODERS[suffix](surface)
    read = trimesh.load(io.BytesIO(data), file_type=suffix[1:])
    assert read.is_watertight and read.is_winding_consistent
    assert len(read.faces) == len(surface.triangles)
    exact = trimesh.load(io.BytesIO(data), file_type=suffix[1:], process=False, maintain_order=True)
    assert np.array_equal(exact.vertices.astype(np.float32), surface.position)
    assert np.allclose(exact.vertex_normals, surface.normal, atol=2e-4)


def test_pysplashsurf_reads_the_points_of_a_bgeo(surface, tmp_path: Path) -> None:
    """It takes compressed files only, and none with polygons."""
    path = tmp_path / "surface.bgeo"
    points = replace(surface, triangles=surface.triangles[:0])
    path.write_bytes(gzip.compress(ENCODERS[".bgeo"](points), compresslevel=1))
    mesh = foreign_bgeo.readbgeo_to_meshio(path)
    assert np.array_equal(mesh.points, surface.position)
    assert np.array_equal(mesh.point_data["N"], surface.normal)
    assert np.array_equal(mesh.point_data["v"], surface.velocity)


def test_a_bgeo_is_laid_out_as_the_format_says() -> None:
    """Byte by byte: no other program here reads its polygons."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=np.float32)
    data = bgeo.write_surface({"P": corners, "v": corners}, np.array([[0, 1, 2]]))
    header = b"BgeoV" + struct.pack(">9i", 5, 3, 1, 0, 0, 1, 0, 0, 0)
    attribute = struct.pack(">H", 1) + b"v" + struct.pack(">Hi3f", 3, 5, 0, 0, 0)
    points = b"".join(struct.pack(">7f", *corner, 1, *corner) for corner in corners)
    polygon = struct.pack(">iic3H", 1, 3, b"<", 2, 1, 0)
    assert data == header + attribute + points + polygon + b"\x00\xff"


@pytest.mark.parametrize("count", [65535, 65536])
def test_point_numbers_grow_with_the_count(count: int) -> None:
    places = np.zeros((count, 3), dtype=np.float32)
    triangles = np.array([[0, 1, count - 1], [5, 4, 3]])
    data = bgeo.write_surface({"P": places}, triangles)
    assert len(data) == 5 + 9 * 4 + 16 * count + 2 * (9 + 3 * (2 if count <= 65535 else 4)) + 2
    attributes, read = bgeo.read(data)
    assert np.array_equal(read, triangles) and len(attributes["P"]) == count


def test_a_cut_or_changed_bgeo_is_refused(surface) -> None:
    data = ENCODERS[".bgeo"](surface)
    for broken in (data[:-1], data[: len(data) // 2], data + b"x", data[:-10] + b"\x01" * 10, b"BgeoV", b""):
        with pytest.raises((ValueError, struct.error)):
            bgeo.read(broken)
