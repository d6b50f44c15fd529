"""A round drop without gravity, stretched by its own velocity into an ellipse (Monaghan 1994).

With u = -A x and v = A y a circle of radius 1 stays an ellipse of semi-axes a and 1/a:
da/dt = -A a, dA/dt = A^2 (a^4 - 1) / (a^4 + 1). Between two slippery planes the drop is a flat slice of it.
"""

from __future__ import annotations

import numpy as np

from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._plots import EXACT, MEASURED, SECOND, plot
from fontana.validate._scenes import lattice, walls

RATE, DURATION = 1.0, 0.76  # 1/s, s: Monaghan's 100/s and 0.0076 s
LAYERS, FRAMES = 6, 19
# Along the lattice's own axes its rows are pressed together head on and pair up, which SPH cannot tell from density; at
# this angle they slide past one another, as they do in a fluid that has been moving.
LATTICE_ANGLE = np.radians(30.0)


def semi_axes(times: np.ndarray) -> np.ndarray:
    """The exact semi-axis a that shrinks, at ascending times, by Runge and Kutta's method."""

    def slope(state: np.ndarray) -> np.ndarray:
        a, rate = state
        return np.array([-rate * a, rate**2 * (a**4 - 1) / (a**4 + 1)])

    steps = 200
    state, now, result = np.array([1.0, RATE]), 0.0, []
    for time in times:
        h = (time - now) / steps
        for _ in range(steps):
            k1 = slope(state)
            k2 = slope(state + h / 2 * k1)
            k3 = slope(state + h / 2 * k2)
            state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(state + h * k3))
        now = time
        result.append(state[0])
    return np.array(result)


def scene(spacing: float) -> dict:
    return {
        "fluid": {"method": "dfsph", "particle_spacing": spacing, "viscosity": 1e-3},
        "forces": {"gravity": [0.0, 0.0, 0.0]},
        "time": {"timestep": DURATION / FRAMES},
        "colliders": walls("z", 0.0, LAYERS * spacing),
    }


def drop(spacing: float, angle: float) -> tuple[np.ndarray, np.ndarray]:
    """Places and velocities of a disc of radius 1 cut out of a lattice that is turned by `angle`."""
    position = lattice(spacing, (-2, 2), (-2, 2), (0, LAYERS * spacing))
    x, y = position[:, 0].copy(), position[:, 1].copy()
    position[:, 0], position[:, 1] = np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y
    position = position[np.hypot(position[:, 0], position[:, 1]) < 1.0]
    return position, RATE * position * np.array([-1.0, 1.0, 0.0])


def stretch(stage: Stage, resolution: int, angle: float, label: str) -> dict[str, np.ndarray]:
    """Over time: semi-axes of the ellipse that has the drop's second moments, its edges (m), energy over the first."""
    spacing = 1.0 / resolution
    position, velocity = drop(spacing, angle)
    simulation = stage.simulation(scene(spacing), position, velocity)
    radius = np.sqrt(2 * (position[:, :2] ** 2).sum(axis=1).mean())
    rows = []
    for frame in stage.frames(simulation, FRAMES, label):
        x = frame.position[:, :2].astype(float)
        energy = (frame.velocity.astype(float) ** 2).sum() / (velocity**2).sum()
        rows.append([frame.time, *2 * np.sqrt((x**2).mean(axis=0)) / radius, *np.abs(x).max(axis=0), energy])
    names = ("time", "minor", "major", "minor_edge", "major_edge", "energy")
    return dict(zip(names, np.array(rows).T, strict=True)) | {"exact": semi_axes(np.array(rows)[:, 0])}


def measure(stage: Stage, resolution: int) -> Outcome:
    turned = stretch(stage, resolution, LATTICE_ANGLE, "lattice turned")
    aligned = stretch(stage, resolution, 0.0, "lattice aligned")
    a, half = turned["exact"][-1], 0.5 / resolution
    figures = [
        Figure("semi-minor axis", 100 * (turned["minor"][-1] / a - 1), 2.0),
        Figure("semi-major axis", 100 * (turned["major"][-1] * a - 1), 2.0),
        Figure("edge of the minor axis, off by spacings", (turned["minor_edge"][-1] + half - a) * resolution, unit="d"),
        Figure(
            "edge of the major axis, off by spacings", (turned["major_edge"][-1] + half - 1 / a) * resolution, unit="d"
        ),
        Figure("kinetic energy, off from the start's", 100 * (turned["energy"][-1] - 1), 2.0),
        Figure("semi-minor axis, lattice aligned", 100 * (aligned["minor"][-1] / a - 1)),
        Figure("semi-major axis, lattice aligned", 100 * (aligned["major"][-1] * a - 1)),
    ]
    curves = {"exact, minor": curve(turned["time"], turned["exact"])}
    curves["exact, major"] = curve(turned["time"], 1 / turned["exact"])
    for name, run in (("lattice turned by 30 degrees", turned), ("lattice along the axes", aligned)):
        curves |= {f"{name}, {axis}": curve(run["time"], run[axis]) for axis in ("minor", "major")}
    return Outcome(figures, curves)


def draw(axes: object, curves: dict) -> None:
    for axis in ("minor", "major"):
        named = axis == "minor"
        plot(axes, curves, f"exact, {axis}", EXACT, "exact" if named else "")
        for name, style in (("lattice turned by 30 degrees", MEASURED), ("lattice along the axes", SECOND)):
            plot(axes, curves, f"{name}, {axis}", style, name if named else "")
    axes.set(xlabel="time, s", ylabel="semi-axes over the radius")


CASE = Case("Elliptical drop", {SMALL: 16, FULL: 32}, measure, draw)
