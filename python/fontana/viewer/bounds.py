"""The box worth seeing while a simulation runs: where the fluid is, where it will come from, and what holds it."""

from __future__ import annotations

import numpy as np

from fontana.bounds import stage_bounds
from fontana.scene import Scene


def worth_seeing(scene: Scene, position: np.ndarray) -> np.ndarray:
    """The lowest and the highest corner, (2, 3) in the scene's unit; `position` is (N, 3), the particles so far."""
    sources = [_emitter_corners(emitter) for emitter in scene.emitters]
    return stage_bounds(scene.colliders, [np.asarray(position, dtype=float), *sources])


def _emitter_corners(emitter: dict) -> np.ndarray:
    """(8, 3): the corners of the box around an emitter."""
    centre = np.array(emitter.get("centre", (0.0, 0.0, 0.0)), dtype=float)
    half = 0.5 * np.array(emitter["size"]) if emitter["type"] == "block" else np.full(3, emitter["radius"])
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return centre + signs * half
