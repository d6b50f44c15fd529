"""The grid read through the local memory of work-groups: another loop, the same sums in the same order."""

import numpy as np
import pytest

from fontana import _core
from fontana.tables import parameters


@pytest.fixture(params=["cuda", "opencl"])
def gpu(request, use_backend):
    use_backend(request.param)
    return request.param


SPACING = 0.02  # m; cells are two spacings wide
ATTRIBUTES = ("position", "velocity", "density", "pressure", "acceleration")


def shaken(points, seed=3):
    return (points + np.random.default_rng(seed).uniform(-0.004, 0.004, points.shape)).astype(np.float32)


def lattice(*counts):
    axes = np.meshgrid(*[np.arange(count) * SPACING for count in counts], indexing="ij")
    return shaken(np.stack(axes, axis=-1).reshape(-1, 3))


CLOUDS = {
    # Work-groups lie within one row of cells: everything goes through tiles, several to a range.
    "rows": lattice(300, 2, 2),
    # Work-groups lie across rows, and so do their ranges.
    "block": lattice(11, 11, 11),
    # Hardly anyone has a neighbour, and rows far apart share a group: each particle reads for itself.
    "spray": shaken(np.random.default_rng(5).uniform(-2.0, 2.0, (700, 3))),
    # Ranges much longer than a tile.
    "crowd": np.random.default_rng(6).uniform(0.0, 2.5 * SPACING, (900, 3)).astype(np.float32),
    # A group of one, and of one less than is full.
    "one": lattice(1, 1, 1),
    "odd": lattice(9, 7, 1),
}


def run(make_simulation, gpu, neighbors, position, **parameters):
    simulation = make_simulation(gpu, neighbors, time__timestep=0.002, time__substeps=20, **parameters)
    simulation.add_particles(position)
    simulation.add_collider("plane_y", centre=(0.0, -0.01, 0.0))
    simulation.step_frame()
    return {name: simulation.read(name) for name in ATTRIBUTES}


@pytest.mark.parametrize("cloud", CLOUDS)
def test_tiles_agree_with_the_grid_bit_for_bit(gpu, make_simulation, cloud):
    runs = (run(make_simulation, gpu, name, CLOUDS[cloud], solver__precision="strict") for name in ("tiles", "grid"))
    tiles, grid = runs
    for name in ATTRIBUTES:
        assert np.array_equal(tiles[name], grid[name]), name
    assert np.isfinite(tiles["position"]).all()


def test_fast_arithmetic_agrees_within_tolerance(gpu, make_simulation):
    tiles, grid = (run(make_simulation, gpu, neighbors, CLOUDS["block"]) for neighbors in ("tiles", "grid"))
    assert np.abs(tiles["density"] / grid["density"] - 1.0).max() < 2e-6
    assert np.abs(tiles["position"] - grid["position"]).max() < 1e-6


def test_the_scheme_may_change_between_frames(gpu, make_simulation):
    settings = {"solver__precision": "strict", "time__timestep": 0.001, "time__substeps": 3}
    stay, move = (make_simulation(gpu, **settings) for _ in range(2))
    for simulation in (stay, move):
        simulation.add_particles(CLOUDS["block"])
    for neighbors in ("grid", "tiles", "grid"):
        move.set("solver.neighbors", neighbors)
        stay.step_frame()
        move.step_frame()
    for name in ATTRIBUTES:
        assert np.array_equal(stay.read(name), move.read(name)), name


def test_tiles_are_counted_under_the_names_of_the_kernels(gpu, make_simulation):
    simulation = make_simulation(gpu, "tiles", solver__profile=True, time__timestep=0.001, time__substeps=2)
    simulation.add_particles(CLOUDS["odd"])
    simulation.step_frame()
    rows = {row.name: row for row in simulation.profile()}
    assert rows["density"].launches == rows["fluid_force"].launches == 2
    assert rows["density"].bytes > 0


@pytest.mark.parametrize("method", ["dfsph", "pcisph", "wcsph"])
def test_other_methods_are_refused(gpu, make_simulation, method):
    simulation = make_simulation(gpu, "tiles", fluid__method=method)
    with pytest.raises(_core.BadInput, match=f"choice of fluid.method=mueller, and the method is {method}.*=grid"):
        simulation.check()


def test_the_cpu_is_refused(make_simulation):
    sentence = r"choice of the backends for GPUs and the run is on cpu, which has grid\|all-pairs: use .*=grid"
    with pytest.raises(_core.BadInput, match=sentence):
        make_simulation("cpu", "tiles").device()


def test_a_gpu_has_every_scheme(gpu):
    listed = {device.neighbors for device in _core.devices() if device.backend == gpu and device.available}
    assert listed == {parameters()["solver.neighbors"].choices}


def test_a_device_starts_with_the_schemes_that_it_lists_alone(backend, make_simulation):
    listed = next(device.neighbors for device in _core.devices() if device.backend == backend and device.available)
    assert "grid" in listed
    for word in parameters()["solver.neighbors"].choices:
        simulation = make_simulation(backend, word)
        if word in listed:
            assert simulation.device().neighbors == listed
        else:
            with pytest.raises(_core.BadInput, match=f"solver.neighbors={word} "):
                simulation.device()
