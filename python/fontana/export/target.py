"""Where a command writes: "water.ply" or "water.####.ply", and which formats it may be."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from fontana import _core
from fontana.file_suffix import check_suffix
from fontana.runs.frame_numbers import is_numbered, numbered

_NUMBER = re.compile(r"[._-]?#+")
_USUAL_NUMBER = ".####"  # a dot before four digits, as the frames of a run have it


@dataclass(frozen=True)
class Target:
    """The files that -o names.

    pattern  the file of a frame, with # where its number stands
    name     the same without number and suffix
    suffix   in small letters
    """

    pattern: Path
    name: str
    suffix: str

    @property
    def folder(self) -> Path:
        return self.pattern.parent

    def frame(self, frame: int) -> Path:
        return self.pattern.with_name(numbered(self.pattern.name, frame))

    @property
    def whole(self) -> Path:
        """The one file of formats that hold all frames."""
        return self.folder / f"{self.name}{self.suffix}"

    @property
    def record(self) -> Path:
        """What a sequence was made with, and its files."""
        return self.folder / f"{self.name}{self.suffix}.json"


def parse_target(text: str, suffixes: Iterable[str]) -> Target:
    """The target that -o names. Raises BadInput, with the nearest suffix, if it ends in none of `suffixes`."""
    path = Path(text)
    suffix = check_suffix(path, suffixes)
    name = _NUMBER.sub("", path.stem)
    if not name:
        raise _core.BadInput(f'-o "{text}": expected a name beside the number, such as water.####{path.suffix}')
    number = "" if is_numbered(path.stem) else _USUAL_NUMBER
    return Target(path.parent / f"{path.stem}{number}{suffix}", name, suffix)
