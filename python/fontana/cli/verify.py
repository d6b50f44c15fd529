"""`fontana verify`: every backend and scheme against the plainest one, all pairs on the CPU in strict arithmetic."""

from __future__ import annotations

import itertools
import json

import click
import numpy as np

from fontana import _core
from fontana.cli.information import print_table

TOLERANCES = {"density": 2e-6, "acceleration": 2e-5, "position": 1e-4}
SUBSTEPS = 20
_SPACING = 0.02  # m
_DT = 5e-4  # s


class Disagreement(_core.InternalError):
    """A backend computes something else than the reference."""


@click.command()
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def verify(as_json: bool) -> None:
    """Compare every backend and scheme here with the plain CPU reference, and print the disagreement.

    Density and acceleration are compared after one substep, positions after twenty, each as the largest difference over
    the largest value. Where strict arithmetic and the scheme are the same, all backends must agree bit for bit.

    \b
    Examples:
      fontana verify
    """
    rows, missing = compare_all()
    if as_json:
        click.echo(json.dumps({"rows": rows, "missing": missing}, indent=1))
    else:
        _print(rows, missing)
    bad = [row for row in rows if not row["passed"]]
    if bad:
        names = ", ".join(f"{row['backend']}/{row['neighbors']}/{row['precision']}" for row in bad)
        raise Disagreement(f"{names} disagree with the reference by more than allowed")


def compare_all() -> tuple[list[dict], dict[str, str]]:
    """A row for each combination, and why backends are missing. Raises the library's errors."""
    backends, missing = _backends()
    reference = _results("cpu", "all-pairs", "strict")
    strict: dict[str, dict] = {"all-pairs": reference}
    rows = []
    for backend, neighbors, precision in itertools.product(backends, ("all-pairs", "grid"), ("strict", "fast")):
        results = _results(backend, neighbors, precision)
        row = {"backend": backend, "neighbors": neighbors, "precision": precision}
        row |= {name: _disagreement(results[name], reference[name]) for name in TOLERANCES}
        row["passed"] = all(row[name] <= limit for name, limit in TOLERANCES.items())
        row["same_bits"] = None
        if precision == "strict":
            first = strict.setdefault(neighbors, results)
            row["same_bits"] = all(np.array_equal(first[name], results[name]) for name in TOLERANCES)
            row["passed"] &= row["same_bits"]
        rows.append(row)
    return rows, missing


def _backends() -> tuple[list[str], dict[str, str]]:
    """Those with a device here, the CPU first, and the reasons of the others."""
    here = ["cpu"]
    missing = {}
    for device in _core.devices():
        if device.available and device.backend not in here:
            here.append(device.backend)
        if not device.available:
            missing[device.backend] = device.reason
    return here, {name: reason for name, reason in missing.items() if name not in here}


def _results(backend: str, neighbors: str, precision: str) -> dict[str, np.ndarray]:
    simulation = _core.Simulation()
    settings = {
        "solver.backend": backend,
        "solver.neighbors": neighbors,
        "solver.precision": precision,
        "fluid.particle_spacing": _SPACING,
        "fluid.surface_tension": 0.0728,
        "time.timestep": _DT,
        "time.substeps": 1,
    }
    for name, value in settings.items():
        simulation.set(name, value)
    simulation.add_collider("plane_y")
    simulation.add_collider("sphere_outside", centre=(0.1, 0.0, 0.1), radius=0.06)
    position, velocity = _cloud()
    simulation.add_particles(position, velocity)
    simulation.step_frame()
    results = {name: simulation.read(name) for name in ("density", "acceleration")}
    simulation.set("time.timestep", _DT * (SUBSTEPS - 1))
    simulation.set("time.substeps", SUBSTEPS - 1)
    simulation.step_frame()
    return results | {"position": simulation.read("position")}


def _cloud() -> tuple[np.ndarray, np.ndarray]:
    """A lattice of 12 x 12 x 12 particles, shaken, in motion, some at the floor and the sphere; the same each time."""
    random = np.random.default_rng(1)
    lattice = np.stack(np.meshgrid(*[np.arange(12)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    shaken = lattice + random.uniform(-0.3, 0.3, lattice.shape)
    return (shaken * _SPACING).astype(np.float32), random.normal(0.0, 0.5, lattice.shape).astype(np.float32)


def _disagreement(values: np.ndarray, reference: np.ndarray) -> float:
    return float(np.abs(values - reference).max() / np.abs(reference).max())


def _print(rows: list[dict], missing: dict[str, str]) -> None:
    columns = ["backend", "neighbours", "arithmetic", *TOLERANCES, "same bits", ""]
    words = {None: "", True: "yes", False: "no"}
    print_table(
        columns,
        [
            [row["backend"], row["neighbors"], row["precision"]]
            + [f"{row[name]:.1e}" for name in TOLERANCES]
            + [words[row["same_bits"]], "ok" if row["passed"] else "FAILED"]
            for row in rows
        ],
    )
    click.echo(f"allowed: {', '.join(f'{name} {limit:g}' for name, limit in TOLERANCES.items())}")
    click.echo("same bits: as the first backend in strict arithmetic with the same neighbours")
    for name, reason in missing.items():
        click.echo(f"not compared: {name}: {reason}")
