"""Water from particles, in the space of the picture: depth, thickness, smoothing, then light."""

from __future__ import annotations

from fontana.gl.lights import filling
from fontana.gl.particles import Particles
from fontana.gl.shader_files import load_program, set_uniforms
from fontana.gl.targets import Targets

# Over the particle radius, which is half the spacing.
_SURFACE_SCALE = 1.85
_THICKNESS_SCALE = 2.4
_FILTER_SCALE = 9.0
_RANGE_SCALE = 5.0
_BEHIND_SCALE = 1.0
_PASSES = ((1, 0), (0, 1), (1, 0), (0, 1), (0, 0))  # axes of the filter
_UNITS = {"scene_colour": 7, "scene_depth": 8, "fluid_depth": 9, "fluid_thickness": 10}
_NOTHING = 1e6  # m, the depth where there is no water


class FluidPass:
    """Draws the particles as water over what a Targets has of the scene."""

    def __init__(self, context: object, particles: Particles):
        self.context, self.particles = context, particles
        self._filter = load_program(context, "screen.vert", "narrow_range.frag")
        self._water = load_program(context, "screen.vert", "water.frag")
        self._triangles = {program: context.vertex_array(program, []) for program in (self._filter, self._water)}

    def draw(
        self, targets: Targets, radius: float, stage_size: float, pixels_per_metre: float, uniforms: dict
    ) -> object:
        """Returns the texture with the scene and the water in it. `pixels_per_metre` is that at a depth of 1 m."""
        targets.scene_depth.use(_UNITS["scene_depth"])
        self._draw_depth(targets, radius, uniforms)
        self._draw_thickness(targets, radius, uniforms)
        surface = self._smooth(targets, radius, pixels_per_metre)
        return self._draw_water(targets, surface, radius, stage_size, uniforms)

    def _draw_depth(self, targets: Targets, radius: float, uniforms: dict) -> None:
        targets.fluid.use()
        targets.fluid.clear(_NOTHING, 0.0, depth=1.0)
        self.context.enable_only(self.context.DEPTH_TEST)
        self._draw_spheres("fluid_depth", _SURFACE_SCALE * radius, uniforms)

    def _draw_thickness(self, targets: Targets, radius: float, uniforms: dict) -> None:
        gl = self.context
        targets.water_thickness.use()
        targets.water_thickness.clear(0.0, 0.0)
        gl.enable_only(gl.BLEND)
        gl.blend_func = gl.ONE, gl.ONE
        wide = _THICKNESS_SCALE * radius
        own = {"filling": filling(wide, radius), "target_size": targets.small_size}
        self._draw_spheres("fluid_thickness", wide, uniforms | own)

    def _draw_spheres(self, program: str, radius: float, uniforms: dict) -> None:
        own = {"radius": radius, "size_by_crowd": 1.0, "scene_depth": _UNITS["scene_depth"]}
        set_uniforms(self.particles.programs[program], **own, **uniforms)
        self.particles.draw(program)

    def _smooth(self, targets: Targets, radius: float, pixels_per_metre: float) -> object:
        self.context.enable_only(self.context.NOTHING)
        set_uniforms(
            self._filter,
            fluid_depth=_UNITS["fluid_depth"],
            filter_radius=_FILTER_SCALE * radius,
            range_width=_RANGE_SCALE * radius,
            behind=_BEHIND_SCALE * radius,
            pixels_per_metre=pixels_per_metre,
        )
        source = 0
        for axis in _PASSES:
            targets.fluid_depths[source].use(_UNITS["fluid_depth"])
            source = 1 - source
            targets.smoothing[source].use()
            set_uniforms(self._filter, axis=axis)
            self._triangles[self._filter].render(self.context.TRIANGLES, vertices=3)
        return targets.fluid_depths[source]

    def _draw_water(
        self, targets: Targets, surface: object, radius: float, stage_size: float, uniforms: dict
    ) -> object:
        targets.scene_colour.use(_UNITS["scene_colour"])
        surface.use(_UNITS["fluid_depth"])
        targets.thickness.use(_UNITS["fluid_thickness"])
        set_uniforms(self._water, stage_size=stage_size, drop_size=2.0 * radius, **_UNITS, **uniforms)
        targets.water.use()
        self.context.enable_only(self.context.NOTHING)
        self._triangles[self._water].render(self.context.TRIANGLES, vertices=3)
        return targets.water_colour
