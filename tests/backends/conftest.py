"""What the tests of the GPU backends share: what makes calls fail, and a small simulation in a process of its own."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import stand_in

HERE = Path(__file__).parent
HEADERS = HERE.parents[1] / "third_party" / "opencl-headers"
SMALL_RUN = HERE / "small_run.py"


# Called only where the kernel cache is empty.
COMPILING = ("clCreateProgramWithSource", "clBuildProgram", "clGetProgramInfo")
COMPILING += ("nvrtcCreateProgram", "nvrtcCompileProgram")
COMPILING += ("nvrtcGetCUBINSize", "nvrtcGetCUBIN", "nvrtcGetPTXSize", "nvrtcGetPTX")


class SmallRun:
    """Runs small_run.py on a backend, with a kernel cache of its own."""

    def __init__(self, backend: str, layer: Path, cache_home: Path, environment: dict[str, str]):
        self.backend = backend
        self.layer = layer
        self.cache_home = cache_home
        self.environment = environment
        # What compiles the kernels, and what loads them out of the cache.
        self.compiling, self.loading = {
            "opencl": ("clCreateProgramWithSource", "clCreateProgramWithBinary"),
            "cuda": ("nvrtcCompileProgram", "cuModuleLoadData"),
        }[backend]

    def with_cache(self, cache_home: Path):
        return SmallRun(self.backend, self.layer, cache_home, self.environment)

    @property
    def cache(self) -> Path:
        return self.cache_home / "fontana" / "kernels"

    def start(self, *arguments, **environment) -> subprocess.CompletedProcess:
        command = [sys.executable, SMALL_RUN, self.backend, *arguments]
        merged = os.environ | self.environment | {"XDG_CACHE_HOME": str(self.cache_home)} | environment
        return subprocess.run(command, env=merged, capture_output=True, text=True, timeout=600)

    def lines(self, *arguments, **environment) -> list[dict]:
        """What a run prints. It must neither crash nor say anything else."""
        result = self.start(*arguments, **environment)
        assert result.returncode == 0, result.stderr
        assert result.stderr == ""
        return [json.loads(line) for line in result.stdout.splitlines()]

    def calls(self, function: str, **environment) -> int:
        """How often one run calls a function of the driver or the compiler."""
        return self.lines("calls", self.layer, function, **environment)[-1]["calls"]

    def sweep(self, function: str, error: tuple[int, str], *settings: str, **environment) -> list[dict]:
        """Lets each call of the function fail once, with this code, whose name must be in every error. Returns the runs
        that raised one; the others must have the result of a run in which nothing fails."""
        code, name = error
        expected = self.lines(*settings, **environment)[-1]
        if function in COMPILING:
            for entry in self.cache.iterdir():
                entry.unlink()
        runs = self.lines("sweep", self.layer, str(code), function, *settings, **environment)
        assert len(runs) > 1, f"no run calls {function}"
        assert runs[-1] == expected
        failed = [run for run in runs if "error" in run]
        assert all(run == expected for run in runs if run not in failed)
        for run in failed:
            assert name in run["sentence"], run
        return failed


@pytest.fixture(scope="session")
def fault_layer(tmp_path_factory) -> Path:
    target = tmp_path_factory.mktemp("layer") / "libfault_layer.so"
    flags = ["-std=gnu11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-shared", "-fPIC", "-isystem", HEADERS]
    source = HERE / "opencl_faults" / "layer.c"
    result = subprocess.run([os.environ.get("CC", "gcc"), *flags, source, "-o", target], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return target


def first_opencl_run(request) -> SmallRun:
    request.getfixturevalue("opencl_device")
    layer = request.getfixturevalue("fault_layer")
    folders = request.getfixturevalue("tmp_path_factory")
    # PoCL's own cache is shared by all tests: they are about ours.
    environment = {"OPENCL_LAYERS": str(layer), "POCL_CACHE_DIR": str(folders.mktemp("pocl"))}
    run = SmallRun("opencl", layer, folders.mktemp("cache"), environment)
    if run.calls("clGetDeviceIDs") == 0:
        reason = "this OpenCL loader knows no layers (ocl-icd 2.3 does), so no call can be made to fail"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    return run


def first_cuda_run(request) -> SmallRun:
    """On the stand-in driver, even where there is a real one: only it can fail on request."""
    environment = stand_in.environment() | stand_in.compiler_faults()
    folder = request.getfixturevalue("tmp_path_factory").mktemp("cache")
    run = SmallRun("cuda", stand_in.library(), folder, environment)
    assert run.calls("cuInit") > 0
    return run


@pytest.fixture(scope="session")
def first_run(request):
    """first_run(backend): a run that has filled its kernel cache, for others to begin with a copy of."""
    runs = {}

    def make(backend):
        if backend not in runs:
            runs[backend] = {"opencl": first_opencl_run, "cuda": first_cuda_run}[backend](request)
        return runs[backend]

    return make


@pytest.fixture
def opencl_run(first_run, tmp_path) -> SmallRun:
    """A small run whose kernels are in the cache."""
    return copy_of(first_run("opencl"), tmp_path)


@pytest.fixture
def cuda_run(first_run, tmp_path) -> SmallRun:
    """A small run on the stand-in driver whose kernels are in the cache."""
    return copy_of(first_run("cuda"), tmp_path)


@pytest.fixture(params=["cuda", "opencl"])
def small_run(request, first_run, tmp_path) -> SmallRun:
    """A small run on each GPU backend whose kernels are in the cache."""
    return copy_of(first_run(request.param), tmp_path)


def copy_of(run: SmallRun, folder: Path) -> SmallRun:
    shutil.copytree(run.cache_home, folder / "cache")
    return run.with_cache(folder / "cache")
