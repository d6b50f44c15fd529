"""The contact sheet of a run: a grid of frames, side view, the fluid coloured by its speed."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.bounds import stage_bounds
from fontana.contact_sheet.spheres import SPEED_COLOURS, SPEED_STOPS, Stage, View
from fontana.gl.camera import Camera
from fontana.gl.footage import Footage
from fontana.gl.frame_data import FrameData
from fontana.runs.cache import Cache
from fontana.runs.manifest import Manifest
from fontana.scene import Scene

COLUMNS = 4
FRAME_COUNT = 8
PANEL = (640, 440)  # pixels
HEAD, FOOT, GAP = 56, 40, 6  # pixels above and below all panels, and around each
SUPERSAMPLING = 2
SPHERE_SCALE = 1.15  # drawn over real radius: closes the gaps of a fluid at rest
DARK, LIGHT_TEXT, DIM_TEXT = "#07090d", "#e8eef5", "#8b98a8"


def contact_sheet(folder: Path) -> Path:
    """Draws the run in `folder` (its run.json and frames) to NAME.png there, and returns the path.

    Raises BadInput if the folder is not that of a run, IoError if files cannot be read or written.
    """
    cache = Cache(folder)
    records = _choose(cache.manifest.frames, cache.scene.view.get("frames"))
    footage = Footage(cache)
    images, fast = _draw_frames(footage, [footage.load(record["frame"]) for record in records])
    path = folder / f"{cache.scene.name}.png"
    _core.publish_file(str(path), _sheet(cache.scene, cache.manifest, records, images, fast))
    return path


def _choose(frames: list[dict], wanted: list[int] | None) -> list[dict]:
    """The wanted frames, with the last one for those that do not exist yet; else up to eight spread over the run."""
    if wanted and min(wanted) <= len(frames):
        return [frames[number - 1] for number in sorted({min(number, len(frames)) for number in wanted})]
    count = min(FRAME_COUNT, len(frames))
    return [frames[round(len(frames) * (k + 1) / count) - 1] for k in range(count)]


def _draw_frames(footage: Footage, frames: list[FrameData]) -> tuple[list[np.ndarray], float]:
    """The pictures of the frames, and the speed (m/s) at the end of their colours."""
    scene = footage.cache.scene
    speeds = [frame.values("speed") for frame in frames]
    everything = np.concatenate(speeds)
    fast = float(np.quantile(everything, 0.996)) if len(everything) else 1.0
    bounds = stage_bounds(scene.colliders, [frame.position for frame in frames])
    view = _view(scene, bounds)
    stage = Stage(view, scene.colliders, footage.centres(0.0), bounds)
    images = [
        _shrink(stage.draw(frame.centres, frame.position, speed, SPHERE_SCALE * frame.radius, fast))
        for frame, speed in zip(frames, speeds, strict=True)
    ]
    return images, fast


def _shrink(image: np.ndarray) -> np.ndarray:
    """Averages blocks of pixels; what is left is smooth at its edges."""
    height, width = PANEL[1], PANEL[0]
    return image.reshape(height, SUPERSAMPLING, width, SUPERSAMPLING, 3).mean(axis=(1, 3))


def _view(scene: Scene, bounds: np.ndarray) -> View:
    camera = Camera.of_scene(scene.view, bounds)
    size = (PANEL[0] * SUPERSAMPLING, PANEL[1] * SUPERSAMPLING)
    return View(camera.eye, camera.target, camera.field_of_view, size)


def _sheet(scene: Scene, manifest: Manifest, records: list[dict], images: list[np.ndarray], fast: float) -> bytes:
    """The panels with their captions as PNG."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    columns = min(COLUMNS, len(images))
    rows = -(-len(images) // columns)
    width = columns * PANEL[0] + (columns + 1) * GAP
    height = rows * (PANEL[1] + GAP) + GAP + HEAD + FOOT
    figure = pyplot.figure(figsize=(width / 100, height / 100), dpi=100, facecolor=DARK)
    for index, (record, image) in enumerate(zip(records, images, strict=True)):
        row, column = divmod(index, columns)
        left = GAP + column * (PANEL[0] + GAP)
        bottom = height - HEAD - (row + 1) * (PANEL[1] + GAP)
        axes = figure.add_axes((left / width, bottom / height, PANEL[0] / width, PANEL[1] / height))
        _draw_panel(axes, image, f"frame {record['frame']}   {record['time']:.2f} s")
    margin, y = 2 * GAP / width, 1 - HEAD / 2 / height
    figure.text(margin, y, scene.name.replace("_", " "), color=LIGHT_TEXT, fontsize=20, va="center")
    facts = f"{records[-1]['particles']:,} particles   {manifest.data['device']['backend']}"
    figure.text(1 - margin, y, facts, color=DIM_TEXT, fontsize=14, va="center", ha="right")
    _speed_scale(figure, fast, height)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", facecolor=DARK)
    pyplot.close(figure)
    return buffer.getvalue()


def _draw_panel(axes, image: np.ndarray, caption: str) -> None:
    from matplotlib import patheffects

    axes.imshow(image, interpolation="none", aspect="auto")
    axes.set_axis_off()
    outline = [patheffects.withStroke(linewidth=3, foreground=DARK)]  # drops may fly behind the words
    place = {"transform": axes.transAxes, "path_effects": outline}
    axes.text(0.025, 0.045, caption, color=LIGHT_TEXT, fontsize=13, **place)


def _speed_scale(figure, fast: float, height: int) -> None:
    """What the colours mean."""
    share = np.linspace(0, 1, 256)
    ramp = np.stack([np.interp(share, SPEED_STOPS, SPEED_COLOURS[:, k]) for k in range(3)], axis=1)
    axes = figure.add_axes((0.44, 0.4 * FOOT / height, 0.12, 0.22 * FOOT / height))
    axes.imshow(ramp[None], aspect="auto")
    axes.set_axis_off()
    y = 0.52 * FOOT / height
    figure.text(0.435, y, "0", color=DIM_TEXT, fontsize=12, va="center", ha="right")
    figure.text(0.565, y, f"{fast:.2g} m/s", color=DIM_TEXT, fontsize=12, va="center", ha="left")
