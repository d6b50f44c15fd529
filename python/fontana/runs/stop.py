"""Ctrl-C and SIGTERM: finish the frame, or after a few seconds stop between substeps; the second one stops at once."""

from __future__ import annotations

import os
import signal
import sys
import time

PATIENCE = 5.0  # s for the frame to finish: a farm that sends SIGTERM gives about ten

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class StoppedError(Exception):
    """What was at work was stopped by a signal; everything so far is saved. `signal` is its number."""

    def __init__(self, signal: int, message: str):
        super().__init__(message)
        self.signal = signal


class StopSignals:
    """Catches the signals while in the `with` block, and says `message`; only the main thread can.

    message    what to say when the first one comes, before "; once more stops at once"
    requested  the signal that came, or None
    """

    def __init__(self, message: str) -> None:
        self._message = f"{message}; once more stops at once\n".encode()
        self.requested: int | None = None
        self._since = 0.0
        self._previous: dict[int, object] = {}

    def __enter__(self) -> StopSignals:
        self._previous = {number: signal.signal(number, self._on_signal) for number in _SIGNALS}
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)

    @property
    def is_overdue(self) -> bool:
        """Whether the frame has had its time to finish."""
        return self.requested is not None and time.monotonic() - self._since > PATIENCE

    def _on_signal(self, number: int, frame: object) -> None:
        self.requested, self._since = number, time.monotonic()
        for each in _SIGNALS:
            signal.signal(each, signal.SIG_DFL)
        os.write(sys.stderr.fileno(), self._message)  # print could be the very thing that was interrupted
