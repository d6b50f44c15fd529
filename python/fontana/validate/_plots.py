"""One picture a case."""

from __future__ import annotations

import io
from pathlib import Path

from fontana import _core
from fontana.validate._case import Case

MEASURED = {"color": "#1f5fa8", "linewidth": 1.8}
SECOND = {"color": "#c8641b", "linewidth": 1.8}
THIRD = {"color": "#4f8a5b", "linewidth": 1.8}
EXACT = {"color": "#444444", "linewidth": 1.2, "linestyle": "--", "zorder": 3}
EXPERIMENT = {"color": "#444444", "marker": "o", "markersize": 4.5, "linestyle": "", "markerfacecolor": "white"}


def publish_picture(case: Case, results: dict, path: Path) -> None:
    """Draws a case's results, as its JSON has them, to a PNG. Raises IoError."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(5.8, 4.2), dpi=100, layout="constrained")
    axes.set_axisbelow(True)
    axes.grid(color="#dddddd", linewidth=0.6)
    case.draw(axes, results["curves"])
    axes.set_title(case.title, fontsize=10.5)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, fontsize=8.5)
    figure.supxlabel(_remark(results), fontsize=7.5, color="#666666")
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    pyplot.close(figure)
    _core.publish_file(str(path), buffer.getvalue())


def _remark(results: dict) -> str:
    most = max(run["particles"] for run in results["runs"])
    methods = ", ".join(sorted({run["method"] for run in results["runs"]}))
    return f"{methods}; {results['settings']['resolution']} spacings to the length; up to {most:,} particles"


def plot(axes: object, curves: dict, name: str, style: dict, label: str | None = None) -> None:
    """One curve by its name, which is also its label unless another is given."""
    axes.plot(curves[name]["x"], curves[name]["y"], label=name if label is None else label, **style)
