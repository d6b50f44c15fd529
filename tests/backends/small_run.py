"""A small simulation on a GPU backend: the program the tests of these backends run in a process.

    small_run.py BACKEND NAME=VALUE...            runs it once, with these parameters beside those below
    small_run.py BACKEND calls LAYER FUNCTION...  runs it once for each function, and counts the calls of that function
    small_run.py BACKEND sweep LAYER CODE FUNCTION NAME=VALUE...
                                             lets the first call of FUNCTION fail with CODE, then the second, and so on
                                             until a run has no call left to fail

LAYER is what makes calls fail: a library between program and driver, or the driver itself.

Each run prints one line of JSON: {"digest": of all results, "launches": names}, or {"error": class, "sentence": text}.
"""

import ctypes
import hashlib
import itertools
import json
import sys

import numpy as np

import fontana
from fontana import _core


def small_run(parameters):
    """The digest of all results, and what was launched. 43 particles for one frame of two substeps, 173 more for the
    next, whose substeps are chosen from the motion."""
    simulation = _core.Simulation()
    for name, value in {
        "solver.profile": True,
        "fluid.method": "mueller",
        "fluid.surface_tension": 0.07,
        "forces.wind": (1.0, 0.0, 0.0),
        "forces.wind_coupling": 0.5,
        "time.frame_rate": 1000.0,
        "time.substeps": 2,
        "solver.max_iterations": 6,  # enough to launch all there is
        **parameters,
    }.items():
        simulation.set(name, value)
    simulation.add_collider("plane_y")
    simulation.add_collider("sphere_inside", radius=1.0)
    lattice = np.stack(np.meshgrid(*3 * [np.arange(6)], indexing="ij"), axis=-1).reshape(-1, 3)
    jitter = np.random.default_rng(1).uniform(-0.2, 0.2, lattice.shape)
    position = ((lattice + jitter) * 0.02).astype(np.float32)
    return digest_after_two_frames(simulation, position[:43], position[43:])


def digest_after_two_frames(simulation, early_position, late_position):
    try:
        simulation.add_particles(early_position)
        simulation.step_frame()
        simulation.set("time.substeps", 0)
        simulation.add_particles(late_position)
        simulation.set_force(np.full((simulation.particle_count, 3), 1e-4, np.float32))
        simulation.step_frame()
        digest = hashlib.sha256(simulation.count_neighbors())
        for name in ("position", "velocity", "acceleration", "density", "pressure", "mass"):
            digest.update(simulation.read(name))
        simulation.measure_copy(256)
        return {"digest": digest.hexdigest(), "launches": sorted(row.name for row in simulation.profile())}
    except _core.DeviceLost as first:
        # What a lost device held is gone: every later call must say so again.
        try:
            simulation.step_frame()
        except _core.DeviceLost as second:
            assert str(second) == str(first)
            raise
        raise AssertionError(f"a lost device went on, after: {first}") from first


def report(parameters):
    try:
        line = small_run(parameters)
    except fontana.FontanaError as error:
        line = {"error": type(error).__name__, "sentence": str(error)}
    print(json.dumps(line), flush=True)


def count(backend, layer, *functions):
    for function in functions:
        layer.arm_fault(function.encode(), 0, 0)
        small_run({"solver.backend": backend})
        print(json.dumps({"function": function, "calls": layer.count_calls()}), flush=True)


def sweep(backend, layer, code, function, *settings):
    for call in itertools.count(1):
        layer.arm_fault(function.encode(), call, int(code))
        report({"solver.backend": backend} | parsed(settings))
        if layer.count_calls() < call:
            return


def parsed(settings):
    return dict(setting.split("=") for setting in settings)


def open_layer(path):
    fontana.devices()  # has the loader load the layer, so that this finds that one and does not load another
    layer = ctypes.CDLL(path)
    layer.count_calls.restype = ctypes.c_long
    layer.arm_fault.argtypes = (ctypes.c_char_p, ctypes.c_long, ctypes.c_int)
    return layer


def main():
    backend, *arguments = sys.argv[1:]
    if arguments and arguments[0] in ("calls", "sweep"):
        mode, path, *rest = arguments
        (count if mode == "calls" else sweep)(backend, open_layer(path), *rest)
    else:
        report({"solver.backend": backend} | parsed(arguments))


if __name__ == "__main__":
    main()
