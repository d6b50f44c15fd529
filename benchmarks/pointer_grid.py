"""The thesis's first grid, preallocated cells of pointers (III.4, Fig. 4), beside the sorted grid of Fontana.

    python benchmarks/pointer_grid.py

Builds pointer_grid.cpp into build/ and runs it on one core: time to build the grid and to sum the density over it, and
memory, on the same particles and with the same formula; both densities must agree to 1e-5. In the order of the lattice
neighbours lie near each other in memory; shuffled, they do not, as after the fluid has been stirred: the sorted grid
sorts its particles again each substep, pointers leave them where they are. A last run packs the fluid until cells of
pointers are full. Writes pointer_grid.json.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import click

from fontana import FontanaError, InternalError, bench
from fontana.runs.text import data_size

REPOSITORY = Path(__file__).resolve().parents[1]
RESULTS = REPOSITORY / "benchmarks/results/local"
SOURCES = (
    "benchmarks/pointer_grid.cpp",
    "src/fontana/backends/cpu/radix_sort.cpp",
    "src/fontana/backends/cpu/thread_pool.cpp",
    "src/fontana/solver/constants.cpp",
)
# As CMakeLists.txt builds the fast kernels of the cpu backend.
FLAGS = "-std=c++17 -O3 -fno-math-errno -fno-trapping-math -fno-signed-zeros -fassociative-math -freciprocal-math"
CONTRACT, AVX2 = "-ffp-contract=fast", "-mavx2 -mfma"
DISAGREE, FULL = 1, 3  # exit codes of the program
REPEATS, SECONDS = 15, 1.5  # samples at the most, and for about so long where neighbours are near in memory
COMPRESSION = 0.5


@click.command(help=__doc__.split("\n\n")[0])
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=RESULTS, help="Folder of the result.")
@click.option("--counts", default="1000,10000,100000,1000000", callback=bench.count_list, help="Particle counts.")
@click.option("--capacity", default=32, show_default=True, help="Pointers that a cell has room for; at rest it has 8.")
def command(out: Path, counts: list[int], capacity: int) -> None:
    conditions = bench.describe_conditions(["python", "benchmarks/pointer_grid.py", *sys.argv[1:]])
    program, flags = build()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # the program inherits it
    rows = [run(program, count, order, capacity) for count in counts for order in ("lattice", "shuffled")]
    packed = run(program, counts[0], "lattice", capacity, COMPRESSION)
    settings = {"capacity": capacity, "flags": flags, "threads": 1}
    results = {"benchmark": "pointer_grid", **conditions, "settings": settings, "rows": rows, "packed": packed}
    bench.note_end(results)
    bench.publish_json(out / "pointer_grid.json", results)
    print_rows(rows)
    print_packed(packed)
    if bench.load_remark(results):
        click.echo(bench.load_remark(results))
    click.echo(f"written: {out / 'pointer_grid.json'}")


def build() -> tuple[Path, list[str]]:
    """Compiles the program; returns it and the flags. Raises InternalError with what the compiler said."""
    compiler = os.environ.get("CXX") or shutil.which("g++") or shutil.which("c++")
    if compiler is None:
        raise InternalError("no C++ compiler: install g++ or set CXX")
    flags = [*FLAGS.split(), CONTRACT, *(AVX2.split() if _has_avx2() else [])]
    program = REPOSITORY / "build/benchmarks/pointer_grid"
    program.parent.mkdir(parents=True, exist_ok=True)
    sources = [str(REPOSITORY / source) for source in SOURCES]
    include = [f"-I{REPOSITORY / 'src/fontana'}", f"-I{REPOSITORY / 'benchmarks'}"]
    call = [compiler, *flags, "-Wall", "-Wextra", *include, *sources, "-o", str(program), "-pthread"]
    done = subprocess.run(call, capture_output=True, text=True)
    if done.returncode:
        raise InternalError(f"pointer_grid.cpp does not compile:\n{done.stderr}")
    return program, flags


def _has_avx2() -> bool:
    cpu = Path("/proc/cpuinfo")
    return cpu.exists() and {"avx2", "fma"} <= set(cpu.read_text().split())


def run(program: Path, count: int, order: str, capacity: int, compression: float = 1.0) -> dict:
    """The program's JSON. Raises InternalError if the two grids disagree."""
    repeats = max(3, min(REPEATS, int(SECONDS / (1e-6 * count))))
    call = [str(program), str(count), order, str(capacity), str(compression), str(repeats)]
    done = subprocess.run(call, capture_output=True, text=True)
    if done.returncode == DISAGREE:
        raise InternalError(f"the two grids disagree: {done.stdout}")
    if done.returncode not in (0, FULL):
        raise InternalError(f"{' '.join(call)} failed with code {done.returncode}: {done.stderr}")
    row = json.loads(done.stdout)
    click.echo(f"{count:,} particles, {order}, compression {compression:g}: done", err=True)
    return row


def print_rows(rows: list[dict]) -> None:
    lines = []
    for row in rows:
        if "full_cells" in row:
            lines.append([f"{row['particles']:,}", row["order"], f"{row['full_cells']:,} cells full"])
            continue
        pointers, ordered = row["pointer_grid"], row["sorted_grid"]
        line = [f"{row['particles']:,}", row["order"]]
        for grid in (pointers, ordered):
            line += [
                bench.short_number(grid[name]["median"]) for name in ("build_milliseconds", "density_milliseconds")
            ]
        line.append(f"{pointers['milliseconds']['median'] / ordered['milliseconds']['median']:.1f}x")
        line += [data_size(grid[name]) for grid in (pointers, ordered) for name in ("grid_bytes", "particle_bytes")]
        lines.append([*line, f"{row['disagreement']:.0e}"])
    columns = ["particles", "order", "pointers: build ms", "density ms", "sorted: build ms", "density ms", "faster"]
    columns += ["pointers: grid", "particles", "sorted: grid", "particles", "disagreement"]
    bench.print_table("cells of pointers beside sorted cells, one core", columns, lines)


def print_packed(packed: dict) -> None:
    what = f"the lattice of {packed['particles']:,} particles at {packed['compression']:g} of its spacing"
    if "full_cells" in packed:
        click.echo(
            f"{what}: {packed['full_cells']:,} cells of {packed['capacity']} pointers are full, "
            f"{packed['particles_without_place']:,} particles have no place; the sorted grid has no such limit"
        )
    else:
        click.echo(f"{what}: its fullest cell holds {packed['fullest_cell']} of {packed['capacity']} pointers")


if __name__ == "__main__":
    try:
        command()
    except FontanaError as error:
        sys.exit(f"pointer_grid: {error}")
