"""The picture behind the panels: drawn anew only when something in it has changed."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from fontana.gl.renderer import Renderer
from fontana.viewer.model import ViewerModel

_ROOM = 0.25  # by how much the stage is larger than what it must hold, so that it is not made anew in every frame
_SLOW = 0.12  # s: pictures that take longer are drawn with fewer pixels while things move
_STILL = 0.4  # s without a change after which a better one is drawn
_SAMPLES = 8  # of the best one: smooth edges and soft shadows
_PATIENCE = 1.0  # s: where the best one would take longer, all pixels must do
_COARSE, _PLAIN, _FINE = range(3)


class Picture:
    """Draws what the model shows into a texture. `seconds` is what the last plain or coarse drawing took."""

    def __init__(self, context: object):
        self.context = context
        self.renderer = Renderer(context)
        self.seconds = 0.0
        self._texture = self._target = None
        self._drawn: object = None
        self._level = _COARSE
        self._full_seconds = 0.0
        self._changed_at = 0.0
        self._snapshot = None
        self._stage_version = -1
        self._bounds: np.ndarray | None = None

    def update(self, model: ViewerModel, size: tuple[int, int]) -> object | None:
        """The texture with the picture of about `size` pixels, or None as long as there is nothing to show."""
        if model.snapshot is None or min(size) < 1:
            return None
        now = time.monotonic()
        wanted = (id(model.snapshot), size, _camera_key(model.camera), _look_key(model), model.stage_version)
        if wanted != self._drawn:
            self._drawn, self._changed_at = wanted, now
            self._draw(model, size, _COARSE if self._full_seconds > _SLOW else _PLAIN)
        elif not self.is_final and now - self._changed_at > _STILL:
            self._draw(model, size, self._level + 1)
        return self._texture

    @property
    def is_final(self) -> bool:
        """Whether the picture gets no better."""
        return self._level >= (_FINE if _SAMPLES * self._full_seconds < _PATIENCE else _PLAIN)

    def image(self, model: ViewerModel, size: tuple[int, int], samples: int = 1) -> np.ndarray:
        """The picture as (height, width, 3) bytes, upper row first, with all its pixels."""
        self._set(model)
        look = replace(model.look, color_range=model.color_range(), samples=samples)
        return self.renderer.image(model.camera, size, look)

    def _draw(self, model: ViewerModel, size: tuple[int, int], level: int) -> None:
        start = time.monotonic()
        self._set(model)
        pixels = tuple(max(1, length // (2 if level == _COARSE else 1)) for length in size)
        self._resize(pixels)
        samples = _SAMPLES if level == _FINE else 1
        look = replace(model.look, color_range=model.color_range(), samples=samples)
        self.renderer.draw(model.camera, pixels, look, self._target)
        self.context.finish()  # so that the time is that of the device
        self._level = level
        if level != _FINE:
            self.seconds = time.monotonic() - start
            self._full_seconds = (4 if level == _COARSE else 1) * self.seconds

    def _set(self, model: ViewerModel) -> None:
        """Hands over the stage and the frame where they are not those of the last picture."""
        bounds = model.bounds() if self._snapshot is not model.snapshot else self._bounds
        if self._stage_version != model.stage_version or not _holds(self._bounds, bounds):
            self._bounds = _with_room(bounds)
            self.renderer.set_stage(model.colliders, self._bounds)
            self._stage_version = model.stage_version
        if self._snapshot is not model.snapshot:
            self.renderer.set_frame(model.snapshot.data)
            self._snapshot = model.snapshot

    def _resize(self, size: tuple[int, int]) -> None:
        if self._texture is not None and self._texture.size == size:
            return
        if self._texture is not None:
            self._target.release()
            self._texture.release()
        self._texture = self.context.texture(size, 4)
        self._target = self.context.framebuffer([self._texture])


def _camera_key(camera: object) -> tuple:
    return (*camera.target, camera.distance, camera.azimuth, camera.elevation, camera.field_of_view)


def _look_key(model: ViewerModel) -> tuple:
    look = model.look
    return look.style, look.color_by, look.color_map, model.color_range() if look.style == "points" else None


def _holds(outer: np.ndarray | None, inner: np.ndarray) -> bool:
    return outer is not None and bool((outer[0] <= inner[0]).all() and (inner[1] <= outer[1]).all())


def _with_room(bounds: np.ndarray) -> np.ndarray:
    """Wider, but with the floor where it was."""
    room = _ROOM * np.ptp(bounds, axis=0)
    return np.array([bounds[0] - room * [1, 0, 1], bounds[1] + room])
