"""Houdini's classic binary geometry (.bgeo, version 5): points with attributes, and closed polygons.

The library writes the points of a run (`src/fontana/io/bgeo.h` describes the layout); this module reads them, and
writes and reads surfaces, which only Python makes. No PyPI package writes this format with polygons.

After the points, each polygon is: the key 1 and the number of its corners (4 bytes each), "<" for closed, and a point
number a corner, of 2 bytes where the file has at most 65535 points, else of 4. Source: the description of the format
that Houdini shipped as GPD.txt. Houdini takes a polygon's front to be where its corners run clockwise, all else here
counter-clockwise, so corners are written and read in reverse.
"""

from __future__ import annotations

import struct

import numpy as np

_MAGIC = b"BgeoV"
_VERSION = 5
_HEADER = struct.Struct(">5s9i")  # magic, version, and eight counts
_END = b"\x00\xff"
_POLYGON = 1
_CLOSED = ord("<")
_MOST_POINTS_IN_TWO_BYTES = 65535
_FLOAT, _INTEGER, _VECTOR = 0, 1, 5
_DTYPES = {_FLOAT: ">f4", _INTEGER: ">i4", _VECTOR: ">f4"}


def read(data: bytes) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """The points' attributes by Houdini's names, P among them, and the triangles: (T, 3), counter-clockwise.

    Raises ValueError and its like for anything that is not a whole file of points and triangles.
    """
    magic, version, *counts = _HEADER.unpack_from(data)
    if magic != _MAGIC or version != _VERSION:
        raise ValueError("not a .bgeo of version 5")
    point_count, triangle_count, *groups, attribute_count = counts[:5]
    if any(groups) or any(counts[5:]):
        raise ValueError("groups and attributes of vertices, primitives and details are not read")
    columns, offset = _read_columns(data, attribute_count)
    points = np.frombuffer(data, np.dtype(columns), point_count, offset)
    offset += points.nbytes
    polygons = np.frombuffer(data, _polygon_dtype(point_count), triangle_count, offset)
    if data[offset + polygons.nbytes :] != _END:
        raise ValueError("does not end where its header says")
    if not np.all((polygons["key"] == _POLYGON) & (polygons["corners"] == 3)):
        raise ValueError("has primitives other than triangles")
    names = [name for name in points.dtype.names if name != "w"]
    return {name: _native(points[name]) for name in names}, polygons["points"][:, ::-1].astype(np.int32)


def _read_columns(data: bytes, attribute_count: int) -> tuple[list[tuple], int]:
    """What a point's record consists of, and where the first one is."""
    columns: list[tuple] = [("P", ">f4", (3,)), ("w", ">f4")]
    offset = _HEADER.size
    for _ in range(attribute_count):
        (length,) = struct.unpack_from(">H", data, offset)
        name = data[offset + 2 : offset + 2 + length].decode("ascii")
        offset += 2 + length
        components, kind = struct.unpack_from(">Hi", data, offset)
        offset += 6 + 4 * components
        dtype = _DTYPES[kind]
        columns.append((name, dtype, (components,)) if components > 1 else (name, dtype))
    return columns, offset


def write_surface(attributes: dict[str, np.ndarray], triangles: np.ndarray) -> bytes:
    """A file of triangles (T, 3), counter-clockwise; `attributes` are vectors (V, 3) by name, P among them."""
    vectors = {name: values for name, values in attributes.items() if name != "P"}
    point_count = len(attributes["P"])
    header = _HEADER.pack(_MAGIC, _VERSION, point_count, len(triangles), 0, 0, len(vectors), 0, 0, 0)
    for name in vectors:
        header += struct.pack(">H", len(name)) + name.encode("ascii") + struct.pack(">Hi3f", 3, _VECTOR, 0, 0, 0)
    points = np.empty(point_count, [("P", ">f4", (3,)), ("w", ">f4"), *((name, ">f4", (3,)) for name in vectors)])
    points["w"] = 1.0
    for name, values in attributes.items():
        points[name] = values
    polygons = np.empty(len(triangles), _polygon_dtype(point_count))
    polygons["key"], polygons["corners"], polygons["closed"] = _POLYGON, 3, _CLOSED
    polygons["points"] = triangles[:, ::-1]
    return header + points.tobytes() + polygons.tobytes() + _END


def _polygon_dtype(point_count: int) -> np.dtype:
    number = ">u2" if point_count <= _MOST_POINTS_IN_TWO_BYTES else ">u4"
    return np.dtype([("key", ">i4"), ("corners", ">i4"), ("closed", "u1"), ("points", number, (3,))])


def _native(array: np.ndarray) -> np.ndarray:
    return array.astype(array.dtype.newbyteorder("="))
