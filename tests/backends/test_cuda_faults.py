"""Every call of the CUDA driver and of NVRTC fails once, on the stand-in driver: a typed error with a sentence, never a
crash or a wrong result. As test_opencl_faults.py, which says how."""

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CUDA = ROOT / "src" / "fontana" / "backends" / "cuda"

OUT_OF_MEMORY = 2, "CUDA_ERROR_OUT_OF_MEMORY (2)"
LAUNCH_FAILED = 719, "CUDA_ERROR_LAUNCH_FAILED (719)"
UNKNOWN = 9999, "CUDA error 9999"
INVALID_INPUT = 3, "NVRTC_ERROR_INVALID_INPUT (3)"
COMPILER_OUT_OF_MEMORY = 1, "NVRTC_ERROR_OUT_OF_MEMORY (1)"

FINDING_DEVICES = (
    "cuInit",
    "cuDeviceGetCount",
    "cuDeviceGet",
    "cuDeviceGetName",
    "cuDeviceTotalMem",
    "cuDeviceGetAttribute",
)
STARTING = ("cuCtxCreate", "cuStreamCreate", "cuModuleGetFunction", "cuFuncGetAttribute", "cuFuncGetParamInfo")
WORKING = (
    "cuMemAlloc",
    "cuMemsetD32Async",
    "cuMemcpyHtoDAsync",
    "cuMemcpyDtoHAsync",
    "cuMemcpyDtoDAsync",
    "cuStreamSynchronize",
    "cuLaunchKernel",
    "cuEventCreate",
    "cuEventRecord",
    "cuEventElapsedTime",
)
STARTING_OR_WORKING = ("cuCtxPushCurrent",)
# A name, a version, the kernel cache: without these the run goes on.
DISPENSABLE = ("cuDriverGetVersion", "cuModuleLoadData", "nvrtcVersion")
COMPILING = (
    "nvrtcCreateProgram",
    "nvrtcCompileProgram",
    "nvrtcGetCUBINSize",
    "nvrtcGetCUBIN",
    "nvrtcGetPTXSize",
    "nvrtcGetPTX",
)
ASKING_THE_COMPILER = ("nvrtcGetNumSupportedArchs", "nvrtcGetSupportedArchs")
# Called where something else has failed; tests of their own are below.
AFTER_A_FAILURE = ("cuMemGetInfo", "cuGetErrorName", "nvrtcGetProgramLogSize", "nvrtcGetProgramLog")
# Their errors have no remedy and are not looked at.
RELEASING = ("cuCtxDestroy", "cuCtxPopCurrent", "cuModuleUnload", "cuMemFree", "cuStreamDestroy", "cuEventDestroy")
RELEASING += ("nvrtcDestroyProgram", "nvrtcGetErrorString")


def test_every_function_is_in_one_of_these_lists():
    lists = (FINDING_DEVICES, STARTING, WORKING, STARTING_OR_WORKING, DISPENSABLE, COMPILING, ASKING_THE_COMPILER)
    named = sorted(function for names in (*lists, AFTER_A_FAILURE, RELEASING) for function in names)
    tables = "".join((CUDA / f"{name}_functions.def").read_text() for name in ("cuda", "nvrtc"))
    assert named == sorted(re.findall(r"^(?:OPTIONAL_)?(?:CUDA|NVRTC)_FUNCTION\((\w+),", tables, re.MULTILINE))


def kinds(failed):
    return {run["error"] for run in failed}


@pytest.mark.parametrize("function", FINDING_DEVICES)
def test_devices_that_cannot_be_asked_are_unavailable(cuda_run, function):
    failed = cuda_run.sweep(function, LAUNCH_FAILED)
    assert kinds(failed) == {"DeviceUnavailable"}
    assert all(function in run["sentence"] for run in failed)


@pytest.mark.parametrize("function", ASKING_THE_COMPILER)
def test_a_compiler_that_cannot_be_asked_is_unavailable(cuda_run, function):
    failed = cuda_run.sweep(function, (INVALID_INPUT[0], "does not say what it compiles for: pip install nvidia-cuda"))
    assert kinds(failed) == {"DeviceUnavailable"}


@pytest.mark.parametrize("function", STARTING)
@pytest.mark.parametrize(("error", "kind"), [(LAUNCH_FAILED, "DeviceUnavailable"), (OUT_OF_MEMORY, "OutOfMemory")])
def test_a_device_that_does_not_start_is_unavailable(cuda_run, function, error, kind):
    failed = cuda_run.sweep(function, error)
    assert kinds(failed) == {kind}
    assert all(function in run["sentence"] for run in failed)


@pytest.mark.parametrize("function", WORKING)
def test_a_device_that_fails_in_mid_run_is_lost(cuda_run, function):
    """small_run.py also checks that a later call on the lost device says the same."""
    failed = cuda_run.sweep(function, LAUNCH_FAILED)
    assert kinds(failed) == {"DeviceLost"}
    assert all("continue from the last checkpoint" in run["sentence"] for run in failed)


@pytest.mark.parametrize("function", [name for name in WORKING if name != "cuMemAlloc"])
def test_a_device_without_memory_says_so(cuda_run, function):
    assert kinds(cuda_run.sweep(function, OUT_OF_MEMORY)) == {"OutOfMemory"}


def test_a_context_that_cannot_be_used(cuda_run):
    failed = cuda_run.sweep("cuCtxPushCurrent", LAUNCH_FAILED)
    assert kinds(failed) == {"DeviceUnavailable", "DeviceLost"}
    assert [run["error"] for run in failed] == sorted((run["error"] for run in failed), reverse=True)


@pytest.mark.parametrize("method", ["dfsph", "pcisph", "wcsph"])
def test_the_other_methods_too(cuda_run, method):
    assert kinds(cuda_run.sweep("cuMemcpyDtoHAsync", LAUNCH_FAILED, f"fluid.method={method}")) == {"DeviceLost"}


@pytest.mark.parametrize("function", DISPENSABLE)
def test_what_can_be_done_without_stops_nothing(cuda_run, function):
    assert cuda_run.sweep(function, LAUNCH_FAILED) == []


@pytest.mark.parametrize("function", COMPILING)
def test_a_compiler_that_fails_is_unavailable(cuda_run, function):
    failed = cuda_run.sweep(function, INVALID_INPUT)
    assert kinds(failed) == {"DeviceUnavailable"}
    assert all("nvrtc" in run["sentence"] for run in failed)


def test_a_compiler_without_memory_says_so(cuda_run):
    assert kinds(cuda_run.sweep("nvrtcCompileProgram", COMPILER_OUT_OF_MEMORY)) == {"OutOfMemory"}


def test_a_buffer_that_does_not_fit_says_what_it_needs_and_what_is_free(cuda_run):
    failed = cuda_run.sweep("cuMemAlloc", (OUT_OF_MEMORY[0], "fewer particles, or another device"))
    assert kinds(failed) == {"OutOfMemory"}
    said = " ".join(run["sentence"] for run in failed)
    for buffer in ("position", "density", "cell start", "sort: block totals"):
        assert re.search(
            rf"the buffer {buffer} needs [0-9]+ bytes, and the CUDA device '.+' has 10[0-9.]+ MiB free of 1024.0 MiB",
            said,
        )


def test_memory_that_really_runs_out(cuda_run):
    (run,) = cuda_run.lines(FONTANA_STAND_IN_MEMORY="0")
    assert run["error"] == "OutOfMemory"
    assert "has 0 bytes" in run["sentence"]


def test_errors_name_the_kernel_and_the_buffer(cuda_run):
    launches = " ".join(run["sentence"] for run in cuda_run.sweep("cuLaunchKernel", LAUNCH_FAILED))
    for kernel in ("density", "fluid_force", "surface_tension", "integrate", "sort: scan blocks", "sort: order ties"):
        assert f"while running the kernel {kernel}: " in launches


def test_an_error_that_the_driver_does_not_know_is_reported_by_number(cuda_run):
    cuda_run.sweep("cuStreamSynchronize", UNKNOWN)


def test_a_driver_that_takes_neither_image_says_what_to_do(cuda_run):
    """Machine code the stand-in always refuses, as a driver of another device would."""
    (run,) = cuda_run.lines(FONTANA_STAND_IN_REFUSES_PTX="1")
    assert run["error"] == "DeviceUnavailable"
    assert re.search(
        r"\(CUDA 12\.4\) does not take what NVRTC \d+\.\d+ compiles: CUDA_ERROR_UNSUPPORTED_PTX_VERSION \(222\): "
        r"update the driver, or pip install nvidia-cuda-nvrtc-cu12",
        run["sentence"],
    )


BROKEN = {"FONTANA_STAND_IN_NVRTC_OPTION": "-DStepConstants=3"}


def test_a_failed_build_shows_the_compilers_first_lines_and_keeps_its_log(cuda_run):
    for entry in cuda_run.cache.iterdir():
        entry.unlink()
    (run,) = cuda_run.lines(**BROKEN)
    assert run["error"] == "DeviceUnavailable"
    found = re.fullmatch(
        r"the kernels do not compile for the CUDA device .+; the whole log is in (\S+) and begins: (.+)",
        run["sentence"],
    )
    assert found, run["sentence"]
    log = Path(found[1])
    assert log.parent == cuda_run.cache
    assert log.read_text().split("\n")[:4] == found[2].split(" | ")
    assert found[2].startswith("step_constants.h("), "the compiler's messages should name the file to edit"


@pytest.mark.parametrize("function", ["nvrtcGetProgramLogSize", "nvrtcGetProgramLog"])
def test_a_failed_build_without_a_log_is_still_a_failed_build(cuda_run, function):
    for entry in cuda_run.cache.iterdir():
        entry.unlink()
    runs = cuda_run.lines("sweep", cuda_run.layer, "3", function, **BROKEN)
    assert [run["error"] for run in runs] == ["DeviceUnavailable"] * 2
    assert "and begins: " in runs[0]["sentence"]
    assert json.dumps(runs[0]) != json.dumps(runs[1])
