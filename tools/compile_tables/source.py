"""The kernels' text as the library embeds it, and the tools that compile it."""

from __future__ import annotations

import re
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# What backends/opencl/opencl_devices.cpp takes for a GPU, and how opencl_program.cpp has fast arithmetic built.
OPENCL_OPTIONS = ("-cl-std=CL1.2", "-DFONTANA_GROUP_SIZE=128", "-cl-mad-enable", "-cl-no-signed-zeros")
CLANG = "clang-15"


class CompilerError(RuntimeError):
    """A compiler refused the kernels; the message has what it said."""


def kernel_text() -> str:
    """All kernels in one text: cmake/EmbedKernels.cmake with the arguments of CMakeLists.txt, as in a build."""
    call = re.search(r"\nembed_kernels\((.*?)\)\n", (ROOT / "CMakeLists.txt").read_text(), re.DOTALL)[1]
    words = call.replace("${CMAKE_CURRENT_SOURCE_DIR}", str(ROOT)).split()
    folder, roots = words[words.index("FOLDER") + 1], words[words.index("ROOTS") + 1 :]
    with tempfile.TemporaryDirectory() as place:
        output = Path(place) / "text.cpp"
        definitions = {"OUTPUT": output, "SYMBOL": "text", "FOLDER": folder, "ROOTS": "|".join(roots)}
        options = [f"-D{name}={value}" for name, value in definitions.items()]
        call_tool(["cmake", *options, "-P", str(ROOT / "cmake" / "EmbedKernels.cmake")])
        return "".join(re.findall(r'R"kernel\((.*?)\)kernel"', output.read_text(), re.DOTALL))


def kernel_names(text: str) -> list[str]:
    """Every kernel of the text, in its order."""
    return re.findall(r"^(?:GROUP_)?KERNEL void (\w+)\(", text, re.MULTILINE)


def call_tool(command: Sequence[str | Path]) -> str:
    """What a program prints. Raises CompilerError with the first complaints if it fails."""
    try:
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    except FileNotFoundError as error:
        raise CompilerError(f"{command[0]} is not installed") from error
    if done.returncode != 0:
        complaints = [line for line in (done.stderr or done.stdout).splitlines() if line.strip()][:8]
        raise CompilerError(f"{command[0]} failed: " + " | ".join(complaints))
    return done.stdout
