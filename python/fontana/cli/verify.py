"""`fontana verify`: every device, scheme and method against the plainest: all pairs on the CPU in strict arithmetic."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterable

import click
import numpy as np

from fontana import _core
from fontana.backends import absent_backends, absent_neighbors
from fontana.cli.information import print_table
from fontana.cli.usage import Choice
from fontana.errors import BeyondLimit, beyond
from fontana.tables import parameters

METHODS = parameters()["fluid.method"].choices
TOLERANCES = {"density": 2e-6, "acceleration": 2e-5, "velocity": 1e-4, "position": 2e-5}
SUBSTEPS = 20
_COLUMNS = ("method", "backend", "device", "neighbors", "precision")
_SPACING = 0.02  # m
_DT = 5e-4  # s
_BALL = {"centre": (0.1, 0.0, 0.1), "radius": 0.06}  # m


@click.command(short_help="Compare devices and schemes with the plain CPU.")
@click.option(
    "--method", "methods", multiple=True, type=Choice(METHODS), help="Only this one; repeatable. [default: all]"
)
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def verify(methods: tuple[str, ...], as_json: bool) -> None:
    """Compare every device and scheme here with the plain CPU reference, by every method, and print the disagreement.

    Density, acceleration and velocity are compared after one substep, positions after twenty, each as the largest
    difference over the largest value; particles that come too close in between are moved apart. With dfsph the grid,
    which has levels to solve on, is compared with the CPU's grid. Where strict arithmetic and the scheme are the same,
    all devices must agree bit for bit.

    \b
    Examples:
      fontana verify
      fontana verify --method mueller --method dfsph
    """
    rows, missing = compare_all(dict.fromkeys(methods or METHODS))
    if as_json:
        click.echo(json.dumps({"rows": rows, "missing": missing}, indent=1))
    else:
        _print(rows, missing)
    findings = [finding for row in rows for finding in _findings(row)]
    if findings:
        raise BeyondLimit(findings)


def compare_all(methods: Iterable[str] = METHODS) -> tuple[list[dict], dict[str, str]]:
    """A row for each combination, and why backends are missing. Raises the library's errors."""
    found = _core.devices()
    devices = _numbered(found)
    rows = []
    for method in methods:
        rows += _compare(method, devices)
    return rows, absent_backends(found)


def _compare(method: str, devices: list[tuple[_core.Device, int]]) -> list[dict]:
    plainest = _results(method, "cpu", 0, "all-pairs", "strict")
    strict: dict[str, dict] = {"all-pairs": plainest}
    rows = []
    schemes = itertools.product(devices, ("all-pairs", "grid", "tiles"), ("strict", "fast"))
    for (device, number), neighbors, precision in schemes:
        if neighbors in absent_neighbors(device, method):
            continue
        scheme = (method, device.backend, number, neighbors, precision)
        results = _results(*scheme)
        row = dict(zip(_COLUMNS, scheme, strict=True))
        # Only the grid has cells to merge: there the multilevel solve takes another path to the same tolerance.
        is_own_path = method == "dfsph" and neighbors == "grid"
        reference = strict.get("grid", results) if is_own_path else plainest
        row |= {name: _disagreement(results[name], reference[name]) for name in TOLERANCES}
        row["same_bits"] = None
        if precision == "strict":
            order_of_sums = "grid" if neighbors == "tiles" else neighbors
            first = strict.setdefault(order_of_sums, results)
            row["same_bits"] = all(np.array_equal(first[name], results[name]) for name in TOLERANCES)
        row["passed"] = not _findings(row)
        rows.append(row)
    return rows


def _findings(row: dict) -> list[str]:
    """Where a combination does not agree with the reference."""
    case = "/".join(map(str, _scheme(row)))
    found = [
        beyond(case, f"the disagreement of {name}", row[name], limit)
        for name, limit in TOLERANCES.items()
        if not row[name] <= limit  # so that NaN is one
    ]
    if row["same_bits"] is False:
        found.append(f"{case}: not the bits of the first device in strict arithmetic")
    return found


def _numbered(devices: list[_core.Device]) -> list[tuple[_core.Device, int]]:
    """Each that is available with its number within its backend, the CPU first."""
    here: list[tuple[_core.Device, int]] = []
    numbers: dict[str, int] = {}
    for device in devices:
        number = numbers[device.backend] = numbers.get(device.backend, -1) + 1
        if device.available:
            here.append((device, number))
    return sorted(here, key=lambda entry: entry[0].backend != "cpu")


def _scheme(row: dict) -> list:
    return [row[name] for name in _COLUMNS]


def _results(method: str, backend: str, device: int, neighbors: str, precision: str) -> dict[str, np.ndarray]:
    simulation = _core.Simulation()
    settings = {
        "fluid.method": method,
        "solver.backend": backend,
        "solver.device": device,
        "solver.neighbors": neighbors,
        "solver.precision": precision,
        "fluid.particle_spacing": _SPACING,
        "fluid.surface_tension": 0.0728,
        "solver.quality": "draft",  # has the coarse levels of dfsph from the start
        "solver.density_error_max": 0.0,
        "time.timestep": _DT,
        "time.substeps": 1,
    }
    for name, value in settings.items():
        simulation.set(name, value)
    simulation.add_collider("plane_y")
    simulation.add_collider("sphere_outside", **_BALL)
    position, velocity = _cloud()
    simulation.add_particles(position, velocity)
    simulation.step_frame()
    results = {name: simulation.read(name) for name in ("density", "acceleration", "velocity")}
    simulation.set("solver.quality", "good")
    simulation.set("solver.density_error_max", 1.0)  # moves particles apart, of which there are a few by then
    simulation.set("time.timestep", _DT * (SUBSTEPS - 1))
    simulation.set("time.substeps", SUBSTEPS - 1)
    simulation.step_frame()
    return results | {"position": simulation.read("position")}


def _cloud() -> tuple[np.ndarray, np.ndarray]:
    """A lattice of 12 x 12 x 12 particles at a floor, a ball cut out, shaken and in motion; the same each time.

    So little that no pair comes closer than half a spacing: a solve that has to blow overlapping particles apart turns
    the last bit of a sum into another splash.
    """
    random = np.random.default_rng(1)
    lattice = np.stack(np.meshgrid(*[np.arange(12) + 0.5] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    shaken = _SPACING * (lattice + random.uniform(-0.1, 0.1, lattice.shape))
    is_outside = np.linalg.norm(shaken - _BALL["centre"], axis=1) > _BALL["radius"] + 0.5 * _SPACING
    velocity = random.normal(0.0, 0.2, lattice.shape)
    return shaken[is_outside].astype(np.float32), velocity[is_outside].astype(np.float32)


def _disagreement(values: np.ndarray, reference: np.ndarray) -> float:
    return float(np.abs(values - reference).max() / np.abs(reference).max())


def _print(rows: list[dict], missing: dict[str, str]) -> None:
    columns = ["method", "backend", "device", "neighbours", "arithmetic", *TOLERANCES, "same bits", ""]
    words = {None: "", True: "yes", False: "no"}
    print_table(
        columns,
        [
            [str(value) for value in _scheme(row)]
            + [f"{row[name]:.1e}" for name in TOLERANCES]
            + [words[row["same_bits"]], "ok" if row["passed"] else "FAILED"]
            for row in rows
        ],
    )
    click.echo(f"allowed: {', '.join(f'{name} {limit:g}' for name, limit in TOLERANCES.items())}")
    click.echo("same bits: as the first device in strict arithmetic with the same neighbours, tiles as the grid")
    for name, reason in missing.items():
        click.echo(f"not compared: {name}: {reason}")
