"""The cache of a run: its frames by number, read and checked against run.json."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.errors import clean
from fontana.formats import decode_frame, particle_radius, read_bytes
from fontana.runs.manifest import Manifest, hash_text
from fontana.scene import resolve

_RANGE = re.compile(r"(\d{1,9})(?:-(\d{1,9}))?")
_VECTORS = ("position", "velocity")


class Cache:
    """The finished frames of the run in `folder`.

    name             of the scene, with which the frames' names begin
    frames           their numbers, ascending
    frame_rate       frames a second
    unit             metres in a unit of positions, 1 unless the scene has another time.simulation_scale
    particle_radius  half the particle spacing, in that unit
    scene            the scene as run.json has it

    Raises BadInput if the folder is not that of a run or has no frames yet.
    """

    def __init__(self, folder: Path):
        manifest = Manifest.load(folder)
        if manifest is None:
            raise _core.BadInput(f'"{folder}" has no run.json: it is not the folder of a run')
        if not manifest.frames:
            raise _core.BadInput(f'"{folder}" has no finished frames yet')
        self.folder = folder
        self.scene = manifest.data["scene"]
        self.name = self.scene["name"]
        self._records = {record["frame"]: record["files"][0] for record in manifest.frames}
        simulation = resolve(self.scene, self.name).build()
        self.frame_rate = _round_rate(1.0 / simulation.derived().frame_duration)
        self.unit = simulation.get("time.simulation_scale")
        self.particle_radius = particle_radius(simulation)

    @property
    def frames(self) -> list[int]:
        return list(self._records)

    def path(self, frame: int) -> Path:
        return self.folder / self._records[frame]["file"]

    def hash(self, frame: int) -> str:
        """The hash that run.json has of the frame's file."""
        return self._records[frame]["hash"]

    def select(self, text: str | None) -> list[int]:
        """The frames that a text such as "1-48" or "1,5,10-20" names, all without one. Raises BadInput."""
        if text is None:
            return self.frames
        chosen: set[int] = set()
        for part in text.split(","):
            match = _RANGE.fullmatch(part.strip())
            if not match:
                raise _core.BadInput(f'--frames: expected numbers such as 1-48 or 1,5,10-20, got "{clean(text)}"')
            first, last = int(match[1]), int(match[2] or match[1])
            if first > last:
                raise _core.BadInput(f"--frames: {first}-{last} runs backwards; use {last}-{first}")
            if first not in self._records or last not in self._records:
                wrong = first if first not in self._records else last
                raise _core.BadInput(
                    f'--frames: there is no frame {wrong}; "{self.folder}" has {self.frames[0]} to {self.frames[-1]}'
                )
            chosen.update(range(first, last + 1))
        return sorted(chosen)

    def read(self, frame: int) -> dict[str, np.ndarray]:
        """The attributes of a frame by name, as `fontana.read_frame` gives them.

        Raises IoError if its file is missing, is not what the run wrote, or has a place or speed that is no number.
        """
        return read_checked(self.path(frame), self.hash(frame))


def read_checked(path: Path, expected_hash: str) -> dict[str, np.ndarray]:
    """The attributes in a frame's file, once its content has the expected hash. Raises IoError."""
    data = read_bytes(path)
    if hash_text(_core.hash(data)) != expected_hash:
        raise _core.IoError(f'"{path}" is not what the run wrote: it is damaged, or was replaced')
    arrays = decode_frame(data, path)
    if not all(np.isfinite(arrays[name]).all() for name in _VECTORS):
        raise _core.IoError(f'"{path}" has particles whose place or speed is not a finite number')
    return arrays


def _round_rate(rate: float) -> float:
    """24 rather than 23.999999: one divided by a duration that was one divided by a rate."""
    return round(rate, 6)


def frame_list(frames: list[int]) -> str:
    """Frame numbers for a sentence, neighbours joined: "3, 7 to 9"."""
    runs: list[list[int]] = []
    for frame in sorted(frames):
        if runs and frame == runs[-1][-1] + 1:
            runs[-1].append(frame)
        else:
            runs.append([frame])
    return ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]} to {run[-1]}" for run in runs)
