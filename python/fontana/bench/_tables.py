"""The results of `fontana bench thesis` as tables for people."""

from __future__ import annotations

import click

from fontana.bench._machine import load_remark
from fontana.bench._schemes import SCHEMES, THESIS_FRAME_CAP, THESIS_PLACES, gpu_remark
from fontana.bench._text import print_table, short_number
from fontana.runs.text import clock


def print_results(results: dict) -> None:
    """Two tables a scene: frames a second, and work a second with the ratio to the first column; then the remarks."""
    for name, rows in results["scenes"].items():
        if not rows:
            continue
        table = THESIS_PLACES[name][0]
        _print(f"{name}: frames per second ({table} of the thesis)", rows, cell_text)
        _print(f"{name}: million particle-substeps per second (times CPU simple)", rows, _work_text)
    for remark in remarks(results):
        click.echo(remark)


def _print(title: str, rows: list[dict], text: object) -> None:
    columns = ["particles", "neighbours", *(scheme.name for scheme in SCHEMES)]
    lines = []
    for row in rows:
        neighbors = f"{row['mean_neighbors']:.1f}" if "mean_neighbors" in row else ""
        cells = [row["cells"].get(scheme.name) for scheme in SCHEMES]
        lines.append([f"{row['particles']:,}", neighbors, *(text(cell) if cell else "" for cell in cells)])
    print_table(title, columns, lines)


def cell_text(cell: dict) -> str:
    """Frames a second, or why there are none."""
    if cell["state"] == "measured":
        return short_number(cell["frames_per_second"]["median"])
    if cell["state"] == "cut off":
        return f"cut off (about {clock(cell['predicted_substep_seconds'])} a substep)"
    return cell["state"]


def progress_text(cell: dict) -> str:
    """The same for a line of its own."""
    if cell["state"] == "measured":
        return f"{cell_text(cell)} frames per second"
    return f"{cell['state']}: {cell['reason']}" if "reason" in cell else cell_text(cell)


def _work_text(cell: dict) -> str:
    if cell["state"] != "measured":
        return cell["state"]
    text = short_number(cell["million_particle_substeps_per_second"]["median"])
    if "ratio_to_cpu_simple" in cell:
        about = "about " if cell["ratio_is_estimate"] else ""
        text += f" ({about}{short_number(cell['ratio_to_cpu_simple'])}x)"
    return text


def remarks(results: dict) -> list[str]:
    """The sentences under the tables: what they mean, where they were measured, and what is not as it should be."""
    settings, machine = results["settings"], results["machine"]
    threads = settings["threads"] or machine["usable_cores"]
    lines = [
        f"a frame is {settings['substeps_per_frame']} substeps, uncapped; the thesis's display stopped at "
        f"{THESIS_FRAME_CAP:g} frames per second",
        f"CPU: {machine['cpu']}, {threads} thread{'s' * (threads != 1)}; {machine['os']}",
    ]
    lines += [remark for remark in (gpu_remark(results), load_remark(results)) if remark]
    used = next((device for device in results["devices"] if device["backend"] == "opencl" and device["is_gpu"]), None)
    if used:
        lines.append(f"GPU: {used['name']}, {used['driver']}")
    return lines + shortfalls(results)


def shortfalls(results: dict) -> list[str]:
    """Which numbers were cut off, what went wrong (each sentence once), and whether the run was stopped."""
    lines = []
    for name, rows in results["scenes"].items():
        for row in rows:
            for scheme, cell in row["cells"].items():
                if cell["state"] == "cut off" and "reason" in cell:
                    lines.append(f"cut off: {name}, {row['particles']:,} particles, {scheme}: {cell['reason']}")
                if cell["state"] == "failed":
                    lines.append(f"failed: {cell['reason']}")
    if results["state"] == "interrupted":
        lines.append("interrupted: these are the numbers until then")
    return list(dict.fromkeys(lines))
