"""NVIDIA GPUs: NVRTC, to real machine code, as the cuda backend compiles. It needs neither a GPU nor a driver.

NVRTC is the one that the backend would open, called through ctypes: eight functions, which do not warrant a package of
bindings that would bring an NVRTC of its own.
"""

from __future__ import annotations

import ctypes
import os
import re
from collections.abc import Sequence

import fontana.cuda_runtime
from compile_tables.source import CompilerError

# Turing; Ampere (A100, RTX 30); Ada; Hopper; Blackwell (B200, RTX 50).
TARGETS = ("sm_75", "sm_80", "sm_86", "sm_89", "sm_90", "sm_100", "sm_120")
# As backends/cuda/cuda_program.cpp has fast arithmetic built, and that the assembler says what each kernel needs.
OPTIONS = ("--std=c++17", "-DFONTANA_GROUP_SIZE=128", "--fmad=true", "--prec-div=false", "--prec-sqrt=false")
REPORT = "--ptxas-options=-v"

_KERNEL = re.compile(
    r"Compiling entry function '(?P<kernel>\w+)' for '\w+'.*?"
    r"(?P<frame>\d+) bytes stack frame, (?P<stores>\d+) bytes spill stores, (?P<loads>\d+) bytes spill loads.*?"
    r"Used (?P<registers>\d+) registers(?P<rest>[^\n]*)",
    re.DOTALL,
)


def missing() -> str | None:
    return None if _library() else "NVRTC is not installed (pip install nvidia-cuda-nvrtc-cu12)"


def rows(kernel_source: str, architectures: Sequence[str]) -> list[dict]:
    """As compile_tables says. Spilled are the bytes a thread stores and loads again; scratch is its stack frame."""
    compiler = f"NVRTC {version()}"
    found = []
    for target in architectures:
        for kernel in _KERNEL.finditer(_report(kernel_source, target)):
            shared = re.search(r"(\d+) bytes smem", kernel["rest"])
            found.append(
                {
                    "kernel": kernel["kernel"],
                    "compiler": compiler,
                    "target": target,
                    "registers": int(kernel["registers"]),
                    "spill_bytes": int(kernel["stores"]) + int(kernel["loads"]),
                    "scratch_bytes": int(kernel["frame"]),
                    "shared_bytes": int(shared[1]) if shared else 0,
                }
            )
    return found


def version() -> str:
    major, minor = ctypes.c_int(), ctypes.c_int()
    _call("nvrtcVersion", ctypes.byref(major), ctypes.byref(minor))
    return f"{major.value}.{minor.value}"


def machine_code(kernel_source: str, target: str) -> bytes:
    """The ELF file of all kernels for an architecture ("sm_80")."""
    return _compile(kernel_source, target)[0]


def _report(kernel_source: str, target: str) -> str:
    return _compile(kernel_source, target)[1]


def _compile(kernel_source: str, target: str) -> tuple[bytes, str]:
    """Machine code and what the compiler says. Raises CompilerError with its first complaints."""
    program = ctypes.c_void_p()
    options = [option.encode() for option in (f"--gpu-architecture={target}", *OPTIONS, REPORT)]
    _call("nvrtcCreateProgram", ctypes.byref(program), kernel_source.encode(), b"fontana", 0, None, None)
    try:
        code = _library().nvrtcCompileProgram(program, len(options), (ctypes.c_char_p * len(options))(*options))
        log = _output(program, "ProgramLog").rstrip(b"\0").decode()
        if code != 0:
            complaints = [line for line in log.splitlines() if line.strip()][:8]
            raise CompilerError(f"NVRTC failed for {target}: " + " | ".join(complaints))
        return _output(program, "CUBIN"), log
    finally:
        _library().nvrtcDestroyProgram(ctypes.byref(program))


def _output(program: ctypes.c_void_p, kind: str) -> bytes:
    size = ctypes.c_size_t()
    _call(f"nvrtcGet{kind}Size", program, ctypes.byref(size))
    text = ctypes.create_string_buffer(size.value)
    _call(f"nvrtcGet{kind}", program, text)
    return text.raw


def _call(function: str, *arguments) -> None:
    code = getattr(_library(), function)(*arguments)
    if code != 0:
        raise CompilerError(f"{function} of NVRTC failed with code {code}")


def _library() -> ctypes.CDLL | None:
    chosen = os.environ.get("FONTANA_NVRTC_LIBRARY")  # set by the package where the library is in a wheel
    for name in [chosen] if chosen else fontana.cuda_runtime.SYSTEM_LIBRARIES:
        try:
            return ctypes.CDLL(name)
        except OSError:
            continue
    return None
