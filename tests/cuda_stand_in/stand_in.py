"""Builds the stand-in driver, and says how to run with it."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
BUILD = ROOT / "build" / "cuda_stand_in"
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wsign-conversion", "-Werror")


def library() -> Path:
    """The path of its libcuda.so.1. Built anew only where a source has changed; translated programs lie beside it."""
    sources = sorted(HERE.glob("*.cpp"))
    headers = [*sorted(HERE.glob("*.h")), ROOT / "src/fontana/backends/cuda/cuda_types.h"]
    texts = "".join(path.read_text() for path in (*sources, *headers)) + sys.executable + str(HERE)
    folder = BUILD / hashlib.sha256(texts.encode()).hexdigest()[:16]
    target = folder / "libcuda.so.1"
    if target.exists():
        return target
    folder.mkdir(parents=True, exist_ok=True)
    places = {"PYTHON": sys.executable, "FOLDER": HERE, "CACHE": BUILD / "programs"}
    defines = [f'-DSTAND_IN_{name}="{place}"' for name, place in places.items()]
    includes = ["-I", HERE, "-I", ROOT / "src" / "fontana"]
    # A fortified longjmp takes a jump to another stack for an attack.
    flags = [
        "-std=c++17",
        "-O2",
        "-fPIC",
        "-shared",
        "-fvisibility=hidden",
        "-U_FORTIFY_SOURCE",
        *WARNINGS,
        *defines,
        *includes,
    ]
    draft = folder / f"{os.getpid()}.draft"
    command = [os.environ.get("CXX", "g++"), *flags, *sources, "-o", draft, "-ldl", "-pthread"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(f"the stand-in driver does not compile:\n{result.stderr}")
    draft.rename(target)
    return target


def environment(**settings: str) -> dict[str, str]:
    """The variables with which Fontana finds the stand-in driver and one device; `settings` are further ones of it."""
    return {"FONTANA_CUDA_LIBRARY": str(library()), "FONTANA_STAND_IN_DEVICES": "1"} | {
        f"FONTANA_STAND_IN_{name.upper()}": value for name, value in settings.items()
    }


def compiler_faults() -> dict[str, str]:
    """The variables with which calls of NVRTC can be made to fail too: the stand-in goes between it and Fontana."""
    real = os.environ.get("FONTANA_NVRTC_LIBRARY", "libnvrtc.so.12")
    return {"FONTANA_NVRTC_LIBRARY": str(library()), "FONTANA_STAND_IN_NVRTC": real}
