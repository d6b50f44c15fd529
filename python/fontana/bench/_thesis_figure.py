"""Figs. 15 to 18 of the thesis: frames per second, or seconds in the node, over particles; both axes logarithmic, a
panel a scene."""

from __future__ import annotations

import io
import textwrap
from collections.abc import Callable
from dataclasses import dataclass

from fontana.bench._schemes import (
    SCHEMES,
    THESIS_FLOOR,
    THESIS_FRAME_CAP,
    THESIS_HARDWARE,
    THESIS_HOUDINI_PLACES,
    THESIS_PLACES,
    THESIS_SECONDS,
    THESIS_TABLES,
    gpu_remark,
)

_COLOURS = {"CPU simple": "#7aa6d8", "CPU grid": "#1f5fa8", "GPU simple": "#eab676", "GPU grid": "#c8641b"}
_MARKERS = {"all-pairs": "s", "grid": "o"}
_QUIET = "#666666"


@dataclass(frozen=True)
class _Plot:
    """What the results of one benchmark are drawn as. `measured`: the key of the numbers in a cell."""

    label: str
    measured: str
    predicted: Callable[[dict], float]
    thesis: dict[str, dict[int, tuple[float | None, ...]]]
    places: dict[str, tuple[str, str]]
    thesis_label: str
    is_capped: bool
    remarks: tuple[str, ...] = ()


_PLOTS = {
    "thesis": _Plot(
        label="frames of {substeps} substeps per second",
        measured="frames_per_second",
        predicted=lambda cell: 1 / (10 * cell["predicted_substep_seconds"]),
        thesis=THESIS_TABLES,
        places=THESIS_PLACES,
        thesis_label=f"the thesis's own, {THESIS_HARDWARE}",
        is_capped=True,
    ),
    "houdini": _Plot(
        label="seconds a frame of {substeps} substeps (the thesis's: a run)",
        measured="node_seconds",
        predicted=lambda cell: cell["predicted_frame_seconds"],
        thesis=THESIS_SECONDS,
        places=THESIS_HOUDINI_PLACES,
        thesis_label=f"the thesis's own, {THESIS_HARDWARE}; of a run, whose length it does not give",
        is_capped=False,
        remarks=("the node cooked on a double of the HDK, not in Houdini",),
    ),
}


def draw_figure(results: dict) -> bytes:
    """The PNG of results as `load_results` gives them."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    plot = _PLOTS[results["benchmark"]]
    names = [name for name in plot.thesis if name in results["scenes"]] or list(plot.thesis)[:1]
    figure, panels = pyplot.subplots(
        1, len(names), figsize=(5.6 * len(names), 5.4), dpi=110, sharey=True, squeeze=False, layout="constrained"
    )
    for axes, name in zip(panels[0], names, strict=True):
        _draw_panel(axes, plot, name, results["scenes"].get(name, []))
    panels[0][0].set_ylabel(plot.label.format(substeps=results["settings"]["substeps_per_frame"]))
    _legend(figure, plot, panels[0])
    figure.supxlabel(
        textwrap.fill("; ".join([*plot.remarks, *_facts(results)]), 90 * len(names)), fontsize=7.5, color=_QUIET
    )
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    pyplot.close(figure)
    return buffer.getvalue()


def _draw_panel(axes, plot: _Plot, name: str, rows: list[dict]) -> None:
    for index, scheme in enumerate(SCHEMES):
        colour, marker = _COLOURS[scheme.name], _MARKERS[scheme.neighbors]
        style = {"color": colour, "marker": marker, "linewidth": 2, "markersize": 6}
        _draw_measured(axes, plot, scheme.name, rows, style)
        _draw_thesis(axes, plot.thesis[name], index, colour)
    if plot.is_capped:
        axes.axhline(THESIS_FRAME_CAP, color=_QUIET, linewidth=0.8, linestyle=":")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(which="major", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.set_title(f"{name} ({plot.places[name][1]} of the thesis)", fontsize=11)
    axes.set_xlabel("particles")


def _draw_measured(axes, plot: _Plot, scheme: str, rows: list[dict], style: dict) -> None:
    """A line with its range; what was cut off hangs on it, hollow, where it was predicted."""
    cells = [(row["particles"], row["cells"].get(scheme, {"state": "not run"})) for row in rows]
    measured = [(count, cell[plot.measured]) for count, cell in cells if cell["state"] == "measured"]
    predicted = [(count, plot.predicted(cell)) for count, cell in cells if cell["state"] == "cut off"]
    line = [(count, found["median"]) for count, found in measured]
    if line:
        axes.plot(*zip(*line, strict=True), **style)
        low, high = zip(*((found["minimum"], found["maximum"]) for _, found in measured), strict=True)
        axes.vlines([count for count, _ in measured], low, high, color=style["color"], linewidth=1)
    if predicted:
        hollow = style | {"markerfacecolor": "white", "linewidth": 1, "linestyle": (0, (1, 1.5))}
        axes.plot(*zip(*line[-1:], *predicted, strict=True), **(hollow | {"marker": ""}))
        axes.plot(*zip(*predicted, strict=True), **(hollow | {"linestyle": ""}))


def _draw_thesis(axes, table: dict, column: int, colour: str) -> None:
    """Dashed; the thesis's "<0.1" is an arrow down."""
    known = [(count, values[column]) for count, values in table.items() if values[column] is not None]
    axes.plot(*zip(*known, strict=True), color=colour, linewidth=1, linestyle=(0, (5, 3)))
    below = [count for count, values in table.items() if values[column] is None]
    axes.plot(below, [THESIS_FLOOR] * len(below), color=colour, marker=7, markersize=5, linestyle="")


def _legend(figure, plot: _Plot, panels) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=_COLOURS[scheme.name], marker=_MARKERS[scheme.neighbors], linewidth=2, label=scheme.name)
        for scheme in SCHEMES
    ]
    handles += [
        Line2D([], [], color=_QUIET, marker="o", markerfacecolor="white", linestyle=":", label="predicted, not run"),
        Line2D([], [], color=_QUIET, linewidth=1, linestyle=(0, (5, 3)), label=plot.thesis_label),
    ]
    if plot.is_capped:
        handles += [
            Line2D([], [], color=_QUIET, marker=7, linestyle="", label="the thesis's <0.1"),
            Line2D([], [], color=_QUIET, linewidth=0.8, linestyle=":", label=f"the thesis's cap, {THESIS_FRAME_CAP:g}"),
        ]
    figure.legend(handles=handles, loc="outside upper center", ncols=2 * len(panels), fontsize=8, frameon=False)


def _facts(results: dict) -> list[str]:
    machine, commit = results["machine"], results.get("commit")
    threads = results["settings"]["threads"] or machine["usable_cores"]
    parts = [f"CPU: {machine['cpu']}, {threads} thread{'s' * (threads != 1)}"]
    parts += [
        f"GPU: {device.get('name')}"
        for device in results["devices"]
        if device["backend"] == "opencl" and device["is_gpu"] and device["available"]
    ]
    if gpu_remark(results):
        parts.append(gpu_remark(results))
    if commit:
        parts.append(f"commit {commit['hash'][:10]}{' with changes' if commit['dirty'] else ''}")
    return parts
