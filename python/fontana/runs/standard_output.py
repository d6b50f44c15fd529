"""What long work prints. Where standard output takes no more, the work ends with a sentence, not unseen."""

from __future__ import annotations

import contextlib
import json
import os
import sys
from collections.abc import Iterator

from rich.console import Console

from fontana import _core


class OutputConsole(Console):
    """rich's, which would leave the process by itself when the reader of a pipe is gone."""

    def on_broken_pipe(self) -> None:
        raise  # noqa: PLE0704  (rich calls this while it handles the BrokenPipeError)


@contextlib.contextmanager
def printing() -> Iterator[None]:
    """Raises IoError where the `with` block cannot print; nothing is printed from then on."""
    try:
        yield
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is buffered fails again at exit
        reason = "its reader is gone" if isinstance(error, BrokenPipeError) else error.strerror
        raise _core.IoError(f"cannot write to standard output: {reason}; the same command continues") from error


def print_json(event: str, **values: object) -> None:
    """One JSON object in a line. Raises IoError."""
    with printing():
        print(json.dumps({"event": event} | values), flush=True)
