"""`fontana bench houdini`: Tables 3 and 4 of the thesis and their plots, by the node's cook on a double of the HDK."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from statistics import quantiles

import click

from fontana import _core
from fontana.bench._cook import build_driver, run_driver
from fontana.bench._houdini_tables import print_results, progress_text
from fontana.bench._machine import missing_backends
from fontana.bench._options import budget_option, counts_option, out_option, scenes_option, threads_option
from fontana.bench._results import publish_json
from fontana.bench._scenes import bench_scene
from fontana.bench._schemes import SCHEMES, Scheme
from fontana.bench._tables_run import describe_results, measure_and_publish
from fontana.bench._timing import beyond_budget, significant, statistics

RESULTS_NAME = "houdini.json"
WARM_UP_FRAMES = 2
LEAST_PAIRS, MOST_PAIRS = 5, 30
GOAL_COUNT = 100_000
_PROBE_COUNT = 1000  # where a scheme's cost is asked for before the first row


@click.command(short_help="The solver node beside the library: the thesis's tables of Houdini anew.")
@out_option(RESULTS_NAME)
@counts_option
@budget_option(20.0, "five pairs of frames")
@scenes_option
@threads_option
def command(out: Path, counts: list[int], budget: float, scene_names: list[str], threads: int) -> None:
    """Time the solver node's cook beside the same frames through the library: Tables 3 and 4, Figs. 17 and 18.

    The node is compiled against a double of the HDK and cooks in it: points in, ten substeps, points out. Frames of
    both are taken in turn. Needs a checkout of Fontana and cmake; the first run builds. Ctrl-C keeps what is measured.

    \b
    Examples:
      fontana bench houdini
      fontana bench houdini --counts 100000 --scenes box --budget 90 --out out/goal
      fontana bench plot out/bench/houdini.json
    """
    path = out / RESULTS_NAME
    settings = {"counts": counts, "budget_seconds": budget, "threads": threads}
    settings |= {"warm_up_frames": WARM_UP_FRAMES, "most_pairs": MOST_PAIRS}
    results = describe_results("houdini", scene_names, **settings)
    results |= {"overhead_percent_100k": None, "overhead_processor_percent_100k": None}
    publish_json(path, results)  # a folder that cannot be written is found now, not in the end
    click.echo("building the node against the double of the HDK ...", err=True)
    driver = build_driver(Path.cwd())
    measure_and_publish(
        results, path, lambda publish: measure_all(results, driver, missing_backends(), publish), print_results
    )


def measure_all(results: dict, driver: tuple[Path, Path], missing: dict[str, str], publish: Callable[[], None]) -> None:
    """Fills results["scenes"] number by number and calls `publish` after each row."""
    for name, rows in results["scenes"].items():
        for count in results["settings"]["counts"]:
            rows.append({"particles": count, "cells": {}})
            for scheme in SCHEMES:
                cell = _cell(scheme, name, rows, driver, missing, results["settings"])
                rows[-1]["cells"][scheme.name] = cell
                click.echo(f"{name}, {count:,} particles, {scheme.name}: {progress_text(cell)}", err=True)
            for kind in ("overhead_percent", "overhead_processor_percent"):
                results[f"{kind}_100k"] = largest_overhead(results, kind)
            publish()


def largest_overhead(results: dict, kind: str) -> float | None:
    """The largest median overhead of the grid at 100,000 particles, in percent; None before there is one."""
    cells = [
        row["cells"].get(scheme.name, {})
        for rows in results["scenes"].values()
        for row in rows
        for scheme in SCHEMES
        if row["particles"] == GOAL_COUNT and scheme.neighbors == "grid"
    ]
    return max((cell[kind]["median"] for cell in cells if kind in cell), default=None)


def _cell(
    scheme: Scheme, name: str, rows: list[dict], driver: tuple[Path, Path], missing: dict[str, str], settings: dict
) -> dict:
    """One number of a table, or why there is none."""
    if scheme.backend in missing:
        return {"state": "not run", "reason": missing[scheme.backend]}
    budget, threads, count = settings["budget_seconds"], settings["threads"], rows[-1]["particles"]
    try:
        expected = _predict(scheme, name, rows, driver, settings)
        if reason := beyond_budget(2.0 * LEAST_PAIRS * expected, budget, f"{LEAST_PAIRS} pairs of frames"):
            return {"state": "cut off", "reason": reason, "predicted_frame_seconds": significant(expected)}
        heard = _ask(scheme, name, count, driver, (WARM_UP_FRAMES, MOST_PAIRS, budget), threads)
    except _core.FontanaError as error:
        return {"state": "failed", "reason": str(error)}
    cell: dict = {"state": "measured"}
    for kind in ("", "processor_"):
        of_node, of_library = heard[f"node_{kind}seconds"], heard[f"library_{kind}seconds"]
        pairs = zip(of_node, of_library, strict=True)
        overhead = [100.0 * (node / max(library, 1e-6) - 1.0) for node, library in pairs]
        cell[f"node_{kind}seconds"] = statistics(of_node)
        cell[f"library_{kind}seconds"] = statistics(of_library)
        cell[f"overhead_{kind}percent"] = statistics(overhead) | _quartiles(overhead)
    return cell


def _quartiles(values: list[float]) -> dict[str, float]:
    lower, _, upper = quantiles(values, n=4, method="inclusive") if len(values) > 1 else 3 * values
    return {"lower_quartile": significant(lower), "upper_quartile": significant(upper)}


def _ask(
    scheme: Scheme, name: str, count: int, driver: tuple[Path, Path], repeats: tuple[int, int, float], threads: int
) -> dict:
    scene = bench_scene(name, count)
    _, dt = scene.build(scheme.backend, threads)
    return run_driver(driver, scene, scheme, dt, repeats, threads)


def _predict(scheme: Scheme, name: str, rows: list[dict], driver: tuple[Path, Path], settings: dict) -> float:
    """Seconds a frame will take, from the row before or, in the first, from a small scene."""
    count = rows[-1]["particles"]
    if len(rows) > 1:
        cell = rows[-2]["cells"][scheme.name]
        seconds = cell["node_seconds"]["median"] if "node_seconds" in cell else cell.get("predicted_frame_seconds", 0.0)
        known = rows[-2]["particles"], seconds
    elif count > _PROBE_COUNT:
        heard = _ask(scheme, name, _PROBE_COUNT, driver, (1, 1, 1.0), settings["threads"])
        known = _PROBE_COUNT, heard["node_seconds"][0]
    else:
        return 0.0
    return known[1] * (count / known[0]) ** scheme.exponent
