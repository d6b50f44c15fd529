"""A column of water, 1 m wide and 2 m high, let go on a dry bed: a slice of it between slippery planes.

Water of that size hardly feels its viscosity, so any experiment of the same proportions is a scaled copy, apart from
what its bed takes. That is a friction coefficient of a smooth bed: 0.003, half of the 0.006 that the turbulent boundary
layer of a plate has at Reynolds numbers of 10^5 (0.058 Re^-1/5). `friction` here is a share per spacing travelled
within half a spacing of the wall, and so the stress is that share times density times speed squared at any spacing.

The clocks of both experiments are early by a lag, of SPlisHSPlasH's front as of ours; docs/validation.md tells what is
known about it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fontana.validate._case import Stage
from fontana.validate._reference import read_reference
from fontana.validate._scenes import tank

WIDTH, HEIGHT, GRAVITY = 1.0, 2.0, 9.81
BED_FRICTION = 0.003
LAYERS, FRAME_RATE = 4, 100.0
TIME_UNIT = np.sqrt(WIDTH / (2 * GRAVITY))  # s: T = t sqrt(2 g / a)


def scene(spacing: float, length: float) -> dict:
    width = LAYERS * spacing
    return {
        "fluid": {"method": "dfsph", "particle_spacing": spacing, "viscosity": 0.05},
        "forces": {"gravity": [0.0, -GRAVITY, 0.0]},
        "time": {"frame_rate": FRAME_RATE},
        "emitters": [{"type": "block", "centre": [WIDTH / 2, HEIGHT / 2, width / 2], "size": [WIDTH, HEIGHT, width]}],
        "colliders": tank(length, width, BED_FRICTION),
    }


def front(stage: Stage, resolution: int, duration: float, label: str) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and the place of the front (m): of the foremost particle and half a spacing before it."""
    spacing = WIDTH / resolution
    simulation = stage.simulation(scene(spacing, 20.0))
    times, places = [0.0], [WIDTH]
    for frame in stage.frames(simulation, round(duration * FRAME_RATE), label):
        times.append(frame.time)
        places.append(float(frame.position[:, 0].max()) + spacing / 2)
    return np.array(times), np.maximum.accumulate(places)


def peer_front() -> tuple[np.ndarray, np.ndarray]:
    """The same of SPlisHSPlasH (DFSPH, 32 spacings to the width), as benchmarks/dam_break_clock.py measured it."""
    return tuple(read_reference("splishsplash_dam_break_front.csv").T)


def best_lag(errors: Callable[[float], np.ndarray], most: float) -> float:
    """The lag of an experiment's clock, within 0 to `most`, that makes the mean of `errors(lag)` least."""
    lags = np.linspace(0.0, most, 401)
    return float(lags[np.argmin([np.mean(errors(lag)) for lag in lags])])
