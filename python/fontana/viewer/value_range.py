"""Ends of a colour map that do not flicker."""

from __future__ import annotations

import math

_STEPS = (1.0, 2.0, 5.0, 10.0)
_FAR_TOO_WIDE = 4.0


def steady_range(former: tuple[float, float] | None, now: tuple[float, float]) -> tuple[float, float]:
    """The range of a frame, `now`, in round numbers; the former one while it holds that and is not far too wide."""
    wanted = _round_range(*now)
    if former is None:
        return wanted
    holds = former[0] <= now[0] and now[1] <= former[1]
    if holds and former[1] - former[0] <= _FAR_TOO_WIDE * (wanted[1] - wanted[0]):
        return former
    return wanted


def _round_range(low: float, high: float) -> tuple[float, float]:
    """The nearest multiples of a tick that hold both, the tick being 1, 2 or 5 times a power of ten."""
    if not (math.isfinite(low) and math.isfinite(high)):
        return 0.0, 1.0
    width = max(high - low, 1e-6 * max(abs(low), abs(high)), 1e-30)
    power = 10.0 ** math.floor(math.log10(width / 4.0))
    tick = next(step * power for step in _STEPS if width <= 4.0 * step * power * (1 + 1e-9))
    return math.floor(low / tick) * tick, math.ceil(high / tick) * tick
