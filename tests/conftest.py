"""One test text for every backend: a test that takes `backend` or `scheme` runs on each."""

import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from fontana import _core

BACKENDS = ("cpu", "opencl")
SCHEMES = tuple((backend, neighbors) for backend in BACKENDS for neighbors in ("grid", "all-pairs"))


def require_backend(name):
    """Skip where a backend has no device; in CI that is a failure, since CI installs a runtime."""
    devices = [device for device in _core.devices() if device.backend == name]
    if any(device.available for device in devices):
        return
    reason = f"no {name} device: " + "; ".join(device.reason for device in devices)
    if os.environ.get("CI") == "true":
        pytest.fail(reason)
    pytest.skip(reason)


@pytest.fixture(params=BACKENDS)
def backend(request):
    require_backend(request.param)
    return request.param


@pytest.fixture(params=SCHEMES, ids=lambda scheme: "-".join(scheme))
def scheme(request):
    require_backend(request.param[0])
    return request.param


@pytest.fixture(scope="session")
def opencl_device():
    """For tests of the OpenCL backend alone."""
    require_backend("opencl")


@pytest.fixture(scope="session")
def native_build():
    """Builds a target of CMakeLists.txt with the release preset and returns its file: native_build("io_test")."""
    root = Path(__file__).parents[1]
    cmake = shutil.which("cmake") or pytest.fail("no cmake on PATH: `make build` puts one into .venv/bin")

    def run(*arguments):
        result = subprocess.run([cmake, *arguments], cwd=root, capture_output=True, text=True)
        assert result.returncode == 0, result.stdout[-4000:] + result.stderr

    def build(target):
        run("--build", "--preset", "release", "-j", "2", "--target", target)
        files = [path for path in (root / "build" / "release").rglob(f"{target}*") if path.is_file()]
        return next(path for path in files if path.name in (target, f"{target}.so"))

    run("--preset", "release", "--log-level=WARNING")
    return build


@pytest.fixture
def make_simulation():
    """A bare simulation: parameters by name with dots as double underscores, no colliders, no emitters."""

    def make(backend="cpu", neighbors="grid", **parameters):
        simulation = _core.Simulation()
        simulation.set("solver.backend", backend)
        simulation.set("solver.neighbors", neighbors)
        for name, value in parameters.items():
            simulation.set(name.replace("__", "."), value)
        return simulation

    return make


@pytest.fixture
def random_block():
    """(N, 3) positions of a jittered lattice block at spacing `spacing`, and velocities of a few cm/s."""

    def make(side, spacing=0.02, seed=1, speed=0.3):
        generator = np.random.default_rng(seed)
        axis = (np.arange(side) + 0.5) * spacing
        lattice = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
        position = lattice + generator.uniform(-0.2, 0.2, lattice.shape) * spacing
        velocity = generator.uniform(-speed, speed, lattice.shape)
        return position.astype(np.float32), velocity.astype(np.float32)

    return make
