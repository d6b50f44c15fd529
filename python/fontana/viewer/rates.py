"""Frames a second of each scheme: the thesis's comparison (its Tables 1 and 2) while one watches."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

_MOST_SAMPLES = 48
_WINDOW = 2.0  # s: older frames no longer count


@dataclass
class SchemeRate:
    """What was last measured of one scheme."""

    finished: deque = field(default_factory=lambda: deque(maxlen=_MOST_SAMPLES))
    frames_per_second: float = 0.0
    solve_seconds: float = 0.0
    particle_count: int = 0


class SchemeRates:
    """Measures the schemes that have run, by name such as "cpu grid". A pause or a switch begins a new streak."""

    def __init__(self):
        self.by_scheme: dict[str, SchemeRate] = {}
        self._streak = ""

    def note(self, scheme: str, now: float, solve_seconds: float, particle_count: int) -> None:
        """A frame of `scheme` was finished at `now` (s, any clock) after `solve_seconds` of work."""
        rate = self.by_scheme.setdefault(scheme, SchemeRate())
        if scheme != self._streak:
            rate.finished.clear()
            self._streak = scheme
        rate.finished.append(now)
        while now - rate.finished[0] > _WINDOW and len(rate.finished) > 2:
            rate.finished.popleft()
        span = rate.finished[-1] - rate.finished[0]
        # The first frame of a streak has only its own duration.
        rate.frames_per_second = (len(rate.finished) - 1) / span if span > 0 else 1.0 / max(solve_seconds, 1e-9)
        rate.solve_seconds = solve_seconds
        rate.particle_count = particle_count

    def interrupt(self) -> None:
        """The next frame does not follow the last one without a break."""
        self._streak = ""
