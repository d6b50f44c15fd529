"""Exit codes: one for each kind of trouble, so that a farm knows what to do."""

from __future__ import annotations

import signal

from fontana import _core
from fontana.errors import BeyondLimit
from fontana.runs.stop import StoppedError

OK = 0
BAD_INPUT = 2
OUT_OF_MEMORY = 3
UNSTABLE = 4
DEVICE = 5
OUTPUT = 6
BEYOND_LIMIT = 7
INTERNAL = 70
INTERRUPTED = 128 + signal.SIGINT
TERMINATED = 128 + signal.SIGTERM

HELP = """\b
Exit codes:
  0    done
  2    bad input: a scene, option or file that cannot be used
  3    out of memory
  4    unstable: the simulation cannot go on as it is
  5    device unavailable, or lost in mid-run
  6    output could not be written or read
  7    validate, verify: a figure is beyond its limit
  70   a defect in Fontana
  130  stopped by Ctrl-C; the same command continues
  143  stopped by SIGTERM; the same command continues
"""

_CODES: tuple[tuple[type[BaseException], int], ...] = (
    (_core.BadInput, BAD_INPUT),
    (_core.OutOfMemory, OUT_OF_MEMORY),
    (MemoryError, OUT_OF_MEMORY),
    (_core.Unstable, UNSTABLE),
    (_core.DeviceUnavailable, DEVICE),
    (_core.DeviceLost, DEVICE),
    (_core.IoError, OUTPUT),
    (OSError, OUTPUT),
    (BeyondLimit, BEYOND_LIMIT),
)


def exit_code(error: BaseException) -> int:
    """The code for what ended the command."""
    if isinstance(error, StoppedError):
        return 128 + error.signal
    if isinstance(error, (KeyboardInterrupt, _core.Interrupted)):
        return INTERRUPTED
    return next((code for kind, code in _CODES if isinstance(error, kind)), INTERNAL)


def sentence(error: BaseException) -> str:
    """What to tell the user; never a traceback."""
    code = exit_code(error)
    text = str(error).strip() or type(error).__name__
    if code == INTERNAL:
        return f"internal error: {text} (set FONTANA_DEBUG=1 to see where, and please report it)"
    return "interrupted" if isinstance(error, KeyboardInterrupt) else text
