"""Lists of neighbours that four particles share (backends/cpu/wide_lists.h) against a list for each, in arrangements
that are hard for them: groups of fewer than four, of far cells, across the border of the grid's box, in a crowd."""

import numpy as np
import pytest

SPACING = 0.02  # m
DENSITY_TOLERANCE = 2e-6  # as in test_agreement.py
# Of the largest change of a velocity: pressure and viscosity take 1 / sqrt to fourteen bits.
VELOCITY_TOLERANCE = 3e-4


def jittered_block(x, y, z):
    lattice = np.stack(np.meshgrid(np.arange(x), np.arange(y), np.arange(z), indexing="ij"), axis=-1).reshape(-1, 3)
    return (lattice + random().uniform(-0.2, 0.2, lattice.shape)) * SPACING


def random():
    return np.random.default_rng(5)


ARRANGEMENTS = {
    **{f"{count} particles": jittered_block(count, 1, 1) for count in (1, 2, 3, 5, 7)},
    "block": jittered_block(13, 11, 9),
    "spray": random().uniform(-1.0, 1.0, (800, 3)),
    # 4096 cells for 300 particles in a row of 600: the box wraps around.
    "row": jittered_block(1200, 1, 1)[::4] * [4.0, 1.0, 1.0],
    # More candidates than a column has room for.
    "crowd": random().uniform(-0.5 * SPACING, 0.5 * SPACING, (1500, 3)),
    "block and crowd": np.concatenate([jittered_block(9, 9, 9), 0.1 * SPACING * random().uniform(0, 1, (1200, 3))]),
}


def after_a_substep(make_simulation, position, neighbors, threads):
    simulation = make_simulation(
        "cpu",
        neighbors,
        solver__threads=threads,
        fluid__method="wcsph",
        fluid__particle_spacing=SPACING,
        fluid__pressure_constant=1e-3,
        fluid__viscosity=0.5,
        time__timestep=1e-5,
        time__substeps=1,
    )
    velocity = random().uniform(-1, 1, position.shape)
    simulation.add_particles(position.astype(np.float32), velocity.astype(np.float32))
    simulation.step_frame()
    change = simulation.read("velocity") - velocity.astype(np.float32)
    return simulation.device().driver, simulation.read("density"), change


@pytest.mark.parametrize("neighbors", ["grid", "all-pairs"])
@pytest.mark.parametrize("name", ARRANGEMENTS)
def test_a_shared_list_has_all_neighbors_of_all_and_counts_no_one_twice(monkeypatch, make_simulation, name, neighbors):
    position = ARRANGEMENTS[name]
    monkeypatch.setenv("FONTANA_CPU_INSTRUCTIONS", "baseline")
    driver, density, change = after_a_substep(make_simulation, position, neighbors, 1)
    assert "baseline" in driver
    for instructions in ("avx2", "best"):
        monkeypatch.setenv("FONTANA_CPU_INSTRUCTIONS", instructions)
        driver, shared_density, shared_change = after_a_substep(make_simulation, position, neighbors, 1)
        if "baseline" in driver:
            pytest.skip("a processor without AVX2 has a list for each particle")
        assert np.abs(shared_density - density).max() < DENSITY_TOLERANCE * density.max()
        assert np.abs(shared_change - change).max() <= VELOCITY_TOLERANCE * np.abs(change).max()
        _, *on_threads = after_a_substep(make_simulation, position, neighbors, 3)
        assert np.array_equal(on_threads[0], shared_density) and np.array_equal(on_threads[1], shared_change)
