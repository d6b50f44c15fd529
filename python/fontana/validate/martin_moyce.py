"""Martin and Moyce 1952: when the front of a broken dam passes each place, column twice as high as wide."""

from __future__ import annotations

import numpy as np

from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._dam_break import TIME_UNIT, best_lag, front, peer_front
from fontana.validate._plots import EXPERIMENT, MEASURED, SECOND, THIRD, plot
from fontana.validate._reference import read_reference

COLUMN = 2.25  # inches: the wider column, with the longer series
MOST_LAG = 0.4  # of the time unit: 15 ms of theirs
# Lethe, a finite element program, adds this to its own times: examples/multiphysics/dam-break/dam-break-2d.py.
LETHE_LAG = 0.175


def experiment() -> tuple[np.ndarray, np.ndarray]:
    """T = t sqrt(2 g / a) and Z = x / a, as recorded."""
    data = read_reference("martin_moyce_1952_n2_2.csv")
    _, recorded, places = data[data[:, 0] == COLUMN].T
    return recorded, places


def arrival_errors(times: np.ndarray, fronts: np.ndarray, lag: float = 0.0) -> np.ndarray:
    """Of the arrival time at each recorded place that the front (s, m) reaches, over the recorded time.

    The experiment's clock is set back by `lag`, in its unit, the same for all places.
    """
    recorded, places = experiment()
    reached = places <= fronts[-1]
    arrival = np.interp(places[reached], fronts, times / TIME_UNIT)
    return np.abs(arrival + lag - recorded[reached]) / recorded[reached]


def own_lag(times: np.ndarray, fronts: np.ndarray) -> float:
    return best_lag(lambda lag: arrival_errors(times, fronts, lag), MOST_LAG)


def measure(stage: Stage, resolution: int) -> Outcome:
    """The lag of the accepted errors is the one that fits SPlisHSPlasH best: ours has no part in it."""
    recorded, places = experiment()
    times, fronts = front(stage, resolution, 1.05 * recorded[-1] * TIME_UNIT, "dam break")
    peer = peer_front()
    lag = own_lag(*peer)
    errors, with_lethes = (arrival_errors(times, fronts, of) for of in (lag, LETHE_LAG))
    as_recorded, of_peer = arrival_errors(times, fronts), arrival_errors(*peer)
    figures = [
        Figure("arrival time, mean error", 100 * errors.mean(), 8.0),
        Figure("arrival time, largest error", 100 * errors.max(), 20.0),
        Figure("places not reached in time", len(places) - len(errors), 0, unit=""),
        Figure("lag of the experiment's clock, of sqrt(a / 2g), by SPlisHSPlasH", 100 * lag),
        Figure("the lag that would fit this result best", 100 * own_lag(times, fronts)),
        Figure("mean error with the lag that Lethe takes, 17.5 %", 100 * with_lethes.mean()),
        Figure("largest error with it", 100 * with_lethes.max()),
        Figure("mean error by the clock as recorded", 100 * as_recorded.mean()),
        Figure("largest error by the clock as recorded", 100 * as_recorded.max()),
        Figure("the same mean error of SPlisHSPlasH", 100 * of_peer.mean()),
        Figure("the same largest error of SPlisHSPlasH", 100 * of_peer.max()),
        Figure("speed of the front beyond Z = 5, off", 100 * (_speed(times, fronts) - 1)),
    ]
    curves = {
        "experiment": curve(recorded, places),
        "by the clock as recorded": curve(times / TIME_UNIT, fronts),
        "with SPlisHSPlasH's lag": curve(times / TIME_UNIT + lag, fronts),
        "SPlisHSPlasH by the clock as recorded": curve(peer[0] / TIME_UNIT, peer[1]),
    }
    return Outcome(figures, curves)


def _speed(times: np.ndarray, fronts: np.ndarray) -> float:
    """Over the experiment's, at the recorded places beyond Z = 5 that the front reaches."""
    recorded, places = experiment()
    far = (places > 5) & (places <= fronts[-1])
    arrival = np.interp(places[far], fronts, times / TIME_UNIT)
    return np.polyfit(arrival, places[far], 1)[0] / np.polyfit(recorded[far], places[far], 1)[0]


def draw(axes: object, curves: dict) -> None:
    plot(axes, curves, "by the clock as recorded", SECOND | {"linewidth": 1.0})
    plot(axes, curves, "SPlisHSPlasH by the clock as recorded", THIRD | {"linewidth": 1.0, "linestyle": "--"})
    plot(axes, curves, "with SPlisHSPlasH's lag", MEASURED)
    plot(axes, curves, "experiment", EXPERIMENT)
    axes.set(xlabel="T = t sqrt(2 g / a)", ylabel="front Z = x / a", xlim=(0, 10), ylim=(0, 15))


CASE = Case("Dam break: front, Martin and Moyce 1952", {SMALL: 12, FULL: 32}, measure, draw)
