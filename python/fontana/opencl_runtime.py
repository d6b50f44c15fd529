"""An OpenCL runtime for machines without root: the loader and the PoCL driver that PyPI wheels carry.

The solver opens the system's OpenCL library. Where there is none, or no driver for it, `pip install fontana[opencl]`
brings both (pyopencl has a loader inside, pocl-binary-distribution a driver for the CPU), but in folders where nothing
looks. `prepare` tells the solver where they are, through the environment of this process.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Mapping
from pathlib import Path

from fontana.system_libraries import has_library

SYSTEM_LOADERS = ("libOpenCL.so.1", "libOpenCL.so")
SYSTEM_DRIVERS = Path("/etc/OpenCL/vendors")
# With any of these set, which drivers the loader finds is the user's choice.
DRIVER_VARIABLES = ("OCL_ICD_VENDORS", "OCL_ICD_FILENAMES", "OPENCL_VENDOR_PATH")


def prepare() -> None:
    """Lets the solver find the OpenCL runtime of the wheels if the system has none. What is set already stays."""
    if sys.platform != "linux":
        return
    folder = _pyopencl_folder()
    if folder is not None:
        os.environ.update(wheel_environment(folder, os.environ, has_library(SYSTEM_LOADERS), _has_system_driver()))


def wheel_environment(
    folder: Path, environment: Mapping[str, str], has_system_loader: bool, has_system_driver: bool
) -> dict[str, str]:
    """The variables to add to `environment` so that the runtime in the wheels is used where the system lacks one.

    `folder` is that of the package pyopencl. Empty where nothing needs to be added.
    """
    libraries = folder / ".libs"
    loader = _first_match(libraries, "libOpenCL*.so*")
    driver = _first_match(libraries, "libpocl*.so*")
    driver_is_chosen = any(environment.get(name) for name in DRIVER_VARIABLES)
    found: dict[str, str] = {}
    chosen_loader = environment.get("FONTANA_OPENCL_LIBRARY")
    if loader is None or (chosen_loader and Path(chosen_loader).resolve().parent != libraries.resolve()):
        return found
    if not chosen_loader:
        if has_system_loader and (has_system_driver or driver_is_chosen):
            return found
        found["FONTANA_OPENCL_LIBRARY"] = str(loader)
    # The loader of the wheel reads this without asking whether it is set.
    if not environment.get("PYOPENCL_HOME"):
        found["PYOPENCL_HOME"] = str(folder)
    # The wheel's own list of drivers names PoCL without its folder, which only pyopencl itself can resolve.
    if driver is not None and not has_system_driver and not driver_is_chosen:
        found["OCL_ICD_VENDORS"] = str(driver)
    return found


def _pyopencl_folder() -> Path | None:
    """Where the package pyopencl is, without importing it: that would load OpenCL for those who do not use it."""
    spec = importlib.util.find_spec("pyopencl")
    return Path(spec.origin).resolve().parent if spec is not None and spec.origin else None


def _first_match(folder: Path, pattern: str) -> Path | None:
    return next(iter(sorted(folder.glob(pattern))), None)


def _has_system_driver() -> bool:
    return any(SYSTEM_DRIVERS.glob("*.icd"))
