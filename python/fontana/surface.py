"""The surface of a fluid: a closed mesh of triangles around its particles, by splashsurf."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fontana import _core
from fontana.optional import OptionalPackage

_SPLASHSURF = OptionalPackage("pysplashsurf", "surface", "a surface")
_SCIPY = OptionalPackage("scipy", "surface", "a surface")

# Cells along an axis: above this the 64-bit numbers of a grid's points overflow.
_MOST_CELLS = 2**20


@dataclass(frozen=True)
class SurfaceSettings:
    """How a surface is made; lengths are in particle radii. The defaults are what splashsurf's authors recommend.

    support_radius  within which particles count for a place
    cell_size       of the grid whose crossings become vertices: smaller is finer and slower
    threshold       the share of the rest density at which the surface lies
    smoothing       passes of weighted Laplacian smoothing (Loeschner, Boettcher, Jeske, Bender 2023); 0: none
    """

    support_radius: float = 4.0
    cell_size: float = 0.75
    threshold: float = 0.6
    smoothing: int = 25


@dataclass(frozen=True)
class Mesh:
    """Triangles, counter-clockwise seen from outside.

    position (V, 3), normal (V, 3; of length 1), velocity (V, 3; per second), triangles (T, 3; numbers of vertices).
    `left_out` particles were too far from the others to be part of it.
    """

    position: np.ndarray
    normal: np.ndarray
    velocity: np.ndarray
    triangles: np.ndarray
    left_out: int = 0


def check_installed() -> None:
    """Raises BadInput with the line that installs what is missing."""
    _SPLASHSURF.module("pysplashsurf")
    _SCIPY.module("scipy.sparse.csgraph")


def reconstruct(position: np.ndarray, velocity: np.ndarray, radius: float, settings: SurfaceSettings) -> Mesh:
    """The surface of particles of `radius` at `position` (N, 3); in their units. Without particles it is empty.

    Raises BadInput where splashsurf is not installed or the settings do not fit.
    """
    splashsurf = _SPLASHSURF.module("pysplashsurf")
    if len(position) == 0:
        return _EMPTY
    # Around the middle of the fluid floats are finest, however far that is from the origin.
    middle = np.median(position, axis=0).astype(np.float64)
    local = position.astype(np.float64) - middle
    is_near = is_on_grid(position, settings.cell_size * radius)
    try:
        mesh, _ = splashsurf.reconstruction_pipeline(
            local[is_near],
            attributes_to_interpolate={"velocity": velocity[is_near].astype(np.float64)},
            multi_threading=False,  # with threads the order of the vertices is another each time
            particle_radius=radius,
            smoothing_length=0.5 * settings.support_radius,
            cube_size=settings.cell_size,
            iso_surface_threshold=settings.threshold,
            mesh_cleanup=settings.smoothing > 0,
            decimate_barnacles=settings.smoothing > 0,
            mesh_smoothing_iters=settings.smoothing,
            mesh_smoothing_weights=True,
            compute_normals=True,
            normals_smoothing_iters=10 if settings.smoothing > 0 else 0,
        )
    except RuntimeError as error:  # its message goes on with a trace of calls
        raise _core.BadInput(f"splashsurf cannot make a surface: {_first_lines(error)}") from error
    vertices, triangles = mesh.mesh.vertices, mesh.mesh.triangles.astype(np.int32)
    is_kept = ~_is_in_a_speck(vertices, triangles, radius)
    numbers = np.cumsum(is_kept, dtype=np.int32) - 1
    return Mesh(
        (vertices[is_kept] + middle).astype(np.float32),
        np.nan_to_num(mesh.point_attributes["normals"][is_kept]).astype(np.float32),
        mesh.point_attributes["velocity"][is_kept].astype(np.float32),
        numbers[triangles[is_kept[triangles[:, 0]]]],
        int(len(position) - is_near.sum()),
    )


def is_on_grid(position: np.ndarray, cell_size: float) -> np.ndarray:
    """Which particles (N,) are near enough to the middle of all for a grid of such cells to have numbers for them."""
    distance = np.abs(position.astype(np.float64) - np.median(position, axis=0))
    return np.all(distance < 0.5 * _MOST_CELLS * cell_size, axis=1)


def _is_in_a_speck(vertices: np.ndarray, triangles: np.ndarray, size: float) -> np.ndarray:
    """Which vertices (V,) belong to a closed piece narrower than `size` along every axis.

    Smoothing shrinks small hollows inside the fluid to points of no area; the surface of a lone particle is twice its
    radius across.
    """
    graph = _SCIPY.module("scipy.sparse.csgraph")
    starts, ends = triangles[:, :2].ravel(), triangles[:, 1:].ravel()
    edges = _SCIPY.module("scipy.sparse").coo_array(
        (np.ones(len(starts), dtype=bool), (starts, ends)), shape=(len(vertices), len(vertices))
    )
    piece_count, piece = graph.connected_components(edges, directed=False)
    low, high = np.full((piece_count, 3), np.inf), np.full((piece_count, 3), -np.inf)
    np.minimum.at(low, piece, vertices)
    np.maximum.at(high, piece, vertices)
    return np.all(high - low < size, axis=1)[piece]


def _first_lines(error: Exception) -> str:
    return " ".join(str(error).partition("\n\nStack backtrace")[0].split())


_NONE = np.zeros((0, 3), dtype=np.float32)
_EMPTY = Mesh(_NONE, _NONE, _NONE, np.zeros((0, 3), dtype=np.int32))
