"""Every call of every OpenCL function fails once: a typed error with a sentence, never a crash or a wrong result.

The first call fails in one run, the second in the next, and so on until a run has no call left to fail. All runs of a
sweep share a process, so each also shows that a new simulation works after the failure of the one before it.
"""

import itertools
import json
import re
from pathlib import Path

import pytest

OUT_OF_MEMORY = -4, "CL_MEM_OBJECT_ALLOCATION_FAILURE"
OUT_OF_RESOURCES = -5, "CL_OUT_OF_RESOURCES"
INVALID_QUEUE = -36, "CL_INVALID_COMMAND_QUEUE"
UNKNOWN = -9999, "OpenCL error -9999"

FINDING_DEVICES = ("clGetPlatformIDs", "clGetDeviceIDs", "clGetDeviceInfo")
STARTING = (
    "clCreateContext",
    "clCreateCommandQueue",
    "clCreateProgramWithSource",
    "clBuildProgram",
    "clCreateKernel",
    "clGetKernelInfo",
    "clGetKernelWorkGroupInfo",
)
WORKING = (
    "clCreateBuffer",
    "clSetKernelArg",
    "clEnqueueNDRangeKernel",
    "clEnqueueFillBuffer",
    "clEnqueueReadBuffer",
    "clEnqueueWriteBuffer",
    "clEnqueueCopyBuffer",
    "clFinish",
    "clGetEventProfilingInfo",
)
# A name, the kernel cache: without these the run goes on.
DISPENSABLE = ("clGetPlatformInfo", "clCreateProgramWithBinary", "clGetProgramInfo")


def clear(folder):
    for entry in folder.iterdir():
        entry.unlink()


@pytest.mark.parametrize("function", FINDING_DEVICES)
def test_devices_that_cannot_be_asked_are_unavailable(opencl_run, function):
    failed = opencl_run.sweep(function, INVALID_QUEUE)
    assert {run["error"] for run in failed} == {"DeviceUnavailable"}


@pytest.mark.parametrize("function", STARTING)
@pytest.mark.parametrize(("error", "kind"), [(INVALID_QUEUE, "DeviceUnavailable"), (OUT_OF_MEMORY, "OutOfMemory")])
def test_a_device_that_does_not_start_is_unavailable(opencl_run, function, error, kind):
    failed = opencl_run.sweep(function, error)
    assert {run["error"] for run in failed} == {kind}
    assert all(function in run["sentence"] for run in failed)


@pytest.mark.parametrize("function", WORKING)
def test_a_device_that_fails_in_mid_run_is_lost(opencl_run, function):
    """small_run.py also checks that a later call on the lost device says the same."""
    failed = opencl_run.sweep(function, INVALID_QUEUE)
    assert {run["error"] for run in failed} == {"DeviceLost"}
    assert all("continue from the last checkpoint" in run["sentence"] for run in failed)


@pytest.mark.parametrize("function", WORKING)
def test_a_device_without_memory_says_so(opencl_run, function):
    failed = opencl_run.sweep(function, OUT_OF_RESOURCES)
    assert {run["error"] for run in failed} == {"OutOfMemory"}


@pytest.mark.parametrize(
    ("method", "function"),
    [
        *itertools.product(["dfsph", "pcisph", "wcsph"], ["clCreateBuffer", "clEnqueueReadBuffer"]),
        ("dfsph", "clCreateSubBuffer"),
    ],
)
@pytest.mark.parametrize(("error", "kind"), [(INVALID_QUEUE, "DeviceLost"), (OUT_OF_RESOURCES, "OutOfMemory")])
def test_the_other_methods_too(opencl_run, method, function, error, kind):
    """They have more buffers, and read sums from the device to decide when to stop."""
    failed = opencl_run.sweep(function, error, f"fluid.method={method}", "solver.quality=draft")
    assert {run["error"] for run in failed} == {kind}


@pytest.mark.parametrize("function", DISPENSABLE)
def test_what_can_be_done_without_stops_nothing(opencl_run, function):
    assert opencl_run.sweep(function, INVALID_QUEUE) == []


def test_errors_name_the_kernel_and_the_buffer(opencl_run):
    launches = " ".join(run["sentence"] for run in opencl_run.sweep("clEnqueueNDRangeKernel", INVALID_QUEUE))
    for kernel in ("density", "fluid_force", "surface_tension", "integrate", "sort: scan blocks", "sort: order ties"):
        assert f"while running the kernel {kernel}: " in launches
    allocations = " ".join(run["sentence"] for run in opencl_run.sweep("clCreateBuffer", OUT_OF_MEMORY))
    for buffer in ("position", "density", "cell start", "sort: block totals"):
        assert re.search(rf"while allocating [0-9]+ bytes for {buffer}: ", allocations)


def test_an_error_outside_the_standard_is_reported_by_number(opencl_run):
    opencl_run.sweep("clFinish", UNKNOWN)


def build_error(opencl_run, **environment):
    """What a run says whose kernels do not compile: PoCL adds flags to every build on request, here a macro that no
    kernel survives. (It also tells the number of errors on stderr.)"""
    broken = {"POCL_EXTRA_BUILD_FLAGS": "-DStepConstants=3"}
    result = opencl_run.start(**broken, **environment)
    assert result.returncode == 0
    run = json.loads(result.stdout)
    if "digest" in run:
        pytest.skip("this driver does not take flags from POCL_EXTRA_BUILD_FLAGS, so its build cannot be broken")
    return run


def test_a_failed_build_shows_the_compilers_first_lines_and_keeps_its_log(opencl_run):
    clear(opencl_run.cache)
    run = build_error(opencl_run)
    assert run["error"] == "DeviceUnavailable"
    found = re.fullmatch(
        r"the kernels do not compile for .+; the whole log is in (\S+) and begins: (.+)", run["sentence"]
    )
    assert found, run["sentence"]
    log = Path(found[1])
    assert log.parent == opencl_run.cache
    shown = found[2].split(" | ")
    assert len(shown) == 4
    assert log.read_text().split("\n")[:4] == shown
    assert "step_constants.h:" in shown[0], "the compiler's messages should name the file to edit"


def test_the_log_of_a_failed_build_is_kept_without_a_cache_too(opencl_run, tmp_path):
    run = build_error(opencl_run, FONTANA_KERNEL_CACHE="off", TMPDIR=str(tmp_path))
    (log,) = tmp_path.glob("fontana-build-log-*")
    assert f"the whole log is in {log} and begins" in run["sentence"]
    assert "step_constants.h:" in log.read_text()
