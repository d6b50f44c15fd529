"""Lists of neighbours of a particle's own (kernels/neighbor_list.h), on every backend: neighbours whose indices lie far
apart, and crowds that no list has room for at first. tests/solver/neighbor_list_test.cpp reads the words themselves."""

import numpy as np
import pytest

SPACING = 0.02  # m; the support radius is twice that
SIDE = 260  # of a sheet: 67,600 particles, more than 16 bits count


def random():
    return np.random.default_rng(5)


def block(side):
    axis = np.arange(side) * SPACING
    lattice = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    return lattice + random().uniform(-0.2, 0.2, lattice.shape) * SPACING


def crowd(count):
    return random().uniform(-0.5 * SPACING, 0.5 * SPACING, (count, 3))


def make_still(make_simulation, backend, **parameters):
    """Without gravity, pressure of any size or steps of any length: what counts is who is near."""
    return make_simulation(
        backend,
        fluid__method="wcsph",
        fluid__particle_spacing=SPACING,
        fluid__pressure_constant=1e-3,
        forces__gravity=(0.0, 0.0, 0.0),
        time__timestep=1e-5,
        time__substeps=1,
        **parameters,
    )


def densities(make_simulation, backend, position, **parameters):
    simulation = make_still(make_simulation, backend, **parameters)
    simulation.add_particles(position.astype(np.float32))
    simulation.step_frame()
    return simulation.read("density")


@pytest.mark.parametrize("precision", ["strict", "fast"])
def test_a_neighbour_may_be_any_number_of_particles_away(backend, make_simulation, precision):
    """Two sheets in two layers of cells, one above the other. In a sheet no one is near anyone; from a particle to the
    one above it is a whole sheet of indices."""
    pair = np.array([[0.0, 0.0, 1.75 * SPACING], [0.0, 0.0, 2.25 * SPACING]])
    place = np.arange(SIDE) * 4.0 * SPACING
    x, y = (axis.ravel() for axis in np.meshgrid(place, place))
    sheets = np.concatenate([np.stack([x, y, np.full_like(x, z)], axis=-1) for z in pair[:, 2]])
    expected = densities(make_simulation, backend, pair, solver__precision=precision)
    alone = densities(make_simulation, backend, pair[:1], solver__precision=precision)
    assert expected[0] == expected[1] > 1.5 * alone[0]
    found = densities(make_simulation, backend, sheets, solver__precision=precision)
    assert np.abs(found - expected[0]).max() < 1e-6 * expected[0]


def test_a_crowd_makes_room_for_itself(backend, make_simulation):
    """In mid-run, and again: strict arithmetic, bit for bit with the cpu, whose lists a test in C++ reads."""
    runs = []
    for name in ("cpu", backend):
        simulation = make_still(make_simulation, name, solver__precision="strict")
        run = []
        for position, least in ((block(8), 25), (crowd(300), 290), (crowd(900) + [0.3, 0.1, 0.1], 890)):
            simulation.add_particles(position.astype(np.float32))
            assert simulation.count_neighbors().max() > least
            simulation.step_frame()
            run += [simulation.read(attribute).tobytes() for attribute in ("density", "velocity")]
        runs.append(run)
    assert runs[0] == runs[1]


def test_a_crowd_leaves_no_one_out(backend, make_simulation):
    """The density of many in all but one place: each adds the most that the smoothing kernel has."""
    count = 700
    alone = densities(make_simulation, backend, np.zeros((1, 3)))
    found = densities(make_simulation, backend, 1e-4 * crowd(count))
    assert np.abs(found / (count * alone[0]) - 1.0).max() < 1e-5
