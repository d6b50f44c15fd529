"""An OpenGL context without a window."""

from __future__ import annotations

import sys

from fontana import _core
from fontana.optional import OptionalPackage

REQUIRED_VERSION = 330  # OpenGL 3.3 core
_INSTALL = "on Debian and Ubuntu: apt install libegl1 libgl1 libgl1-mesa-dri"


def create_headless_context() -> object:
    """A moderngl context: the GPU's where there is one, else Mesa's renderer on the CPU. No display is needed.

    Raises BadInput without moderngl, DeviceUnavailable without EGL or OpenGL 3.3; each says what to install.
    """
    moderngl = OptionalPackage("moderngl", "view", "a picture").module("moderngl")
    # EGL is what needs no display on Linux; on Windows and macOS the platform's own standalone context needs none.
    backend = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    try:
        return moderngl.create_context(standalone=True, require=REQUIRED_VERSION, **backend)
    except Exception as error:  # each platform raises kinds of its own
        raise _core.DeviceUnavailable(
            f"no OpenGL 3.3 without a window here ({_first_line(error)}); {_INSTALL}; without root, "
            "fontana run draws its contact sheet with neither"
        ) from error


def _first_line(error: Exception) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0]
