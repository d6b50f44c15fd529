"""Draws the frames of a run one by one, and loses none that is done."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.gl.camera import Camera
from fontana.gl.context import create_headless_context
from fontana.gl.footage import Footage
from fontana.gl.frame_data import FrameData, Look
from fontana.gl.renderer import Renderer
from fontana.render.legend import add_legend
from fontana.render.options import RenderOptions
from fontana.render.outputs import Output
from fontana.runs.frame_numbers import refuse_skipped
from fontana.runs.progress import Quiet
from fontana.runs.stop import StoppedError, StopSignals


def render(footage: Footage, options: RenderOptions, output: Output, progress: Quiet) -> list[Path]:
    """Draws the frames whose pictures are not in the output yet, and returns the files of all that are there.

    A frame whose file is missing or damaged is skipped: once all others are done, IoError names it. Raises StoppedError
    on Ctrl-C and SIGTERM with what is drawn complete; IoError if a picture cannot be written; DeviceUnavailable without
    OpenGL.
    """
    job = _Job(footage, options, output, progress)
    try:
        due = [frame for frame in options.frames if not output.has(frame, job.stamp(frame))]
        progress.start(str(output.path), len(options.frames), len(options.frames) - len(due))
        with StopSignals("stopping after this picture") as stop:
            for frame in due:
                if stop.requested:
                    break
                job.do(frame)
            files = output.finish()
    finally:
        output.abandon()
    untouched = len(due) - job.drawn - len(job.skipped)
    if stop.requested and untouched:
        done = len(options.frames) - untouched - len(job.skipped)
        so_far = f"; {files[-1]} is complete so far" if files else ""
        raise StoppedError(stop.requested, f"stopped after {done} of {len(options.frames)} pictures{so_far}")
    refuse_skipped(job.skipped, len(options.frames))
    return files


class _Job:
    """Draws frames one by one.

    drawn    how many
    skipped  those that cannot be read, each with the reason
    """

    def __init__(self, footage: Footage, options: RenderOptions, output: Output, progress: Quiet):
        self.footage, self.options, self.output, self.progress = footage, options, output, progress
        self.drawn = 0
        self.skipped: dict[int, str] = {}
        self.bounds = footage.bounds()
        self._renderer: Renderer | None = None
        self._color_range = options.look.color_range

    def do(self, frame: int) -> None:
        """Draws a frame, or skips it."""
        try:
            data = self.footage.load(frame)
        except _core.IoError as error:
            self.skipped[frame] = str(error)
            self.progress.skip(frame, str(error))
            return
        self.output.write(frame, self._draw(frame, data), self.stamp(frame))
        self.drawn += 1
        self.progress.frame({"frame": frame, "text": f"{data.particle_count:,} particles"})

    def stamp(self, frame: int) -> str:
        """A fingerprint of everything the picture depends on."""
        parts = {
            "version": _core.version(),
            "frame": self.footage.cache.hash(frame),
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
            self._renderer.set_stage(self.footage.cache.scene.colliders, self.bounds)
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
            self._color_range = self.footage.value_range(look.color_by)
        return replace(look, color_range=self._color_range)
