"""The box of a scene that is worth seeing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

_MOST_POINTS = 5000  # of a frame: quantiles need no more
_STRAYS = 0.005  # share of the particles that may lie outside, on either side
_MARGIN = 0.12  # over the longest edge


def stage_bounds(colliders: Sequence[dict], positions: Sequence[np.ndarray]) -> np.ndarray:
    """The lowest and the highest corner, (2, 3) in metres, of most of the fluid at all times and of what holds it.

    `positions` are those of some frames, (N, 3) each.
    """
    points = [position[:: max(1, len(position) // _MOST_POINTS)] for position in positions if len(position)]
    corners = [np.quantile(np.concatenate(points), [_STRAYS, 1 - _STRAYS], axis=0)] if points else []
    corners += [_cylinder_corners(c) for c in colliders if c["type"].startswith("cylinder")]
    joined = np.concatenate(corners) if corners else np.array([[-1.0, 0.0, -1.0], [1.0, 1.0, 1.0]])
    low, high = joined.min(axis=0), joined.max(axis=0)
    _include_planes(colliders, low, high)
    margin = _MARGIN * (high - low).max()
    return np.array([low - [margin, 0.0, margin], high + margin])


def _cylinder_corners(cylinder: dict) -> np.ndarray:
    centre = np.array(cylinder.get("centre", [0.0, 0.0, 0.0]), dtype=float)
    radius = cylinder["radius"] + cylinder.get("thickness", 0.0)
    low, high = centre - radius, centre + radius
    low[1], high[1] = centre[1], cylinder.get("cutoff", centre[1])
    return np.array([low, high])


def _include_planes(colliders: Sequence[dict], low: np.ndarray, high: np.ndarray) -> None:
    """Widens the box to walls and floors that are not far from it."""
    for axis, kind in enumerate(("plane_x", "plane_y", "plane_z")):
        reach = high[axis] - low[axis]
        places = [c.get("centre", [0.0, 0.0, 0.0])[axis] for c in colliders if c["type"] == kind]
        near = [place for place in places if low[axis] - reach < place < high[axis] + reach]
        low[axis], high[axis] = min([low[axis], *near]), max([high[axis], *near])
