"""Screenshots and movies of what the window shows."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.render.film import Film
from fontana.render.outputs import Pictures
from fontana.viewer.model import ViewerModel

_SCREENSHOT_SAMPLES = 8
_MOST_NUMBER = 9999
_STAMP = "a screenshot of fontana view"


class Capture:
    """Writes into `folder`, the present one if None: NAME.view.0001.png and NAME.view.0001.mp4.

    What fails becomes a message of the model; a file has its name once it is complete.
    """

    def __init__(self, model: ViewerModel, picture: object, folder: Path | None = None):
        self.model = model
        self.picture = picture
        self.folder = folder or Path.cwd()
        self._film: Film | None = None
        self._filmed: object = None

    def update(self, size: tuple[int, int]) -> None:
        """Does what the model asks for with the picture of `size` pixels."""
        if self.model.is_screenshot_due:
            self.model.is_screenshot_due = False
            self._try(lambda: self._write_screenshot(self.picture.image(self.model, size, _SCREENSHOT_SAMPLES)))
        if self.model.is_recording:
            if not self._try(lambda: self._record(size)):
                self._abandon()
        elif self._film:
            self._try(self._finish)

    def update_window(self, image: Callable[[], np.ndarray]) -> None:
        """The same with the panels; `image` is what the window shows, (height, width, 3) bytes."""
        if self.model.is_window_shot_due:
            self.model.is_window_shot_due = False
            self._try(lambda: self._write_screenshot(image()))

    def close(self) -> None:
        """Finishes the movie, if one is being made."""
        if self._film:
            self._try(self._finish)

    def _write_screenshot(self, image: np.ndarray) -> None:
        path = self._free_path("png")
        Pictures(path, restart=True).write(0, np.ascontiguousarray(image), _STAMP)
        self.model.messages.say(f"screenshot: {path}")

    def _record(self, size: tuple[int, int]) -> None:
        """Adds the frame to the movie, once. Its size stays that of the first picture."""
        if self._film is None:
            even = (size[0] - size[0] % 2, size[1] - size[1] % 2)  # what an .mp4 can be
            self._film = Film(self._free_path("mp4"), even, self.model.source.frame_rate)
        if self._filmed is not self.model.snapshot:
            self._filmed = self.model.snapshot
            image = self.picture.image(self.model, self._film.size)
            self._film.write(self.model.snapshot.number, image, _STAMP)

    def _finish(self) -> None:
        film, self._film, self._filmed = self._film, None, None
        for path in film.finish():
            self.model.messages.say(f"movie: {path}")

    def _abandon(self) -> None:
        """Gives up a movie that cannot be written on."""
        film, self._film, self._filmed = self._film, None, None
        self.model.is_recording = False
        if film:
            film.abandon()

    def _try(self, write: Callable[[], None]) -> bool:
        try:
            write()
        except (_core.FontanaError, OSError, MemoryError) as error:
            self.model.messages.say(str(error) or "out of memory", is_error=True)
            return False
        return True

    def _free_path(self, suffix: str) -> Path:
        name = self.model.source.scene.name
        for number in range(1, _MOST_NUMBER + 1):
            path = self.folder / f"{name}.view.{number:04d}.{suffix}"
            if not path.exists():
                return path
        raise _core.IoError(f'"{self.folder}" has {_MOST_NUMBER} files {name}.view.*.{suffix}: remove some')
