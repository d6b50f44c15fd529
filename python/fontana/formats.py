"""The files a frame is written to and read from: .bgeo (Houdini, Partio, splashsurf), .npz (numpy), .ply.

All hold the same attributes in order of id: position (m), velocity (m/s), id, density (kg/m^3), pressure (Pa), radius
(m, half the particle spacing) and mass (kg). In .bgeo they go by Houdini's names: P, v, pscale.
"""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np

from fontana import _core

FORMATS = ("bgeo", "npz", "ply")
BYTES_PER_PARTICLE = {"bgeo": 48, "npz": 44, "ply": 44}
ATTRIBUTES = ("position", "velocity", "id", "density", "pressure", "mass")

_HOUDINI_NAMES = {"P": "position", "v": "velocity", "pscale": "radius"}
_PLY_NAMES = {"position": ("x", "y", "z"), "velocity": ("vx", "vy", "vz")}


def write_frame(simulation: _core.Simulation, path: Path, format: str) -> tuple[int, int]:
    """Writes the present frame; it appears under its name only when it is complete and on disk.

    Returns its size in bytes and its hash. Raises IoError.
    """
    if format == "bgeo":
        simulation.write_bgeo(str(path))
        data = read_bytes(path)
        return len(data), _core.hash(data)
    arrays = {name: simulation.read(name) for name in ATTRIBUTES}
    arrays["radius"] = np.full(len(arrays["id"]), _particle_radius(simulation), dtype=np.float32)
    data = _npz_bytes(arrays) if format == "npz" else _ply_bytes(arrays)
    return len(data), _core.publish_file(str(path), data)


def _particle_radius(simulation: _core.Simulation) -> float:
    """Half the distance of particles at rest, which is half the support radius; in the scene's unit, as positions."""
    return simulation.derived().particle_radius


def read_frame(path: str | Path) -> dict[str, np.ndarray]:
    """The attributes of a frame's file by name: (N,) or (N, 3) arrays. Raises IoError."""
    path = Path(path)
    readers = {".bgeo": _read_bgeo, ".npz": _read_npz, ".ply": _read_ply}
    if path.suffix not in readers:
        raise _core.BadInput(f'"{path}": expected a file that ends in {", ".join(readers)}')
    data = read_bytes(path)
    try:
        return readers[path.suffix](data)
    except Exception as error:  # three parsers, each with its own kinds
        raise _core.IoError(f'cannot read "{path}": it is damaged, or not a frame that Fontana wrote') from error


def read_bytes(path: Path) -> bytes:
    """The content of a file. Raises IoError."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise _core.IoError(f'cannot read "{path}": {error.strerror or error}') from error


def _npz_bytes(arrays: dict[str, np.ndarray]) -> bytes:
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    return buffer.getvalue()


def _read_npz(data: bytes) -> dict[str, np.ndarray]:
    with np.load(io.BytesIO(data), allow_pickle=False) as arrays:
        return dict(arrays)


def _ply_bytes(arrays: dict[str, np.ndarray]) -> bytes:
    from plyfile import PlyData, PlyElement

    columns = {}
    for name, values in arrays.items():
        parts = np.atleast_2d(values.T)
        columns |= dict(zip(_PLY_NAMES.get(name, (name,)), parts, strict=True))
    table = np.empty(len(arrays["id"]), dtype=[(name, column.dtype) for name, column in columns.items()])
    for name, column in columns.items():
        table[name] = column
    buffer = io.BytesIO()
    PlyData([PlyElement.describe(table, "vertex")], byte_order="<").write(buffer)
    return buffer.getvalue()


def _read_ply(data: bytes) -> dict[str, np.ndarray]:
    from plyfile import PlyData

    table = PlyData.read(io.BytesIO(data))["vertex"].data
    vectors = {part: name for name, parts in _PLY_NAMES.items() for part in parts}
    result = {name: np.array(table[name]) for name in table.dtype.names if name not in vectors}
    for name, parts in _PLY_NAMES.items():
        result[name] = np.stack([table[part] for part in parts], axis=1)
    return result


def _read_bgeo(data: bytes) -> dict[str, np.ndarray]:
    """Reads points and their attributes from Houdini's classic binary geometry, which no PyPI package reads."""
    magic, version = data[:5], int.from_bytes(data[5:9], "big")
    if magic != b"BgeoV" or version != 5:
        raise ValueError("not a .bgeo of version 5")
    point_count, _, _, _, attribute_count = np.frombuffer(data, ">i4", 5, 9)
    offset = 9 + 8 * 4
    columns = [("P", ">f4", (3,)), ("w", ">f4")]
    for _ in range(attribute_count):
        length = int.from_bytes(data[offset : offset + 2], "big")
        name = data[offset + 2 : offset + 2 + length].decode("ascii")
        offset += 2 + length
        components = int.from_bytes(data[offset : offset + 2], "big")
        kind = int.from_bytes(data[offset + 2 : offset + 6], "big")
        offset += 6 + 4 * components
        dtype = {0: ">f4", 1: ">i4", 5: ">f4"}[kind]
        columns.append((name, dtype, (components,)) if components > 1 else (name, dtype))
    points = np.frombuffer(data, np.dtype(columns), point_count, offset)
    names = [name for name in points.dtype.names if name != "w"]
    return {_HOUDINI_NAMES.get(name, name): _native(points[name]) for name in names}


def _native(array: np.ndarray) -> np.ndarray:
    return array.astype(array.dtype.newbyteorder("="))
