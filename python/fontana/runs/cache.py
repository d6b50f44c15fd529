"""The folder of a run as something to look at: its scene, its frames, where its colliders were."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.bounds import stage_bounds
from fontana.formats import read_bytes, read_frame
from fontana.gl.frame_data import FrameData
from fontana.runs.manifest import Manifest, hash_text
from fontana.scene import resolve

_SAMPLED_FRAMES = 8  # how many frames, spread over the run, say where the fluid goes and how fast


class Cache:
    """The finished frames of a run.

    scene      as it was simulated
    fps        frames a second
    """

    def __init__(self, folder: Path):
        """Raises BadInput if the folder is not that of a run, or no frame of it is finished."""
        manifest = Manifest.load(folder)
        if manifest is None:
            raise _core.BadInput(f'"{folder}" has no run.json: it is not the folder of a run')
        if not manifest.frames:
            raise _core.BadInput(f'"{folder}" has no finished frames to show')
        self.folder = folder
        self.records = manifest.frames
        self.scene = resolve(manifest.data["scene"], manifest.data["scene"]["name"])
        self._simulation = self.scene.build()
        self._rest_density = self._simulation.get("fluid.rest_density")
        self._scale = self._simulation.get("time.simulation_scale")
        self.frame_duration = self._simulation.derived().frame_duration

    @property
    def fps(self) -> float:
        return 1.0 / self.frame_duration

    @property
    def frame_count(self) -> int:
        return len(self.records)

    def load(self, frame: int) -> FrameData:
        """The particles of `frame`, from 1. Raises IoError if its file is missing or not as it was written."""
        record = self.records[frame - 1]
        file = record["files"][0]
        path = self.folder / file["file"]
        data = read_bytes(path)
        if len(data) != file["bytes"] or hash_text(_core.hash(data)) != file["hash"]:
            raise _core.IoError(f'"{path}" is damaged: it is not what the run wrote')
        arrays = read_frame(path)
        radius = float(arrays["radius"][0]) if len(arrays["radius"]) else 1.0
        names = ("position", "velocity", "density", "pressure", "id")
        time = record.get("time", frame * self.frame_duration)
        return FrameData(
            **{name: arrays[name] for name in names},
            radius=radius,
            rest_density=self._rest_density,
            centres=self.centres(time),
            centre_velocities=self._centre_velocities(time),
            time=time,
            simulation_scale=self._scale,
        )

    def centres(self, time: float) -> list[np.ndarray]:
        """Where the colliders are at `time` (s), in the order of the scene."""
        count = self._simulation.collider_count
        return [np.array(self._simulation.collider_centre(index, time)) for index in range(count)]

    def _centre_velocities(self, time: float) -> list[np.ndarray]:
        """m/s, within half a frame: keys are straight between frames at the closest."""
        half = 0.25 * self.frame_duration
        before, after = self.centres(max(0.0, time - half)), self.centres(time + half)
        return [(b - a) / (time + half - max(0.0, time - half)) for a, b in zip(before, after, strict=True)]

    def bounds(self) -> np.ndarray:
        """The box (2, 3) that holds what is worth seeing in all frames. Frames that cannot be read do not count."""
        return stage_bounds(self.scene.colliders, [frame.position for frame in self._sampled()])

    def value_range(self, color_by: str) -> tuple[float, float]:
        """The lowest and the highest value of `FrameData.value_range` over the run."""
        ranges = [frame.value_range(color_by) for frame in self._sampled()] or [(0.0, 1.0)]
        return min(low for low, _ in ranges), max(high for _, high in ranges)

    def _sampled(self) -> list[FrameData]:
        """Frames spread over the run, those of them that can be read."""
        wanted = np.linspace(1, self.frame_count, min(self.frame_count, _SAMPLED_FRAMES)).round().astype(int)
        frames = []
        for frame in wanted:
            with contextlib.suppress(_core.IoError):
                frames.append(self.load(int(frame)))
        return frames
