"""Builds and runs gpu_checks.h: the backends for GPUs from inside, since the library exports none of them."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
SOURCE = ROOT / "src" / "fontana"
BACKENDS = SOURCE / "backends"
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wsign-conversion", "-Werror")


def run(*command):
    result = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def embed_kernels(target):
    cmake = shutil.which("cmake") or pytest.fail("the kernels are embedded by cmake, which is not on PATH")
    roots = "|".join(map(str, (SOURCE / "kernels/kernels.h", BACKENDS / "gpu/sort.inl", BACKENDS / "gpu/tiles.inl")))
    variables = {"OUTPUT": target, "SYMBOL": "gpu_kernel_text", "FOLDER": SOURCE / "kernels", "ROOTS": roots}
    run(cmake, *[f"-D{name}={value}" for name, value in variables.items()], "-P", ROOT / "cmake" / "EmbedKernels.cmake")
    return target


def build(backend, folder) -> Path:
    # The backend's own class needs the table of all kernels; what it is made of does not.
    parts = [path for name in ("gpu", backend) for path in sorted((BACKENDS / name).glob("*.cpp"))]
    sources = [path for path in parts if path.name != f"{backend}_backend.cpp"]
    sources += [embed_kernels(folder / "kernels.cpp"), SOURCE / "io" / "hash64.cpp", HERE / f"{backend}_checks.cpp"]
    includes = ("-I", SOURCE, "-I", HERE, "-isystem", ROOT / "third_party" / "opencl-headers")
    program = folder / f"{backend}_checks"
    compiler = os.environ.get("CXX", "g++")
    run(compiler, "-std=c++17", "-O1", *WARNINGS, "-pthread", *includes, *sources, "-o", program, "-ldl")
    return program


@pytest.mark.parametrize("backend", ["cuda", "opencl"])
def test_the_backend_from_inside(use_backend, tmp_path, backend):
    use_backend(backend)
    assert run(build(backend, tmp_path)).endswith(" checks, 0 failed\n")
