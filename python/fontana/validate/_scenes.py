"""Vessels and lattices that several cases share."""

from __future__ import annotations

import numpy as np

SLIPPERY = {"friction": 0.0, "elasticity": 0.0}


def walls(axis: str, first: float, last: float, friction: float = 0.0) -> list[dict]:
    """Two planes across an axis, with the fluid between them."""
    index = "xyz".index(axis)
    planes = []
    for place, is_far in ((first, False), (last, True)):
        centre = [0.0, 0.0, 0.0]
        centre[index] = place
        plane = {"type": f"plane_{axis}", "centre": centre, "flip": is_far}
        planes.append(plane | SLIPPERY | {"friction": friction})
    return planes


def floor(friction: float = 0.0) -> dict:
    return {"type": "plane_y", "centre": [0.0, 0.0, 0.0]} | SLIPPERY | {"friction": friction}


def tank(length: float, width: float, friction: float = 0.0) -> list[dict]:
    """An open tank from 0 to `length` in x and to `width` in z; friction on its floor alone."""
    return [floor(friction), *walls("x", 0.0, length), *walls("z", 0.0, width)]


def lattice(spacing: float, *ranges: tuple[float, float]) -> np.ndarray:
    """(N, 3) places of a cubic lattice that fills the box of the three ranges, half a spacing within its faces."""
    axes = [low + (np.arange(round((high - low) / spacing)) + 0.5) * spacing for low, high in ranges]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
