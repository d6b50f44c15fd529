"""What the renderer is told: the particles of a frame, and how to look at them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fontana import _core
from fontana.tables import suggestion

STYLES = ("points", "fluid")
COLOR_UNITS = {"speed": "m/s", "density": "kg/m^3", "pressure": "Pa", "id": ""}
COLOR_MAPS = ("viridis", "turbo")


@dataclass
class FrameData:
    """The particles and colliders at one time.

    position           (N, 3) m
    velocity           (N, 3) m/s
    density            (N,) kg/m^3
    pressure           (N,) Pa
    id                 (N,)
    radius             m, half the particle spacing
    rest_density       kg/m^3
    centres            (M, 3) m, where the colliders of the stage are now; none: where the scene puts them
    centre_velocities  (M, 3) m/s; none: they stand still
    time               s
    simulation_scale   metres that one unit of length of the scene is; what is in m above is in that unit then
    """

    position: np.ndarray
    velocity: np.ndarray
    density: np.ndarray
    pressure: np.ndarray
    id: np.ndarray
    radius: float
    rest_density: float
    centres: Sequence[np.ndarray] = ()
    centre_velocities: Sequence[np.ndarray] = ()
    time: float = 0.0
    simulation_scale: float = 1.0

    def centres_at(self, seconds: float) -> list[np.ndarray]:
        """Where the colliders are so long after the frame."""
        if not len(self.centre_velocities):
            return list(self.centres)
        return [c + seconds * v for c, v in zip(self.centres, self.centre_velocities, strict=True)]

    @property
    def particle_count(self) -> int:
        return len(self.position)

    def values(self, color_by: str) -> np.ndarray:
        """What the particles are coloured by, (N,) float32: speed in m/s, the others as they are."""
        if color_by == "speed":
            return (self.simulation_scale * np.linalg.norm(self.velocity, axis=1)).astype(np.float32)
        return np.asarray(getattr(self, color_by), dtype=np.float32)

    def value_range(self, color_by: str) -> tuple[float, float]:
        """The range that shows all but a few strays."""
        values = self.values(color_by)
        values = values[np.isfinite(values)]
        if not len(values):
            return 0.0, 1.0
        if color_by == "id":
            return 0.0, max(1.0, float(values.max()))
        low, high = (
            (0.0, float(np.quantile(values, 0.996))) if color_by == "speed" else np.quantile(values, [0.01, 0.99])
        )
        return float(low), float(high) if high > low else float(low) + 1.0


@dataclass
class Look:
    """How a picture is drawn.

    style        "points": particles as spheres; "fluid": their surface as water
    color_by     what colours the points: "speed", "density", "pressure" or "id"
    color_range  the values at the two ends of the colour map; None: those of the frame
    color_map    "viridis" or "turbo"
    samples      pictures averaged into one, each with its own time, place in the pixel, of the sun and of the sky
    shutter      s that the picture is exposed, around the time of the frame; one sample alone is sharp
    """

    style: str = "fluid"
    color_by: str = "speed"
    color_range: tuple[float, float] | None = None
    color_map: str = "turbo"
    samples: int = 1
    shutter: float = 0.0
    absorption: Sequence[float] = field(default=(5.0, 1.15, 0.55))  # by red, green, blue, over the size of the stage

    def __post_init__(self) -> None:
        for name, value, known in (
            ("style", self.style, STYLES),
            ("color_by", self.color_by, tuple(COLOR_UNITS)),
            ("color_map", self.color_map, COLOR_MAPS),
        ):
            if value not in known:
                raise _core.BadInput(f'{name}: "{value}" is not one of {", ".join(known)}{_near(value, known)}')
        if not 0.0 <= self.shutter < np.inf:
            raise _core.BadInput(f"shutter: expected 0 s or more, got {self.shutter:g}")
        if self.samples < 1:
            raise _core.BadInput(f"samples: expected 1 or more, got {self.samples}")


def _near(value: str, known: tuple[str, ...]) -> str:
    hint = suggestion(value, known)
    return "" if hint.startswith("; known are") else hint
