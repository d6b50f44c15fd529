"""The two environments of the thesis (IV.1) at any particle count: an open box and a fountain of two cylinders.

The particle spacing is fixed and the vessel grows with the count, so a particle has as many neighbours at every count
but for the share of the surface. The method is the thesis's; all other parameters have their defaults.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fontana import _core

METHOD = "mueller"
SPACING = 0.02  # m
_JITTER = 0.1  # spacings: a perfect lattice would be too easy for the search and for branch prediction
_FALL = (0.0, -1.0, 0.0)  # m/s
_FASTEST = 3.0  # m/s, for the time step


@dataclass(frozen=True)
class BenchScene:
    """position (N, 3) float32 m, velocity (N, 3) float32 m/s, and colliders as for _core.Simulation.add_collider."""

    name: str
    position: np.ndarray
    velocity: np.ndarray
    colliders: tuple[dict, ...]

    @property
    def particle_count(self) -> int:
        return len(self.position)

    def build(self, backend: str, threads: int = 0, profile: bool = False) -> tuple[_core.Simulation, float]:
        """A simulation by the grid before its first frame, and the time step that its limits allow, s.

        Raises DeviceUnavailable or OutOfMemory.
        """
        simulation = _core.Simulation()
        simulation.set("fluid.method", METHOD)
        simulation.set("fluid.particle_spacing", SPACING)
        simulation.set("solver.backend", backend)
        simulation.set("solver.threads", threads)
        simulation.set("solver.profile", profile)
        for collider in self.colliders:
            simulation.add_collider(**collider)
        limits = simulation.estimate_limits(_FASTEST, 9.81)
        simulation.add_particles(self.position, self.velocity)
        return simulation, min(limits.advection, limits.acceleration, limits.acoustic, limits.viscosity)


def bench_scene(name: str, particle_count: int) -> BenchScene:
    """The scene `name` with exactly so many particles. Raises BadInput for an unknown name."""
    if name not in BENCH_SCENES:
        raise _core.BadInput(f'no scene "{name}" to measure: expected {" or ".join(BENCH_SCENES)}')
    return BENCH_SCENES[name](particle_count)


def _box(particle_count: int) -> BenchScene:
    """A block of fluid just above the floor in one half of an open box."""

    def is_fluid(point: np.ndarray, size: float) -> np.ndarray:
        return (np.abs(point[:, 0]) < 0.5 * size) & (point[:, 1] < size) & (np.abs(point[:, 2]) < 0.4 * size)

    position, size = _fill(is_fluid, volume=0.8, reach=(0.5, 1.0, 0.4), count=particle_count)
    half_depth = 0.4 * size + SPACING
    colliders = (
        {"type": "plane_y"},
        {"type": "plane_x", "centre": (-0.5 * size - SPACING, 0.0, 0.0)},
        {"type": "plane_x", "centre": (1.5 * size, 0.0, 0.0), "flip": True},
        {"type": "plane_z", "centre": (0.0, 0.0, -half_depth)},
        {"type": "plane_z", "centre": (0.0, 0.0, half_depth), "flip": True},
    )
    return _scene("box", position, colliders)


def _fountain(particle_count: int) -> BenchScene:
    """An inner basin with water standing above its rim, which runs over into a shallow outer one."""
    wall = 3.0 * SPACING  # m: more than the support radius, so that the water on both sides does not meet
    rim, outer, outer_rim = 0.9, 1.7, 0.7  # of the inner radius

    def is_fluid(point: np.ndarray, radius: float) -> np.ndarray:
        r, y = np.hypot(point[:, 0], point[:, 2]), point[:, 1]
        is_inner = (r < radius) & (y < 1.1 * radius)
        is_outer = (r > radius + wall + SPACING) & (r < outer * radius + wall) & (y < 0.45 * radius)
        return is_inner | is_outer

    volume = math.pi * (1.1 + 0.45 * (outer**2 - 1.0))
    position, radius = _fill(is_fluid, volume, reach=(outer, 1.1, outer), count=particle_count, margin=wall)
    edge = radius + 0.5 * SPACING
    inner = {"cutoff": rim * radius, "thickness": 0.5 * wall}
    colliders = (
        {"type": "plane_y"},
        {"type": "cylinder_inside", "radius": edge, **inner},
        {"type": "cylinder_outside", "radius": edge + wall, **inner},
        {
            "type": "cylinder_inside",
            "radius": outer * radius + wall + 0.5 * SPACING,
            "cutoff": outer_rim * radius,
            "thickness": wall,
        },
    )
    return _scene("fountain", position, colliders)


BENCH_SCENES: dict[str, Callable[[int], BenchScene]] = {"box": _box, "fountain": _fountain}


def _fill(
    is_fluid: Callable[[np.ndarray, float], np.ndarray],
    volume: float,
    reach: tuple[float, float, float],
    count: int,
    margin: float = 0.0,
) -> tuple[np.ndarray, float]:
    """`count` lattice points of a shape that is as large as they need, the topmost left out; and its size, m.

    is_fluid(points, size) says which points belong to it; `volume` and `reach` (+-x, y, +-z; `margin` m are added) are
    those of the shape at size 1.
    """
    size = SPACING * (count / volume) ** (1 / 3)
    while True:
        points = _lattice([size * reach[0] + margin, size * reach[1], size * reach[2] + margin])
        points = points[is_fluid(points, size)]
        if len(points) >= count:
            lowest = np.argsort(points[:, 1], kind="stable")[:count]
            return points[np.sort(lowest)], size
        size *= 1.01


def _lattice(reach: list[float]) -> np.ndarray:
    """Points a spacing apart, (N, 3): from -reach to reach in x and z, from 0 to reach in y."""
    cells = [max(1, math.ceil(length / SPACING)) for length in reach]
    x, y, z = (
        SPACING * (np.arange(low, high) + 0.5) for low, high in zip((-cells[0], 0, -cells[2]), cells, strict=True)
    )
    return np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)


def _scene(name: str, lattice: np.ndarray, colliders: tuple[dict, ...]) -> BenchScene:
    shift = np.random.default_rng(1).uniform(-_JITTER, _JITTER, lattice.shape) * SPACING
    velocity = np.broadcast_to(np.array(_FALL, dtype=np.float32), lattice.shape)
    return BenchScene(name, (lattice + shift).astype(np.float32), np.ascontiguousarray(velocity), colliders)
