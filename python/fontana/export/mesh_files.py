"""A surface as the content of a file: .obj, .ply, .bgeo. Normals travel along, velocities too except in .obj."""

from __future__ import annotations

import io
from collections.abc import Callable

import numpy as np

from fontana import bgeo
from fontana.surface import Mesh

_PLY_NAMES = {"position": ("x", "y", "z"), "normal": ("nx", "ny", "nz"), "velocity": ("vx", "vy", "vz")}


def obj_bytes(mesh: Mesh) -> bytes:
    """Wavefront text. Own code because it is one format string a line, and numpy fills it many times faster than the
    libraries' loops."""
    lines = io.StringIO()
    np.savetxt(lines, mesh.position, fmt="v %.9g %.9g %.9g")
    np.savetxt(lines, mesh.normal, fmt="vn %.4f %.4f %.4f")
    np.savetxt(lines, np.repeat(mesh.triangles + 1, 2, axis=1), fmt="f %d//%d %d//%d %d//%d")
    return lines.getvalue().encode("ascii")


def ply_bytes(mesh: Mesh) -> bytes:
    """Binary, little-endian."""
    from plyfile import PlyData, PlyElement

    names = [name for parts in _PLY_NAMES.values() for name in parts]
    vertices = np.empty(len(mesh.position), dtype=[(name, "f4") for name in names])
    for attribute, parts in _PLY_NAMES.items():
        for name, values in zip(parts, getattr(mesh, attribute).T, strict=True):
            vertices[name] = values
    faces = np.empty(len(mesh.triangles), dtype=[("vertex_indices", "i4", (3,))])
    faces["vertex_indices"] = mesh.triangles
    buffer = io.BytesIO()
    elements = [PlyElement.describe(vertices, "vertex"), PlyElement.describe(faces, "face")]
    PlyData(elements, byte_order="<").write(buffer)
    return buffer.getvalue()


def bgeo_bytes(mesh: Mesh) -> bytes:
    """Houdini's classic binary geometry, with its names for the attributes: P, N, v."""
    attributes = {"P": mesh.position, "N": mesh.normal, "v": mesh.velocity}
    return bgeo.write_surface(attributes, mesh.triangles)


ENCODERS: dict[str, Callable[[Mesh], bytes]] = {".bgeo": bgeo_bytes, ".ply": ply_bytes, ".obj": obj_bytes}
