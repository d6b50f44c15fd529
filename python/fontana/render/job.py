"""Draws the frames of a run one by one, and loses none that is done."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.gl.camera import Camera
from fontana.gl.context import create_headless_context
from fontana.gl.frame_data import FrameData, Look
from fontana.gl.renderer import Renderer
from fontana.render.legend import add_legend
from fontana.render.options import RenderOptions
from fontana.render.outputs import Output
from fontana.runs.cache import Cache
from fontana.runs.runner import StoppedError
from fontana.runs.stop import StopSignals

_STOP_MESSAGE = "stopping after this picture; once more stops at once"


@dataclass
class Report:
    """What became of the frames asked for: numbers of those drawn, found done, and skipped with the reason."""

    drawn: list[int] = field(default_factory=list)
    found: list[int] = field(default_factory=list)
    skipped: dict[int, str] = field(default_factory=dict)
    files: list[Path] = field(default_factory=list)


def render(cache: Cache, options: RenderOptions, output: Output, on_frame: Callable[[int, str], None]) -> Report:
    """Draws the frames into the output; `on_frame(frame, reason)` follows each, `reason` is "" unless it is skipped.

    A frame whose file is missing or damaged is skipped. Raises StoppedError on Ctrl-C and SIGTERM with what is drawn
    complete; IoError if nothing could be read or a picture cannot be written; DeviceUnavailable without OpenGL.
    """
    job = _Job(cache, options, output)
    try:
        with StopSignals(_STOP_MESSAGE) as stop:
            for frame in options.frames:
                if stop.requested:
                    break
                on_frame(frame, job.do(frame))
            job.report.files = output.finish()
    finally:
        output.abandon()
    done = len(job.report.drawn) + len(job.report.found)
    if stop.requested and done + len(job.report.skipped) < len(options.frames):
        files = f"; {job.report.files[-1]} is complete so far" if job.report.files else ""
        raise StoppedError(stop.requested, f"stopped after {done} of {len(options.frames)} pictures{files}")
    if not done:
        raise _core.IoError(f"none of the frames can be drawn: {next(iter(job.report.skipped.values()))}")
    return job.report


class _Job:
    def __init__(self, cache: Cache, options: RenderOptions, output: Output):
        self.cache, self.options, self.output = cache, options, output
        self.report = Report()
        self.bounds = cache.bounds()
        self._renderer: Renderer | None = None
        self._color_range = options.look.color_range

    def do(self, frame: int) -> str:
        """Draws a frame unless its picture is there; returns why it was skipped, or ""."""
        stamp = self._stamp(frame)
        if self.output.has(frame, stamp):
            self.report.found.append(frame)
            return ""
        try:
            data = self.cache.load(frame)
        except _core.IoError as error:
            self.report.skipped[frame] = str(error)
            return str(error)
        self.output.write(frame, self._draw(frame, data), stamp)
        self.report.drawn.append(frame)
        return ""

    def _stamp(self, frame: int) -> str:
        """A fingerprint of everything the picture depends on."""
        parts = {
            "version": _core.version(),
            "frame": self.cache.records[frame - 1]["files"][0]["hash"],
            "look": asdict(self._look()),
            "legend": self.options.legend,
            "size": self.options.size,
            "camera": vars(self._camera(frame)),
            "bounds": self.bounds,
        }
        text = json.dumps(parts, sort_keys=True, default=lambda array: np.asarray(array).tolist())
        return hashlib.sha256(text.encode()).hexdigest()[:32]

    def _draw(self, frame: int, data: FrameData) -> np.ndarray:
        renderer, look = self._open_renderer(), self._look()
        renderer.set_frame(data)
        picture = renderer.image(self._camera(frame), self.options.size, look)
        return add_legend(picture, look) if self.options.legend and look.style == "points" else picture

    def _open_renderer(self) -> Renderer:
        if self._renderer is None:
            self._renderer = Renderer(create_headless_context())
            self._renderer.set_stage(self.cache.scene.colliders, self.bounds)
        return self._renderer

    def _camera(self, frame: int) -> Camera:
        """The camera at a frame: part of its turn, the same whatever frames are skipped."""
        frames = self.options.frames
        share = (frame - frames[0]) / max(1, frames[-1] - frames[0])
        camera = replace(self.options.camera)
        camera.orbit(share * self.options.turn, 0.0)
        return camera

    def _look(self) -> Look:
        """The look with a colour range that is the same in all pictures of the run, so that they can be compared."""
        look = self.options.look
        if look.style == "points" and self._color_range is None:
            self._color_range = self.cache.value_range(look.color_by)
        return replace(look, color_range=self._color_range)
