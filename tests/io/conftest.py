"""Builds io_test and the fault-injecting library once a session, from the sources of io alone."""

import os
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).parent
SOURCE = HERE.parents[1] / "src" / "fontana"
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Werror"]
CXX_WARNINGS = [*WARNINGS, "-Wconversion", "-Wshadow"]


def compile_to(target: Path, compiler: str, *arguments) -> Path:
    command = [compiler, *map(str, arguments), "-o", str(target)]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 0, f"{' '.join(command)}\n{result.stderr}"
    return target


def build_io_test(target: Path, *flags: str) -> Path:
    sources = [*sorted(HERE.glob("*.cpp")), *sorted((SOURCE / "io").glob("*.cpp"))]
    compiler = os.environ.get("CXX", "g++")
    return compile_to(target, compiler, "-std=c++17", *CXX_WARNINGS, *flags, "-I", SOURCE, "-I", HERE.parent, *sources)


@pytest.fixture(scope="session")
def io_test(tmp_path_factory) -> Path:
    return build_io_test(tmp_path_factory.mktemp("bin") / "io_test", "-O1")


@pytest.fixture(scope="session")
def fail_write(tmp_path_factory) -> Path:
    """The library of fail_write.c, for LD_PRELOAD."""
    target = tmp_path_factory.mktemp("bin") / "libfail_write.so"
    compiler = os.environ.get("CC", "gcc")
    return compile_to(target, compiler, "-std=gnu11", *WARNINGS, "-shared", "-fPIC", HERE / "fail_write.c", "-ldl")
