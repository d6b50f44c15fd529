"""The automatic step: which limit holds, and what is refused before it can go wrong."""

import numpy as np
import pytest

from fontana import _core


@pytest.mark.parametrize(
    ("limit", "parameters", "speed"),
    [
        ("acoustic", {"fluid__pressure_constant": 1e4}, 0.0),
        ("viscosity", {"fluid__viscosity": 500.0}, 0.0),
        ("surface_tension", {"fluid__surface_tension": 2e3 / 2.0}, 0.0),
        ("advection", {"fluid__pressure_constant": 1.0, "fluid__viscosity": 0.0}, 50.0),
        (
            "acceleration",
            {"fluid__pressure_constant": 1.0, "forces__gravity": (0, -5e4, 0), "time__timestep": 5e-4},
            0.0,
        ),
        ("convergence", {"fluid__method": "dfsph", "fluid__viscosity": 0.0}, 0.0),
        ("frame", {"fluid__pressure_constant": 1e-3, "fluid__viscosity": 0.0, "time__timestep": 1e-4}, 0.0),
    ],
)
def test_the_limit_that_held_is_named(make_simulation, limit, parameters, speed):
    simulation = make_simulation("cpu", **({"forces__gravity": (0, 0, 0)} | parameters))
    count = 2 if speed else 1  # who moves has company, a spacing away: alone it might go further
    position = np.array([[0, 0, 0], [0.02, 0, 0]], dtype=np.float32)[:count]
    simulation.add_particles(position, np.array([[speed, 0, 0]] * count, dtype=np.float32))
    report = simulation.step_frame()
    assert report.dt_limit == limit
    if limit != "frame":
        expected = getattr(simulation.estimate_limits(speed, 5e4), limit)
        assert 0.5 * expected < report.dt_min <= expected * (1 + 1e-6)


@pytest.mark.parametrize(
    ("others", "colliders", "spacings"),
    [
        ([], [], 1.0),
        ([[1.0, 0, 0]], [], 1.0),  # beyond the support radius of 2 spacings, 0.2 m
        ([[0.15, 0, 0]], [], 0.4),
        ([], [("plane_y", (0, -0.1, 0))], 0.4),
    ],
    ids=["alone", "another far away", "a neighbour", "a wall"],
)
def test_who_is_alone_may_travel_a_spacing(backend, make_simulation, others, colliders, spacings):
    speed = 50.0
    free = {"forces__gravity": (0, 0, 0), "fluid__viscosity": 0.0, "fluid__particle_spacing": 0.1}
    simulation = make_simulation(backend, fluid__method="dfsph", time__timestep=0.02, **free)
    for kind, centre in colliders:
        simulation.add_collider(kind, centre=centre)
    position = np.array([[0, 0, 0], *others], dtype=np.float32)
    simulation.add_particles(position, np.full((len(position), 3), (speed, 0, 0), dtype=np.float32))
    steps = []
    simulation.step_frame(steps.append)
    assert np.diff(steps).max() * 0.02 == pytest.approx(spacings * 0.1 / speed, rel=0.1)


def test_a_droplet_meets_water_no_closer_than_a_spacing(make_simulation):
    """It may travel that far while it is alone: then it is among neighbours, and steps are short enough for them."""
    spacing, side = 0.1, 8
    lattice = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) * spacing
    free = {"forces__gravity": (0, 0, 0), "fluid__viscosity": 0.0, "fluid__particle_spacing": spacing}
    nearest = []
    for start in np.linspace(4.0, 5.0, 11):
        simulation = make_simulation("cpu", fluid__method="dfsph", time__timestep=0.02, **free)
        droplet = [0.35, 0.35, (side - 1 + start) * spacing]
        velocity = np.zeros((len(lattice) + 1, 3), dtype=np.float32)
        velocity[-1] = [0, 0, -30.0]
        simulation.add_particles(np.array([*lattice, droplet], dtype=np.float32), velocity)
        distances = []

        def watch(_, distances=distances, simulation=simulation):
            position = simulation.read("position")
            distances.append(np.linalg.norm(position[:-1] - position[-1], axis=1).min() / spacing)

        simulation.step_frame(watch)
        nearest.append(next(distance for distance in distances if distance < 2.0))
    assert min(nearest) > 0.95


def test_substeps_add_up_to_the_frame(make_simulation, random_block):
    simulation = make_simulation("cpu")
    simulation.add_particles(*random_block(6))
    for frame in (1, 2, 3):
        report = simulation.step_frame()
        assert report.frame == frame
        assert report.time == pytest.approx(frame / 24.0)
        assert (
            report.substeps * report.dt_min <= 1.0 / 24.0 * (1 + 1e-9) <= report.substeps * report.dt_max * (1 + 2e-9)
        )


def test_fixed_substeps(make_simulation, random_block):
    simulation = make_simulation("cpu", time__timestep=0.002, time__substeps=10)
    simulation.add_particles(*random_block(4))
    report = simulation.step_frame()
    assert (report.substeps, report.dt_limit) == (10, "fixed")
    assert report.dt_min == report.dt_max == pytest.approx(0.0002)


def test_a_viscosity_beyond_the_fixed_step_is_refused_before_the_start(make_simulation):
    simulation = make_simulation("cpu", fluid__viscosity=1e4, time__substeps=10)
    with pytest.raises(_core.BadInput, match="viscosity of 1e\\+04 Pa\\*s is unstable.*use time.substeps"):
        simulation.check()


def test_a_spacing_too_fine_for_the_solve_is_refused_before_the_start(make_simulation):
    simulation = make_simulation("cpu", fluid__method="dfsph", fluid__viscosity=0.0, fluid__particle_spacing=1.1e-4)
    with pytest.raises(_core.BadInput, match="dfsph needs 2.53e\\+03 substeps a frame.*max_substeps allows 2000"):
        simulation.check()


def test_the_refused_step_is_really_unstable(make_simulation, random_block):
    """The bound is no excuse: just below it motion dies out; beyond it, unnoticed by the check, it grows.

    The check knows the rest density; particles of a third of the mass have a third of it, and so three times the
    kinematic viscosity.
    """
    dt, fastest = 0.002, {}
    for lighter in (1.0, 3.0):
        run = make_simulation(
            forces__gravity=(0, 0, 0), fluid__pressure_constant=0.0, time__timestep=dt, time__substeps=1
        )
        bound = run.derived().support_radius ** 2 * 1000.0 / (15.0 * dt)
        run.set("fluid.viscosity", 0.95 * bound)
        position, velocity = random_block(8, speed=0.01)
        run.add_particles(position, velocity, np.full(len(position), run.derived().particle_mass / lighter, np.float32))
        for _ in range(20):
            run.step_frame()
        fastest[lighter] = np.abs(run.read("velocity")).max()
    assert fastest[1.0] < 0.02
    assert fastest[3.0] > 1.0


def test_too_many_substeps_stop_the_run_with_the_limit(make_simulation):
    simulation = make_simulation("cpu", time__max_substeps=100)
    simulation.add_particles(np.zeros((1, 3), dtype=np.float32), np.array([[1e4, 0, 0]], dtype=np.float32))
    with pytest.raises(_core.Unstable, match="more than 100 substeps.*'advection'"):
        simulation.step_frame()


@pytest.mark.parametrize("substeps", [0, 60])
def test_a_run_that_blows_up_says_so(make_simulation, substeps):
    simulation = make_simulation("cpu", time__substeps=substeps)
    simulation.add_particles(np.zeros((1, 3), dtype=np.float32), np.array([[1e30, 0, 0]], dtype=np.float32))
    with pytest.raises(_core.Unstable, match="no longer a number"):
        simulation.step_frame()


def test_an_interrupted_frame_goes_on_where_it_stopped(make_simulation, random_block):
    whole, parts = make_simulation("cpu"), make_simulation("cpu")
    for simulation in (whole, parts):
        simulation.add_particles(*random_block(8))
        simulation.add_collider("plane_y")
    whole.step_frame()
    with pytest.raises(_core.Interrupted, match="in frame 1"):
        parts.step_frame(lambda fraction: fraction > 0.3)
    assert parts.frame == 0
    parts.step_frame()
    assert np.array_equal(whole.read("position"), parts.read("position"))
