"""Builds and runs opencl_checks.cpp: the OpenCL backend from inside, since the library exports none of it."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
SOURCE = ROOT / "src" / "fontana"
OPENCL = SOURCE / "backends" / "opencl"
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wsign-conversion", "-Werror")


def run(*command):
    result = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def embed_kernels(target):
    cmake = shutil.which("cmake") or pytest.fail("the kernels are embedded by cmake, which is not on PATH")
    roots = f"{SOURCE / 'kernels' / 'kernels.h'}|{OPENCL / 'sort.cl'}"
    variables = {"OUTPUT": target, "SYMBOL": "opencl_kernel_source", "FOLDER": SOURCE / "kernels", "ROOTS": roots}
    run(cmake, *[f"-D{name}={value}" for name, value in variables.items()], "-P", ROOT / "cmake" / "EmbedKernels.cmake")
    return target


@pytest.fixture(scope="session")
def opencl_checks(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("checks")
    # The backend's own class needs the table of all kernels; what it is made of does not.
    sources = [path for path in sorted(OPENCL.glob("*.cpp")) if path.name != "opencl_backend.cpp"]
    sources += [embed_kernels(folder / "kernels.cpp"), SOURCE / "io" / "hash64.cpp", HERE / "opencl_checks.cpp"]
    includes = ("-I", SOURCE, "-isystem", ROOT / "third_party" / "opencl-headers")
    program = folder / "opencl_checks"
    compiler = os.environ.get("CXX", "g++")
    run(compiler, "-std=c++17", "-O1", *WARNINGS, "-pthread", *includes, *sources, "-o", program, "-ldl")
    return program


def test_the_backend_from_inside(opencl_device, opencl_checks):
    assert run(opencl_checks).endswith(" checks, 0 failed\n")
