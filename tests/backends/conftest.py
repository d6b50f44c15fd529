"""What the tests of the OpenCL backend share: the fault layer, and a small simulation in a process of its own."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
HEADERS = HERE.parents[1] / "third_party" / "opencl-headers"
SMALL_RUN = HERE / "opencl_faults" / "small_run.py"


class SmallRun:
    """Runs opencl_faults/small_run.py with a kernel cache of its own."""

    def __init__(self, layer: Path, cache_home: Path, driver_cache: Path):
        self.layer = layer
        self.cache_home = cache_home
        self.driver_cache = driver_cache  # PoCL's own, shared by all tests: they are about ours

    @property
    def cache(self) -> Path:
        return self.cache_home / "fontana" / "kernels"

    def start(self, *arguments, **environment) -> subprocess.CompletedProcess:
        variables = {
            "XDG_CACHE_HOME": str(self.cache_home),
            "POCL_CACHE_DIR": str(self.driver_cache),
            "OPENCL_LAYERS": str(self.layer),
        }
        command = [sys.executable, SMALL_RUN, *arguments]
        merged = os.environ | variables | environment
        return subprocess.run(command, env=merged, capture_output=True, text=True, timeout=600)

    def lines(self, *arguments, **environment) -> list[dict]:
        """What a run prints. It must neither crash nor say anything else."""
        result = self.start(*arguments, **environment)
        assert result.returncode == 0, result.stderr
        assert result.stderr == ""
        return [json.loads(line) for line in result.stdout.splitlines()]

    def calls(self, function: str, **environment) -> int:
        """How often one run calls an OpenCL function."""
        return self.lines("calls", self.layer, function, **environment)[-1]["calls"]


@pytest.fixture(scope="session")
def fault_layer(tmp_path_factory) -> Path:
    target = tmp_path_factory.mktemp("layer") / "libfault_layer.so"
    flags = ["-std=gnu11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-shared", "-fPIC", "-isystem", HEADERS]
    source = HERE / "opencl_faults" / "layer.c"
    result = subprocess.run([os.environ.get("CC", "gcc"), *flags, source, "-o", target], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return target


@pytest.fixture(scope="session")
def first_run(opencl_device, fault_layer, tmp_path_factory) -> SmallRun:
    """A run that has filled its kernel cache, for others to begin with a copy of."""
    run = SmallRun(fault_layer, tmp_path_factory.mktemp("cache"), tmp_path_factory.mktemp("pocl"))
    if run.calls("clGetDeviceIDs") == 0:
        reason = "this OpenCL loader knows no layers (ocl-icd 2.3 does), so no call can be made to fail"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    return run


@pytest.fixture
def small_run(first_run, tmp_path) -> SmallRun:
    """A small run whose kernels are in the cache."""
    shutil.copytree(first_run.cache_home, tmp_path / "cache")
    return SmallRun(first_run.layer, tmp_path / "cache", first_run.driver_cache)
