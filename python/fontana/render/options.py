"""What `fontana render` is asked for, read from text with one sentence for each mistake."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from fontana import _core
from fontana.gl.camera import Camera
from fontana.gl.frame_data import Look
from fontana.tables import suggestion

LARGEST_SIDE = 8192  # pixels; what OpenGL 3.3 drivers commonly draw into
_SIZE = re.compile(r"(\d{1,5})[xX](\d{1,5})")
_NUMBERS = {"eye": 3, "target": 3, "fov": 1, "azimuth": 1, "elevation": 1, "distance": 1, "turn": 1}


@dataclass(frozen=True)
class RenderOptions:
    """size in pixels; `turn` degrees that the camera goes around the target, from the first frame to the last."""

    frames: list[int]
    size: tuple[int, int]
    camera: Camera
    turn: float
    look: Look
    legend: bool
    fps: float
    restart: bool


def parse_size(text: str) -> tuple[int, int]:
    """ "1280x720" as (width, height). Raises BadInput."""
    match = _SIZE.fullmatch(text)
    size = (int(match[1]), int(match[2])) if match else (0, 0)
    if not match or min(size) < 1 or max(size) > LARGEST_SIDE:
        raise _core.BadInput(f'--size: expected WIDTHxHEIGHT of 1 to {LARGEST_SIDE} pixels, as 1280x720, got "{text}"')
    return size


def parse_color_range(text: str | None) -> tuple[float, float] | None:
    """ "0,3" as two numbers. Raises BadInput."""
    if text is None:
        return None
    low, high = _floats("--color-range", text, 2)
    if not high > low:
        raise _core.BadInput(f'--color-range: expected the lower value first, as 0,3, got "{text}"')
    return low, high


def parse_camera(text: str, start: Camera) -> tuple[Camera, float]:
    """Changes `start` by "eye=1,2,3 target=0,0.3,0 fov=35" or "azimuth=30 elevation=15 distance=2.5 turn=90".

    Returns the camera and the degrees of the turn. Raises BadInput with the nearest word.
    """
    values = dict(_camera_word(word) for word in text.replace(";", " ").split())
    eye = values.get("eye")
    around = [name for name in ("azimuth", "elevation", "distance") if name in values]
    if eye and around:
        raise _core.BadInput(f"--camera: eye already says where the camera is; leave out {', '.join(around)}")
    opening = values.get("fov", [start.field_of_view])[0]
    if not 1.0 <= opening <= 150.0:
        raise _core.BadInput(f"--camera: fov is the vertical opening in degrees, 1 to 150, got {opening:g}")
    target = np.array(values.get("target", start.target))
    camera = Camera.looking(eye or (start.eye if "target" not in values else target + start.eye - start.target), target)
    camera.field_of_view = opening
    for name in around:
        setattr(camera, name, values[name][0])
    if not camera.distance > 0:
        raise _core.BadInput(f"--camera: distance must be above 0 m, got {camera.distance:g}")
    camera.orbit(0.0, 0.0)  # within what a camera can do
    return camera, values.get("turn", [0.0])[0]


def _camera_word(word: str) -> tuple[str, list[float]]:
    name, _, value = word.partition("=")
    if name not in _NUMBERS:
        raise _core.BadInput(f'--camera: there is no "{name}"{suggestion(name, _NUMBERS)}')
    return name, _floats(f"--camera: {name}", value, _NUMBERS[name])


def _floats(where: str, text: str, count: int) -> list[float]:
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if len(values) != count or not np.isfinite(values).all():
        words = "a number" if count == 1 else f"{count} numbers with commas between"
        raise _core.BadInput(f'{where}: expected {words}, got "{text}"')
    return values
