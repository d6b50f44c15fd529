"""A camera that turns around what it looks at."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from fontana import _core

DEFAULT_FIELD_OF_VIEW = 32.0  # degrees, vertical
_DEFAULT_AIM = np.array([0.42, 0.48, 1.0])  # from the target to the eye where a scene has no view
_STEEPEST = 89.0  # degrees: straight from above or below, "up" would be undefined
_NEAR_SHARE, _FAR_SHARE = 0.02, 200.0  # of the distance to the target


@dataclass
class Camera:
    """Looks at `target` (m) from `distance` (m), `azimuth` degrees around Y from +Z, `elevation` degrees above it.

    `field_of_view` is the vertical opening in degrees.
    """

    target: np.ndarray = field(default_factory=lambda: np.zeros(3))
    distance: float = 3.0
    azimuth: float = 23.0
    elevation: float = 24.0
    field_of_view: float = DEFAULT_FIELD_OF_VIEW

    @classmethod
    def looking(cls, eye: object, target: object, field_of_view: float = DEFAULT_FIELD_OF_VIEW) -> Camera:
        """From `eye` at `target`, both (3,) metres. Raises BadInput if they are the same place."""
        target = np.asarray(target, dtype=float)
        away = np.asarray(eye, dtype=float) - target
        distance = float(np.linalg.norm(away))
        if not distance > 0:
            raise _core.BadInput("view: eye and target are the same place")
        azimuth = float(np.degrees(np.arctan2(away[0], away[2])))
        elevation = float(np.degrees(np.arcsin(away[1] / distance)))
        return cls(target, distance, azimuth, np.clip(elevation, -_STEEPEST, _STEEPEST), field_of_view)

    @classmethod
    def of_scene(cls, view: Mapping[str, object], bounds: np.ndarray) -> Camera:
        """The camera of a scene's `view`; what that leaves open shows the whole of `bounds` (2, 3) from above."""
        middle, size = bounds.mean(axis=0), np.ptp(bounds, axis=0)
        opening = float(view.get("field_of_view", DEFAULT_FIELD_OF_VIEW))
        target = np.array(view.get("target", middle - [0.0, 0.12 * size[1], 0.0]), dtype=float)
        reach = 0.5 * float(np.linalg.norm(size)) / np.tan(np.radians(opening) / 2)
        eye = view.get("eye", target + _DEFAULT_AIM / np.linalg.norm(_DEFAULT_AIM) * reach * 0.95)
        return cls.looking(eye, target, opening)

    @property
    def backward(self) -> np.ndarray:
        """The unit vector from the target to the eye."""
        azimuth, elevation = np.radians([self.azimuth, self.elevation])
        return np.array([np.sin(azimuth) * np.cos(elevation), np.sin(elevation), np.cos(azimuth) * np.cos(elevation)])

    @property
    def right(self) -> np.ndarray:
        azimuth = np.radians(self.azimuth)
        return np.array([np.cos(azimuth), 0.0, -np.sin(azimuth)])

    @property
    def up(self) -> np.ndarray:
        return np.cross(self.backward, self.right)

    @property
    def eye(self) -> np.ndarray:
        return self.target + self.distance * self.backward

    @property
    def clip_range(self) -> tuple[float, float]:
        """Depths (m) between which things are drawn."""
        return _NEAR_SHARE * self.distance, _FAR_SHARE * self.distance

    def orbit(self, azimuth: float, elevation: float) -> None:
        """Turns by so many degrees."""
        self.azimuth = (self.azimuth + azimuth) % 360.0
        self.elevation = float(np.clip(self.elevation + elevation, -_STEEPEST, _STEEPEST))

    def pan(self, right: float, up: float) -> None:
        """Moves eye and target by shares of the picture's height, at the depth of the target."""
        height = 2.0 * self.distance * np.tan(np.radians(self.field_of_view) / 2)
        self.target = self.target + height * (right * self.right + up * self.up)

    def zoom(self, factor: float) -> None:
        """Multiplies the distance to the target."""
        self.distance = float(np.clip(self.distance * factor, 1e-4, 1e6))

    def frame_all(self, bounds: np.ndarray, aspect: float) -> None:
        """Moves, without turning, until the box `bounds` (2, 3) fills a picture of width over height `aspect`."""
        low, high = np.asarray(bounds, dtype=float)
        self.target = 0.5 * (low + high)
        corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
        relative = corners - self.target
        half = np.tan(np.radians(self.field_of_view) / 2)
        # A corner at depth (distance - b) fits if |offset| <= half * depth, on each axis of the picture.
        toward = relative @ self.backward
        across = np.abs(relative @ self.right) / (half * aspect)
        upright = np.abs(relative @ self.up) / half
        self.distance = max(1e-4, 1.05 * float((toward + np.maximum(across, upright)).max()))

    def view_matrix(self) -> np.ndarray:
        """(4, 4), from world to camera, where the camera looks along -Z; multiplies column vectors."""
        matrix = np.eye(4)
        matrix[:3, :3] = np.stack([self.right, self.up, self.backward])
        matrix[:3, 3] = -matrix[:3, :3] @ self.eye
        return matrix

    def projection_matrix(self, size: tuple[int, int], shift: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
        """(4, 4), from camera to OpenGL's clip space, for a picture of `size` pixels moved by `shift` pixels."""
        width, height = size
        near, far = self.clip_range
        scale = 1.0 / np.tan(np.radians(self.field_of_view) / 2)
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[1, 1] = scale * height / width, scale
        matrix[0, 2], matrix[1, 2] = -2.0 * shift[0] / width, -2.0 * shift[1] / height
        matrix[2, 2], matrix[2, 3] = (far + near) / (near - far), 2.0 * far * near / (near - far)
        matrix[3, 2] = -1.0
        return matrix

    def ray(self, pixel: tuple[float, float], size: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
        """Origin and unit direction, (3,) each, through a pixel counted from the upper left corner."""
        width, height = size
        half = np.tan(np.radians(self.field_of_view) / 2)
        x = (2.0 * pixel[0] / width - 1.0) * half * width / height
        y = (1.0 - 2.0 * pixel[1] / height) * half
        direction = x * self.right + y * self.up - self.backward
        return self.eye, direction / np.linalg.norm(direction)

    def project(self, points: np.ndarray, size: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
        """Pixels (N, 2) from the upper left corner and depths (N,) in metres of points (N, 3)."""
        seen = np.asarray(points, dtype=float) @ self.view_matrix()[:3, :3].T + self.view_matrix()[:3, 3]
        depth = -seen[:, 2]
        scale = size[1] / (2.0 * np.tan(np.radians(self.field_of_view) / 2) * depth)
        pixels = np.stack([0.5 * size[0] + scale * seen[:, 0], 0.5 * size[1] - scale * seen[:, 1]], axis=1)
        return pixels, depth
