"""Koshizuka and Oka 1996: where the tip of a broken dam is, column twice as high as wide, scaled to 1 m."""

from __future__ import annotations

import numpy as np

from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._dam_break import TIME_UNIT, WIDTH, best_lag, front
from fontana.validate._plots import EXPERIMENT, MEASURED, SECOND, plot
from fontana.validate._reference import read_reference

MOST_LAG = 0.4  # of the time unit


def measure(stage: Stage, resolution: int) -> Outcome:
    """The accepted error is with the clock of the experiment set back by one lag."""
    recorded, places = read_reference("koshizuka_oka_1996_tip.csv").T
    times, fronts = front(stage, resolution, recorded[-1] + 0.02, "dam break")

    def errors(lag: float) -> np.ndarray:
        return np.abs(np.interp(recorded - lag * TIME_UNIT, times, fronts) - places) / WIDTH

    lag = best_lag(errors, MOST_LAG)
    figures = [
        Figure("tip, mean error, of the column's width", 100 * errors(lag).mean(), 5.0),
        Figure("tip, largest error, of the column's width", 100 * errors(lag).max()),
        Figure("lag of the experiment's clock, of sqrt(a / 2g)", 100 * lag),
        Figure("mean error by the clock as recorded", 100 * errors(0.0).mean()),
    ]
    curves = {
        "experiment": curve(recorded, places),
        "by the clock as recorded": curve(times, fronts),
        "with the lag": curve(times + lag * TIME_UNIT, fronts),
    }
    return Outcome(figures, curves)


def draw(axes: object, curves: dict) -> None:
    plot(axes, curves, "by the clock as recorded", SECOND | {"linewidth": 1.0})
    plot(axes, curves, "with the lag", MEASURED)
    plot(axes, curves, "experiment", EXPERIMENT)
    axes.set(xlabel="time, s", ylabel="tip, m", xlim=(0, 0.8), ylim=(0.9, 4.5))


CASE = Case("Dam break: tip, Koshizuka and Oka 1996", {SMALL: 12, FULL: 32}, measure, draw)
