"""Why broken dams are later in the experiments than in simulations: what was tried, by the clocks as recorded.

    python benchmarks/dam_break_clock.py --peer-python PEER/bin/python --out benchmarks/results

The dam break of `fontana validate martin-moyce koshizuka-oka` behind a gate that is pulled up, with other friction and
viscosity, with the front where the water is a capillary length deep, and in SPlisHSPlasH (splishsplash_front.py; PEER
as in splishsplash_run.py); and the wider column of Lobovsky et al. 2014 behind the same gates. Writes
dam_break_clock.json and prints the table of docs/validation.md. `--reference FILE` keeps SPlisHSPlasH's front for the
validation.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import click
import numpy as np

from fontana import FontanaError, Simulation, bench
from fontana.validate import koshizuka_oka, martin_moyce
from fontana.validate._dam_break import GRAVITY, LAYERS, scene
from fontana.validate._reference import read_reference
from fontana.validate._scenes import SLIPPERY

HERE = Path(__file__).resolve().parent
PRELOAD = "/lib/x86_64-linux-gnu/libGLdispatch.so.0"
Front = tuple[np.ndarray, np.ndarray]  # s, m

COLUMN, WIDE_COLUMN = (1.0, 2.0), (2.0, 1.0)  # width and height, m
SECONDS, WIDE_SECONDS, FRAME_RATE = 2.3, 0.85, 500.0
# Over sqrt(2 H / g), the slowest that counts as sudden (Lauber and Hager 1998).
GATES = (0.2, 0.4, 0.6, 1.0)
GATE_RADIUS = 200.0  # m: of the cylinder that stands for a flat gate; 0.1 mm of sagitta across the slice
CAPILLARY_LENGTH = 0.0027  # m, of water
WIDTHS = {"martin-moyce": 2.25 * 0.0254, "koshizuka-oka": 0.146}  # m, of the experiments' columns
PEERS = (("dfsph", 16), ("dfsph", 32), ("dfsph", 64), ("iisph", 32))
REFERENCE = ("dfsph", 32)


@click.command(help=__doc__.split("\n\n")[0])
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=HERE / "results/local")
@click.option("--spacings", default=32, show_default=True, type=click.IntRange(4), help="To the column's width.")
@click.option("--peer-python", help="Python with SPlisHSPlasH; without it the peer is left out.")
@click.option("--reference", type=click.Path(path_type=Path), help="Where SPlisHSPlasH's front goes, as CSV.")
def command(out: Path, spacings: int, peer_python: str | None, reference: Path | None) -> None:
    results = {
        "benchmark": "dam_break_clock",
        **bench.describe_conditions([Path(sys.executable).name, "benchmarks/dam_break_clock.py", *sys.argv[1:]]),
        "settings": {"spacings": spacings},
        "rows": [],
    }
    runs = our_runs(spacings) | (peer_runs(peer_python) if peer_python else {})
    for name, run in runs.items():
        fronts = run()
        results["rows"].append({"name": name, **errors_of(fronts)})
        if reference and name == peer_name(*REFERENCE):
            write_reference(reference, *fronts["koshizuka-oka"])
    for row, gate in zip(results["rows"], (None, *GATES), strict=False):
        row["lobovsky"] = wide_errors(foremost(Setup(WIDE_COLUMN[1] / spacings, WIDE_COLUMN, WIDE_SECONDS, gate)))
    bench.note_end(results)
    bench.publish_json(out / "dam_break_clock.json", results)
    click.echo(table(results["rows"]))


@dataclass(frozen=True)
class Setup:
    """A dam break of a column (width and height, m), behind a gate gone in `gate` sqrt(2 H / g) or none."""

    spacing: float  # m
    column: tuple[float, float] = COLUMN
    seconds: float = SECONDS
    gate: float | None = None
    friction: float | None = None  # None: that of the validation
    viscosity: float | None = None  # Pa s; likewise


def our_runs(spacings: int) -> dict[str, Callable[[], dict[str, Front]]]:
    """By the names of the rows: fronts by experiment."""
    setup = Setup(COLUMN[0] / spacings)
    setups = {
        "let go at once": setup,
        **{f"gate, gone in {gate:g} sqrt(2 H / g)": replace(setup, gate=gate) for gate in GATES},
        "without friction": replace(setup, friction=0.0),
        "friction 0.02, seven times ours": replace(setup, friction=0.02),
        "viscosity 2 Pa s, 40 times ours": replace(setup, viscosity=2.0),
    }
    runs = {name: partial(both, setup) for name, setup in setups.items()}
    return runs | {"front where water is 2.7 mm deep": partial(deep_fronts, setup)}


def both(setup: Setup) -> dict[str, Front]:
    return dict.fromkeys(WIDTHS, foremost(setup))


def document_of(setup: Setup) -> dict:
    """The scene upside down, floor above and gravity upwards: a cylinder's wall stands below its cutoff."""
    (width, height), across = setup.column, LAYERS * setup.spacing
    document = scene(setup.spacing, 20.0)
    document["time"]["frame_rate"] = FRAME_RATE
    document["forces"]["gravity"] = [0.0, GRAVITY, 0.0]
    document["emitters"][0] |= {"centre": [width / 2, -height / 2, across / 2], "size": [width, height, across]}
    document["colliders"][0]["flip"] = True
    if setup.friction is not None:
        document["colliders"][0]["friction"] = setup.friction
    if setup.viscosity is not None:
        document["fluid"]["viscosity"] = setup.viscosity
    if setup.gate is not None:
        document["colliders"].append({"type": "cylinder_inside"} | gate_at(setup, 0.0))
    return document


def gate_at(setup: Setup, time: float) -> dict:
    """The fields of the gate that has been on its way for so many seconds; far off when it is past the water."""
    (width, height), across = setup.column, LAYERS * setup.spacing
    lifted = height * time / (setup.gate * np.sqrt(2 * height / GRAVITY))
    centre, cutoff = [width - GATE_RADIUS, 0.0, across / 2], -lifted if lifted < 1.1 * height else -1000.0
    return SLIPPERY | {"centre": centre, "radius": GATE_RADIUS, "thickness": 2 * setup.spacing, "cutoff": cutoff}


def play(setup: Setup) -> Iterator[tuple[float, np.ndarray]]:
    """Time (s) and positions (N, 3) of each frame; the gate moves between frames."""
    document = document_of(setup)
    simulation = Simulation(document)
    for number in range(round(setup.seconds * FRAME_RATE)):
        if setup.gate is not None:
            last = len(document["colliders"]) - 1
            simulation.core.set_collider(last, "cylinder_inside", **gate_at(setup, (number + 1) / FRAME_RATE))
        frame = simulation.step()
        yield frame.time, frame.position


def foremost(setup: Setup) -> Front:
    """The foremost particle and half a spacing before it, as in the validation."""
    times, fronts = [0.0], [setup.column[0]]
    for time, position in play(setup):
        times.append(time)
        fronts.append(float(position[:, 0].max()) + setup.spacing / 2)
    return np.array(times), np.maximum.accumulate(fronts)


def deep_fronts(setup: Setup) -> dict[str, Front]:
    """Where the water is still as deep as the capillary length in each experiment."""
    times, fronts = [0.0], {name: [setup.column[0]] for name in WIDTHS}
    for time, position in play(setup):
        times.append(time)
        for name, width in WIDTHS.items():
            fronts[name].append(deep_front(position, setup.spacing, CAPILLARY_LENGTH / width))
    return {name: (np.array(times), np.maximum.accumulate(places)) for name, places in fronts.items()}


def deep_front(position: np.ndarray, spacing: float, depth: float) -> float:
    """The place, between the middles of strips two spacings long, where their mean depth falls to `depth`."""
    strip = 2 * spacing
    depths = np.bincount((position[:, 0] / strip).astype(int)) * spacing**3 / (strip * LAYERS * spacing)
    last = int(np.nonzero(depths >= depth)[0].max())
    beyond = depths[last + 1] if last + 1 < len(depths) else 0.0
    return (last + 0.5 + (depths[last] - depth) / (depths[last] - beyond)) * strip


def peer_name(method: str, spacings: int) -> str:
    return f"SPlisHSPlasH, {method.upper()}, {spacings} spacings"


def peer_runs(python: str) -> dict[str, Callable[[], dict[str, Front]]]:
    return {peer_name(*peer): partial(run_peer, python, *peer) for peer in PEERS}


def run_peer(python: str, method: str, spacings: int) -> dict[str, Front]:
    environment = os.environ | ({"LD_PRELOAD": PRELOAD} if Path(PRELOAD).exists() else {})
    call = [python, str(HERE / "splishsplash_front.py"), str(spacings), str(SECONDS), "1", method]
    result = subprocess.run(call, env=environment, capture_output=True, text=True)
    if result.returncode != 0:
        last = (result.stderr.strip().splitlines() or ["no message"])[-1]
        raise click.ClickException(f"SPlisHSPlasH did not run ({last}); see benchmarks/splishsplash_run.py")
    found = json.loads(result.stdout.strip().splitlines()[-1])
    return dict.fromkeys(WIDTHS, (np.array(found["times"]), np.maximum.accumulate(found["fronts"])))


def errors_of(fronts: dict[str, Front]) -> dict:
    """By the clocks as recorded, percent; and the lags that fit best, percent of sqrt(a / 2g)."""
    of_front, of_tip = fronts["martin-moyce"], fronts["koshizuka-oka"]
    arrival, tip = martin_moyce.arrival_errors(*of_front), koshizuka_oka.tip_errors(*of_tip)
    return {
        "arrival_mean": bench.significant(100 * arrival.mean()),
        "arrival_max": bench.significant(100 * arrival.max()),
        "arrival_lag": bench.significant(100 * martin_moyce.own_lag(*of_front)),
        "tip_mean": bench.significant(100 * tip.mean()),
        "tip_lag": bench.significant(100 * koshizuka_oka.own_lag(*of_tip)),
    }


def wide_errors(front: Front) -> dict:
    """Against Lobovsky et al. 2014: the tip, percent of the column's width; how far ahead of theirs, on the mean."""
    width, height = WIDE_COLUMN
    when, where = read_reference("lobovsky_2014_tip.csv").T
    ahead = np.interp(when * np.sqrt(height / GRAVITY), *front) - (width + where * height)
    first = when < 1.0
    return {
        "tip_mean": bench.significant(100 * np.abs(ahead).mean() / width),
        "ahead_first": bench.significant(100 * ahead[first].mean() / width),
        "ahead_then": bench.significant(100 * ahead[~first].mean() / width),
    }


def write_reference(path: Path, times: np.ndarray, fronts: np.ndarray) -> None:
    every = np.arange(0.0, SECONDS + 1e-9, 0.01)
    lines = [
        "# SPlisHSPlasH 2.19.0, DFSPH in two dimensions: front of a dam break, column 1 m wide and 2 m high,",
        "# 32 spacings to the width; the foremost particle and half a spacing before it.",
        "# Written by benchmarks/dam_break_clock.py --reference.",
        "t_s,x_m",
        *(f"{t:.2f},{x:.4f}" for t, x in zip(every, np.interp(every, times, fronts), strict=True)),
    ]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def table(rows: list[dict]) -> str:
    """Markdown."""
    lines = [
        "| | arrival, mean | largest | lag | tip, mean | lag | Lobovsky: tip, mean | ahead first | then |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        own = [row[key] for key in ("arrival_mean", "arrival_max", "arrival_lag", "tip_mean", "tip_lag")]
        wide = list(row.get("lobovsky", {}).values()) or [None] * 3
        cells = ["" if value is None else f"{value:.1f}" for value in (*own, *wide)]
        lines.append(f"| {row['name']} | {' | '.join(cells)} |")
    return "\n".join(lines)


if __name__ == "__main__":
    try:
        command()
    except FontanaError as error:
        sys.exit(f"dam_break_clock: {error}")
