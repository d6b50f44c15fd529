"""What a case is made of: its figures, its curves, and the stage on which its simulations run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field

import numpy as np

from fontana import _core
from fontana.bench import significant
from fontana.simulation import Frame, Simulation

SIZES = SMALL, FULL = "small", "full"


@dataclass(frozen=True)
class Figure:
    """One measured number. `limit` is what its absolute value must not exceed; None: it is reported only."""

    name: str
    value: float
    limit: float | None = None
    unit: str = "%"

    @property
    def is_kept(self) -> bool:
        return self.limit is None or bool(abs(self.value) <= self.limit)


@dataclass(frozen=True)
class Outcome:
    """What a case measured.

    figures  the numbers
    curves   what its plot shows, by name: {"x": [...], "y": [...]}
    """

    figures: list[Figure]
    curves: dict[str, dict[str, list[float]]]

    def as_json(self) -> dict:
        """Both, with whether each figure is kept."""
        rows = [
            asdict(figure) | {"value": significant(float(figure.value)), "kept": figure.is_kept}
            for figure in self.figures
        ]
        return {"figures": rows, "curves": self.curves}


@dataclass(frozen=True)
class Case:
    """`measure` runs the case with `resolution` particle spacings to its length; `draw` puts the curves on axes."""

    title: str
    resolutions: Mapping[str, int]
    measure: Callable[[Stage, int], Outcome]
    draw: Callable[[object, dict], None]


def curve(x: object, y: object) -> dict[str, list[float]]:
    """A curve as JSON takes it, five digits."""
    return {name: [significant(value) for value in np.ravel(values)] for name, values in (("x", x), ("y", y))}


@dataclass
class Stage:
    """Where simulations run: it has the last word on their parameters, tells of progress and keeps count.

    overrides  parameters by path, stronger than a case's scene
    tell       called after each substep with a label and the finished share of that simulation
    runs       of each simulation: label, method, particles, substeps, iterations, unconverged, largest errors
    """

    overrides: Mapping[str, object] = field(default_factory=dict)
    tell: Callable[[str, float], None] = lambda label, share: None
    runs: list[dict] = field(default_factory=list)

    def simulation(
        self, scene: Mapping, position: object = None, velocity: object = None, kept: tuple[str, ...] = ()
    ) -> Simulation:
        """A simulation of the scene with these particles (N, 3) in metres besides what it emits.

        Parameters in `kept` stay as the scene has them, whatever the overrides say.
        """
        overrides = {path: value for path, value in self.overrides.items() if path not in kept}
        simulation = Simulation(scene, **overrides)
        if position is not None:
            simulation.add_particles(position, velocity)
        return simulation

    def frames(self, simulation: Simulation, count: int, label: str) -> Iterator[Frame]:
        """The next `count` frames. Raises Unstable with the label where it cannot go on."""
        run = {"label": label, "method": simulation.get("fluid.method"), "particles": 0, "seconds": 0.0}
        run |= {"substeps": 0, "iterations": 0, "unconverged": 0, "density_error_mean": 0.0, "density_error_max": 0.0}
        self.runs.append(run)
        for number in range(count):
            frame = self._step(simulation, label, number, count)
            _note(run, frame.report)
            yield frame

    def _step(self, simulation: Simulation, label: str, number: int, count: int) -> Frame:
        def tell(share: float) -> bool:
            self.tell(label, (number + share) / count)
            return False

        try:
            return simulation.step(tell)
        except _core.Unstable as error:
            raise _core.Unstable(f"{label}: {error}") from error


def _note(run: dict, report: object) -> None:
    run["particles"] = report.particle_count
    for name in ("seconds", "substeps", "iterations", "unconverged"):
        run[name] += getattr(report, name)
    for name in ("density_error_mean", "density_error_max"):
        run[name] = max(run[name], getattr(report, name))
