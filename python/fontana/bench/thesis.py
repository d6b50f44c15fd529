"""`fontana bench thesis`: the thesis's Tables 1 and 2 and Figs. 15 and 16 anew."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import click

from fontana import _core
from fontana.bench._machine import missing_backends
from fontana.bench._options import budget_option, counts_option, out_option, scenes_option, threads_option
from fontana.bench._results import publish_json
from fontana.bench._scenes import bench_scene
from fontana.bench._schemes import REFERENCE, SCHEMES, Scheme
from fontana.bench._tables import print_results, progress_text
from fontana.bench._tables_run import describe_results, measure_and_publish
from fontana.bench._timing import WARM_UP_SUBSTEPS, beyond_budget, clock_substeps, significant

RESULTS_NAME = "thesis.json"
_PROBE_COUNT = 1000  # where a scheme's cost is asked for before the first row


@click.command(short_help="Four schemes in two scenes: the thesis's tables anew.")
@out_option(RESULTS_NAME)
@counts_option
@budget_option(5.0, "one substep")
@scenes_option
@threads_option
def command(out: Path, counts: list[int], budget: float, scene_names: list[str], threads: int) -> None:
    """Measure the thesis's four schemes in its two scenes: Tables 1 and 2, Figs. 15 and 16.

    A frame is ten substeps, as in the thesis, whose display stopped at 24 frames a second; here nothing stops it. A
    substep takes what the limits of stability allow, not a tenth of a frame of film: the work is the same. Ctrl-C keeps
    what is measured.

    \b
    Examples:
      fontana bench thesis
      fontana bench thesis --counts 1000,1000000 --scenes box --budget 20
      fontana bench plot out/bench/thesis.json
    """
    path = out / RESULTS_NAME
    settings = {"counts": counts, "budget_seconds": budget, "threads": threads, "warm_up_substeps": WARM_UP_SUBSTEPS}
    results = describe_results("thesis", scene_names, **settings)
    publish_json(path, results)  # a folder that cannot be written is found now, not in the end
    measure_and_publish(results, path, lambda publish: measure_all(results, missing_backends(), publish), print_results)


def measure_all(results: dict, missing: dict[str, str], publish: Callable[[], None]) -> None:
    """Fills results["scenes"] number by number and calls `publish` after each row."""
    for name, rows in results["scenes"].items():
        for count in results["settings"]["counts"]:
            scene = bench_scene(name, count)
            rows.append({"particles": count, "cells": {}})
            for scheme in SCHEMES:
                cell = _cell(scheme, scene, rows, missing, results["settings"])
                rows[-1]["cells"][scheme.name] = cell
                click.echo(f"{name}, {count:,} particles, {scheme.name}: {progress_text(cell)}", err=True)
            publish()


def _cell(scheme: Scheme, scene: object, rows: list[dict], missing: dict[str, str], settings: dict) -> dict:
    """One number of a table, or why there is none; adds what was learnt of the row to it."""
    row = rows[-1]
    if scheme.backend in missing:
        return {"state": "not run", "reason": missing[scheme.backend]}
    budget, threads = settings["budget_seconds"], settings["threads"]
    try:
        expected = _predict(scheme, scene, rows, budget, threads)
        if reason := beyond_budget(expected, budget, "one substep"):
            cell = {"state": "cut off", "reason": reason, "predicted_substep_seconds": significant(expected)}
        else:
            simulation, dt = scene.build(scheme.backend, threads)
            clocked = clock_substeps(simulation, dt, scheme.neighbors, budget)
            cell = {"state": "measured", **clocked.rates(scene.particle_count)}
            row.setdefault("mean_neighbors", significant(float(simulation.count_neighbors().mean())))
            row.setdefault("substep_of_simulated_time", significant(dt))
    except _core.FontanaError as error:
        return {"state": "failed", "reason": str(error)}
    return cell | _ratio(cell, row["cells"].get(REFERENCE, cell))


def _predict(scheme: Scheme, scene: object, rows: list[dict], budget: float, threads: int) -> float:
    """Seconds a substep will take, from the row before or, in the first, from a small scene."""
    if len(rows) > 1:
        known = rows[-2]["particles"], _substep_seconds(rows[-2]["cells"][scheme.name])
    elif scene.particle_count > _PROBE_COUNT:
        simulation, dt = bench_scene(scene.name, _PROBE_COUNT).build(scheme.backend, threads)
        known = _PROBE_COUNT, clock_substeps(simulation, dt, scheme.neighbors, 0.1 * budget).median
    else:
        return 0.0
    return (known[1] or 0.0) * (scene.particle_count / known[0]) ** scheme.exponent


def _substep_seconds(cell: dict) -> float | None:
    """Measured, or predicted where the scheme was cut off."""
    if cell["state"] == "measured":
        return cell["substep_seconds"]["median"]
    return cell.get("predicted_substep_seconds")


def _ratio(cell: dict, reference: dict) -> dict:
    """How many times as fast as the first column; an estimate where that was cut off."""
    own, other = _substep_seconds(cell), _substep_seconds(reference)
    if cell["state"] != "measured" or not own or not other:
        return {}
    return {"ratio_to_cpu_simple": significant(other / own), "ratio_is_estimate": reference["state"] != "measured"}
