"""Screenshots and movies of what the window shows."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.viewer.model import ViewerModel

_SCREENSHOT_SAMPLES = 8
_MOST_NUMBER = 9999


class Capture:
    """Writes into `folder`, the present one if None: NAME.view.0001.png and NAME.view.0001.mp4."""

    def __init__(self, model: ViewerModel, picture: object, folder: Path | None = None):
        self.model = model
        self.picture = picture
        self.folder = folder or Path.cwd()

    def update(self, size: tuple[int, int]) -> None:
        """Does what the model asks for; what fails becomes a message and nothing is left half written."""
        if self.model.is_screenshot_due:
            self.model.is_screenshot_due = False
            self._try(lambda: self._write_screenshot(self.picture.image(self.model, size, _SCREENSHOT_SAMPLES)))

    def update_window(self, image: Callable[[], np.ndarray]) -> None:
        """The same with the panels; `image` is what the window shows, (height, width, 3) bytes."""
        if self.model.is_window_shot_due:
            self.model.is_window_shot_due = False
            self._try(lambda: self._write_screenshot(image()))

    def close(self) -> None:
        """Finishes the movie, if one is being made."""

    def _write_screenshot(self, image: np.ndarray) -> None:
        path = self._free_path("png")
        _core.publish_file(str(path), png_bytes(image))
        self.model.messages.say(f"screenshot: {path.name}")

    def _try(self, write: object) -> None:
        try:
            write()
        except (_core.FontanaError, OSError, MemoryError) as error:
            self.model.messages.say(str(error) or "out of memory", is_error=True)

    def _free_path(self, suffix: str) -> Path:
        name = self.model.source.scene.name
        for number in range(1, _MOST_NUMBER + 1):
            path = self.folder / f"{name}.view.{number:04d}.{suffix}"
            if not path.exists():
                return path
        raise _core.IoError(f'"{self.folder}" has {_MOST_NUMBER} files {name}.view.*.{suffix}: remove some')


def png_bytes(image: np.ndarray) -> bytes:
    """A picture (height, width, 3) of bytes as a PNG."""
    from PIL import Image

    buffer = io.BytesIO()
    Image.fromarray(image).save(buffer, format="png", optimize=True)
    return buffer.getvalue()
