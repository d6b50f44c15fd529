"""Where rays meet the colliders of a scene. Arrays of rays have shape (..., 3), distances and masks (...)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

_AXES = {"plane_x": 0, "plane_y": 1, "plane_z": 2}


@dataclass
class Hits:
    """The nearest surface on each ray: distance (inf where there is none), its unit normal, and which collider."""

    distance: np.ndarray
    normal: np.ndarray
    index: np.ndarray

    @classmethod
    def none(cls, shape: tuple[int, ...]) -> Hits:
        return cls(np.full(shape, np.inf), np.zeros((*shape, 3)), np.full(shape, -1))

    def copy(self) -> Hits:
        return Hits(self.distance.copy(), self.normal.copy(), self.index.copy())

    def add(self, index: int, distance: np.ndarray, normal: np.ndarray) -> None:
        """Keeps what is nearer. Distances that are NaN or negative are no hits."""
        nearer = (distance > 1e-9) & (distance < self.distance)
        self.distance[nearer] = distance[nearer]
        self.normal[nearer] = normal[nearer]
        self.index[nearer] = index


def cast(
    colliders: list[dict],
    centres: list[np.ndarray],
    rays: tuple[np.ndarray, np.ndarray],
    bounds: np.ndarray,
    chosen: Iterable[int],
    onto: Hits | None = None,
) -> Hits:
    """Meets rays (origins, directions) with the chosen colliders of a scene, at their present centres.

    Surfaces without an end are drawn within `bounds`, (2, 3): lowest and highest corner, in metres. `onto` are hits to
    begin with; they are not changed.
    """
    origin, direction = rays
    hits = onto.copy() if onto else Hits.none(direction.shape[:-1])
    planes = [(c, centre) for c, centre in zip(colliders, centres, strict=True) if c["type"] in _AXES]
    with np.errstate(divide="ignore", invalid="ignore"):
        for index in chosen:
            collider, centre = colliders[index], centres[index]
            if not collider.get("enabled", True):
                continue
            if collider["type"] in _AXES:
                others = [other for other in planes if other[0] is not collider]
                _cast_plane(hits, index, collider, centre, others, origin, direction, bounds)
            elif collider["type"].startswith("sphere"):
                _cast_sphere(hits, index, collider, centre, origin, direction)
            else:
                _cast_cylinder(hits, index, collider, centre, origin, direction, bounds)
    return hits


def _side(plane: dict) -> float:
    return -1.0 if plane.get("flip") else 1.0


def _cast_plane(hits, index, plane, centre, others, origin, direction, bounds) -> None:
    """A plane shows its fluid side only, so that the front walls of a box do not hide what is in it."""
    axis, side = _AXES[plane["type"]], _side(plane)
    distance = (centre[axis] - origin[..., axis]) / direction[..., axis]
    distance = np.where(direction[..., axis] * side < 0, distance, np.inf)
    point = origin + _finite(distance)[..., None] * direction
    seen = np.ones(distance.shape, bool)
    for k in range(3):
        if k != axis:
            seen &= (point[..., k] >= bounds[0][k]) & (point[..., k] <= bounds[1][k])
    for other, place in others:
        other_axis = _AXES[other["type"]]
        seen &= (point[..., other_axis] - place[other_axis]) * _side(other) >= -1e-6
    normal = np.zeros(direction.shape)
    normal[..., axis] = side
    hits.add(index, np.where(seen, distance, np.inf), normal)


def _cast_sphere(hits, index, sphere, centre, origin, direction) -> None:
    """From outside the near surface; a sphere that holds fluid inside shows its far one."""
    inside = sphere["type"] == "sphere_inside"
    relative = origin - centre
    near, far = _roots(
        _dot(direction, direction), _dot(relative, direction), _dot(relative, relative) - sphere["radius"] ** 2
    )
    distance = far if inside else near
    normal = (relative + _finite(distance)[..., None] * direction) / sphere["radius"]
    hits.add(index, distance, -normal if inside else normal)


def _cast_cylinder(hits, index, cylinder, centre, origin, direction, bounds) -> None:
    """The wall as solid: its outer face, its inner face and its rim. A wall without thickness shows its inner face."""
    radius, thickness = cylinder["radius"], cylinder.get("thickness")
    top = min(cylinder.get("cutoff", bounds[1][1]), bounds[1][1])
    bottom = bounds[0][1]
    if cylinder["type"] == "cylinder_inside":
        inner, outer = radius, radius + thickness if thickness else None
    else:
        inner, outer = radius - thickness if thickness else 0.0, radius
    for face_radius, is_outer in ((outer, True), (inner, False)):
        if face_radius:
            _cast_tube(hits, index, centre, face_radius, is_outer, (bottom, top), origin, direction)
    if outer:
        _cast_rim(hits, index, centre, (inner, outer), top, origin, direction)


def _cast_tube(hits, index, centre, radius, is_outer, heights, origin, direction) -> None:
    flat = np.array([1.0, 0.0, 1.0])
    relative, along = (origin - centre) * flat, direction * flat
    near, far = _roots(_dot(along, along), _dot(relative, along), _dot(relative, relative) - radius**2)
    distance = near if is_outer else far
    steps = _finite(distance)
    height = origin[..., 1] + steps * direction[..., 1]
    distance = np.where((height >= heights[0]) & (height <= heights[1]), distance, np.inf)
    normal = (relative + steps[..., None] * along) / radius
    hits.add(index, distance, normal if is_outer else -normal)


def _cast_rim(hits, index, centre, radii, top, origin, direction) -> None:
    distance = (top - origin[..., 1]) / direction[..., 1]
    point = origin + _finite(distance)[..., None] * direction - centre
    squared = point[..., 0] ** 2 + point[..., 2] ** 2
    on_rim = (squared >= radii[0] ** 2) & (squared <= radii[1] ** 2)
    hits.add(index, np.where(on_rim, distance, np.inf), np.broadcast_to([0.0, 1.0, 0.0], direction.shape))


def _finite(distance: np.ndarray) -> np.ndarray:
    """Distances to compute with: zero where a ray meets nothing."""
    return np.where(np.isfinite(distance), distance, 0.0)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Of the last axis; several times faster than a sum over an axis of three."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def _roots(a: np.ndarray, half_b: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both solutions of a t^2 + 2 half_b t + c = 0, the smaller first; NaN where there is none."""
    root = np.sqrt(half_b**2 - a * c)
    return (-half_b - root) / a, (-half_b + root) / a
