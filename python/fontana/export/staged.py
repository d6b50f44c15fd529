"""Publishing a file that another library writes: it appears under its name only when it is complete and on disk.

`fontana_publish_file` does this for bytes in memory. The writers of USD, OpenVDB and Alembic open a path themselves and
their files can be larger than memory, so this follows the same steps around them.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from fontana import _core

_NEXT_TO_NOTHING = 2**20  # bytes: less than one write of those libraries


@contextlib.contextmanager
def staged(path: Path) -> Iterator[Path]:
    """A path to write to in the `with` block; the file moves to `path` at its end, or is removed on an error.

    Raises IoError if that fails, or if the block raises an OSError or RuntimeError, which is what those writers raise;
    BadInput for a name that is not UTF-8, which they do not take.
    """
    _check_name(path)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.tmp{path.suffix}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary.touch()  # where that fails, the system says why; the libraries do not
        temporary.unlink()
        yield temporary
        _sync(temporary, os.O_RDWR)
        os.replace(temporary, path)
        _sync(path.parent, os.O_RDONLY)
    except (OSError, RuntimeError) as error:
        if isinstance(error, _core.FontanaError):
            raise
        raise _core.IoError(f'cannot write "{path}": {_reason(error, path.parent)}') from error
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink()


def _check_name(path: Path) -> None:
    try:
        str(path).encode()
    except UnicodeEncodeError as error:
        raise _core.BadInput(
            f'-o "{path}": expected a name in UTF-8, the only ones that writers of {path.suffix} take'
        ) from error


def _sync(path: Path, flags: int) -> None:
    number = os.open(path, flags)
    try:
        os.fsync(number)
    finally:
        os.close(number)


def _reason(error: Exception, folder: Path) -> str:
    """The system's word where there is one; the libraries do not pass it on, a full disk least of all."""
    if isinstance(error, FileExistsError):
        return f'"{folder}" is a file, not a folder'
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    with contextlib.suppress(OSError):
        disk = os.statvfs(folder)
        if disk.f_blocks > 0 and disk.f_bavail * disk.f_frsize < _NEXT_TO_NOTHING:  # /proc and its like have no blocks
            return "the disk is full"
    return " ".join(str(error).split())[:200]
