"""AMD GPUs: clang with LLVM's own library of OpenCL functions. To real machine code, without the vendor's driver."""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path

from compile_tables.source import CLANG, OPENCL_OPTIONS, call_tool

TARGETS = ("gfx90a", "gfx1030")  # Instinct MI200 series; Radeon RX 6000 series
LIBRARY = Path("/usr/lib/clc/amdgcn--amdhsa.bc")
_REGISTER_BYTES = 4  # of one thread


def missing() -> str | None:
    if not shutil.which(CLANG):
        return f"{CLANG} is not installed (Debian: apt install clang-15)"
    return None if LIBRARY.exists() else f"{LIBRARY} does not exist (Debian: apt install libclc-15)"


def rows(kernel_source: str, architectures: Sequence[str]) -> list[dict]:
    """As compile_tables says; also scalar_registers (a wave's) and occupancy (waves a SIMD unit can hold)."""
    compiler = re.search(r"version (\S+)", call_tool([CLANG, "--version"]))[1]
    found = []
    for target in architectures:
        assembly = _assembly(kernel_source, target)
        found += [
            {"kernel": kernel, "compiler": f"clang {compiler}", "target": target} | facts
            for kernel, facts in _kernels(assembly)
        ]
    return found


def _assembly(kernel_source: str, target: str) -> str:
    machine = ["-target", "amdgcn-amd-amdhsa", f"-mcpu={target}", "-nogpulib"]
    library = ["-Xclang", "-mlink-builtin-bitcode", "-Xclang", str(LIBRARY), "-Wno-linker-warnings"]
    header = ["-Xclang", "-finclude-default-header", "-D__OPENCL_VERSION__=120"]
    with tempfile.TemporaryDirectory() as place:
        source, output = Path(place) / "kernels.cl", Path(place) / "kernels.s"
        source.write_text(kernel_source)
        options = [*OPENCL_OPTIONS, *header, *machine, *library, "-O2", "-S"]
        call_tool([CLANG, "-x", "cl", *options, source, "-o", output])
        return output.read_text()


def _kernels(assembly: str) -> list[tuple[str, dict]]:
    """The comments under each kernel have what it needs; the notes at the end have what was spilled."""
    flags = re.DOTALL | re.MULTILINE
    spilled = dict(re.findall(r"\.symbol:\s+(\w+)\.kd$.*?\.vgpr_spill_count:\s+(\d+)$", assembly, flags))
    found = []
    for kernel, comments in re.findall(r"\.amdhsa_kernel (\w+)$(.*?^; Occupancy: \d+$)", assembly, flags):
        needs = {name: int(value) for name, value in re.findall(r"^; (\w+): (\d+)", comments, flags)}
        facts = {
            "registers": needs["NumVgprs"],
            "spill_bytes": _REGISTER_BYTES * int(spilled[kernel]),
            "scratch_bytes": needs["ScratchSize"],
            "shared_bytes": needs["LDSByteSize"],
            "scalar_registers": needs["NumSgprs"],
            "occupancy": needs["Occupancy"],
        }
        found.append((kernel, facts))
    return found
