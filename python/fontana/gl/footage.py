"""A cache as the renderer takes it: particles and colliders of a frame, and what is the same in all pictures of it."""

from __future__ import annotations

import contextlib

import numpy as np

from fontana import _core
from fontana.bounds import stage_bounds
from fontana.gl.frame_data import FrameData
from fontana.runs.cache import Cache

_SAMPLED_FRAMES = 8  # how many frames, spread over the run, say where the fluid goes and how fast
_ARRAYS = ("position", "velocity", "density", "pressure", "id")


class Footage:
    """The frames of `cache` to be drawn."""

    def __init__(self, cache: Cache):
        self.cache = cache
        self._rest_density = cache.simulation.get("fluid.rest_density")

    def load(self, frame: int) -> FrameData:
        """The particles and colliders of `frame`. Raises IoError if its file is missing or not as it was written."""
        arrays = self.cache.read(frame)
        time = self.time(frame)
        return FrameData(
            **{name: arrays[name] for name in _ARRAYS},
            radius=self.cache.particle_radius,
            rest_density=self._rest_density,
            centres=self.centres(time),
            centre_velocities=self._centre_velocities(time),
            time=time,
            simulation_scale=self.cache.unit,
        )

    def time(self, frame: int) -> float:
        """s"""
        return self.cache.record(frame).get("time", frame * self.cache.frame_duration)

    def bounds(self) -> np.ndarray:
        """The box (2, 3) that holds what is worth seeing in all frames. Frames that cannot be read do not count."""
        return stage_bounds(self.cache.scene.colliders, [frame.position for frame in self._sampled()])

    def value_range(self, color_by: str) -> tuple[float, float]:
        """The lowest and the highest value of `FrameData.value_range` over the run."""
        ranges = [frame.value_range(color_by) for frame in self._sampled()] or [(0.0, 1.0)]
        return min(low for low, _ in ranges), max(high for _, high in ranges)

    def centres(self, time: float) -> list[np.ndarray]:
        """Where the colliders are at `time` (s), in the order of the scene."""
        simulation = self.cache.simulation
        return [np.array(simulation.collider_centre(index, time)) for index in range(simulation.collider_count)]

    def _centre_velocities(self, time: float) -> list[np.ndarray]:
        """m/s, within half a frame: keys are straight between frames at the closest."""
        half = 0.25 * self.cache.frame_duration
        start, end = max(0.0, time - half), time + half
        return [(b - a) / (end - start) for a, b in zip(self.centres(start), self.centres(end), strict=True)]

    def _sampled(self) -> list[FrameData]:
        """Frames spread over the run, those of them that can be read."""
        numbers = self.cache.frames
        wanted = np.linspace(0, len(numbers) - 1, min(len(numbers), _SAMPLED_FRAMES)).round().astype(int)
        frames = []
        for index in wanted:
            with contextlib.suppress(_core.IoError):
                frames.append(self.load(numbers[index]))
        return frames
