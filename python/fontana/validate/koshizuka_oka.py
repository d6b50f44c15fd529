"""Koshizuka and Oka 1996: where the tip of a broken dam is, column twice as high as wide, scaled to 1 m."""

from __future__ import annotations

import numpy as np

from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._dam_break import GRAVITY, HEIGHT, TIME_UNIT, WIDTH, best_lag, front, peer_front
from fontana.validate._plots import EXPERIMENT, MEASURED, SECOND, THIRD, plot
from fontana.validate._reference import read_reference

# Of the time unit. Their column was 0.146 m wide and filmed at 30 pictures a second (as the series of Lobovsky et al.
# 2014, Fig. 12, shows), the first at rest: the water was let go at some time before the second.
ONE_PICTURE = (1 / 30) / np.sqrt(0.146 / (2 * GRAVITY))
HU_RUNS = (1, 2)


def experiment() -> tuple[np.ndarray, np.ndarray]:
    """Time (s) and place of the tip (m), as recorded, scaled to our column."""
    recorded, places = read_reference("koshizuka_oka_1996_tip.csv").T
    return recorded, places


def hu_2010(run: int) -> tuple[np.ndarray, np.ndarray]:
    """The same of another experiment with such a column."""
    data = read_reference("hu_2010_tip.csv")
    _, recorded, places = data[data[:, 0] == run].T
    return recorded * np.sqrt(HEIGHT / GRAVITY), WIDTH + places * HEIGHT


def tip_errors(
    times: np.ndarray, fronts: np.ndarray, lag: float = 0.0, recorded: tuple[np.ndarray, np.ndarray] | None = None
) -> np.ndarray:
    """Of the tip at each recorded time, over the width, with the experiment's clock set back by `lag` time units."""
    when, where = experiment() if recorded is None else recorded
    return np.abs(np.interp(when - lag * TIME_UNIT, times, fronts) - where) / WIDTH


def against_hu(run: int, times: np.ndarray, fronts: np.ndarray) -> Figure:
    errors = tip_errors(times, fronts, recorded=hu_2010(run))
    return Figure(f"the same against Hu 2010, run {run}", 100 * errors.mean())


def own_lag(times: np.ndarray, fronts: np.ndarray) -> float:
    return best_lag(lambda lag: tip_errors(times, fronts, lag), ONE_PICTURE)


def measure(stage: Stage, resolution: int) -> Outcome:
    """The accepted error is with the clock of the experiment set back by one lag, of less than a picture."""
    recorded, places = experiment()
    times, fronts = front(stage, resolution, recorded[-1] + 0.02, "dam break")
    peer = peer_front()
    lag, peer_lag = own_lag(times, fronts), own_lag(*peer)
    errors = tip_errors(times, fronts, lag)
    figures = [
        Figure("tip, mean error, of the column's width", 100 * errors.mean(), 5.0),
        Figure("tip, largest error, of the column's width", 100 * errors.max()),
        Figure("lag of the experiment's clock, of sqrt(a / 2g)", 100 * lag),
        Figure("the lag that would fit SPlisHSPlasH best", 100 * peer_lag),
        Figure("mean error with that lag", 100 * tip_errors(times, fronts, peer_lag).mean()),
        Figure("mean error by the clock as recorded", 100 * tip_errors(times, fronts).mean()),
        Figure("the same of SPlisHSPlasH", 100 * tip_errors(*peer).mean()),
        *(against_hu(run, times, fronts) for run in HU_RUNS),
    ]
    curves = {
        "experiment": curve(recorded, places),
        "by the clock as recorded": curve(times, fronts),
        "with the lag": curve(times + lag * TIME_UNIT, fronts),
        "SPlisHSPlasH by the clock as recorded": curve(*peer),
        **{f"Hu 2010, run {run}": curve(*hu_2010(run)) for run in HU_RUNS},
    }
    return Outcome(figures, curves)


def draw(axes: object, curves: dict) -> None:
    plot(axes, curves, "by the clock as recorded", SECOND | {"linewidth": 1.0})
    plot(axes, curves, "SPlisHSPlasH by the clock as recorded", THIRD | {"linewidth": 1.0, "linestyle": "--"})
    plot(axes, curves, "with the lag", MEASURED)
    plot(axes, curves, "experiment", EXPERIMENT)
    for run, marker in zip(HU_RUNS, "^v", strict=True):
        style = EXPERIMENT | {"marker": marker, "markersize": 3.5, "color": "#9a9a9a"}
        plot(axes, curves, f"Hu 2010, run {run}", style)
    axes.set(xlabel="time, s", ylabel="tip, m", xlim=(0, 0.8), ylim=(0.9, 4.5))


CASE = Case("Dam break: tip, Koshizuka and Oka 1996", {SMALL: 12, FULL: 32}, measure, draw)
