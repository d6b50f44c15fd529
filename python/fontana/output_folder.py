"""Folders that files are about to be written to."""

from __future__ import annotations

import os
from pathlib import Path

from fontana import _core


def make_output_folder(folder: Path) -> None:
    """Makes the folder where it is not there and tries a write in it, before any work. Raises IoError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / f".fontana.{os.getpid()}.tmp"
        probe.touch()
        probe.unlink()
    except FileExistsError as error:
        raise _core.IoError(f'cannot write to "{folder}": it is a file, not a folder') from error
    except OSError as error:
        raise _core.IoError(f'cannot write to "{folder}": {error.strerror}') from error
