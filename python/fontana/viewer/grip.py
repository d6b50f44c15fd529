"""From a mouse that is dragged to a push of the fluid: the thesis's user interaction force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fontana.gl.camera import Camera
from fontana.viewer.orders import Push

_REACH_IN_SPACINGS = 1.5  # from a particle at which the mouse still points at it


@dataclass
class Grip:
    """The hand's settings and, while it drags, where it is.

    strength  m/s^2 at the centre, once it was dragged as far as its own radius
    spacings  its radius in particle spacings
    centre    (3,) where it is, in the scene's unit; None while nothing is dragged
    """

    strength: float = 60.0
    spacings: float = 6.0
    centre: np.ndarray | None = None
    _anchor: np.ndarray | None = None
    _radius: float = 0.0

    @property
    def radius(self) -> float:
        """In the scene's unit, of the push at hand."""
        return self._radius

    @property
    def pull(self) -> np.ndarray:
        """From the anchor to the hand, at most a radius long: which way, and how much of the strength."""
        return self.centre - self._anchor

    def take(self, origin: np.ndarray, direction: np.ndarray, position: np.ndarray, spacing: float) -> None:
        """Puts the hand on the particle that the ray meets first, or passes closest. Without particles: nothing."""
        if not len(position):
            return
        relative = position - origin
        depth = relative @ direction
        miss = np.sqrt(np.maximum(0.0, (relative**2).sum(axis=1) - depth**2))
        is_ahead = depth > 0
        is_met = is_ahead & (miss < _REACH_IN_SPACINGS * spacing)
        if is_met.any():
            chosen = depth[is_met].min()
        elif is_ahead.any():
            chosen = depth[is_ahead][np.argmin((miss / np.maximum(depth, 1e-9))[is_ahead])]
        else:
            return
        self._radius = self.spacings * spacing
        self.centre = self._anchor = origin + chosen * direction

    def move(self, origin: np.ndarray, direction: np.ndarray, camera: Camera) -> None:
        """Follows the mouse in the plane that faces the camera. The anchor is towed behind, a radius away at most.

        So a hand that stirs pushes where it goes, and one that stops goes on pushing, however slow the simulation is.
        """
        if self.centre is None:
            return
        facing = camera.backward
        slope = direction @ facing
        if abs(slope) < 1e-6:
            return
        self.centre = origin + ((self.centre - origin) @ facing / slope) * direction
        length = float(np.linalg.norm(self.pull))
        if length > self._radius:
            self._anchor = self.centre - self.pull * (self._radius / length)

    def release(self) -> None:
        self.centre = self._anchor = None

    def push(self) -> Push | None:
        """What the simulation is asked for; None while nothing is dragged."""
        if self.centre is None or self._radius <= 0:
            return None
        acceleration = self.strength / self._radius * self.pull
        return Push(tuple(acceleration.tolist()), tuple(self.centre.tolist()), self._radius)
