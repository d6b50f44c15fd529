"""Where pictures go: a file for each, or a film. Each appears under its name only when it is complete."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import Protocol

import numpy as np

from fontana import _core
from fontana.file_suffix import check_suffix
from fontana.output_folder import make_output_folder
from fontana.render.film import FILM_SUFFIXES, Film
from fontana.runs.frame_numbers import is_numbered, numbered

_STAMP = "fontana"  # the text chunk of a PNG that says from what it was made


class Output(Protocol):
    """Takes pictures in order of their frames; `path` is the file, or the pattern of their names."""

    path: Path

    def has(self, frame: int, stamp: str) -> bool:
        """Whether the picture of `frame` is there, made from what `stamp` says. Raises BadInput if it is not ours."""

    def write(self, frame: int, picture: np.ndarray, stamp: str) -> None:
        """Takes a picture, (height, width, 3) bytes. Raises IoError."""

    def finish(self) -> list[Path]:
        """Completes what was written so far and returns its files. Raises IoError."""

    def abandon(self) -> None:
        """Removes what is not complete; nothing happens after `finish`."""


def open_output(path: Path, size: tuple[int, int], fps: float, frame_count: int, restart: bool) -> Output:
    """The output for the name of a file. Raises BadInput for a suffix or a pattern that cannot be, IoError."""
    suffix = check_suffix(path, (".png", *FILM_SUFFIXES))
    make_output_folder(path.parent)
    if suffix != ".png":
        return Film(path, size, fps)
    if frame_count > 1 and not is_numbered(path.name):
        better = path.with_name(f"{path.stem}.####.png")
        raise _core.BadInput(f'-o "{path}": {frame_count} frames need a number in the name, as "{better}"')
    return Pictures(path, restart)


class Pictures:
    """A PNG for each frame, numbered where # stand in the name."""

    def __init__(self, pattern: Path, restart: bool):
        self.path, self.restart = pattern, restart
        self._files: list[Path] = []

    def file(self, frame: int) -> Path:
        return self.path.with_name(numbered(self.path.name, frame))

    def has(self, frame: int, stamp: str) -> bool:
        path = self.file(frame)
        if self.restart or not os.path.exists(path):  # pathlib's raises for a name that is too long
            return False
        found = _read_stamp(path)
        if found is None:
            raise _core.BadInput(f'"{path}" was not made by fontana render; use another -o, or --restart to replace it')
        if found == stamp:
            self._files.append(path)
        return found == stamp

    def write(self, frame: int, picture: np.ndarray, stamp: str) -> None:
        path = self.file(frame)
        _core.publish_file(str(path), _png(picture, stamp))
        self._files.append(path)

    def finish(self) -> list[Path]:
        return sorted(self._files)

    def abandon(self) -> None:
        pass


def _png(picture: np.ndarray, stamp: str) -> bytes:
    from PIL import Image, PngImagePlugin

    text = PngImagePlugin.PngInfo()
    text.add_text(_STAMP, stamp)
    buffer = io.BytesIO()
    Image.fromarray(picture).save(buffer, format="png", pnginfo=text)
    return buffer.getvalue()


def _read_stamp(path: Path) -> str | None:
    """What a picture was made from; None if it is not one of ours, which appear only when they are complete."""
    from PIL import Image

    try:
        with Image.open(path) as image:
            stamp = image.info.get(_STAMP)
            image.load()
    except (OSError, SyntaxError, ValueError):  # Pillow raises SyntaxError for a broken PNG
        return None
    return stamp
