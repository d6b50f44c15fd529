"""What each pressure method costs at the same density error: the thesis expects "an order of magnitude" from PCISPH.

    python benchmarks/methods.py --out benchmarks/results

A dam break by mueller, wcsph, pcisph and dfsph. The two with a solve are asked for the error; for the two without, the
stiffness is searched with which they just keep it. Then all four run in turn, so that what else the machine does falls
on each, and the medians are compared; substeps and iterations are exact. Writes methods.json and methods.png.
"""

from __future__ import annotations

import io
import statistics
import sys
import time
from pathlib import Path

import click

from fontana import FontanaError, _core, bench

METHODS = ("mueller", "wcsph", "pcisph", "dfsph")
STIFF = ("mueller", "wcsph")
EXPECTED = 10.0  # times as fast: the thesis, V (future work), after Solenthaler and Pajarola 2009
FIRST_STIFFNESS, SEARCHES, CLOSE = 300.0, 10, 0.1  # m^2/s^2; runs; of the error
FRAME_RATE = 100.0
RESULTS = Path(__file__).resolve().parent / "results/local"
COLOURS = {"mueller": "#7aa6d8", "wcsph": "#1f5fa8", "pcisph": "#eab676", "dfsph": "#c8641b"}


@click.command(help=__doc__.split("\n\n")[0])
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=RESULTS, help="Folder of the results.")
@click.option("--particles", default=8192, show_default=True, type=click.IntRange(100), help="About so many.")
@click.option("--seconds", default=0.3, show_default=True, type=click.FloatRange(0.02), help="Simulated time.")
@click.option(
    "--error",
    "errors",
    multiple=True,
    default=(1.0, 0.1),
    show_default=True,
    type=click.FloatRange(0.01, 20),
    help="Mean density error, percent; repeatable.",
)
@click.option("--repeats", default=3, show_default=True, type=click.IntRange(1), help="Turns of all four.")
@click.option("--threads", default=0, type=click.IntRange(0), help="Threads of the cpu backend; 0: all cores.")
def command(out: Path, particles: int, seconds: float, errors: tuple[float, ...], repeats: int, threads: int) -> None:
    settings = {"particles": particles, "seconds": seconds, "threads": threads, "repeats": repeats}
    results = {
        "benchmark": "methods",
        **bench.describe_conditions([Path(sys.executable).name, "benchmarks/methods.py", *sys.argv[1:]]),
        "settings": settings | {"scene": "dam break in a tank 2.5 times as long as the water"},
        "errors": [compare(settings | {"error_percent": error}) for error in errors],
    }
    bench.note_end(results)
    bench.publish_json(out / "methods.json", results)
    show(results)
    draw(results, out / "methods.png")
    click.echo(f"written: {out / 'methods.json'}, {out / 'methods.png'}")


def compare(settings: dict) -> dict:
    """All four at one density error, in turn."""
    stiffness = {method: find_stiffness(method, settings) for method in STIFF}
    runs: dict[str, list[dict]] = {method: [] for method in METHODS}
    for turn in range(settings["repeats"]):
        for method in METHODS:
            runs[method].append(run(method, settings, stiffness.get(method)))
            click.echo(f"turn {turn + 1}: {method} {runs[method][-1]['seconds_per_second']:.1f} s a second", err=True)
    methods = {name: summary(each) | {"pressure_constant": stiffness.get(name)} for name, each in runs.items()}
    return {"error_percent": settings["error_percent"], "methods": methods, "speed_over": speeds(runs)}


def build(method: str, settings: dict, stiffness: float | None) -> _core.Simulation:
    """Water 1 m high and long, half as wide, at one end of a slippery tank."""
    simulation = _core.Simulation()
    values = {
        "fluid.method": method,
        "fluid.particle_spacing": 1.0 / even_cube_root(2 * settings["particles"]),
        "fluid.viscosity": 1.0,
        "solver.backend": "cpu",
        "solver.threads": settings["threads"],
        "solver.quality": "custom",
        "solver.density_error": settings["error_percent"],
        "time.frame_rate": FRAME_RATE,
    }
    if stiffness is not None:
        values["fluid.pressure_constant"] = stiffness
    for name, value in values.items():
        simulation.set(name, value)
    simulation.add_emitter("block", centre=(0.5, 0.5, 0.25), size=(1.0, 1.0, 0.5))
    slippery = {"friction": 0.0, "elasticity": 0.0}
    simulation.add_collider("plane_y", **slippery)
    for kind, far in (("plane_x", (2.5, 0.0, 0.0)), ("plane_z", (0.0, 0.0, 0.5))):
        simulation.add_collider(kind, **slippery)
        simulation.add_collider(kind, centre=far, flip=True, **slippery)
    return simulation


def even_cube_root(count: int) -> int:
    """So that whole particles fill the half cube: one that is squeezed into its tank starts with an explosion."""
    return max(2, 2 * round(count ** (1 / 3) / 2))


def run(method: str, settings: dict, stiffness: float | None) -> dict:
    """Wall time per simulated second, exact counts, and the mean over substeps of the mean density error."""
    simulation = build(method, settings, stiffness)
    begin = time.perf_counter()
    reports = [simulation.step_frame() for _ in range(round(settings["seconds"] * FRAME_RATE))]
    wall = time.perf_counter() - begin
    substeps = sum(report.substeps for report in reports)
    simulated = reports[-1].time
    return {
        "particles": simulation.particle_count,
        "seconds_per_second": bench.significant(wall / simulated),
        "substeps": substeps,
        "iterations": sum(report.iterations for report in reports),
        "unconverged": sum(report.unconverged for report in reports),
        "error_percent": bench.significant(
            100 * sum(report.density_error_mean * report.substeps for report in reports) / substeps
        ),
        "largest_error_percent": bench.significant(100 * max(report.density_error_max for report in reports)),
        "front": bench.significant(float(simulation.read("position")[:, 0].max())),
        "centre_of_mass": [bench.significant(value) for value in reports[-1].centre_of_mass],
    }


def find_stiffness(method: str, settings: dict) -> float:
    """The pressure constant with which the error is the one asked for. Raises click's error where there is none.

    The error falls about as one over the stiffness, so that multiplying by the ratio of errors gets there.
    """
    stiffness = FIRST_STIFFNESS
    for _ in range(SEARCHES):
        found = run(method, settings, stiffness)["error_percent"] / settings["error_percent"]
        click.echo(f"{method}: pressure constant {stiffness:.4g} gives {found:.2f} of the error", err=True)
        if abs(found - 1.0) <= CLOSE:
            return stiffness
        stiffness = bench.significant(stiffness * min(10.0, max(0.1, found)))
    raise click.ClickException(f"{method}: no pressure constant found that keeps {settings['error_percent']} %")


def summary(runs: list[dict]) -> dict:
    """The wall times' statistics; all else is the same in every turn."""
    return runs[0] | {"seconds_per_second": bench.statistics([each["seconds_per_second"] for each in runs])}


def speeds(runs: dict[str, list[dict]]) -> dict[str, dict[str, float]]:
    """How many times as fast a method is as another: the median of the turns' ratios."""

    def ratio(slow: str, fast: str) -> float:
        pairs = zip(runs[slow], runs[fast], strict=True)
        return bench.significant(statistics.median(s["seconds_per_second"] / f["seconds_per_second"] for s, f in pairs))

    return {slow: {fast: ratio(slow, fast) for fast in METHODS if fast != slow} for slow in METHODS}


def show(results: dict) -> None:
    settings = results["settings"]
    columns = ["method", "s a second", "min", "max", "substeps", "iterations", "error", "largest", "pressure constant"]
    for at in results["errors"]:
        count = at["methods"]["dfsph"]["particles"]
        title = f"dam break, {count:,} particles, {settings['seconds']:g} s, error {at['error_percent']:g} %"
        bench.print_table(title, columns, [table_row(name, row) for name, row in at["methods"].items()])
        click.echo(verdict(at) + "\n")
    remark = bench.load_remark(results)
    if remark:
        click.echo(remark)


def table_row(method: str, row: dict) -> list[str]:
    wall, stiffness = row["seconds_per_second"], row["pressure_constant"]
    cells = [method, *(f"{wall[name]:.2f}" for name in ("median", "minimum", "maximum")), str(row["substeps"])]
    cells.append(f"{row['iterations'] / row['substeps']:.1f}" if row["iterations"] else "")
    cells += [f"{row['error_percent']:.3f} %", f"{row['largest_error_percent']:.0f} %"]
    return [*cells, "" if stiffness is None else f"{stiffness:.0f}"]


def verdict(at: dict) -> str:
    over = at["speed_over"]
    pcisph, dfsph = (f"{over['mueller'][fast]:.1f} times as fast as mueller" for fast in ("pcisph", "dfsph"))
    met = "met" if over["mueller"]["pcisph"] >= EXPECTED else "not met"
    return (
        f"pcisph is {pcisph}, {over['wcsph']['pcisph']:.1f} times wcsph; the thesis expects {EXPECTED:g}: {met}. "
        f"dfsph is {dfsph}, {over['pcisph']['dfsph']:.1f} times pcisph"
    )


def draw(results: dict, path: Path) -> None:
    """Bars of wall time, with what was done in it; a panel for each error."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    panels = len(results["errors"])
    figure, axes = pyplot.subplots(panels, 1, figsize=(7.2, 0.6 + 2.1 * panels), dpi=110, layout="constrained")
    for panel, at in zip([axes] if panels == 1 else axes, results["errors"], strict=True):
        draw_panel(panel, at)
    machine, settings = results["machine"], results["settings"]
    threads = settings["threads"] or machine["usable_cores"]
    facts = f"{machine['cpu']}, {threads} thread{'s' * (threads != 1)}; medians of {settings['repeats']}"
    figure.supxlabel(f"wall time of one simulated second, s\n{facts}", fontsize=8, color="#666666")
    picture = io.BytesIO()
    figure.savefig(picture, format="png")
    pyplot.close(figure)
    _core.publish_file(str(path), picture.getvalue())


def draw_panel(axes, at: dict) -> None:
    slowest = max(row["seconds_per_second"]["median"] for row in at["methods"].values())
    for method, row in at["methods"].items():
        seconds = row["seconds_per_second"]["median"]
        axes.barh(method, seconds, color=COLOURS[method], height=0.6)
        solve = f" of {row['iterations'] / row['substeps']:.1f} iterations" if row["iterations"] else ""
        text = f"{seconds:.3g} s; {row['substeps']} substeps{solve}; error {row['error_percent']:.2g} %"
        axes.text(seconds + 0.01 * slowest, method, text, va="center", fontsize=8)
    axes.invert_yaxis()
    axes.set_xlim(0, 1.75 * slowest)
    count = at["methods"]["dfsph"]["particles"]
    axes.set_title(f"dam break, {count:,} particles, mean density error {at['error_percent']:g} %", fontsize=10)


if __name__ == "__main__":
    try:
        command()
    except FontanaError as error:
        sys.exit(f"methods: {error}")
