"""All kernels in a device simulator that watches every memory access: no data race, no misuse of OpenCL.

Its check for uninitialised memory is left out: it takes a float4 filled member by member for uninitialised.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
SOURCE = HERE.parents[1] / "src" / "fontana"
SMALL_RUN = HERE / "small_run.py"
LIBRARY = "liboclgrind-rt.so"
# Inlining a function with restrict pointers leaves a mark in LLVM's code that this simulator does not know.
WATCH = ("--data-races", "--check-api", "--build-options", "-cl-opt-disable")
SCHEMES = (
    ("mueller", "grid"),
    ("mueller", "tiles"),
    ("wcsph", "grid"),
    ("pcisph", "grid"),
    ("dfsph", "grid", "solver.quality=draft"),  # which asks the coarse levels from the start
)


def find_oclgrind():
    """The simulator and its OpenCL library, which must be opened by path: it is no driver of the system's loader."""
    program = shutil.which("oclgrind")
    if program:
        prefix = Path(program).resolve().parents[1]
        for library in (prefix / "lib" / "oclgrind" / LIBRARY, prefix / "lib" / LIBRARY):
            if library.exists():
                return program, library
    reason = "oclgrind is not installed (Debian: apt install oclgrind), so races in kernels go unseen"
    if os.environ.get("CI") == "true":
        pytest.fail(reason)
    pytest.skip(reason)


def kernels_of_the_library():
    """By the names of their launches."""
    listed = re.findall(r"^KERNEL_ENTRY\((\w+)", (SOURCE / "kernels" / "kernel_list.def").read_text(), re.MULTILINE)
    sort = re.findall(r"^\w*KERNEL void sort_(\w+)", (SOURCE / "backends/gpu/sort.inl").read_text(), re.MULTILINE)
    assert len(listed) > 10
    assert len(sort) == 5
    return {*listed, *(f"sort: {name.replace('_', ' ')}" for name in sort)}


def run_simulator(log, method, neighbors, *settings):
    """The names of all launches. What the simulator reports goes to `log`."""
    program, library = find_oclgrind()
    environment = os.environ | {"FONTANA_OPENCL_LIBRARY": str(library), "FONTANA_KERNEL_CACHE": "off"}
    environment.pop("OPENCL_LAYERS", None)
    settings = (f"fluid.method={method}", f"solver.neighbors={neighbors}", *settings)
    command = [program, *WATCH, "--log", log, sys.executable, SMALL_RUN, "opencl", *settings]
    result = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    run = json.loads(result.stdout)
    assert "launches" in run, run
    return set(run["launches"])


def test_kernels_have_no_race_and_use_opencl_as_specified(tmp_path):
    launches = set()
    for scheme in SCHEMES:
        log = tmp_path / "-".join(scheme)
        launches |= run_simulator(log, *scheme)
        assert not log.exists() or log.read_text() == ""
    assert kernels_of_the_library() <= launches, "a kernel that no scheme of this test launches was not watched"
