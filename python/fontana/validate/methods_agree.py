"""One dam break in a tank by every incompressible method: front, centre of mass and energy before it hits the far wall
and after."""

from __future__ import annotations

import numpy as np

from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._plots import EXACT, MEASURED, SECOND, THIRD, plot
from fontana.validate._scenes import tank

METHODS = {
    "dfsph": {"method": "dfsph"},
    "dfsph, plain Jacobi": {"method": "dfsph"},
    "pcisph": {"method": "pcisph"},
    "wcsph": {"method": "wcsph", "pressure_constant": 4000.0},
}
STYLES = dict(zip(METHODS, (MEASURED, EXACT, SECOND, THIRD), strict=True))
FRAMES, FRAME_RATE, IMPACT = 60, 100.0, 0.35  # s: when the front has met the far wall


def scene(spacing: float, method: str) -> dict:
    solver = {"pressure_solver": "jacobi"} if method == "dfsph, plain Jacobi" else {}
    return {
        "fluid": {"particle_spacing": spacing, "viscosity": 0.1} | METHODS[method],
        "solver": solver,
        "time": {"frame_rate": FRAME_RATE},
        "emitters": [{"type": "block", "centre": [0.25, 0.25, 0.125], "size": [0.5, 0.5, 0.25]}],
        "colliders": tank(1.25, 0.25),
    }


def follow(stage: Stage, resolution: int, method: str) -> dict[str, np.ndarray]:
    """Front (m), centre of mass (m, twice) and kinetic energy (J) over time."""
    simulation = stage.simulation(scene(0.5 / resolution, method), kept=("fluid.method",))
    rows = []
    for frame in stage.frames(simulation, FRAMES, method):
        x, y, _ = frame.report.centre_of_mass
        rows.append([frame.time, frame.position[:, 0].max(), x, y, frame.report.kinetic_energy])
    return dict(zip(("time", "front", "x", "y", "energy"), np.array(rows).T, strict=True))


def measure(stage: Stage, resolution: int) -> Outcome:
    runs = {method: follow(stage, resolution, method) for method in METHODS}
    reference = runs["dfsph"]
    figures = []
    for method, (front, centre, energy) in {
        "dfsph, plain Jacobi": (2.0, 1.0, 3.0),
        "pcisph": (2.0, 1.0, 3.0),
        "wcsph": (None, None, None),
    }.items():
        run = runs[method]
        difference = np.hypot(run["x"] - reference["x"], run["y"] - reference["y"])
        before = reference["time"] < IMPACT
        energies = np.abs(run["energy"] - reference["energy"]) / reference["energy"].max()
        figures += [
            Figure(f"{method}: front before the impact, of the tank", 100 * _largest(run, reference, before), front),
            Figure(f"{method}: centre of mass, of the tank", 100 * difference.max() / 1.25, centre),
            Figure(f"{method}: energy before the impact, of the largest", 100 * energies[before].max(), energy),
            Figure(f"{method}: energy after it, of the largest", 100 * energies.max(), energy and 8.0),
        ]
    return Outcome(figures, {name: curve(run["time"], run["energy"]) for name, run in runs.items()})


def _largest(run: dict, reference: dict, when: np.ndarray) -> float:
    return np.abs(run["front"] - reference["front"])[when].max() / 1.25


def draw(axes: object, curves: dict) -> None:
    for name, style in STYLES.items():
        plot(axes, curves, name, style)
    axes.set(xlabel="time, s", ylabel="kinetic energy, J")


CASE = Case("Dam break by every method", {SMALL: 16, FULL: 24}, measure, draw)
