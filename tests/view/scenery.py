"""Small things to draw, and how the tests look at pictures of them."""

from __future__ import annotations

import numpy as np

from fontana.gl.camera import Camera
from fontana.gl.frame_data import FrameData, Look
from fontana.gl.renderer import Renderer

BOUNDS = np.array([[-1.0, 0.0, -1.0], [1.0, 1.0, 1.0]])
SIZE = (120, 90)
FRONT = Camera.looking([0.0, 0.5, 4.0], [0.0, 0.5, 0.0], 30.0)
ABOVE = Camera.looking([0.0, 4.0, 0.5], [0.0, 0.0, 0.0], 30.0)
POINTS = Look(style="points", color_range=(0.0, 1.0))
FLUID = Look(style="fluid")


def frame(position: object, speed: object = 0.0, radius: float = 0.1, **others: object) -> FrameData:
    """A frame of particles (N, 3) with speeds (N,), at rest density unless said otherwise."""
    position = np.asarray(position, dtype=np.float32).reshape(-1, 3)
    count = len(position)
    velocity = np.zeros((count, 3), dtype=np.float32)
    velocity[:, 0] = speed
    values = {
        "density": np.full(count, 1000.0, dtype=np.float32),
        "pressure": np.zeros(count, dtype=np.float32),
        "id": np.arange(count),
        "rest_density": 1000.0,
    }
    return FrameData(position=position, velocity=velocity, radius=radius, **(values | others))


def picture(renderer: Renderer, data: FrameData, colliders=(), camera=FRONT, look=POINTS, size=SIZE) -> np.ndarray:
    """(height, width, 3) in 0 to 255 as float."""
    renderer.set_stage(colliders, BOUNDS)
    renderer.set_frame(data)
    return renderer.image(camera, size, look).astype(float)


def changed(first: np.ndarray, second: np.ndarray, by: float = 6.0) -> np.ndarray:
    """Which pixels (height, width) differ visibly."""
    return np.abs(first - second).max(axis=2) > by


def block(low: object, high: object, spacing: float) -> np.ndarray:
    """A lattice of positions between two corners."""
    axes = [np.arange(a + 0.5 * spacing, b, spacing) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def pool(spacing: float = 0.05, shake: float = 0.2) -> np.ndarray:
    """A basin full of water at rest, 0.3 m deep, a little disordered."""
    positions = block([-0.8, 0.0, -0.8], [0.8, 0.3, 0.8], spacing)
    return positions + np.random.default_rng(2).uniform(-shake, shake, positions.shape) * spacing
