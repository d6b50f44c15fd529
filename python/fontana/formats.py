"""The files a frame is written to and read from: .bgeo (Houdini, Partio, splashsurf), .npz (numpy), .ply.

All hold the same attributes in order of id: position (m), velocity (m/s), id, density (kg/m^3), pressure (Pa), radius
(m, half the particle spacing) and mass (kg). In .bgeo they go by Houdini's names: P, v, pscale.
"""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np

from fontana import _core, bgeo

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
    arrays["radius"] = np.full(len(arrays["id"]), particle_radius(simulation), dtype=np.float32)
    data = _npz_bytes(arrays) if format == "npz" else _ply_bytes(arrays)
    return len(data), _core.publish_file(str(path), data)


def particle_radius(simulation: _core.Simulation) -> float:
    """Half the distance of particles at rest, which is half the support radius; in the scene's unit, as positions."""
    return simulation.derived().particle_radius


def read_frame(path: str | Path) -> dict[str, np.ndarray]:
    """The attributes of a frame's file by name: (N,) or (N, 3) arrays. Raises IoError."""
    path = Path(path)
    if path.suffix not in _READERS:
        raise _core.BadInput(f'"{path}": expected a file that ends in {", ".join(_READERS)}')
    return decode_frame(read_bytes(path), path)


def decode_frame(data: bytes, path: Path) -> dict[str, np.ndarray]:
    """The attributes in the content of the file `path`, as `read_frame` returns them. Raises IoError."""
    try:
        return _READERS[path.suffix](data)
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
    attributes, _ = bgeo.read(data)
    return {_HOUDINI_NAMES.get(name, name): values for name, values in attributes.items()}


_READERS = {".bgeo": _read_bgeo, ".npz": _read_npz, ".ply": _read_ply}
