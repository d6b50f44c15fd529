"""NVRTC, the compiler of the CUDA backend, for machines where no CUDA toolkit is installed.

The solver opens the system's NVRTC. Where there is none, `pip install fontana[cuda]` brings it in a wheel, in a folder
where nothing looks. `prepare` tells the solver where that is, through the environment of this process. The driver
itself cannot come in a wheel: it belongs to the GPU.
"""

from __future__ import annotations

import importlib.util
import os
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from fontana.system_libraries import has_library

SYSTEM_LIBRARIES = ("libnvrtc.so.13", "libnvrtc.so.12", "libnvrtc.so.11.2", "libnvrtc.so")
# nvidia-cuda-nvrtc-cu12 and -cu11 use the first folder, nvidia-cuda-nvrtc (CUDA 13 and later) one of the second kind.
WHEEL_LIBRARIES = ("cuda_nvrtc/lib/libnvrtc.so.*", "cu[0-9]*/lib/libnvrtc.so.*")


def prepare() -> None:
    """Lets the solver find the NVRTC of a wheel if the system has none. What is set already stays."""
    if sys.platform == "linux":
        os.environ.update(wheel_environment(_nvidia_folders(), os.environ, has_library(SYSTEM_LIBRARIES)))


def wheel_environment(
    folders: Sequence[Path], environment: Mapping[str, str], has_system_library: bool
) -> dict[str, str]:
    """The variable to add to `environment` so that the NVRTC of a wheel is used where the system has none.

    `folders` are those of the package nvidia, which many wheels share. Empty where nothing needs to be added. Of
    several versions the oldest is taken: what it compiles, every later driver takes, and the other way round is not so.
    """
    if has_system_library or environment.get("FONTANA_NVRTC_LIBRARY"):
        return {}
    found = [path for folder in folders for pattern in WHEEL_LIBRARIES for path in folder.glob(pattern)]
    return {"FONTANA_NVRTC_LIBRARY": str(min(found, key=_version))} if found else {}


def _version(path: Path) -> tuple[int, ...]:
    """(12,) of libnvrtc.so.12"""
    return tuple(int(number) for number in re.findall(r"\d+", path.name))


def _nvidia_folders() -> list[Path]:
    spec = importlib.util.find_spec("nvidia")
    return [Path(place) for place in spec.submodule_search_locations or []] if spec is not None else []
