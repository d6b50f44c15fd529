"""SPIR-V, what Intel's and other OpenCL drivers take in: clang, then Khronos's translator and validator.

The driver assigns registers later, so a row says no more than that the kernel is there and the module valid.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path

from compile_tables.source import CLANG, OPENCL_OPTIONS, call_tool

TARGETS = ("spir64",)
TRANSLATOR = "llvm-spirv-15"
_PACKAGES = {CLANG: "clang-15", TRANSLATOR: "llvm-spirv-15", "spirv-val": "spirv-tools", "spirv-dis": "spirv-tools"}


def missing() -> str | None:
    for program, package in _PACKAGES.items():
        if not shutil.which(program):
            return f"{program} is not installed (Debian: apt install {package})"
    return None


def rows(kernel_source: str, architectures: Sequence[str]) -> list[dict]:
    """As compile_tables says; also module_bytes, of all kernels together."""
    version = re.search(r"version (\S+)", call_tool([TRANSLATOR, "--version"]))[1]
    unknown = dict.fromkeys(("registers", "spill_bytes", "scratch_bytes", "shared_bytes"))
    found = []
    for target in architectures:
        with tempfile.TemporaryDirectory() as place:
            module = _module(kernel_source, target, Path(place))
            kernels = re.findall(r'OpEntryPoint Kernel %\w+ "(\w+)"', call_tool(["spirv-dis", module]))
            size = module.stat().st_size
        common = {"compiler": f"llvm-spirv {version}", "target": target, **unknown, "module_bytes": size}
        found += [{"kernel": kernel} | common for kernel in kernels]
    return found


def _module(kernel_source: str, target: str, place: Path) -> Path:
    """Valid SPIR-V for OpenCL 1.2. Clang's own passes are left out: they make instructions that SPIR-V has not."""
    source, bitcode, module = (place / f"kernels.{ending}" for ending in ("cl", "bc", "spv"))
    source.write_text(kernel_source)
    header = ["-Xclang", "-finclude-default-header", "-D__OPENCL_VERSION__=120"]
    machine = ["-target", f"{target}-unknown-unknown", "-O1", "-Xclang", "-disable-llvm-passes"]
    call_tool([CLANG, "-x", "cl", *OPENCL_OPTIONS, *header, *machine, "-emit-llvm", "-c", source, "-o", bitcode])
    call_tool([TRANSLATOR, "--spirv-max-version=1.2", bitcode, "-o", module])
    call_tool(["spirv-val", "--target-env", "opencl1.2", module])
    return module
