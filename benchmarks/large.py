"""Time and memory of a particle from 10 k to 4 M of them, with dfsph and mueller.

    python benchmarks/large.py --out benchmarks/results

A block of water on a floor, a frame of ten substeps to warm up and one that is timed at every count, each in a process
of its own: its peak of resident memory beyond what it had before the first step, over the count, is the memory of a
particle. All counts in turn, and that several times, so that a slow minute of the machine is not taken for a large
count. dfsph takes a fixed number of iterations, and the water is calm enough for the coarse levels in every substep:
the same work at every count. Writes large.json and large.png.

The cells of the grid are two spacings wide, so a lattice in the middle of the axes has the same eight particles in
every cell where its side is even, which a processor's branch prediction learns, and some on the borders of cells where
it is odd, where mueller on OpenCL takes longer a particle. A quarter of a spacing aside, both meet the cells alike, as
each other's mirror image. A little jitter takes the order out of the distances; with more, dfsph would throw apart
those that come too close: the water would be calm at no count, or at some.
"""

from __future__ import annotations

import io
import multiprocessing
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import click

from fontana import FontanaError, _core, bench

METHODS, BACKENDS = ("dfsph", "mueller"), ("cpu", "opencl")
SPACING, DT, SUBSTEPS, ITERATIONS = 0.02, 5e-4, 10, 5
FROM, BOUND, MOST_BYTES = 100_000, 1.3, 250
RESULTS = Path(__file__).resolve().parent / "results/local"
COLOURS = {"dfsph": "#c8641b", "mueller": "#1f5fa8"}
STYLES = {"cpu": "o-", "opencl": "s--"}


@click.command(help=__doc__.split("\n\n")[0])
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=RESULTS, help="Folder of the results.")
@click.option("--counts", default="10000,30000,100000,300000,1000000,2000000,4000000", callback=bench.count_list)
@click.option("--opencl-most", default=1_000_000, show_default=True, help="The largest count for OpenCL.")
@click.option("--repeats", default=3, show_default=True, type=click.IntRange(1), help="Rounds over all counts.")
@click.option("--threads", default=0, type=click.IntRange(0), help="Threads of the cpu backend; 0: all cores.")
def command(out: Path, counts: list[int], opencl_most: int, repeats: int, threads: int) -> None:
    results = {
        "benchmark": "large",
        **bench.describe_conditions([Path(sys.executable).name, "benchmarks/large.py", *sys.argv[1:]]),
        "settings": {"substeps": SUBSTEPS, "dfsph_iterations": ITERATIONS, "threads": threads, "repeats": repeats},
        "missing": bench.missing_backends(),
    }
    asked = [
        (method, backend, count)
        for backend in BACKENDS
        if backend not in results["missing"]
        for count in counts
        if backend == "cpu" or count <= opencl_most
        for method in METHODS
    ]
    rounds = [[measure_alone(*row, threads) for row in asked] for _ in range(repeats)]
    results["rows"] = [merged(samples) for samples in zip(*rounds, strict=True)]
    results["bounds"] = {f"{m}, {b}": bound(select(results, m, b)) for m in METHODS for b in BACKENDS}
    bench.note_end(results)
    bench.publish_json(out / "large.json", results)
    show(results)
    draw(results, out / "large.png")
    click.echo(f"written: {out / 'large.json'}, {out / 'large.png'}")


def measure_alone(method: str, backend: str, count: int, threads: int) -> dict:
    """One sample, from a fresh process; one that says why where the memory did not suffice."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        try:
            sample = pool.submit(measure, method, backend, count, threads).result()
        except (FontanaError, BrokenProcessPool) as error:
            return {"method": method, "backend": backend, "asked": count, "failed": str(error)}
    ns, room = sample["nanoseconds_per_particle_substep"], sample["bytes_per_particle"]
    remark = f"{ns:.0f} ns a particle-substep, {room:.0f} bytes a particle"
    click.echo(f"{method}, {backend}, {sample['particles']:,} particles: {remark}", err=True)
    return sample


def merged(samples: tuple[dict, ...]) -> dict:
    """A row of the results: statistics of the times, the least of the memory; or the first sample that failed."""
    for sample in samples:
        if "failed" in sample:
            return sample
    times = [sample["nanoseconds_per_particle_substep"] for sample in samples]
    return samples[0] | {
        "nanoseconds_per_particle_substep": bench.statistics(times),
        # The first process may hold an OpenCL device's compiler, whose kernels later ones find in a cache.
        "bytes_per_particle": min(sample["bytes_per_particle"] for sample in samples),
    }


def measure(method: str, backend: str, count: int, threads: int) -> dict:
    """One sample, in this process. Raises the library's errors."""
    simulation = build(method, backend, count, threads)
    simulation.device()
    before = resident_bytes("VmRSS")
    simulation.step_frame()
    particles, begin = simulation.particle_count, time.perf_counter()
    iterations = simulation.step_frame().iterations
    seconds = time.perf_counter() - begin
    return {
        "method": method,
        "backend": backend,
        "asked": count,
        "particles": particles,
        "nanoseconds_per_particle_substep": 1e9 * seconds / (SUBSTEPS * particles),
        "iterations_per_substep": iterations / SUBSTEPS,
        "bytes_per_particle": bench.significant((resident_bytes("VmHWM") - before) / particles),
        "estimated_bytes_per_particle": bench.significant(simulation.estimate_memory(particles) / particles),
    }


def build(method: str, backend: str, count: int, threads: int) -> _core.Simulation:
    """A cube of water on a floor. The library fills it, so that no array of ours counts as its memory."""
    simulation = _core.Simulation()
    for name, value in {
        "fluid.method": method,
        "fluid.particle_spacing": SPACING,
        "solver.backend": backend,
        "solver.threads": threads,
        "solver.quality": "custom",
        "solver.density_error": 1e-5,
        "solver.max_iterations": ITERATIONS,
        "time.substeps": SUBSTEPS,
        "time.timestep": SUBSTEPS * DT,
    }.items():
        simulation.set(name, value)
    side = SPACING * round(count ** (1 / 3))
    aside = SPACING / 4
    simulation.add_emitter("block", centre=(aside, side / 2, aside), size=(side, side, side), jitter=0.02)
    simulation.add_collider("plane_y")
    return simulation


def resident_bytes(field: str) -> int:
    """VmRSS, what this process has in memory, or VmHWM, the most it ever had; Linux only."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return 1024 * int(line.split()[1])
    raise _core.IoError(f"/proc/self/status has no {field}: memory is measured on Linux only")


def select(results: dict, method: str, backend: str) -> list[dict]:
    return [
        row for row in results["rows"] if row["method"] == method and row["backend"] == backend and "failed" not in row
    ]


def bound(rows: list[dict]) -> dict | None:
    """Largest over smallest time of a particle from 100 k on, and the most bytes there; None with fewer than two."""
    rows = [row for row in rows if row["asked"] >= FROM]
    if len(rows) < 2:
        return None
    ratios = {}
    for name in ("median", "minimum"):
        values = [row["nanoseconds_per_particle_substep"][name] for row in rows]
        ratios[name] = bench.significant(max(values) / min(values))
    return {"time_ratio": ratios, "most_bytes": max(row["bytes_per_particle"] for row in rows)}


def show(results: dict) -> None:
    columns = ["method", "backend", "particles", "ns/particle-substep", "min", "max", "bytes/particle", "estimate"]
    lines = []
    for row in results["rows"]:
        if "failed" in row:
            lines.append([row["method"], row["backend"], f"{row['asked']:,}", row["failed"], *[""] * 4])
            continue
        ns = row["nanoseconds_per_particle_substep"]
        cells = [row["method"], row["backend"], f"{row['particles']:,}"]
        cells += [f"{ns[name]:.0f}" for name in ("median", "minimum", "maximum")]
        lines.append([*cells, *(f"{row[name]:.0f}" for name in ("bytes_per_particle", "estimated_bytes_per_particle"))])
    bench.print_table(f"{SUBSTEPS} substeps a frame; dfsph with {ITERATIONS} iterations", columns, lines)
    for name, found in results["bounds"].items():
        if found:
            click.echo(f"{name}: {bound_text(found)}")
    for remark in filter(None, (bench.gpu_remark(results), bench.load_remark(results))):
        click.echo(remark)


def bound_text(found: dict) -> str:
    ratio, fastest = found["time_ratio"]["median"], found["time_ratio"]["minimum"]
    linear = "within" if ratio <= BOUND else "OUTSIDE"
    room = "within" if found["most_bytes"] <= MOST_BYTES else "OUTSIDE"
    return (
        f"from {FROM:,} on, largest over smallest time {ratio:.2f}, {linear} {BOUND} (of the fastest samples "
        f"{fastest:.2f}); {found['most_bytes']:.0f} bytes a particle, {room} {MOST_BYTES}"
    )


def draw(results: dict, path: Path) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10.4, 4.2), dpi=100, layout="constrained")
    for method in METHODS:
        for backend in BACKENDS:
            rows = select(results, method, backend)
            if not rows:
                continue
            counts = [row["particles"] for row in rows]
            times = [row["nanoseconds_per_particle_substep"] for row in rows]
            label, colour = f"{method}, {backend}", COLOURS[method]
            left.plot(counts, [ns["median"] for ns in times], STYLES[backend], color=colour, label=label)
            left.vlines(counts, [ns["minimum"] for ns in times], [ns["maximum"] for ns in times], color=colour)
            right.plot(counts, [row["bytes_per_particle"] for row in rows], STYLES[backend], color=colour, label=label)
    right.axhline(MOST_BYTES, color="#666666", linewidth=0.9, linestyle=":", label=f"goal for dfsph, {MOST_BYTES}")
    left.set(ylabel="ns a particle-substep", title=f"time; dfsph with {ITERATIONS} iterations")
    right.set(ylabel="bytes a particle", title="growth of the process's memory")
    for axes in (left, right):
        axes.set(xscale="log", xlabel="particles", ylim=(0, None))
        axes.grid(color="#dddddd", linewidth=0.6)
        axes.legend(frameon=False, fontsize=8)
    facts = [results["machine"]["cpu"], bench.gpu_remark(results)]
    figure.supxlabel("; ".join(filter(None, facts)), fontsize=8, color="#666666")
    picture = io.BytesIO()
    figure.savefig(picture, format="png")
    pyplot.close(figure)
    _core.publish_file(str(path), picture.getvalue())


if __name__ == "__main__":
    try:
        command()
    except FontanaError as error:
        sys.exit(f"large: {error}")
