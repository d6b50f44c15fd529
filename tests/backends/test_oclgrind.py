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
LIBRARY = "liboclgrind-rt.so"


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
    sort = re.findall(r"^KERNEL void sort_(\w+)", (SOURCE / "backends/opencl/sort.cl").read_text(), re.MULTILINE)
    assert len(listed) > 10
    assert len(sort) == 5
    return {*listed, *(f"sort: {name.replace('_', ' ')}" for name in sort)}


def test_kernels_have_no_race_and_use_opencl_as_specified(tmp_path):
    program, library = find_oclgrind()
    log = tmp_path / "reports"
    environment = os.environ | {"FONTANA_OPENCL_LIBRARY": str(library), "FONTANA_KERNEL_CACHE": "off"}
    environment.pop("OPENCL_LAYERS", None)
    command = [program, "--data-races", "--check-api", "--log", log, sys.executable]
    result = subprocess.run(
        [*command, HERE / "opencl_faults" / "small_run.py"], env=environment, capture_output=True, text=True
    )
    assert result.returncode == 0, result.stderr
    assert kernels_of_the_library() <= set(json.loads(result.stdout)["launches"])
    reports = log.read_text() if log.exists() else ""
    assert reports + result.stderr == ""
