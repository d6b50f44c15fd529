"""Shared libraries that the system has or has not."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable


def has_library(names: Iterable[str]) -> bool:
    """Whether one of these opens, by the system's own search. It stays open, as the solver will open it too."""
    for name in names:
        try:
            ctypes.CDLL(name)
        except OSError:
            continue
        return True
    return False
