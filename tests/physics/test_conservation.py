"""What must stay: momentum, mass, and a pool at rest."""

import numpy as np
import pytest


def momentum(simulation):
    mass = simulation.read("mass").astype(np.float64)
    return (mass[:, None] * simulation.read("velocity").astype(np.float64)).sum(axis=0)


def test_momentum_is_conserved_to_rounding(scheme, make_simulation, random_block):
    """No walls, no gravity; pressure, viscosity: action equals reaction. Masses differ by particle."""
    simulation = make_simulation(*scheme, forces__gravity=(0, 0, 0), time__frame_rate=200.0)
    position, velocity = random_block(9)
    mass = simulation.derived().particle_mass * np.linspace(0.9, 1.1, len(position), dtype=np.float32)
    simulation.add_particles(position, velocity, mass.astype(np.float32))
    before = momentum(simulation)
    exchanged = np.abs(simulation.read("mass")[:, None] * simulation.read("velocity")).sum()
    for _ in range(3):
        simulation.step_frame()
    moved = np.abs(simulation.read("velocity") - velocity).max()
    assert moved > 0.05, "nothing happened: the test would prove nothing"
    assert np.abs(momentum(simulation) - before).max() < 1e-5 * exchanged


def test_mass_is_exact(scheme, make_simulation, random_block):
    simulation = make_simulation(*scheme, time__frame_rate=200.0)
    position, velocity = random_block(6)
    mass = np.random.default_rng(3).uniform(0.5, 2.0, len(position)).astype(np.float32)
    simulation.add_particles(position, velocity, mass)
    for _ in range(3):
        simulation.step_frame()
    assert np.array_equal(simulation.read("mass"), mass)


@pytest.mark.parametrize("neighbors", ["grid"])
def test_a_pool_comes_to_rest_in_its_box(backend, make_simulation, neighbors):
    """A block dropped a little settles: no particle leaves, the mean density ends near rest, the speed near zero."""
    simulation = make_simulation(backend, neighbors, fluid__particle_spacing=0.05, fluid__viscosity=20.0)
    simulation.add_emitter("block", centre=(0.0, 0.3, 0.0), size=(0.5, 0.5, 0.5), jitter=0.05)
    simulation.add_collider("plane_y")
    for axis, kind in enumerate(("plane_x", "plane_z")):
        for side in (-1.0, 1.0):
            centre = [0.0, 0.0, 0.0]
            centre[2 * axis] = 0.3 * side
            simulation.add_collider(kind, centre=centre, flip=side > 0)
    reports = [simulation.step_frame() for _ in range(40)]
    position = simulation.read("position")
    assert np.all(np.abs(position[:, [0, 2]]) <= 0.3 + 1e-6)
    assert position[:, 1].min() >= -1e-6
    assert reports[-1].kinetic_energy < 0.02 * max(report.kinetic_energy for report in reports)
    assert simulation.read("density").mean() == pytest.approx(1000.0, rel=0.05)
    spread = np.ptp([report.density_error_mean for report in reports[-5:]])
    assert spread < 0.01, "the mean density does not settle"
