"""One test text for every backend: a test that takes `backend` or `scheme` runs on each."""

import ctypes
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line import fontana_command
from small_scenes import DROP

from fontana import _core

sys.path.append(str(Path(__file__).parent / "cuda_stand_in"))
import stand_in  # noqa: E402

BACKENDS = ("cpu", "cuda", "opencl")
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


def cuda_environment():
    """What CUDA runs on in tests: a real driver where one has a GPU, else the stand-in driver, which runs NVRTC's PTX
    on the CPU. It shows its device only with these variables, so that other tests see the machine as it is."""
    if any(device.available for device in _core.devices() if device.backend == "cuda"):
        return {}
    return stand_in.environment()


@pytest.fixture
def use_backend(monkeypatch):
    """Call it with a backend's name before using that backend."""

    def use(name):
        for variable, value in (cuda_environment() if name == "cuda" else {}).items():
            monkeypatch.setenv(variable, value)
        require_backend(name)

    return use


@pytest.fixture(params=BACKENDS)
def backend(request, use_backend):
    use_backend(request.param)
    return request.param


@pytest.fixture(params=SCHEMES, ids=lambda scheme: "-".join(scheme))
def scheme(request, use_backend):
    use_backend(request.param[0])
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
    """A bare simulation by the thesis's method unless fluid__method says otherwise: parameters by name with dots as
    double underscores, no colliders, no emitters."""

    def make(backend="cpu", neighbors="grid", **parameters):
        simulation = _core.Simulation()
        simulation.set("solver.backend", backend)
        simulation.set("solver.neighbors", neighbors)
        for name, value in ({"fluid__method": "mueller"} | parameters).items():
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


@pytest.fixture
def fontana(tmp_path: Path):
    """Runs the command line in a folder of its own and returns the finished process."""

    def call(*arguments: object, code: int = 0, env: dict | None = None, **options) -> subprocess.CompletedProcess:
        done = subprocess.run(
            fontana_command(*arguments),
            cwd=tmp_path,
            env=os.environ | {"FONTANA_DEBUG": ""} | (env or {}),
            capture_output=True,
            text=True,
            **options,
        )
        assert done.returncode == code, f"code {done.returncode}\n{done.stdout}\n{done.stderr}"
        assert "Traceback" not in done.stderr or (env or {}).get("FONTANA_DEBUG")
        return done

    return call


@pytest.fixture(scope="session")
def finished_drop(tmp_path_factory) -> Path:
    """The folder of a run of six frames; to look at, not to change."""
    folder = tmp_path_factory.mktemp("drop")
    (folder / "drop.json").write_text(json.dumps(DROP))
    words = ("run", "drop.json", "--out", "drop", "--backend", "cpu", "--no-picture", "--quiet")
    subprocess.run(fontana_command(*words), cwd=folder, check=True)
    return folder / "drop"


@pytest.fixture
def drop_cache(finished_drop: Path, tmp_path: Path) -> Path:
    """A copy of it to spoil."""
    return Path(shutil.copytree(finished_drop, tmp_path / "drop"))


@pytest.fixture(scope="module")
def opengl():
    """A moderngl context without a window; skipped where there is none, which in CI is a failure.

    It is let go of with the module: while it is current, a window cannot make its own so.
    """
    from fontana.gl.context import create_headless_context

    try:
        context = create_headless_context()
    except _core.DeviceUnavailable as error:
        if os.environ.get("CI") == "true":
            pytest.fail(str(error))
        pytest.skip(str(error))
    yield context
    context.release()
    ctypes.CDLL("libEGL.so.1").eglReleaseThread()
