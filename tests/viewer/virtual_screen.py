"""A display that nobody sees (Xvfb), and hands on its mouse and keyboard (xdotool): real events for a real window."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess

import pytest

SIZE = (1280, 800)
PROGRAMS = ("Xvfb", "xdotool")
MODULES = ("moderngl", "glfw", "imgui_bundle")


def missing_programs() -> list[str]:
    return [name for name in PROGRAMS if shutil.which(name) is None]


class VirtualScreen:
    """Runs until `close`. `environment` is that of a program which shall open its windows there."""

    def __init__(self):
        read, write = os.pipe()
        size = f"{SIZE[0]}x{SIZE[1]}x24"
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", size, "-nolisten", "tcp", "-noreset"]
        self._server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.display = f":{pipe.readline().strip()}"
        # The renderer on the CPU, and a single choice of it on every machine.
        software = {"LIBGL_ALWAYS_SOFTWARE": "1", "GALLIUM_DRIVER": "llvmpipe"}
        self.environment = os.environ | {"DISPLAY": self.display} | software
        self.environment.pop("WAYLAND_DISPLAY", None)

    def do(self, *words: object) -> None:
        """What xdotool shall do: do("key", "space")."""
        command = ["xdotool", *map(str, words)]
        subprocess.run(command, env=self.environment, check=True, capture_output=True, timeout=30)

    def close(self) -> None:
        self._server.terminate()
        self._server.wait()


def virtual_screen():
    """The body of a fixture: a screen, or why there is none. In CI, which installs all of it, that is a failure."""
    missing = missing_programs() + [name for name in MODULES if importlib.util.find_spec(name) is None]
    if missing:
        reason = f"no window without {', '.join(missing)}"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    screen = VirtualScreen()
    yield screen
    screen.close()
