"""Every backend and scheme against each other: bit for bit in strict arithmetic, within stated tolerances in fast."""

import numpy as np
import pytest

from fontana import _core

# Relative to the largest value; float32 sums of 30 neighbours in another order or with contraction.
DENSITY_TOLERANCE = 2e-6
ACCELERATION_TOLERANCE = 2e-5

WALLS = (
    ("plane_y", {"friction": 0.1}),
    ("sphere_inside", {"radius": 0.5, "centre": (0.1, 0.3, 0.1)}),
    ("cylinder_outside", {"radius": 0.05, "centre": (0.1, 0.0, 0.1), "cutoff": 0.1}),
)


def make_run(make_simulation, random_block, backend, neighbors="grid", substeps=20, **parameters):
    # Substeps of half a millisecond, where they are fixed.
    timing = {"time__timestep": 0.0005 * substeps, "time__substeps": substeps}
    simulation = make_simulation(backend, neighbors, fluid__surface_tension=0.07, **timing, **parameters)
    position, velocity = random_block(9)
    simulation.add_particles(position, velocity)
    for kind, fields in WALLS:
        simulation.add_collider(kind, **fields)
    return simulation


def results(simulation):
    return {name: simulation.read(name) for name in ("position", "velocity", "density", "pressure", "acceleration")}


def relative_difference(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


@pytest.mark.parametrize("neighbors", ["grid", "all-pairs"])
def test_strict_arithmetic_agrees_with_the_cpu_bit_for_bit(backend, make_simulation, random_block, neighbors):
    runs = []
    for name in ("cpu", backend):
        simulation = make_run(make_simulation, random_block, name, neighbors, solver__precision="strict")
        simulation.step_frame()
        runs.append(results(simulation))
    for name in runs[0]:
        assert np.array_equal(runs[0][name], runs[1][name]), name


def test_fast_arithmetic_agrees_within_tolerance(scheme, make_simulation, random_block):
    """One substep against cpu, all pairs, strict."""
    reference = make_run(make_simulation, random_block, "cpu", "all-pairs", 1, solver__precision="strict")
    simulation = make_run(make_simulation, random_block, *scheme, 1, solver__precision="fast")
    reference.step_frame()
    simulation.step_frame()
    expected, found = results(reference), results(simulation)
    assert relative_difference(found["density"], expected["density"]) < DENSITY_TOLERANCE
    assert relative_difference(found["acceleration"], expected["acceleration"]) < ACCELERATION_TOLERANCE


@pytest.mark.parametrize("method", ["mueller", "dfsph"])
def test_processors_without_avx2_get_the_same_answer(monkeypatch, make_simulation, random_block, method):
    """The baseline instructions against the vector loops: densities of positions as given, before any is moved."""
    settings = {"fluid__method": method, "solver__density_error_max": 0.0}
    densities = []
    for instructions in ("baseline", "best"):
        monkeypatch.setenv("FONTANA_CPU_INSTRUCTIONS", instructions)
        simulation = make_run(make_simulation, random_block, "cpu", "grid", 1, **settings)
        simulation.step_frame()
        assert ("baseline" in simulation.device().driver) == (instructions == "baseline")
        densities.append(simulation.read("density"))
    assert relative_difference(*densities) < DENSITY_TOLERANCE


def test_instructions_that_are_none_are_refused(monkeypatch, make_simulation):
    monkeypatch.setenv("FONTANA_CPU_INSTRUCTIONS", "avx1024")
    with pytest.raises(_core.BadInput, match="'avx1024'; expected baseline, avx2 or best"):
        make_simulation("cpu").device()


def test_automatic_steps_are_the_same_on_every_backend(backend, make_simulation, random_block):
    reports = []
    for name in ("cpu", backend):
        simulation = make_run(make_simulation, random_block, name, substeps=0, solver__precision="strict")
        reports.append(simulation.step_frame())
    for field in ("substeps", "dt_min", "dt_max", "dt_limit", "density_error_mean", "kinetic_energy", "max_speed"):
        assert getattr(reports[0], field) == getattr(reports[1], field), field


def test_switching_in_the_middle_of_a_run_changes_nothing(backend, make_simulation, random_block):
    """Strict arithmetic: frames on another backend give the same bytes as staying."""
    stay = make_run(make_simulation, random_block, "cpu", solver__precision="strict")
    move = make_run(make_simulation, random_block, "cpu", solver__precision="strict")
    for frame in range(3):
        move.set("solver.backend", backend if frame == 1 else "cpu")
        stay.step_frame()
        move.step_frame()
    for name, values in results(stay).items():
        assert np.array_equal(values, move.read(name)), name


def test_switching_the_scheme_in_the_middle_of_a_run(make_simulation, random_block):
    stay = make_run(make_simulation, random_block, "cpu", substeps=2)
    move = make_run(make_simulation, random_block, "cpu", substeps=2)
    for neighbors in ("grid", "all-pairs", "grid"):
        move.set("solver.neighbors", neighbors)
        stay.step_frame()
        move.step_frame()
    assert relative_difference(move.read("density"), stay.read("density")) < 10 * DENSITY_TOLERANCE


@pytest.mark.parametrize("precision", ["fast", "strict"])
def test_the_same_run_twice_gives_the_same_bytes(scheme, make_simulation, random_block, precision):
    runs = []
    for _ in range(2):
        simulation = make_run(make_simulation, random_block, *scheme, solver__precision=precision)
        simulation.step_frame()
        runs.append(simulation.read("position").tobytes())
    assert runs[0] == runs[1]


@pytest.mark.parametrize(
    "settings", [{}, {"fluid__method": "dfsph"}, {"fluid__method": "dfsph", "solver__pressure_solver": "anderson"}]
)
def test_the_number_of_threads_does_not_matter(make_simulation, random_block, settings):
    """Enough particles that each thread gets several pieces of every loop and of the sort."""
    runs = set()
    for threads in (1, 2, 4):
        simulation = make_simulation("cpu", time__frame_rate=1000.0, solver__threads=threads, **settings)
        position, velocity = random_block(34)
        simulation.add_particles(position, velocity)
        simulation.add_collider("plane_y")
        for _ in range(2):
            simulation.step_frame()
        runs.add(simulation.read("position").tobytes() + simulation.read("density").tobytes())
    assert len(runs) == 1


def test_particles_added_in_the_middle_of_a_run_keep_their_ids(scheme, make_simulation, random_block):
    simulation = make_run(make_simulation, random_block, *scheme)
    simulation.step_frame()
    before = simulation.read("position")
    added = np.array([[0.0, 5.0, 0.0], [1.0, 5.0, 0.0]], dtype=np.float32)
    simulation.add_particles(added, mass=np.array([0.5, 0.25], dtype=np.float32))
    assert np.array_equal(simulation.read("position"), np.concatenate([before, added]))
    assert np.array_equal(simulation.read("id"), np.arange(len(before) + 2))
    assert simulation.read("mass")[-2:].tolist() == [0.5, 0.25]
