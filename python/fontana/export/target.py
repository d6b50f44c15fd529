"""Where a command writes: "water.ply" or "water.####.ply", and which formats it may be."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from fontana import _core
from fontana.file_suffix import check_suffix

_NUMBER = re.compile(r"\.?#+$")


@dataclass(frozen=True)
class Target:
    """The file that -o names, without its number: `folder`/`name``suffix`."""

    folder: Path
    name: str
    suffix: str

    def frame(self, frame: int) -> Path:
        """water.0001.ply: a dot before a number of four digits, as the frames of a run have it."""
        return self.folder / f"{self.name}.{frame:04d}{self.suffix}"

    @property
    def pattern(self) -> Path:
        return self.folder / f"{self.name}.####{self.suffix}"

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
        raise _core.BadInput(f'-o "{text}": expected a name before the number, such as water.####{path.suffix}')
    return Target(path.parent, name, suffix)
