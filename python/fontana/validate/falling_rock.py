"""A ball that falls into a tank and stops dead, in mid-water and on the floor: how fast the fastest droplet is."""

from __future__ import annotations

import numpy as np

from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._plots import EXACT, MEASURED, SECOND, plot
from fontana.validate._scenes import SLIPPERY, tank

SIDE, DEPTH, RADIUS, SPEED = 0.8, 0.4, 0.12, 3.0  # m, m/s
FRAMES, FRAME_RATE = 60, 100.0
# Water slips past the equator of a ball at 1.5 of its speed, and a jet off its edge may gather a little more. On the
# floor no such bound is kept: a particle keeps its size in the closing gap, where water would be a film, and is pinched
# out of it like a cherry stone.
STOPS = {"in mid-water": (DEPTH / 2, 2.0), "on the floor": (RADIUS, None)}


def scene(spacing: float, rest: float) -> dict:
    """The ball starts a spacing above the water and stops with its centre at the height `rest`."""
    top, middle = DEPTH + RADIUS + spacing, SIDE / 2
    keys = [
        {"time": 0.0, "centre": [middle, top, middle]},
        {"time": (top - rest) / SPEED, "centre": [middle, rest, middle]},
    ]
    return {
        "fluid": {"method": "dfsph", "particle_spacing": spacing, "viscosity": 1.0},
        "time": {"frame_rate": FRAME_RATE},
        "emitters": [{"type": "block", "centre": [middle, DEPTH / 2, middle], "size": [SIDE, DEPTH, SIDE]}],
        "colliders": [*tank(SIDE, SIDE), {"type": "sphere_outside", "radius": RADIUS, "keys": keys} | SLIPPERY],
    }


def measure(stage: Stage, resolution: int) -> Outcome:
    spacing = DEPTH / resolution
    figures, curves = [], {}
    for name, (rest, limit) in STOPS.items():
        simulation = stage.simulation(scene(spacing, rest))
        times, speeds, within = [], [], -np.inf
        for frame in stage.frames(simulation, FRAMES, f"stops {name}"):
            times.append(frame.time)
            speeds.append(frame.report.max_speed / SPEED)
            within = max(within, _outside(frame.position))
        figures += [
            Figure(f"stops {name}: fastest droplet, of the rock's speed", max(speeds), limit, unit=""),
            Figure(f"stops {name}: outside the tank, farthest", max(0.0, within) / spacing, 1e-4, unit="d"),
        ]
        curves[f"stops {name}"] = curve(times, speeds)
    curves["bound in mid-water"] = curve([0, FRAMES / FRAME_RATE], [2.0, 2.0])
    return Outcome(figures, curves)


def _outside(position: np.ndarray) -> float:
    """How far the farthest particle is behind floor or sides, m."""
    return float(max(-position.min(), (position[:, [0, 2]] - SIDE).max()))


def draw(axes: object, curves: dict) -> None:
    for name, style in zip(STOPS, (MEASURED, SECOND), strict=True):
        plot(axes, curves, f"stops {name}", style)
    plot(axes, curves, "bound in mid-water", EXACT)
    axes.set(xlabel="time, s", ylabel="fastest particle over the rock's speed")
    axes.set_ylim(bottom=0)


CASE = Case("Rock falling into water", {SMALL: 8, FULL: 20}, measure, draw)
