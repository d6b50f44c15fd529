"""The user's push (kernels/push.h): its shape, the momentum it gives, and that it costs nothing where it is off."""

import numpy as np
import pytest

import fontana

DT = 0.002
PUSH = (3.0, -2.0, 5.0)
RADIUS = 0.15
CENTRE = (0.02, 0.01, -0.03)
METHODS = ("mueller", "wcsph", "pcisph", "dfsph")


def pushed(make_simulation, backend, position, **parameters):
    """One substep of a fluid at rest, under the push alone."""
    simulation = make_simulation(
        backend,
        forces__gravity=(0, 0, 0),
        forces__push=PUSH,
        forces__push_centre=CENTRE,
        forces__push_radius=RADIUS,
        time__timestep=DT,
        time__substeps=1,
        **parameters,
    )
    simulation.add_particles(position)
    simulation.step_frame()
    return simulation


def lattice(spacing, half_side):
    axis = np.arange(-half_side, half_side + 0.5 * spacing, spacing)
    return np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3).astype(np.float32)


def test_it_fades_to_nothing_at_its_radius(backend, make_simulation):
    """Particles too far apart to feel each other: v = dt a (1 - r^2 / R^2)^2."""
    distance = np.array([0.0, 0.05, 0.1, 0.149, 0.151, 3.0])
    direction = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]])
    simulation = pushed(make_simulation, backend, np.add(CENTRE, distance[:, None] * direction))
    share = np.maximum(0.0, 1.0 - (distance / RADIUS) ** 2) ** 2
    assert simulation.read("velocity") == pytest.approx(DT * share[:, None] * PUSH, rel=1e-4, abs=1e-8)
    assert not simulation.read("velocity")[-2:].any()


@pytest.mark.parametrize("method", METHODS)
def test_momentum_is_the_integral_over_the_fluid(backend, make_simulation, method):
    """Forces between particles cancel in sum, so that 32 pi / 105 R^3 density a dt remains."""
    simulation = pushed(
        make_simulation,
        backend,
        lattice(0.02, 0.24),
        fluid__method=method,
        fluid__viscosity=0.0,
        solver__quality="final",
    )
    momentum = (simulation.read("mass")[:, None] * simulation.read("velocity")).sum(axis=0)
    integral = 32.0 * np.pi / 105.0 * RADIUS**3 * 1000.0
    assert momentum == pytest.approx(integral * DT * np.array(PUSH), rel=0.01)


def test_without_a_radius_nothing_changes(backend, make_simulation, random_block):
    states = []
    for push in ((0.0, 0.0, 0.0), (100.0, 0.0, 0.0)):
        simulation = make_simulation(backend, forces__push=push)
        simulation.add_particles(*random_block(8))
        simulation.step_frame()
        states.append(simulation.read("position").tobytes() + simulation.read("velocity").tobytes())
    assert states[0] == states[1]


@pytest.mark.parametrize("method", METHODS)
def test_a_push_agrees_bit_for_bit(backend, make_simulation, random_block, method):
    states = []
    for name in ("cpu", backend):
        simulation = make_simulation(
            name,
            solver__precision="strict",
            fluid__method=method,
            forces__push=(20.0, 40.0, 0.0),
            forces__push_centre=(0.08, 0.08, 0.08),
            forces__push_radius=0.1,
            time__timestep=0.02,
        )
        simulation.add_particles(*random_block(8))
        simulation.step_frame()
        states.append(simulation.read("position").tobytes() + simulation.read("velocity").tobytes())
    assert states[0] == states[1]


def test_the_smallest_ball_at_a_particle_is_still_a_number(backend, make_simulation):
    simulation = make_simulation(
        backend,
        forces__gravity=(0, 0, 0),
        forces__push=PUSH,
        forces__push_radius=1e-300,
        time__timestep=DT,
        time__substeps=1,
    )
    simulation.add_particles(np.zeros((1, 3), dtype=np.float32))
    simulation.step_frame()
    assert simulation.read("velocity")[0] == pytest.approx(np.multiply(DT, PUSH), rel=1e-5)


def test_the_python_call_is_in_the_unit_of_the_scene():
    """Two particles six centimetres apart in a scene of centimetres; the push reaches the first alone."""
    simulation = fontana.Simulation(backend="cpu", simulation_scale=0.01, gravity=[0, 0, 0], timestep=DT, substeps=1)
    simulation.add_particles([[3.0, 0.0, 0.0], [9.0, 0.0, 0.0]])
    simulation.push((6.0, 0.0, 0.0), centre=(3.0, 0.0, 0.0), radius=2.0)
    frame = simulation.step()
    assert frame.velocity[0] == pytest.approx((100 * 6.0 * DT, 0.0, 0.0))
    assert not frame.velocity[1].any()
    simulation.push((6.0, 0.0, 0.0), centre=(3.0, 0.0, 0.0), radius=0.0)
    assert simulation.step().velocity[0] == pytest.approx(frame.velocity[0])
