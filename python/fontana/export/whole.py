"""One file that holds all frames of a cache: read one after the other, since such a file has one writer."""

from __future__ import annotations

from contextlib import AbstractContextManager
from typing import Protocol

import numpy as np

from fontana import _core
from fontana.export.target import Target
from fontana.runs.cache import Cache
from fontana.runs.frame_numbers import refuse_skipped
from fontana.runs.progress import Quiet
from fontana.runs.stop import StoppedError, StopSignals


class FrameWriter(Protocol):
    """What takes the frames, in ascending order."""

    def add(self, frame: int, arrays: dict[str, np.ndarray]) -> None: ...


def write_whole(
    cache: Cache, frames: list[int], writer: AbstractContextManager[FrameWriter], target: Target, progress: Quiet
) -> None:
    """Adds the frames to the file that `writer` publishes at its end.

    Frames that are missing or damaged are skipped: once all others are done, IoError names them. Raises StoppedError on
    Ctrl-C and SIGTERM, when the file has the frames so far. Without a single frame, what was there before stays.
    """
    with StopSignals("stopping after this frame") as stop:
        with writer as file:
            progress.start(str(target.whole), len(frames), 0)
            added, skipped = _add_frames(cache, frames, file, stop, progress)
            if not added:
                _raise_if_incomplete(added, skipped, frames, target, stop)
        _raise_if_incomplete(added, skipped, frames, target, stop)


def _add_frames(
    cache: Cache, frames: list[int], file: FrameWriter, stop: StopSignals, progress: Quiet
) -> tuple[int, dict[int, str]]:
    """How many were added until the last or a stop, and those that cannot be read, each with the reason."""
    added, skipped = 0, {}
    for frame in frames:
        if stop.requested:
            break
        try:
            arrays = cache.read(frame)
        except _core.IoError as error:
            skipped[frame] = str(error)
            progress.skip(frame, str(error))
            continue
        file.add(frame, arrays)
        added += 1
        progress.frame({"frame": frame, "text": f"{len(arrays['id']):,} particles"})
    return added, skipped


def _raise_if_incomplete(
    added: int, skipped: dict[int, str], frames: list[int], target: Target, stop: StopSignals
) -> None:
    if stop.requested and added + len(skipped) < len(frames):
        has = f"has {added} of {len(frames)} frames" if added else "was not begun"
        raise StoppedError(stop.requested, f'"{target.whole}" {has}; the same command makes it anew')
    refuse_skipped(skipped, len(frames))
