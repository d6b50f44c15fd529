"""The solids of a scene on the device, and the box they are drawn in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fontana.gl.shader_files import load_program, set_uniforms
from fontana.gl.solids import MATERIALS, Solid, make_solids


class Stage:
    """Draws the colliders of a scene, once `load` has said which.

    bounds  (2, 3) m, what has no end is drawn within it; middle its centre, size its longest edge
    """

    def __init__(self, context: object):
        self.context = context
        self._program = load_program(context, "solid.vert", "solid.frag")
        self._shadow_program = load_program(context, "light_solid.vert", "light_solid.frag")
        self._solids: list[tuple[Solid, object, object, object]] = []

    def load(self, colliders: Sequence[dict], bounds: np.ndarray) -> None:
        """Replaces what is drawn. `colliders` are a scene's, `bounds` (2, 3) metres."""
        for _, *resources in self._solids:
            for resource in resources:
                resource.release()
        self.colliders = list(colliders)
        self.bounds = np.asarray(bounds, dtype=float)
        self.middle = self.bounds.mean(axis=0)
        self.size = float(np.ptp(self.bounds, axis=0).max())
        self._solids = [self._upload(solid) for solid in make_solids(self.colliders, self.bounds)]

    def _upload(self, solid: Solid) -> tuple[Solid, object, object, object]:
        """The solid with its two vertex arrays and their buffer."""
        data = np.concatenate([solid.position, solid.normal], axis=1).astype("f4")
        buffer = self.context.buffer(data.tobytes())
        lit = self.context.vertex_array(self._program, [(buffer, "3f 3f", "in_position", "in_normal")])
        shadow = self.context.vertex_array(self._shadow_program, [(buffer, "3f 12x", "in_position")])
        return solid, lit, shadow, buffer

    def draw(self, centres: Sequence[np.ndarray], uniforms: dict) -> None:
        """Draws colour and depth into the bound framebuffer; `centres` are where the colliders are now (m)."""
        set_uniforms(self._program, stage_size=self.size, stage_middle=self.middle, **uniforms)
        for solid, lit, *_ in self._solids:
            set_uniforms(self._program, centre=self._centre(solid, centres), material=MATERIALS.index(solid.material))
            flags = self.context.DEPTH_TEST | (self.context.CULL_FACE if solid.one_sided else 0)
            self.context.enable_only(flags)
            lit.render()

    def draw_shadows(self, centres: Sequence[np.ndarray], light_matrix: np.ndarray) -> None:
        """Draws depths as the light sees them."""
        set_uniforms(self._shadow_program, light_matrix=light_matrix)
        for solid, _, shadow, _ in self._solids:
            if solid.casts_shadow:
                set_uniforms(self._shadow_program, centre=self._centre(solid, centres))
                shadow.render()

    def _centre(self, solid: Solid, centres: Sequence[np.ndarray]) -> np.ndarray:
        if len(centres):
            return np.asarray(centres[solid.index], dtype=float)
        return np.array(self.colliders[solid.index].get("centre", [0.0, 0.0, 0.0]), dtype=float)
