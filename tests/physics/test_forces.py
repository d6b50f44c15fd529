"""External forces on a lone particle against the closed form, and what surface tension does to a drop."""

import numpy as np
import pytest

DT, SUBSTEPS = 0.1, 10


def fly(make_simulation, backend, velocity=(0.0, 0.0, 0.0), force=None, mass=None, **parameters):
    parameters = {"forces__gravity": (0, 0, 0)} | parameters
    simulation = make_simulation(
        backend,
        time__timestep=DT,
        time__substeps=SUBSTEPS,
        fluid__pressure_constant=0.0,
        fluid__viscosity=0.0,
        **parameters,
    )
    simulation.add_particles(
        np.zeros((1, 3), dtype=np.float32),
        np.array([velocity], dtype=np.float32),
        None if mass is None else np.array([mass], dtype=np.float32),
    )
    if force is not None:
        simulation.set_force(np.array([force], dtype=np.float32))
    simulation.step_frame()
    return simulation.read("position")[0], simulation.read("velocity")[0]


def test_gravity(backend, make_simulation):
    """Symplectic Euler: v = n g dt, x = n (n + 1) / 2 g dt^2."""
    x, v = fly(make_simulation, backend, forces__gravity=(1.0, -9.81, 2.0))
    dt = DT / SUBSTEPS
    gravity = np.array([1.0, -9.81, 2.0])
    assert v == pytest.approx(SUBSTEPS * dt * gravity, rel=1e-5)
    assert x == pytest.approx(0.5 * SUBSTEPS * (SUBSTEPS + 1) * dt**2 * gravity, rel=1e-5)


def test_drag_is_a_factor_per_substep(backend, make_simulation):
    _, v = fly(make_simulation, backend, velocity=(1.0, 2.0, 3.0), forces__drag=0.9)
    assert v == pytest.approx(0.9**SUBSTEPS * np.array([1.0, 2.0, 3.0]), rel=1e-5)


def test_wind_takes_a_particle_along(backend, make_simulation):
    _, v = fly(make_simulation, backend, forces__wind=(5.0, 0.0, -1.0), forces__wind_coupling=2.0)
    share = 1.0 - (1.0 - 2.0 * DT / SUBSTEPS) ** SUBSTEPS
    assert v == pytest.approx(share * np.array([5.0, 0.0, -1.0]), rel=1e-5, abs=1e-7)


def test_a_force_on_each_particle(backend, make_simulation):
    _, v = fly(make_simulation, backend, force=(3.0, 0.0, 6.0), mass=1.5)
    assert v == pytest.approx(np.array([0.2, 0.0, 0.4]), rel=1e-5)


def test_forces_follow_the_id_and_not_the_order_of_the_cells(backend, make_simulation):
    simulation = make_simulation(backend, forces__gravity=(0, 0, 0), time__timestep=DT, time__substeps=40)
    position = np.array([[5.0, 0, 0], [-5.0, 0, 0], [0, 0, 9.0], [0, -3.0, 0]], dtype=np.float32)
    simulation.add_particles(position, mass=np.ones(4, dtype=np.float32))
    force = np.arange(12, dtype=np.float32).reshape(4, 3)
    simulation.set_force(force)
    assert np.array_equal(simulation.read("force"), force)
    simulation.step_frame()
    assert simulation.read("velocity") == pytest.approx(DT * force, rel=1e-5)
    simulation.set_force(None)
    before = simulation.read("velocity")
    simulation.step_frame()
    assert np.array_equal(simulation.read("velocity"), before)
    with pytest.raises(Exception, match="forces for 3 particles, but there are 4"):
        simulation.set_force(np.zeros((3, 3), dtype=np.float32))


def test_surface_tension_pulls_a_cube_of_water_into_a_ball(backend, make_simulation):
    """Corners of a floating cube come in, the middle of its faces moves out; without it the cube stays."""
    reach = {}
    for tension in (0.0, 5.0):
        simulation = make_simulation(
            backend, forces__gravity=(0, 0, 0), fluid__surface_tension=tension, fluid__viscosity=5.0
        )
        simulation.add_emitter("block", centre=(0, 0, 0), size=(0.24, 0.24, 0.24))
        for _ in range(4):
            simulation.step_frame()
        position = simulation.read("position")
        corners = np.argsort(np.abs(position).min(axis=1))[-8:]
        reach[tension] = np.linalg.norm(position[corners], axis=1).max()
    assert reach[5.0] < 0.9 * reach[0.0]


def test_viscosity_takes_away_relative_motion_only(backend, make_simulation, random_block):
    energies = {}
    for viscosity in (0.0, 20.0):
        simulation = make_simulation(
            backend,
            forces__gravity=(0, 0, 0),
            fluid__viscosity=viscosity,
            fluid__pressure_constant=0.0,
            time__timestep=0.01,
        )
        position, velocity = random_block(8)
        simulation.add_particles(position, velocity + np.array([1.0, 0.0, 0.0], dtype=np.float32))
        simulation.step_frame()
        v = simulation.read("velocity")
        energies[viscosity] = np.var(v, axis=0).sum()
        assert v.mean(axis=0) == pytest.approx(velocity.mean(axis=0) + [1.0, 0.0, 0.0], abs=1e-4)
    assert energies[20.0] < 0.5 * energies[0.0]
