"""Timing substeps: warm up, repeat, take the median."""

from __future__ import annotations

import statistics as numbers
import time
from dataclasses import dataclass

from fontana import _core
from fontana.runs.text import clock

SUBSTEPS_PER_FRAME = 10  # the thesis's frame
WARM_UP_SUBSTEPS = 10
_REPEATS = 30  # so few that the fluid is still on its way when the last is taken, at every speed


@dataclass(frozen=True)
class Clocked:
    """Seconds a substep, a sample each; and how many substeps a sample has."""

    seconds: list[float]
    substeps_per_sample: int

    @property
    def median(self) -> float:
        return numbers.median(self.seconds)

    def rates(self, particle_count: int) -> dict:
        """What a table shows, each as `statistics` gives it."""
        return {
            "substeps_per_sample": self.substeps_per_sample,
            "substep_seconds": statistics(self.seconds),
            "frames_per_second": statistics([1 / (SUBSTEPS_PER_FRAME * value) for value in self.seconds]),
            "million_particle_substeps_per_second": statistics([1e-6 * particle_count / s for s in self.seconds]),
            "nanoseconds_per_particle_substep": statistics([1e9 * value / particle_count for value in self.seconds]),
        }


def clock_substeps(simulation: _core.Simulation, dt: float, neighbors: str, budget: float) -> Clocked:
    """Times substeps of `dt` seconds by the scheme `neighbors` for at most about `budget` seconds of wall time.

    A sample is one short frame by the wall clock, so it holds all that a frame does; ten substeps as in the thesis, or
    fewer where the budget would not hold five samples. Before it, the grid disturbs the fluid for ten substeps and the
    scheme itself takes one, in which a device builds its programs.
    """
    _step(simulation, dt, "grid", WARM_UP_SUBSTEPS)
    _step(simulation, dt, neighbors, 1)
    first = _step(simulation, dt, neighbors, 1)
    substeps = min(SUBSTEPS_PER_FRAME, max(1, int(budget / 5 / first)))
    begin = time.perf_counter()
    seconds: list[float] = []
    while True:
        seconds.append(_step(simulation, dt, neighbors, substeps) / substeps)
        if len(seconds) == _REPEATS or time.perf_counter() - begin > budget:
            return Clocked(seconds, substeps)


def _step(simulation: _core.Simulation, dt: float, neighbors: str, substeps: int) -> float:
    """Wall time of one frame of so many substeps, s."""
    simulation.set("solver.neighbors", neighbors)
    simulation.set("time.substeps", substeps)
    simulation.set("time.timestep", substeps * dt)
    begin = time.perf_counter()
    simulation.step_frame()
    return time.perf_counter() - begin


def beyond_budget(expected: float, budget: float, work: str) -> str:
    """Why a number is cut off; "" where the work, of `expected` seconds, is within the budget."""
    if expected <= budget:
        return ""
    return f"{work} would take about {clock(expected)}, by a smaller run; the budget of a number is {budget:g} s"


def statistics(values: list[float]) -> dict[str, float]:
    """Median, smallest and largest of repeated measurements, and how many there were."""
    return {
        "median": significant(numbers.median(values)),
        "minimum": significant(min(values)),
        "maximum": significant(max(values)),
        "repeats": len(values),
    }


def significant(value: float) -> float:
    """Five digits: more than repeats agree on."""
    return float(f"{value:.5g}")
