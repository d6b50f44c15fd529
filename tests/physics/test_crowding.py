"""Particles that a step has crowded are moved apart (solver.density_error_max)."""

import numpy as np
import pytest

SPACING = 0.05


def colliding_blocks(make_simulation, backend="cpu", **parameters):
    """Two blocks of 10 x 8 x 8 particles in free space that strike each other at 6 m/s, a little beside the middle."""
    settings = {"fluid__method": "dfsph", "fluid__particle_spacing": SPACING, "forces__gravity": (0.0, 0.0, 0.0)}
    simulation = make_simulation(backend, **(settings | {"time__timestep": 0.01} | parameters))
    for side in (-1.0, 1.0):
        axes = [(np.arange(count) + 0.5) * SPACING for count in (10, 8, 8)]
        position = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
        position[:, 0] = side * (position[:, 0] + 0.5 * SPACING)
        position[:, 1:] += side * np.array([0.11, 0.07]) * SPACING
        velocity = np.tile([-3.0 * side, 0.0, 0.0], (len(position), 1))
        simulation.add_particles(position.astype(np.float32), velocity.astype(np.float32))
    return simulation


def frames(simulation, count=12):
    return [simulation.step_frame() for _ in range(count)]


def cubic_sums(position):
    """Sum of the cubic spline of support two spacings over all pairs, up to its constant."""
    distance = np.linalg.norm(position[:, None, :].astype(float) - position[None, :, :], axis=-1) / (2 * SPACING)
    inner = 1 - 6 * distance**2 + 6 * distance**3
    return np.where(distance < 0.5, inner, 2 * np.clip(1 - distance, 0, None) ** 3).sum(axis=1)


@pytest.mark.parametrize(
    ("method", "mean", "percent", "without"), [("dfsph", 0.1, 1.0, 5.0), ("pcisph", 0.05, 0.5, 0.6)]
)
def test_nobody_is_denser_than_the_bound(make_simulation, method, mean, percent, without):
    """pcisph takes steps so short that it crowds less."""
    settings = {"fluid__method": method, "solver__quality": "custom", "solver__density_error": mean}
    largest = {}
    for bound in (0.0, percent):
        simulation = colliding_blocks(make_simulation, solver__density_error_max=bound, **settings)
        largest[bound] = 100 * max(report.density_error_max for report in frames(simulation))
    assert largest[0.0] > without and 0.8 * percent < largest[percent] < 1.01 * percent, largest


def test_the_frame_that_is_read_keeps_the_bound_too(make_simulation):
    """Density, by all pairs from the positions of every frame; that of the frame itself is the same."""
    simulation = colliding_blocks(make_simulation)
    scale = 1000.0 / cubic_sums(np.stack(np.meshgrid(*3 * [np.arange(7) * SPACING]), -1).reshape(-1, 3)).max()
    largest = []
    for _ in range(12):
        simulation.step_frame()
        density = scale * cubic_sums(simulation.read("position"))
        largest.append(density.max() / 1000.0 - 1.0)
        if largest[-1] > 1e-3:  # once they meet; calm water is left as its last substep found it
            assert np.abs(simulation.read("density") - density).max() < 0.1
    assert 0.005 < max(largest) < 0.0102, largest


def test_moving_apart_keeps_the_centre_of_mass(make_simulation):
    simulation = colliding_blocks(make_simulation)
    before = np.array(simulation.read("position"), float).mean(axis=0)
    reports = frames(simulation)
    assert max(report.density_error_max for report in reports) > 0.009
    assert np.abs(np.array(reports[-1].centre_of_mass) - before).max() < 1e-5


def test_backends_move_the_same_particles(backend, make_simulation):
    """Strictly, to the bit; and the vector loops, which share lists, to rounding over the first impact."""
    for precision, tolerance in (("strict", 0.0), ("fast", 1e-4)):
        runs = []
        for name, reference in (("cpu", "strict"), (backend, precision)):
            simulation = colliding_blocks(make_simulation, name, solver__precision=reference)
            reports = frames(simulation, 2)
            runs.append((simulation.read("position"), simulation.read("pressure")))
            assert reports[-1].density_error_max > 0.009, "nobody was moved"
        (a, p), (b, q) = runs
        assert np.abs(a - b).max() <= tolerance * SPACING
        assert precision == "fast" or np.array_equal(p, q)


def test_a_draft_leaves_what_its_mean_allows(make_simulation):
    simulation = colliding_blocks(make_simulation, solver__quality="draft")
    largest = max(report.density_error_max for report in frames(simulation))
    assert 0.02 < largest < 0.101


def test_who_has_nowhere_to_go_is_left_alone(make_simulation):
    """A layer between planes a tenth of a spacing apart: it feels no pressure, and the run goes on."""
    gap = 0.1 * SPACING
    simulation = make_simulation(fluid__method="dfsph", fluid__particle_spacing=SPACING)
    simulation.add_collider("plane_y")
    simulation.add_collider("plane_y", centre=(0.0, gap, 0.0), flip=True)
    axis = np.arange(5) * SPACING
    position = np.stack(np.meshgrid(axis, [gap / 2], axis), axis=-1).reshape(-1, 3).astype(np.float32)
    simulation.add_particles(position, np.zeros_like(position))
    assert simulation.step_frame().density_error_max > 0.5
    assert np.abs(simulation.read("position") - position).max() <= 1.01 * gap / 2
