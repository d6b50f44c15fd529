"""A Taylor-Green vortex in a slippery box: how fast viscosity, the scheme's own included, takes its energy.

u = sin(pi x) cos(pi y), v = -cos(pi x) sin(pi y) in a unit square, times exp(-2 pi^2 nu t): the velocity normal to the
walls and the shear along them are zero, so slippery planes stand in for the periodic box of the textbook.
"""

from __future__ import annotations

import numpy as np

from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._plots import EXACT, MEASURED, SECOND, plot
from fontana.validate._scenes import lattice, walls

REYNOLDS = 100.0  # side times speed over kinematic viscosity
LAYERS, FRAMES, DURATION, STIRRING = 4, 25, 1.0, 0.5  # s
DECAY_RATE = 2 * np.pi**2 / REYNOLDS  # 1/s


def scene(spacing: float) -> dict:
    return {
        "fluid": {"method": "dfsph", "particle_spacing": spacing, "viscosity": 1000.0 / REYNOLDS},
        "forces": {"gravity": [0.0, 0.0, 0.0]},
        "time": {"timestep": DURATION / FRAMES},
        "colliders": [*walls("x", 0.0, 1.0), *walls("y", 0.0, 1.0), *walls("z", 0.0, LAYERS * spacing)],
    }


def vortex(position: np.ndarray) -> np.ndarray:
    x, y = np.pi * position[:, 0], np.pi * position[:, 1]
    return np.stack([np.sin(x) * np.cos(y), -np.cos(x) * np.sin(y), np.zeros_like(x)], axis=-1)


def decay(stage: Stage, resolution: int) -> dict[str, np.ndarray]:
    """Speed over time, and how far the velocities are from the vortex, both root mean square over those at the start.

    The vortex stirs a lattice for a while and is then set anew: what a lattice loses as it breaks up is no viscosity.
    """
    spacing = 1.0 / resolution
    start = lattice(spacing, (0, 1), (0, 1), (0, LAYERS * spacing))
    simulation = stage.simulation(scene(spacing), start, vortex(start))
    lattice_speed = [1.0]
    for frame in stage.frames(simulation, round(STIRRING / DURATION * FRAMES), f"stirring at 1/{resolution}"):
        lattice_speed.append(_norm(frame.velocity) / _norm(vortex(start)))
    stirred = frame.position.astype(float)
    simulation = stage.simulation(scene(spacing), stirred, vortex(stirred))
    rows = [[0.0, 1.0, 0.0]]
    for frame in stage.frames(simulation, FRAMES, f"decay at 1/{resolution}"):
        exact = vortex(frame.position) * np.exp(-DECAY_RATE * frame.time)
        rows.append([frame.time, _norm(frame.velocity), _norm(frame.velocity - exact)])
    rows = np.array(rows)
    rows[1:, 1:] /= _norm(vortex(stirred))
    return dict(zip(("time", "speed", "error"), rows.T, strict=True)) | {"lattice": np.array(lattice_speed)}


def rate_error(run: dict[str, np.ndarray]) -> float:
    """Of the rate at which the speed decays, by the straight line through its logarithm."""
    return -np.polyfit(run["time"], np.log(run["speed"]), 1)[0] / DECAY_RATE - 1


def measure(stage: Stage, resolution: int) -> Outcome:
    run = decay(stage, resolution)
    figures = [
        Figure("rate of decay, off", 100 * rate_error(run)),
        Figure("speed after 1 s, off", 100 * (run["speed"][-1] / np.exp(-DECAY_RATE * DURATION) - 1)),
        Figure("velocities after 1 s, off from the vortex", 100 * run["error"][-1]),
        Figure("speed lost by a lattice as it breaks up, in 0.5 s", 100 * (1 - run["lattice"][-1])),
    ]
    curves = {
        "exact": curve(run["time"], np.exp(-DECAY_RATE * run["time"])),
        "stirred": curve(run["time"], run["speed"]),
        "from a lattice": curve(np.linspace(0, STIRRING, len(run["lattice"])), run["lattice"]),
    }
    return Outcome(figures, curves)


def _norm(velocity: np.ndarray) -> float:
    return float(np.sqrt((velocity.astype(float) ** 2).sum(axis=1).mean()))


def draw(axes: object, curves: dict) -> None:
    plot(axes, curves, "exact", EXACT)
    plot(axes, curves, "stirred", MEASURED)
    plot(axes, curves, "from a lattice", SECOND)
    axes.set(xlabel="time, s", ylabel="root mean square speed over the start's", ylim=(0, 1.05))


CASE = Case("Taylor-Green vortex, Re 100", {SMALL: 24, FULL: 64}, measure, draw)
