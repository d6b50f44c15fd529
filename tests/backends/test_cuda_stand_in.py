"""What the stand-in driver is there to catch: wrong arguments, accesses out of bounds, missed barriers. And that it is
no more than it says: it has no device unless asked, and runs nothing but PTX."""

import ctypes
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import stand_in
import translate

from fontana import _core

SMALL_RUN = Path(__file__).parent / "small_run.py"

INVALID_VALUE, NO_BINARY, ILLEGAL_ADDRESS, MISALIGNED, LAUNCH_FAILED = 1, 209, 700, 716, 719

# Three kernels by hand, in the PTX that NVRTC writes.
PTX = """
.version 7.0
.target sm_75
.address_size 64

.visible .entry store_at(
	.param .u32 store_at_param_0,
	.param .u64 store_at_param_1
)
{
	.reg .b32 	%r<3>;
	.reg .b64 	%rd<5>;
	ld.param.u32 	%r1, [store_at_param_0];
	ld.param.u64 	%rd1, [store_at_param_1];
	cvta.to.global.u64 	%rd2, %rd1;
	cvt.u64.u32 	%rd3, %r1;
	add.s64 	%rd4, %rd2, %rd3;
	mov.u32 	%r2, %tid.x;
	st.global.u32 	[%rd4], %r2;
	ret;
}

.visible .entry copy_first(
	.param .u64 copy_first_param_0,
	.param .u64 copy_first_param_1
)
{
	.reg .b32 	%r<2>;
	.reg .b64 	%rd<5>;
	ld.param.u64 	%rd1, [copy_first_param_0];
	ld.param.u64 	%rd2, [copy_first_param_1];
	cvta.to.global.u64 	%rd3, %rd1;
	cvta.to.global.u64 	%rd4, %rd2;
	ld.global.nc.u32 	%r1, [%rd3];
	st.global.u32 	[%rd4], %r1;
	ret;
}

.visible .entry wait_for_some(
	.param .u32 wait_for_some_param_0
)
{
	.reg .pred 	%p<2>;
	.reg .b32 	%r<3>;
	ld.param.u32 	%r1, [wait_for_some_param_0];
	mov.u32 	%r2, %tid.x;
	setp.ge.u32 	%p1, %r2, %r1;
	@%p1 bra 	$L__BB2_2;
	bar.sync 	0;

$L__BB2_2:
	ret;
}
"""


class Device:
    """The stand-in driver, called as the backend calls it. Each call gives its error code."""

    def __init__(self, image=PTX):
        self.driver = ctypes.CDLL(str(stand_in.library()))
        context, self.module, self.stream = ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_void_p()
        assert self.driver.cuInit(0) == 0
        assert self.driver.cuCtxCreate_v2(ctypes.byref(context), 0, 0) == 0
        self.context = context
        self.load_code = self.driver.cuModuleLoadData(ctypes.byref(self.module), image.encode("latin-1"))
        assert self.driver.cuStreamCreate(ctypes.byref(self.stream), 1) == 0

    def close(self):
        popped = ctypes.c_void_p()
        self.driver.cuCtxPopCurrent_v2(ctypes.byref(popped))
        for release, handle in (("cuModuleUnload", self.module), ("cuStreamDestroy_v2", self.stream)):
            getattr(self.driver, release)(handle)
        assert self.driver.cuCtxDestroy_v2(self.context) == 0

    def allocate(self, size):
        memory = ctypes.c_uint64()
        assert self.driver.cuMemAlloc_v2(ctypes.byref(memory), ctypes.c_size_t(size)) == 0
        return memory

    def launch(self, name, *arguments, threads=32):
        """Of the launch, then of waiting for it."""
        function = ctypes.c_void_p()
        assert self.driver.cuModuleGetFunction(ctypes.byref(function), self.module, name.encode()) == 0
        addresses = (ctypes.c_void_p * (len(arguments) + 1))(*(ctypes.addressof(argument) for argument in arguments))
        launched = self.driver.cuLaunchKernel(function, 1, 1, 1, threads, 1, 1, 0, self.stream, addresses, None)
        return launched, self.driver.cuStreamSynchronize(self.stream)


@pytest.fixture
def device(monkeypatch):
    for name, value in stand_in.environment().items():
        monkeypatch.setenv(name, value)
    device = Device()
    yield device
    device.close()


def test_a_right_launch_passes(device):
    memory = device.allocate(16)
    assert device.launch("store_at", ctypes.c_uint32(12), memory) == (0, 0)
    values = (ctypes.c_uint32 * 4)()
    assert device.driver.cuMemcpyDtoHAsync_v2(values, memory, ctypes.c_size_t(16), device.stream) == 0
    assert list(values) == [0xA5A5A5A5] * 3 + [31], "fresh memory is no zeros, and the last thread stores last"


def test_a_missing_or_an_added_argument_is_caught(device, capfd):
    memory = device.allocate(16)
    assert device.launch("store_at", ctypes.c_uint32(0)) == (INVALID_VALUE, 0)
    assert "kernel store_at takes 2 arguments, not 1" in capfd.readouterr().err
    assert device.launch("store_at", ctypes.c_uint32(0), memory, memory) == (INVALID_VALUE, 0)
    assert "kernel store_at takes 2 arguments, not more" in capfd.readouterr().err


def test_arguments_in_the_wrong_order_are_caught(device, capfd):
    padded = (ctypes.c_uint32 * 2)(0, 0)  # the place of an address, read as one
    assert device.launch("store_at", device.allocate(16), padded) == (0, ILLEGAL_ADDRESS)
    assert "kernel store_at, block 0, thread 0: a store" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("offset", "code", "said"),
    [
        (16, ILLEGAL_ADDRESS, "a store of 4 bytes at byte 16 of an allocation of 16"),
        (13, ILLEGAL_ADDRESS, "a store of 4 bytes at byte 13 of an allocation of 16"),
        (2, MISALIGNED, "is not on a multiple of its size"),
    ],
)
def test_an_access_out_of_bounds_is_caught(device, capfd, offset, code, said):
    memory = device.allocate(16)
    assert device.launch("store_at", ctypes.c_uint32(offset), memory) == (0, code)
    assert said in capfd.readouterr().err
    assert device.driver.cuMemsetD32Async(memory, 0, ctypes.c_size_t(4), device.stream) == code, "it stays broken"


def test_a_buffer_that_is_read_as_constant_and_written_is_caught(device, capfd):
    memory = device.allocate(16)
    assert device.launch("copy_first", memory, device.allocate(16)) == (0, 0)
    assert device.launch("copy_first", memory, memory) == (0, LAUNCH_FAILED)
    assert "the same launch both stores into and reads as constant" in capfd.readouterr().err


def test_a_barrier_that_some_threads_never_reach_is_caught(device, capfd):
    assert device.launch("wait_for_some", ctypes.c_uint32(32)) == (0, 0)
    assert device.launch("wait_for_some", ctypes.c_uint32(31)) == (0, LAUNCH_FAILED)
    assert "a barrier that 1 threads of the block never reach" in capfd.readouterr().err


@pytest.mark.parametrize("threads", [0, 2048])
def test_a_block_that_no_device_has_is_caught(device, threads):
    assert device.launch("store_at", ctypes.c_uint32(0), device.allocate(16), threads=threads)[0] == INVALID_VALUE


@pytest.mark.parametrize(
    ("image", "code"),
    [("\x7fELF, and so on", NO_BINARY), ("nothing", 200), (PTX.replace("st.global.u32", "st.weird.u32"), 218)],
)
def test_other_images_are_refused(monkeypatch, image, code):
    for name, value in stand_in.environment().items():
        monkeypatch.setenv(name, value)
    device = Device(image)
    device.module = None
    assert device.load_code == code
    device.close()


@pytest.mark.parametrize(
    "line", ["st.weird.u32 [%rd4], %r2;", "add.s64 %rd4, %rd2, %tid.q;", ".local .b8 depot[4];", "mul.f64 %r1, %r2;"]
)
def test_ptx_that_is_not_known_is_not_guessed(line):
    with pytest.raises((translate.UnknownPtxError, KeyError)):
        translate.translate(PTX.replace("st.global.u32 \t[%rd4], %r2;", line))


def test_without_being_asked_it_has_no_device():
    environment = stand_in.environment() | {"FONTANA_STAND_IN_DEVICES": ""}
    (device,) = listed(**environment)
    assert device == ["none", False, "the CUDA driver finds no GPU on this machine"]


def listed(**environment):
    """Name, availability and reason of the CUDA devices, in a process with these variables."""
    code = """import json, fontana
print(json.dumps([[d.name, d.available, d.reason] for d in fontana.devices() if d.backend == "cuda"]))"""
    result = subprocess.run([sys.executable, "-c", code], env=os.environ | environment, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def small_run(*settings, **environment):
    command = [sys.executable, SMALL_RUN, "cuda", *settings]
    result = subprocess.run(command, env=os.environ | stand_in.environment() | environment, capture_output=True)
    assert result.returncode == 0, result.stderr
    assert result.stderr == b""
    return json.loads(result.stdout)


@pytest.mark.parametrize("method", ["mueller", "wcsph", "pcisph", "dfsph"])
def test_the_order_of_blocks_and_threads_changes_no_bit(method):
    settings = f"fluid.method={method}", "solver.quality=draft"  # which has all kernels of dfsph
    run = small_run(*settings)
    assert "digest" in run, run
    assert small_run(*settings, FONTANA_STAND_IN_ORDER="reversed") == run


def test_all_is_released_in_the_end(monkeypatch, make_simulation, random_block):
    for name, value in stand_in.environment().items():
        monkeypatch.setenv(name, value)
    driver = ctypes.CDLL(str(stand_in.library()))
    before = driver.count_left_objects()
    simulation = make_simulation("cuda", solver__profile=True, time__timestep=1e-3)
    if "stand-in" not in next(device.name for device in _core.devices() if device.backend == "cuda"):
        pytest.skip("a real driver is open in this process")
    simulation.add_particles(*random_block(4))
    simulation.step_frame()
    assert driver.count_left_objects() > before
    del simulation
    assert driver.count_left_objects() == before


def test_a_device_newer_than_the_compiler_gets_ptx(tmp_path):
    (device,) = listed(**stand_in.environment(capability="999"))
    assert device[1], device
    strict = "solver.precision=strict"
    assert small_run(strict, FONTANA_STAND_IN_CAPABILITY="999", XDG_CACHE_HOME=str(tmp_path)) == small_run(strict)
    (entry,) = (tmp_path / "fontana" / "kernels").glob("*.bin")
    # The newest that NVRTC knows, which the driver would translate.
    assert int(re.search(rb"\.target sm_(\d+)", entry.read_bytes())[1]) >= 90


def test_a_device_older_than_the_compiler_is_unavailable_and_says_why():
    (device,) = listed(**stand_in.environment(capability="30"))
    assert not device[1]
    assert re.fullmatch(
        r"NVRTC \d+\.\d+ compiles for compute capability \d\.\d and above, and the device has 3\.0: "
        r"pip install nvidia-cuda-nvrtc-cu12",
        device[2],
    )


def test_a_device_closed_to_computing_is_unavailable_and_says_why():
    (device,) = listed(**stand_in.environment(compute_mode="2"))
    assert device[1:] == [False, "it is closed to computing: its owner can open it with 'nvidia-smi -c 0'"]
