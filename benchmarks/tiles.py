"""The grid read through the local memory of work-groups beside the grid itself, on the OpenCL device.

    python benchmarks/tiles.py --out benchmarks/results

The method is mueller, the scene the box of `fontana bench thesis`: time of a whole substep by each scheme in turn,
and by the clock of the device of the two passes that differ. Writes tiles.json.
"""

from __future__ import annotations

import sys
from pathlib import Path

import click

from fontana import FontanaError, bench

SCHEMES = ("grid", "tiles")
PASSES = ("density", "fluid_force")
PROFILED_SUBSTEPS = 20
RESULTS = Path(__file__).resolve().parent / "results/local"


@click.command(help=__doc__.split("\n\n")[0])
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=RESULTS, help="Folder of the results.")
@click.option("--counts", default="10000,30000,100000", callback=bench.count_list)
@click.option("--budget", default=4.0, show_default=True, help="Seconds for each number.")
def command(out: Path, counts: list[int], budget: float) -> None:
    results = {
        "benchmark": "tiles",
        **bench.describe_conditions([Path(sys.executable).name, "benchmarks/tiles.py", *sys.argv[1:]]),
        "settings": {"scene": "box", "method": "mueller", "backend": "opencl", "budget_seconds": budget},
        "rows": [row(count, budget) for count in counts],
    }
    bench.note_end(results)
    bench.publish_json(out / "tiles.json", results)
    show(results)
    for remark in filter(None, (bench.gpu_remark(results), bench.load_remark(results))):
        click.echo(remark)
    click.echo(f"written: {out / 'tiles.json'}")


def row(particle_count: int, budget: float) -> dict:
    """Both schemes at one count, and how many times as fast the tiles are."""
    measured: dict = {"particles": particle_count}
    for neighbors in SCHEMES:
        simulation, dt = bench.bench_scene("box", particle_count).build("opencl")
        rates = bench.clock_substeps(simulation, dt, neighbors, budget).rates(particle_count)
        measured[neighbors] = {
            "nanoseconds_per_particle_substep": rates["nanoseconds_per_particle_substep"],
            "pass_nanoseconds_per_particle": passes(particle_count, neighbors),
        }
        median = rates["nanoseconds_per_particle_substep"]["median"]
        click.echo(f"{neighbors}, {particle_count:,} particles: {median:.0f} ns a particle-substep", err=True)
    grid, tiles = (measured[neighbors]["nanoseconds_per_particle_substep"]["median"] for neighbors in SCHEMES)
    return measured | {"speed_of_tiles_over_grid": bench.significant(grid / tiles)}


def passes(particle_count: int, neighbors: str) -> dict[str, float]:
    """Nanoseconds a particle of the two passes, after a warm-up."""
    simulation, dt = bench.bench_scene("box", particle_count).build("opencl", profile=True)
    simulation.set("solver.neighbors", neighbors)
    simulation.set("time.substeps", PROFILED_SUBSTEPS)
    simulation.set("time.timestep", PROFILED_SUBSTEPS * dt)
    simulation.step_frame()
    before = {launch.name: launch for launch in simulation.profile()}
    simulation.step_frame()
    after = {launch.name: launch for launch in simulation.profile()}
    return {
        name: bench.significant(
            1e9 * (after[name].seconds - before[name].seconds) / (after[name].elements - before[name].elements)
        )
        for name in PASSES
    }


def show(results: dict) -> None:
    lines = []
    for measured in results["rows"]:
        line = [f"{measured['particles']:,}"]
        for neighbors in SCHEMES:
            scheme = measured[neighbors]
            line.append(f"{scheme['nanoseconds_per_particle_substep']['median']:.0f}")
            line += [f"{scheme['pass_nanoseconds_per_particle'][name]:.0f}" for name in PASSES]
        lines.append([*line, f"{measured['speed_of_tiles_over_grid']:.2f}"])
    columns = ["particles"]
    for neighbors in SCHEMES:
        columns += [f"{neighbors}: substep", *PASSES]
    bench.print_table("ns a particle", [*columns, "tiles / grid, speed"], lines)


if __name__ == "__main__":
    try:
        command()
    except FontanaError as error:
        sys.exit(f"tiles: {error}")
