"""Martin and Moyce 1952: when the front of a broken dam passes each place, column twice as high as wide."""

from __future__ import annotations

import numpy as np

from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._dam_break import TIME_UNIT, best_lag, front
from fontana.validate._plots import EXPERIMENT, MEASURED, SECOND, plot
from fontana.validate._reference import read_reference

COLUMN = 2.25  # inches: the wider column, with the longer series
MOST_LAG = 0.4  # of the time unit: 15 ms of theirs


def measure(stage: Stage, resolution: int) -> Outcome:
    """Errors are those of the arrival time at each recorded place, over the recorded time.

    The accepted ones are with the clock of the experiment set back by one lag, the same for all places.
    """
    data = read_reference("martin_moyce_1952_n2_2.csv")
    _, recorded, places = data[data[:, 0] == COLUMN].T
    times, fronts = front(stage, resolution, 1.05 * recorded[-1] * TIME_UNIT, "dam break")
    if fronts[-1] < places[-1]:
        places, recorded = places[places <= fronts[-1]], recorded[places <= fronts[-1]]
    arrival = np.interp(places, fronts, times / TIME_UNIT)

    def errors(lag: float) -> np.ndarray:
        return np.abs(arrival + lag - recorded) / recorded

    lag = best_lag(errors, MOST_LAG)
    missing = int((data[:, 0] == COLUMN).sum()) - len(places)
    figures = [
        Figure("arrival time, mean error", 100 * errors(lag).mean(), 8.0),
        Figure("arrival time, largest error", 100 * errors(lag).max(), 20.0),
        Figure("places not reached in time", missing, 0, unit=""),
        Figure("lag of the experiment's clock, of sqrt(a / 2g)", 100 * lag),
        Figure("mean error by the clock as recorded", 100 * errors(0.0).mean()),
        Figure("largest error by the clock as recorded", 100 * errors(0.0).max()),
        Figure("speed of the front beyond Z = 5, off", 100 * (_speed(arrival, places) / _speed(recorded, places) - 1)),
    ]
    curves = {
        "experiment": curve(recorded, places),
        "by the clock as recorded": curve(times / TIME_UNIT, fronts),
        "with the lag": curve(times / TIME_UNIT + lag, fronts),
    }
    return Outcome(figures, curves)


def _speed(times: np.ndarray, places: np.ndarray) -> float:
    return np.polyfit(times[places > 5], places[places > 5], 1)[0]


def draw(axes: object, curves: dict) -> None:
    plot(axes, curves, "by the clock as recorded", SECOND | {"linewidth": 1.0})
    plot(axes, curves, "with the lag", MEASURED)
    plot(axes, curves, "experiment", EXPERIMENT)
    axes.set(xlabel="T = t sqrt(2 g / a)", ylabel="front Z = x / a", xlim=(0, 10), ylim=(0, 15))


CASE = Case("Dam break: front, Martin and Moyce 1952", {SMALL: 12, FULL: 32}, measure, draw)
