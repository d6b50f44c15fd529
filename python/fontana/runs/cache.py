"""The cache of a run: its scene, and its frames by number, read and checked against run.json."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fontana import _core
from fontana.formats import decode_frame, particle_radius, read_bytes
from fontana.runs.frame_numbers import parse_frames
from fontana.runs.manifest import Manifest, hash_text
from fontana.scene import resolve

_VECTORS = ("position", "velocity")


class Cache:
    """The finished frames of the run in `folder`.

    manifest         run.json
    scene            as it was simulated
    simulation       of that scene, at its start: its parameters, and where its colliders are at a time
    frames           the numbers of the frames, ascending
    frame_duration   s
    frame_rate       frames a second
    unit             metres in a unit of positions, 1 unless the scene has another time.simulation_scale
    particle_radius  half the particle spacing, in that unit

    Raises BadInput if the folder is not that of a run or has no frames yet.
    """

    def __init__(self, folder: Path):
        manifest = Manifest.of_run(folder)
        if not manifest.frames:
            raise _core.BadInput(f'"{folder}" has no finished frames yet')
        self.folder = folder
        self.manifest = manifest
        self.scene = resolve(manifest.data["scene"], manifest.data["scene"]["name"])
        self.simulation = self.scene.build()
        self._records = {record["frame"]: record for record in manifest.frames}
        self.frame_duration = self.simulation.derived().frame_duration
        self.frame_rate = _round_rate(1.0 / self.frame_duration)
        self.unit = self.simulation.get("time.simulation_scale")
        self.particle_radius = particle_radius(self.simulation)

    @property
    def frames(self) -> list[int]:
        return list(self._records)

    def record(self, frame: int) -> dict:
        """What run.json says of a frame."""
        return self._records[frame]

    def path(self, frame: int) -> Path:
        return self.folder / self._file(frame)["file"]

    def hash(self, frame: int) -> str:
        """The hash that run.json has of the frame's file."""
        return self._file(frame)["hash"]

    def select(self, text: str | None) -> list[int]:
        """The frames that a text such as "1-48/2" or "1,5,10-20" names, all without one. Raises BadInput."""
        return parse_frames(text, self.frames)

    def read(self, frame: int) -> dict[str, np.ndarray]:
        """The attributes of a frame by name, as `fontana.read_frame` gives them.

        Raises IoError if its file is missing, is not what the run wrote, or has a place or speed that is no number.
        """
        return read_checked(self.path(frame), self.hash(frame))

    def _file(self, frame: int) -> dict:
        """The first of the files that have the frame: each format has all of it."""
        return self._records[frame]["files"][0]


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
