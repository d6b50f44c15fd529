"""The dam break of SPlisHSPlasH and ours in turn, both DFSPH, at the same density error and with the same threads.

    python benchmarks/vs_splishsplash.py --particles 32768 --seconds 0.3 --threads 1 --peer-python PEER/bin/python

The peer runs in an environment of its own (splishsplash_run.py says how to make one). Prints both sides' wall time,
steps, errors, front and centre of mass, and the ratio of wall times, theirs over ours: the median over the repeats. The
largest density error of any particle is that of every step, of which the median, the 95th percentile and the largest
are printed, and what a sample every 0.1 s sees of it. The peer has no bound on it; ours moves
particles apart until each keeps --largest-error. Densities are those that a step begins with.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

import click
from rich.console import Console
from rich.table import Table

from fontana import _core, bench

SAMPLE = 0.1  # s, between two samples; ours end a frame there
HERE = Path(__file__).resolve().parent
PRELOAD = "/lib/x86_64-linux-gnu/libGLdispatch.so.0"
FIELDS = (
    "seconds", "steps", "iterations", "density_error_mean", "density_error_max", "density_error_max_median",
    "density_error_max_95", "density_error_max_sampled", "front", "centre_of_mass",
)  # fmt: skip


@click.command(help=__doc__.split("\n\n")[0])
@click.option("--particles", default=32768, show_default=True, help="A cube: 32768 or 97336.")
@click.option("--seconds", default=0.3, show_default=True, help="Simulated time.")
@click.option("--largest-error", default=1.0, show_default=True, help="Percent, ours: of any particle; 0: no bound.")
@click.option("--threads", default=1, show_default=True, help="Of both.")
@click.option("--repeats", default=1, show_default=True, help="Pairs of runs.")
@click.option("--peer-python", default=sys.executable, show_default=False, help="A Python that has pysplishsplash.")
@click.option("--json", "path", type=click.Path(path_type=Path, dir_okay=False), help="Where the results go.")
def command(
    particles: int,
    seconds: float,
    largest_error: float,
    threads: int,
    repeats: int,
    peer_python: str,
    path: Path | None,
) -> None:
    per_metre = round(particles ** (1 / 3))
    if per_metre**3 != particles:
        raise click.BadParameter(f"{particles} is no cube; the nearest is {per_metre**3}", param_hint="--particles")
    results = {
        "benchmark": "vs_splishsplash",
        **bench.describe_conditions([Path(sys.executable).name, "benchmarks/vs_splishsplash.py", *sys.argv[1:]]),
        "settings": {
            "particles": particles,
            "seconds": seconds,
            "density_error_max": largest_error,
            "threads": threads,
        },
        "fontana": [],
        "splishsplash": [],
    }
    for _ in range(repeats):
        results["fontana"].append(run_ours(per_metre, seconds, largest_error, threads))
        results["splishsplash"].append(run_peer(peer_python, per_metre, seconds, threads))
    pairs = zip(results["splishsplash"], results["fontana"], strict=True)
    results["ratio"] = statistics.median(theirs["seconds"] / ours["seconds"] for theirs, ours in pairs)
    bench.note_end(results)
    if path:
        bench.publish_json(path, results)
    show(results)


def run_ours(per_metre: int, seconds: float, largest_error: float, threads: int) -> dict:
    """The same tank: where their walls have particles, 0.75 spacings outside, our planes have their first layer."""
    simulation = _core.Simulation()
    spacing = 1.0 / per_metre
    frames = max(1, round(seconds / SAMPLE))
    for name, value in {
        "fluid.method": "dfsph", "fluid.particle_spacing": spacing, "fluid.viscosity": 10.0,  # their 0.01 m^2/s
        "solver.backend": "cpu", "solver.threads": threads, "solver.quality": "custom", "solver.density_error": 0.05,
        "solver.density_error_max": largest_error, "time.timestep": seconds / frames,
    }.items():  # fmt: skip
        simulation.set(name, value)
    simulation.add_emitter("block", centre=(0.5, 0.5, 0.5), size=(1.0, 1.0, 1.0))
    slippery = {"friction": 0.0, "elasticity": 0.0}
    gap = 0.25 * spacing
    for kind in ("plane_x", "plane_y", "plane_z"):
        simulation.add_collider(kind, centre=(-gap, -gap, -gap), **slippery)
    simulation.add_collider("plane_x", centre=(2.0 + gap, 0.0, 0.0), flip=True, **slippery)
    simulation.add_collider("plane_z", centre=(0.0, 0.0, 1.0 + gap), flip=True, **slippery)
    largest, times, watching = [], [], 0.0

    def after_step(share: float) -> None:
        """The error at every step; the time it takes is not counted, there as here."""
        nonlocal watching
        begin = time.perf_counter()
        times.append((simulation.frame + share) * seconds / frames)
        largest.append(max(0.0, float(simulation.read("density").max()) / 1000.0 - 1.0))
        watching += time.perf_counter() - begin

    begin = time.perf_counter()
    reports = [simulation.step_frame(after_step) for _ in range(frames)]
    wall = time.perf_counter() - begin - watching
    steps = sum(report.substeps for report in reports)
    return {
        "particles": simulation.particle_count,
        "simulated": reports[-1].time,
        "steps": steps,
        "iterations": sum(report.iterations for report in reports) / steps,
        "seconds": wall,
        "density_error_mean": sum(report.density_error_mean * report.substeps for report in reports) / steps,
        **spread(largest, times),
        "front": float(simulation.read("position")[:, 0].max()),
        "centre_of_mass": list(reports[-1].centre_of_mass),
    }


def run_peer(python: str, per_metre: int, seconds: float, threads: int) -> dict:
    environment = os.environ | ({"LD_PRELOAD": PRELOAD} if Path(PRELOAD).exists() else {})
    command_line = [python, str(HERE / "splishsplash_run.py"), str(per_metre), str(seconds), str(threads)]
    result = subprocess.run(command_line, env=environment, capture_output=True, text=True)
    if result.returncode != 0:
        last = (result.stderr.strip().splitlines() or ["no message"])[-1]
        raise click.ClickException(f"SPlisHSPlasH did not run ({last}); see benchmarks/splishsplash_run.py")
    found = json.loads(result.stdout.strip().splitlines()[-1])
    return found | spread(found.pop("density_errors"), found.pop("times"))


def spread(errors: list[float], times: list[float]) -> dict:
    """Of the largest error of any particle, at every step, and after the first step that reaches each sample's time."""
    count = round(times[-1] / SAMPLE)
    reached = [next(k for k, t in enumerate(times) if t > n * SAMPLE - 1e-6) for n in range(1, count + 1)]
    return {
        "density_error_max_sampled": [errors[k] for k in reached],
        "density_error_max": max(errors),
        "density_error_max_median": statistics.median(errors),
        "density_error_max_95": statistics.quantiles(errors, n=20)[-1],
    }


def show(results: dict) -> None:
    table = Table("", "Fontana", "SPlisHSPlasH")
    for field in FIELDS:
        table.add_row(field, *(text_of(results[side][-1].get(field)) for side in ("fontana", "splishsplash")))
    console = Console()
    console.print(table)
    console.print(f"ratio of wall times, theirs over ours: {results['ratio']:.2f}")
    remark = bench.load_remark(results)
    if remark:
        console.print(remark)


def text_of(value: object) -> str:
    if isinstance(value, list):
        return ", ".join(f"{part:.4f}" for part in value)
    return "not told" if value is None else f"{value:.4g}"


if __name__ == "__main__":
    command()
