"""Errors against exact solutions at three spacings: they must fall as the spacing does.

The decay of the Taylor-Green vortex and the drop whose lattice lies along its axes, since these have errors to lose.
"""

from __future__ import annotations

import numpy as np

from fontana.validate import elliptical_drop, taylor_green
from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._plots import EXACT, MEASURED, SECOND, plot

STEPS = (1.0, 1.5, 2.25)
VORTEX, DROP = "rate of decay of the vortex", "semi-minor axis of the drop"


def measure(stage: Stage, resolution: int) -> Outcome:
    """`resolution` is the coarsest of the vortex, to its side; the drop has two thirds of it to its radius.

    The limit holds the error at the finest spacing over that at the coarsest; in first order it would be 44 %.
    """
    counts = [round(resolution * step) for step in STEPS]
    vortex = [abs(taylor_green.rate_error(taylor_green.decay(stage, count))) for count in counts]
    drop = [_drop_error(stage, round(count * 2 / 3)) for count in counts]
    figures = []
    for name, errors in ((VORTEX, vortex), (DROP, drop)):
        order = -np.polyfit(np.log(STEPS), np.log(errors), 1)[0]
        falls = all(b < a for a, b in zip(errors, errors[1:], strict=False))
        figures += [
            Figure(f"{name}: finest over coarsest", 100 * errors[-1] / errors[0], 75.0),
            Figure(f"{name}: spacings at which it does not fall", int(not falls), 0, unit=""),
            Figure(f"{name}: order in the spacing", order, unit=""),
        ]
    spacing = 1.0 / np.array(counts)
    curves = {VORTEX: curve(spacing, vortex), DROP: curve(1.5 * spacing, drop)}
    curves["first order"] = curve(spacing, vortex[0] * spacing / spacing[0])
    return Outcome(figures, curves)


def _drop_error(stage: Stage, resolution: int) -> float:
    run = elliptical_drop.stretch(stage, resolution, 0.0, f"drop at 1/{resolution}")
    return abs(run["minor"][-1] / run["exact"][-1] - 1)


def draw(axes: object, curves: dict) -> None:
    plot(axes, curves, VORTEX, MEASURED | {"marker": "o"})
    plot(axes, curves, DROP, SECOND | {"marker": "s"})
    plot(axes, curves, "first order", EXACT)
    axes.set(xlabel="spacing over side or radius", ylabel="relative error", xscale="log", yscale="log")


CASE = Case("Convergence with the spacing", {SMALL: 14, FULL: 24}, measure, draw)
