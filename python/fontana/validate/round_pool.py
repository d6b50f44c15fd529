"""Water at rest in an upright cylinder: nobody leaves it, nothing moves, and it is as dense at the wall as within."""

from __future__ import annotations

import numpy as np

from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._plots import EXACT, MEASURED, plot
from fontana.validate._scenes import SLIPPERY, floor, lattice

RADIUS, DEPTH, GRAVITY, REST_DENSITY = 0.4, 0.5, 9.81, 1000.0
FRAMES, FRAME_RATE = 180, 50.0
RIM = {"cutoff": 0.6, "thickness": 0.05}


def scene(spacing: float) -> dict:
    """The wall ends at a rim above the water and is as thin as two spacings of the coarsest run."""
    return {
        "fluid": {"method": "dfsph", "particle_spacing": spacing, "viscosity": 10.0, "rest_density": REST_DENSITY},
        "forces": {"gravity": [0.0, -GRAVITY, 0.0]},
        "solver": {"quality": "good"},
        "time": {"frame_rate": FRAME_RATE},
        "colliders": [floor(), {"type": "cylinder_inside", "radius": RADIUS} | RIM | SLIPPERY],
    }


def measure(stage: Stage, resolution: int) -> Outcome:
    spacing = DEPTH / resolution
    water = lattice(spacing, (-RADIUS, RADIUS), (0.0, DEPTH), (-RADIUS, RADIUS))
    water = water[np.hypot(water[:, 0], water[:, 2]) < RADIUS - 0.4 * spacing]
    depth = len(water) * spacing**3 / (np.pi * RADIUS**2)
    simulation = stage.simulation(scene(spacing), water)
    leak, times, speeds, counts = -np.inf, [], [], []
    for frame in stage.frames(simulation, FRAMES, "coming to rest"):
        position = frame.position
        distance = np.hypot(position[:, 0], position[:, 2])
        leak = max(leak, float((distance - RADIUS).max()), float(-position[:, 1].min()))
        times.append(frame.time)
        speeds.append(np.sqrt((frame.velocity.astype(float) ** 2).sum(axis=1).mean() / (GRAVITY * depth)))
        if frame.number > FRAMES // 2:
            counts.append(_filling(distance, position[:, 1], spacing, depth))
    density = frame.density / REST_DENSITY - 1
    at_wall = (distance > RADIUS - spacing) & (position[:, 1] < 0.6 * depth)
    outer, inner = np.mean(counts, axis=0)
    figures = [
        Figure("particles outside, farthest", max(0.0, leak) / spacing, 1e-4, unit="d"),
        Figure("residual speed, root mean square, of sqrt(g H)", 100 * np.mean(speeds[-FRAMES // 3 :]), 1.0),
        Figure("density of the layer at the wall, mean error", 100 * np.abs(density[at_wall]).mean(), 1.0),
        Figure("density of the layer at the wall, largest error", 100 * np.abs(density[at_wall]).max(), 2.0),
        Figure("particles a volume in two spacings at the wall, off from within", 100 * (outer / inner - 1), 5.0),
        Figure("centre of mass, off from half the depth", 100 * (position[:, 1].mean() / (depth / 2) - 1), 2.0),
    ]
    curves = {"residual speed": curve(times, speeds), "1 %": curve([0, times[-1]], [0.01, 0.01])}
    return Outcome(figures, curves)


def _filling(distance: np.ndarray, height: np.ndarray, spacing: float, depth: float) -> tuple[float, float]:
    """Rest volume over volume in the outer two spacings and within them, away from floor and surface."""
    low, high, edge = 2 * spacing, 0.7 * depth, RADIUS - 2 * spacing
    is_between = (height >= low) & (height < high)
    within = (is_between & (distance < edge)).sum() * spacing**3 / (np.pi * edge**2 * (high - low))
    outside = (is_between & (distance >= edge)).sum() * spacing**3
    return outside / (np.pi * (RADIUS**2 - edge**2) * (high - low)), within


def draw(axes: object, curves: dict) -> None:
    plot(axes, curves, "residual speed", MEASURED)
    plot(axes, curves, "1 %", EXACT)
    axes.set(xlabel="time, s", ylabel="root mean square speed over sqrt(g H)", yscale="log")


CASE = Case("Pool in a cylinder", {SMALL: 10, FULL: 20}, measure, draw)
