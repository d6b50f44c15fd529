"""The colliders of a scene as triangles: what stands where, made of what.

A wall of a basin is often two colliders back to back, one for the water within and one for the water without. They are
drawn as one wall.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

MATERIALS = ("ground", "stone", "rock", "wall")
_AXES = {"plane_x": 0, "plane_y": 1, "plane_z": 2}
_SEGMENTS = 128  # around a basin or a rock
_BEVEL_SHARE = 0.28  # of a wall's thickness
_BEVEL_STEPS = 5
_FLOOR_RISE = 2e-3  # over the outer radius of a basin
_ROCK_WAVES, _ROCK_DEPTH = 12, 0.06  # the stone stays within the sphere that the water meets
_HORIZON = 60.0  # radius of the ground over the size of the stage


@dataclass
class Solid:
    """Triangles about the centre of collider `index`: position (V, 3) m, normal (V, 3), every three a triangle.

    `one_sided` surfaces are seen from their front only: one looks into a box through the near wall.
    """

    index: int
    material: str
    position: np.ndarray
    normal: np.ndarray
    one_sided: bool = False
    casts_shadow: bool = True


def make_solids(colliders: Sequence[dict], bounds: np.ndarray) -> list[Solid]:
    """The solids of a scene's colliders; what has no end is drawn to `bounds`, (2, 3) metres."""
    solids, merged = [], set()
    for index, collider in enumerate(colliders):
        if not collider.get("enabled", True) or index in merged:
            continue
        kind = collider["type"]
        if kind in _AXES:
            solids.append(_plane(index, collider, colliders, bounds))
        elif kind.startswith("sphere"):
            solids.append(_sphere(index, collider))
        else:
            partner = _other_half(index, colliders)
            merged.add(partner)
            half = colliders[partner] if partner is not None else None
            solids.append(_cylinder(index, collider, half, bounds, _has_floor(colliders, bounds[0][1])))
    return solids


def _centre(collider: dict) -> np.ndarray:
    return np.array(collider.get("centre", [0.0, 0.0, 0.0]), dtype=float)


def _faces(collider: dict) -> tuple[float, float]:
    """Inner and outer radius of a cylinder's wall; inf or 0 where it has no second face."""
    radius, thickness = collider["radius"], collider.get("thickness", np.inf)
    if collider["type"] == "cylinder_inside":
        return radius, radius + thickness
    return max(0.0, radius - thickness), radius


def _other_half(index: int, colliders: Sequence[dict]) -> int | None:
    """The cylinder that stands back to back with this one, at the same height and as still."""
    this = colliders[index]
    for other, candidate in enumerate(colliders):
        is_pair = {this["type"], candidate["type"]} == {"cylinder_inside", "cylinder_outside"}
        if not is_pair or not candidate.get("enabled", True) or "keys" in this or "keys" in candidate:
            continue
        inner, outer = sorted((this, candidate), key=lambda c: c["type"])  # inside, outside
        same_place = np.allclose(_centre(this), _centre(candidate)) and this.get("cutoff") == candidate.get("cutoff")
        still = not any(this.get("velocity", ())) and not any(candidate.get("velocity", ()))
        if same_place and still and inner["radius"] < outer["radius"] and _faces(inner)[1] >= _faces(outer)[0] - 1e-6:
            return other
    return None


def _plane(index: int, plane: dict, colliders: Sequence[dict], bounds: np.ndarray) -> Solid:
    axis = _AXES[plane["type"]]
    side = -1.0 if plane.get("flip") else 1.0
    low, high = bounds - _centre(plane)
    if axis == 1 and side > 0:
        reach = _HORIZON * float(np.ptp(bounds, axis=0).max())
        low, high = np.array([-reach, 0.0, -reach]), np.array([reach, 0.0, reach])
    else:
        low, high = _between_walls(axis, low, high, _centre(plane), colliders)
    first, second = [k for k in range(3) if k != axis]
    corners = np.zeros((4, 3))
    corners[:, first] = [low[first], high[first], high[first], low[first]]
    corners[:, second] = [low[second], low[second], high[second], high[second]]
    normal = np.zeros(3)
    normal[axis] = side
    position = corners[[0, 1, 2, 0, 2, 3]]
    if np.dot(np.cross(position[1] - position[0], position[2] - position[0]), normal) < 0:
        position = position[::-1]
    material = "ground" if axis == 1 else "wall"
    return Solid(index, material, position, np.tile(normal, (6, 1)), one_sided=True, casts_shadow=False)


def _between_walls(axis, low, high, centre, colliders) -> tuple[np.ndarray, np.ndarray]:
    """A wall ends where others stand, and at the floor."""
    low, high = low.copy(), high.copy()
    for other in colliders:
        other_axis = _AXES.get(other["type"])
        if other_axis is None or other_axis == axis or not other.get("enabled", True):
            continue
        place = _centre(other)[other_axis] - centre[other_axis]
        if other.get("flip"):
            high[other_axis] = min(high[other_axis], place)
        else:
            low[other_axis] = max(low[other_axis], place)
    return low, high


def _sphere(index: int, sphere: dict) -> Solid:
    inside = sphere["type"] == "sphere_inside"
    angle = np.linspace(-np.pi / 2, np.pi / 2, _SEGMENTS // 2 + 1)
    outline = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    position, normal = _revolve(sphere["radius"] * outline, outline)
    if inside:
        return Solid(index, "stone", position[::-1], -normal[::-1], one_sided=True, casts_shadow=False)
    return Solid(index, "rock", position * _roughness(normal)[:, None], normal)


def _roughness(direction: np.ndarray) -> np.ndarray:
    """Shares of the radius, (V,), just below 1: the outline of a stone is no circle."""
    waves = np.random.default_rng(3).normal(0.0, 4.5, (_ROCK_WAVES, 3))
    heights = np.cos(direction @ waves.T + np.arange(_ROCK_WAVES)).mean(axis=1)
    return 1.0 - _ROCK_DEPTH * (0.5 + 0.5 * np.tanh(3.0 * heights))


def _has_floor(colliders: Sequence[dict], height: float) -> bool:
    floors = [c for c in colliders if c["type"] == "plane_y" and c.get("enabled", True) and not c.get("flip")]
    return any(abs(_centre(floor)[1] - height) < 1e-6 for floor in floors)


def _cylinder(index: int, cylinder: dict, partner: dict | None, bounds: np.ndarray, has_floor: bool) -> Solid:
    """A wall with rounded rims, or, without a thickness, the face that the water meets."""
    inner, outer = _faces(cylinder)
    if partner is not None:
        inner, outer = sorted((cylinder["radius"], partner["radius"]))
    centre = _centre(cylinder)
    bottom = bounds[0][1] - centre[1]
    top = min(cylinder.get("cutoff", np.inf), bounds[1][1]) - centre[1]
    if np.isinf(outer):
        outline = np.array([[inner, top], [inner, bottom]])
        position, normal = _revolve(outline, np.tile([-1.0, 0.0], (2, 1)))
        return Solid(index, "stone", position, normal, one_sided=True, casts_shadow=False)
    # A basin is of one stone with its floor, which lies a little above the ground.
    floor = bottom + _FLOOR_RISE * outer if has_floor and inner > 0 else bottom
    outline, normals = _wall_outline((inner, outer), (bottom, floor, top))
    if floor > bottom:
        outline = np.concatenate([outline, [[inner, floor], [0.0, floor]]])
        normals = np.concatenate([normals, [[0.0, 1.0], [0.0, 1.0]]])
    return Solid(index, "stone", *_revolve(outline, normals))


def _wall_outline(radii: tuple[float, float], heights: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """(K, 2) points and normals, radius and height, up the outer face, over the rounded rim and down the inner one.

    `heights` are those of the outer foot, the inner foot and the rim.
    """
    (inner, outer), (bottom, floor, top) = radii, heights
    bevel = min(_BEVEL_SHARE * (outer - inner), 0.5 * (top - bottom))
    angle = np.linspace(0.0, np.pi / 2, _BEVEL_STEPS + 1)
    outward = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = [np.array([[outer, bottom]]), [outer - bevel, top - bevel] + bevel * outward]
    normals = [np.array([[1.0, 0.0]]), outward]
    if inner > 0:
        inward = outward[::-1] * [-1.0, 1.0]
        points += [[inner + bevel, top - bevel] + bevel * inward, np.array([[inner, floor]])]
        normals += [inward, np.array([[-1.0, 0.0]])]
    else:
        points.append(np.array([[0.0, top]]))
        normals.append(np.array([[0.0, 1.0]]))
    return np.concatenate(points), np.concatenate(normals)


def _revolve(outline: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Turns outline (K, 2) of radius and height around Y: triangles (V, 3), front faces outward, and their normals."""
    angle = np.linspace(0.0, 2.0 * np.pi, _SEGMENTS + 1)
    around = np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], axis=1)

    def turned(pairs: np.ndarray) -> np.ndarray:
        return pairs[:, None, :1] * around + pairs[:, None, 1:] * np.array([0.0, 1.0, 0.0])

    return _grid_triangles(turned(outline)), _grid_triangles(turned(normals))


def _grid_triangles(grid: np.ndarray) -> np.ndarray:
    """(K, S, 3) corners to the triangles between them, (V, 3)."""
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    return np.stack([a, b, c, a, c, d], axis=2).reshape(-1, 3)
