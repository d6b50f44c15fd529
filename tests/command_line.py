"""How the tests call the command line and read what it says."""

from __future__ import annotations

import subprocess
import sys


def fontana_command(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "fontana", *map(str, arguments)]


def error_line(done: subprocess.CompletedProcess) -> str:
    """The one sentence on stderr."""
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1, done.stderr
    return lines[0]
