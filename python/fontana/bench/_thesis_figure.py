"""Figs. 15 and 16 of the thesis: frames per second over particles, both axes logarithmic, a panel a scene."""

from __future__ import annotations

import io
import textwrap
from pathlib import Path

from fontana import _core
from fontana.bench._schemes import (
    SCHEMES,
    THESIS_FLOOR,
    THESIS_FRAME_CAP,
    THESIS_HARDWARE,
    THESIS_PLACES,
    THESIS_TABLES,
    gpu_remark,
)

_COLOURS = {"CPU simple": "#7aa6d8", "CPU grid": "#1f5fa8", "GPU simple": "#eab676", "GPU grid": "#c8641b"}
_MARKERS = {"all-pairs": "s", "grid": "o"}
_QUIET = "#666666"


def publish_figure(results: dict, path: Path) -> None:
    """Draws results as `load_results` gives them to a PNG. Raises IoError."""
    _core.publish_file(str(path), _draw(results))


def _draw(results: dict) -> bytes:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    names = [name for name in THESIS_TABLES if name in results["scenes"]] or list(THESIS_TABLES)[:1]
    figure, panels = pyplot.subplots(
        1, len(names), figsize=(5.6 * len(names), 5.4), dpi=110, sharey=True, squeeze=False, layout="constrained"
    )
    for axes, name in zip(panels[0], names, strict=True):
        _draw_panel(axes, name, results["scenes"].get(name, []))
    panels[0][0].set_ylabel(f"frames of {results['settings']['substeps_per_frame']} substeps per second")
    _legend(figure, panels[0])
    figure.supxlabel(textwrap.fill(_facts(results), 90 * len(names)), fontsize=7.5, color=_QUIET)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    pyplot.close(figure)
    return buffer.getvalue()


def _draw_panel(axes, name: str, rows: list[dict]) -> None:
    for index, scheme in enumerate(SCHEMES):
        colour, marker = _COLOURS[scheme.name], _MARKERS[scheme.neighbors]
        _draw_measured(axes, scheme.name, rows, {"color": colour, "marker": marker, "linewidth": 2, "markersize": 6})
        _draw_thesis(axes, THESIS_TABLES[name], index, colour)
    axes.axhline(THESIS_FRAME_CAP, color=_QUIET, linewidth=0.8, linestyle=":")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.grid(which="major", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    axes.set_title(f"{name} ({THESIS_PLACES[name][1]} of the thesis)", fontsize=11)
    axes.set_xlabel("particles")


def _draw_measured(axes, scheme: str, rows: list[dict], style: dict) -> None:
    """A line with its range; what was cut off hangs on it, hollow, where it was predicted."""
    cells = [(row["particles"], row["cells"].get(scheme, {"state": "not run"})) for row in rows]
    measured = [(count, cell["frames_per_second"]) for count, cell in cells if cell["state"] == "measured"]
    predicted = [
        (count, 1 / (10 * cell["predicted_substep_seconds"])) for count, cell in cells if cell["state"] == "cut off"
    ]
    line = [(count, rate["median"]) for count, rate in measured]
    if line:
        axes.plot(*zip(*line, strict=True), **style)
        low, high = zip(*((rate["minimum"], rate["maximum"]) for _, rate in measured), strict=True)
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


def _legend(figure, panels) -> None:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=_COLOURS[scheme.name], marker=_MARKERS[scheme.neighbors], linewidth=2, label=scheme.name)
        for scheme in SCHEMES
    ]
    handles += [
        Line2D([], [], color=_QUIET, marker="o", markerfacecolor="white", linestyle=":", label="predicted, not run"),
        Line2D([], [], color=_QUIET, linewidth=1, linestyle=(0, (5, 3)), label=f"the thesis's own, {THESIS_HARDWARE}"),
        Line2D([], [], color=_QUIET, marker=7, linestyle="", label="the thesis's <0.1"),
        Line2D([], [], color=_QUIET, linewidth=0.8, linestyle=":", label=f"the thesis's cap, {THESIS_FRAME_CAP:g}"),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=2 * len(panels), fontsize=8, frameon=False)


def _facts(results: dict) -> str:
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
    return "; ".join(parts)
