"""The results of `fontana bench houdini` as tables for people."""

from __future__ import annotations

import click

from fontana.bench._machine import load_remark
from fontana.bench._schemes import (
    SCHEMES,
    THESIS_HARDWARE,
    THESIS_HOUDINI_PLACES,
    THESIS_SECONDS,
    gpu_remark,
)
from fontana.bench._tables import shortfalls
from fontana.bench._text import print_table, short_number
from fontana.runs.text import clock as clock_text


def print_results(results: dict) -> None:
    """Two tables a scene: seconds of a frame through the node, and what the node adds; then the remarks."""
    for name, rows in results["scenes"].items():
        if rows:
            columns = ["particles", *(scheme.name for scheme in SCHEMES)]
            title = f"{name}: seconds a frame in the node ({THESIS_HOUDINI_PLACES[name][0]}: a run)"
            print_table(title, columns, [_line(name, row, _seconds_text) for row in rows])
            title = f"{name}: what the node adds, percent by the clock, and of processor time"
            print_table(title, columns, [_line(name, row, _overhead_text) for row in rows])
    for remark in _remarks(results):
        click.echo(remark)


def _line(scene: str, row: dict, text: object) -> list[str]:
    then = THESIS_SECONDS[scene].get(row["particles"])
    cells = [row["cells"].get(scheme.name) for scheme in SCHEMES]
    texts = [text(cell, then[column] if then else None) if cell else "" for column, cell in enumerate(cells)]
    return [f"{row['particles']:,}", *texts]


def _seconds_text(cell: dict, then: float | None) -> str:
    beside = f" ({then:g})" if then else ""
    if cell["state"] == "measured":
        return short_number(cell["node_seconds"]["median"]) + beside
    if cell["state"] == "cut off":
        return f"cut off, about {clock_text(cell['predicted_frame_seconds'])}{beside}"
    return cell["state"] + beside


def _overhead_text(cell: dict, then: float | None) -> str:
    if cell["state"] != "measured":
        return cell["state"]
    found = cell["overhead_percent"]
    spread = f"({found['lower_quartile']:+.1f} to {found['upper_quartile']:+.1f})"
    return f"{found['median']:+.1f} {spread}, {cell['overhead_processor_percent']['median']:+.1f}"


def progress_text(cell: dict) -> str:
    """A cell for a line of its own."""
    if cell["state"] == "measured":
        return f"{_seconds_text(cell, None)} s a frame, overhead {_overhead_text(cell, None)} %"
    return f"{cell['state']}: {cell['reason']}" if "reason" in cell else _seconds_text(cell, None)


def _remarks(results: dict) -> list[str]:
    settings, machine = results["settings"], results["machine"]
    threads = settings["threads"] or machine["usable_cores"]
    lines = [
        "the node cooked on a double of the HDK, not in Houdini: points in, ten substeps, points out and kept for "
        "scrubbing; Houdini's own work around a cook is not in it",
        "an overhead is the median of pairs of frames taken in turn, and half of the pairs lie between the numbers in "
        "brackets; at the end both had the same bytes",
        "processor time is that of all threads, which other programs disturb less",
        f"in brackets beside the seconds: the thesis's ({THESIS_HARDWARE}), of a run whose length it does not give",
        f"CPU: {machine['cpu']}, {threads} thread{'s' * (threads != 1)}; {machine['os']}",
    ]
    if results["overhead_percent_100k"] is not None:
        clock, processor = results["overhead_percent_100k"], results["overhead_processor_percent_100k"]
        lines.append(
            f"largest overhead by the grid at 100,000 particles: {clock:.1f} % by the clock, {processor:.1f} % of "
            "processor time"
        )
    lines += [remark for remark in (gpu_remark(results), load_remark(results)) if remark]
    return lines + shortfalls(results)
