"""The search against brute force: nobody is missed, nobody is counted twice."""

import numpy as np
import pytest

SUPPORT = 0.04


def brute_force(position):
    count = np.zeros(len(position), dtype=np.uint32)
    for i, x in enumerate(position):
        offset = x - position
        # In float32, as the kernels do: a pair within rounding of the support radius must fall on the same side.
        squared = offset[:, 0] * offset[:, 0] + offset[:, 1] * offset[:, 1] + offset[:, 2] * offset[:, 2]
        count[i] = np.count_nonzero(squared < np.float32(SUPPORT) * np.float32(SUPPORT)) - 1
    return count


def random_cloud(generator):
    return generator.uniform(-0.2, 0.2, (1500, 3))


def clustered_cloud(generator):
    centres = generator.uniform(-0.5, 0.5, (8, 3))
    return (centres[:, None] + generator.normal(0.0, 0.02, (8, 150, 3))).reshape(-1, 3)


def sparse_cloud(generator):
    return generator.uniform(-40.0, 40.0, (1200, 3))


def strays(generator):
    cloud = random_cloud(generator)
    cloud[:3] = [[1000.0, 0.0, 0.0], [0.0, -1000.0, 3.0], [1000.0, 0.01, 0.0]]
    return cloud


def line(generator):
    """One row of cells: the box of cells wraps around along it, thousands of times."""
    cloud = generator.uniform(-0.01, 0.01, (1000, 3))
    cloud[:, 0] = np.linspace(-200.0, 200.0, 1000) + generator.uniform(-0.01, 0.01, 1000)
    cloud[500:, 0] = cloud[:500, 0] + 0.01
    return cloud


def one_cell(generator):
    return generator.uniform(0.0, 0.01, (300, 3))


@pytest.mark.parametrize("cloud", [random_cloud, clustered_cloud, sparse_cloud, strays, line, one_cell])
def test_neighbours_equal_brute_force(scheme, make_simulation, cloud):
    backend, neighbors = scheme
    position = cloud(np.random.default_rng(7)).astype(np.float32)
    simulation = make_simulation(backend, neighbors, solver__precision="strict", fluid__support_radius=SUPPORT)
    simulation.add_particles(position)
    assert np.array_equal(simulation.count_neighbors(), brute_force(position))


def test_a_stray_changes_nothing_for_the_others(make_simulation, random_block):
    """Grid memory follows the particle count: a dense one would need 10^13 cells here."""
    position, velocity = random_block(8)
    runs = []
    for stray in (False, True):
        simulation = make_simulation(
            solver__precision="strict", forces__gravity=(0, 0, 0), time__timestep=0.0025, time__substeps=5
        )
        simulation.add_particles(position, velocity)
        if stray:
            simulation.add_particles(np.array([[1000.0, 1000.0, -1000.0]], dtype=np.float32))
        simulation.step_frame()
        runs.append(simulation.read("position")[: len(position)])
    assert np.abs(runs[0] - runs[1]).max() < 1e-6
