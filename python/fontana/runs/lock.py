"""One run a folder: a lock file that names its owner."""

from __future__ import annotations

import contextlib
import json
import os
import socket
import time
from pathlib import Path

from fontana import _core

LOCK_NAME = "run.lock"


class FolderLock:
    """Holds `folder`/run.lock while in the `with` block. Raises BadInput that names the owner if it is taken.

    A lock whose process is gone (same host) is broken; `notes` then has a sentence about it.
    """

    def __init__(self, folder: Path):
        self.path = folder / LOCK_NAME
        self.notes: list[str] = []

    def __enter__(self) -> FolderLock:
        for _ in range(10):  # each round lost to another run that broke or released the same lock
            if self._create():
                return self
            self._break_or_refuse()
        raise _core.BadInput(f'"{self.path}" keeps changing hands; try again')

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):
            self.path.unlink()

    def _create(self) -> bool:
        try:
            file = os.open(self.path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o644)
        except FileExistsError:
            return False
        except OSError as error:
            raise _core.IoError(f'cannot write to "{self.path.parent}": {error.strerror}') from error
        with os.fdopen(file, "w", encoding="utf-8") as lock:
            json.dump(_owner(os.getpid()), lock)
        return True

    def _break_or_refuse(self) -> None:
        content = _read(self.path)
        owner = _parse(content)
        if owner is None:
            raise _core.BadInput(f'"{self.path}" is not a lock of Fontana\'s; remove it if no run uses this folder')
        if not owner or not _is_gone(owner):
            who = f"process {owner['pid']} on {owner['host']}, since {owner['since']}" if owner else "another run"
            raise _core.BadInput(
                f'"{self.path.parent}" is in use by {who}; wait for it, or remove its {self.path.name} if it is gone'
            )
        aside = self.path.with_name(f"{LOCK_NAME}.{os.getpid()}.stale")
        with contextlib.suppress(FileNotFoundError):
            os.rename(self.path, aside)  # only one of several that saw the stale lock can take it away
            if _read(aside) != content:  # it was a new owner's by then: give it back
                os.link(aside, self.path)
            else:
                self.notes.append(f"took over from process {owner['pid']}, which is gone")
            os.unlink(aside)


def _owner(pid: int) -> dict:
    now = time.strftime("%Y-%m-%d %H:%M:%S")
    return {"host": socket.gethostname(), "pid": pid, "started": _start_of(pid), "since": now}


def _start_of(pid: int) -> str:
    """When a process began, in the kernel's own clock: a process number alone is used again. "" where unknown."""
    try:
        return Path(f"/proc/{pid}/stat").read_text(encoding="ascii", errors="replace").rpartition(")")[2].split()[19]
    except (OSError, IndexError):
        return ""


def _is_gone(owner: dict) -> bool:
    if owner["host"] != socket.gethostname():
        return False
    try:
        os.kill(owner["pid"], 0)
    except ProcessLookupError:
        return True
    except OSError:
        pass  # it lives and belongs to someone else
    return owner["started"] != _start_of(owner["pid"])


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except FileNotFoundError:
        return ""
    except OSError as error:
        raise _core.IoError(f'cannot read "{path}": {error.strerror}') from error


def _parse(content: str) -> dict | None:
    """The owner; {} while the file is still being written; None if it is something else."""
    if not content:
        return {}
    try:
        owner = json.loads(content)
        kinds = {"host": str, "pid": int, "started": str, "since": str}
        return owner if all(isinstance(owner[key], kind) for key, kind in kinds.items()) else None
    except (ValueError, KeyError, TypeError):
        return None
