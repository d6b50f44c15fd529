"""A column of water at rest: the pressure on its floor is its weight, and nothing moves."""

from __future__ import annotations

import numpy as np

from fontana.simulation import Frame, Simulation
from fontana.validate._case import FULL, SMALL, Case, Figure, Outcome, Stage, curve
from fontana.validate._plots import EXACT, MEASURED, plot
from fontana.validate._scenes import tank

DENSITY, GRAVITY, DEPTH, WIDTH = 1000.0, 9.81, 1.0, 0.5
SETTLING, FRAME_RATE = 3.0, 50.0  # s, 1/s
SAMPLED_SUBSTEPS = 400
SPEED_UNIT, WEIGHT = np.sqrt(GRAVITY * DEPTH), DENSITY * GRAVITY * DEPTH  # m/s; Pa


def scene(spacing: float, width: float, quality: str = "good") -> dict:
    """The viscosity is such that what the start stirs up dies out in seconds."""
    return {
        "fluid": {"method": "dfsph", "particle_spacing": spacing, "viscosity": 10.0, "rest_density": DENSITY},
        "forces": {"gravity": [0.0, -GRAVITY, 0.0]},
        "solver": {"quality": quality},
        "time": {"frame_rate": FRAME_RATE},
        "emitters": [{"type": "block", "centre": [width / 2, DEPTH / 2, width / 2], "size": [width, DEPTH, width]}],
        "colliders": tank(width, width),
    }


def measure(stage: Stage, resolution: int) -> Outcome:
    """Three seconds to settle; then every substep is read, since the pressure swings about its mean.

    The mean is taken where no wall is within the support radius, and the water below is added by its weight: particles
    next to a wall carry more pressure than the water there, since a wall pushes with theirs alone.
    """
    spacing = DEPTH / resolution
    width = round(WIDTH / spacing) * spacing
    simulation = stage.simulation(scene(spacing, width))
    settling = _settle(stage, simulation, "settling")
    simulation.set("time.timestep", settling[-1].report.dt_max)
    simulation.set("time.substeps", 1)
    samples = _sample(stage, simulation, width, spacing)
    height, pressure = (np.concatenate(samples[name]).astype(float) for name in ("height", "pressure"))
    followed = (pressure + DENSITY * GRAVITY * height).mean()
    gradient = -np.polyfit(height, pressure, 1)[0]
    means = [np.mean(values) for values in samples["pressure"]]
    figures = [
        Figure("pressure on the floor, off from the weight above", 100 * (followed / WEIGHT - 1), 2.0),
        Figure("residual speed, root mean square, of sqrt(g H)", 100 * np.mean(samples["speed"]) / SPEED_UNIT, 1.0),
        Figure("the same with quality final", 100 * _final_speed(stage, spacing, width) / SPEED_UNIT),
        Figure("residual speed of the fastest, of sqrt(g H)", 100 * samples["fastest"][-1] / SPEED_UNIT),
        Figure("pressure of the particles at the floor, off from the water's", 100 * np.mean(samples["at_floor"])),
        Figure("pressure gradient, off from density g", 100 * (gradient / (DENSITY * GRAVITY) - 1)),
        Figure("centre of mass, off from the middle", 100 * (samples["centre"][-1] / (DEPTH / 2) - 1), 2.0),
        Figure("pressure from substep to substep, standard deviation", 100 * np.std(means) / np.mean(means)),
    ]
    return Outcome(figures, _curves(height, pressure, spacing))


def _sample(stage: Stage, simulation: Simulation, width: float, spacing: float) -> dict[str, list]:
    """Of every substep: heights (m) and pressures (Pa) of the particles in the bulk; root mean square and largest speed
    (m/s); how far the pressure of the particles at the floor is from the water's, relative; height of the centre.
    """
    names = ("height", "pressure", "speed", "fastest", "at_floor", "centre")
    samples: dict[str, list] = {name: [] for name in names}
    for frame in stage.frames(simulation, SAMPLED_SUBSTEPS, "sampling"):
        height, in_bulk = frame.position[:, 1], _is_in_bulk(frame.position, width, spacing)
        lowest = height < spacing
        water = DENSITY * GRAVITY * (DEPTH - height[lowest].mean())
        speed = _root_mean_square(frame.velocity)
        off = frame.pressure[lowest].mean() / water - 1
        values = (height[in_bulk], frame.pressure[in_bulk], speed, frame.report.max_speed, off)
        for name, value in zip(names, (*values, frame.report.centre_of_mass[1]), strict=True):
            samples[name].append(value)
    return samples


def _settle(stage: Stage, simulation: Simulation, label: str) -> list[Frame]:
    return list(stage.frames(simulation, round(SETTLING * FRAME_RATE), label))


def _final_speed(stage: Stage, spacing: float, width: float) -> float:
    """The residual speed of the last second, m/s, at the tightest of the preset tolerances."""
    simulation = stage.simulation(scene(spacing, width, "final"))
    reports = [frame.report for frame in _settle(stage, simulation, "with quality final")]
    mass = simulation.core.read("mass").astype(float).sum()
    return float(np.sqrt(2 * np.mean([report.kinetic_energy for report in reports[-round(FRAME_RATE) :]]) / mass))


def _is_in_bulk(position: np.ndarray, width: float, spacing: float) -> np.ndarray:
    support_radius = 2 * spacing
    sides = np.abs(position[:, [0, 2]] - width / 2).max(axis=1) < width / 2 - support_radius
    return sides & (position[:, 1] > support_radius) & (position[:, 1] < 0.8 * DEPTH)


def _root_mean_square(velocity: np.ndarray) -> float:
    return float(np.sqrt((velocity.astype(float) ** 2).sum(axis=1).mean()))


def _curves(height: np.ndarray, pressure: np.ndarray, spacing: float) -> dict:
    bins = np.round(height / spacing).astype(int)
    rows = [(height[bins == k].mean(), pressure[bins == k].mean()) for k in np.unique(bins)]
    middle, mean = np.array(rows).T
    return {"mean pressure": curve(mean / WEIGHT, middle), "density g (H - y)": curve([1.0, 0.0], [0.0, DEPTH])}


def draw(axes: object, curves: dict) -> None:
    plot(axes, curves, "density g (H - y)", EXACT)
    plot(axes, curves, "mean pressure", MEASURED | {"marker": "o", "markersize": 4, "linestyle": ""})
    axes.set(xlabel="pressure over density g H", ylabel="height, m")


CASE = Case("Hydrostatic column", {SMALL: 16, FULL: 32}, measure, draw)
