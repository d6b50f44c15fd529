"""The numbers of frames: out of text, in names of files, in a sentence, and of those that could not be read."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from fontana import _core
from fontana.errors import clean

FRAMES_HELP = "Such as 1-48, 1-48/2 (every second) or 1,5,10-20. [default: all]"

_RANGE = re.compile(r"(\d{1,9})(?:-(\d{1,9})(?:/(\d{1,9}))?)?")
_HASHES = re.compile(r"#+")


def parse_frames(text: str | None, known: Sequence[int]) -> list[int]:
    """The frames that "7", "1-48", "1-48/2" or "1,5,10-20" names, ascending; all that are `known` without a text.

    Raises BadInput.
    """
    if text is None:
        return list(known)
    return sorted({frame for part in text.split(",") for frame in _parse_part(part.strip(), text, known)})


def _parse_part(part: str, text: str, known: Sequence[int]) -> Iterable[int]:
    match = _RANGE.fullmatch(part)
    if not match:
        raise _core.BadInput(f'--frames: expected numbers such as 1-48, 1-48/2 or 1,5,10-20, got "{clean(text)}"')
    first, last, step = int(match[1]), int(match[2] or match[1]), int(match[3] or 1)
    if first > last:
        raise _core.BadInput(f"--frames: {first}-{last} runs backwards; use {last}-{first}")
    if step < 1:
        raise _core.BadInput(f"--frames: in {part} the step is 0; use {first}-{last} for every frame")
    for frame in (first, last):
        if frame not in known:
            raise _core.BadInput(f"--frames: there is no frame {frame}; the run has {known[0]} to {known[-1]}")
    return range(first, last + 1, step)


def is_numbered(name: str) -> bool:
    """Whether a name has a place for the number of a frame: a run of #."""
    return "#" in name


def numbered(name: str, frame: int) -> str:
    """The name with the number of `frame` where # stand, of at least as many digits: water.##.ply is water.07.ply."""
    return _HASHES.sub(lambda run: f"{frame:0{len(run[0])}d}", name)


def frame_list(frames: Iterable[int]) -> str:
    """Frame numbers for a sentence, neighbours joined: "3, 7 to 9"."""
    runs: list[list[int]] = []
    for frame in sorted(frames):
        if runs and frame == runs[-1][-1] + 1:
            runs[-1].append(frame)
        else:
            runs.append([frame])
    return ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in runs)


def refuse_skipped(skipped: Mapping[int, str], asked: int) -> None:
    """Raises IoError that names the skipped ones of the frames asked for, if any, with the reason of the first."""
    if not skipped:
        return
    reason = skipped[min(skipped)]
    if len(skipped) == asked:
        raise _core.IoError(f"none of the frames can be read: {reason}")
    raise _core.IoError(f"all is done but frame{'s' * (len(skipped) > 1)} {frame_list(skipped)}: {reason}")
