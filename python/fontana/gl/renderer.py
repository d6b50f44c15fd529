"""Draws a frame: light maps, solids, particles or water, and the average over samples."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fontana import _core
from fontana.gl import lights
from fontana.gl.camera import Camera
from fontana.gl.color_maps import color_map_texture
from fontana.gl.context import REQUIRED_VERSION
from fontana.gl.fluid import FluidPass
from fontana.gl.frame_data import FrameData, Look
from fontana.gl.particles import Particles
from fontana.gl.shader_files import load_program, set_uniforms
from fontana.gl.stage import Stage
from fontana.gl.targets import Targets

_NOISE_SIZE = 32  # a side of the cube of noise, as environment.glsl has it
_PROGRAMS = {
    "points": ("sphere.vert", "points.frag"),
    "fluid_depth": ("sphere.vert", "fluid_depth.frag"),
    "fluid_thickness": ("sphere.vert", "fluid_thickness.frag"),
    "light_points": ("light_sphere.vert", "light_points.frag"),
    "light_fluid": ("light_sphere.vert", "light_fluid.frag"),
}
_NOISE_UNIT, _MAP_UNIT, _PICTURE_UNIT = 0, 5, 6
_SUN_UNITS, _SKY_UNITS = (1, 2), (3, 4)
_SUN_SPREAD, _SKY_SPREAD = 1.6, 40.0  # texels; a single sample stands for the whole sky
_RIPPLE_SPEED = 1.6  # 1/s
_GRAVITY = 9.81  # m/s^2; only says what is fast for spray to be white
_PLASTIC = np.array([0.7548776662466927, 0.5698402909980532])  # Roberts' R2 sequence covers the square evenly
_GOLDEN = np.array([0.6180339887498949, 0.7548776662466927])


class Renderer:
    """Draws frames of a stage with a moderngl context, that of a window or a headless one.

    set_stage once for a scene, set_frame once for a frame, draw as often as the picture changes. What stands in the
    context's state (flags, blending, bound framebuffer and textures) is not restored.

    targets  the textures of the last picture, depth and thickness of the water among them
    """

    def __init__(self, context: object):
        if context.version_code < REQUIRED_VERSION:
            raise _core.DeviceUnavailable(
                f"pictures need OpenGL 3.3; this context has {context.version_code / 100:.1f}"
            )
        self.context = context
        self.particles = Particles(context, _PROGRAMS)
        self._sun = lights.LightMap(context, "sun", _SUN_UNITS)
        self._sky = lights.LightMap(context, "sky", _SKY_UNITS)
        self._fluid = FluidPass(context, self.particles)
        self._screen = {
            name: load_program(context, "screen.vert", f"{name}.frag") for name in ("backdrop", "tone", "present")
        }
        self._triangles = {name: context.vertex_array(program, []) for name, program in self._screen.items()}
        self._noise = self._make_noise()
        self._color_maps: dict[str, object] = {}
        self._stage = Stage(context)
        self._has_stage = False
        self._frame: FrameData | None = None
        self.targets: Targets | None = None

    def set_stage(self, colliders: Sequence[dict], bounds: np.ndarray) -> None:
        """The colliders of the scene and the box (2, 3) in metres that holds what is worth seeing."""
        self._stage.load(colliders, bounds)
        self._has_stage = True

    def set_frame(self, frame: FrameData) -> None:
        """Uploads the particles of a frame."""
        self._frame = frame
        self.particles.upload(frame)

    def draw(self, camera: Camera, size: tuple[int, int], look: Look, target: object) -> None:
        """Draws into `target`, a framebuffer of `size` pixels; a size without pixels draws nothing."""
        if min(size) < 1 or not self._has_stage or self._frame is None:
            return
        targets = self._targets_of(size)
        targets.averaged.clear(0.0, 0.0, 0.0, 0.0)
        for sample in range(look.samples):
            picture = self._draw_sample(camera, targets, look, sample)
            self._add(picture, targets, 1.0 / look.samples)
        target.use()
        self.context.enable_only(self.context.NOTHING)
        self._screen_pass("present", targets.average, "picture")

    def image(self, camera: Camera, size: tuple[int, int], look: Look) -> np.ndarray:
        """The picture as (height, width, 3) bytes, upper row first."""
        targets = self._targets_of(size)
        self.draw(camera, size, look, targets.shown)
        rows = np.frombuffer(targets.shown.read(components=3, alignment=1), np.uint8)
        return rows.reshape(size[1], size[0], 3)[::-1].copy()

    def _draw_sample(self, camera: Camera, targets: Targets, look: Look, sample: int) -> object:
        """Draws one sample and returns the texture that has it."""
        moment = self._moment(look, sample)
        uniforms = self._camera_uniforms(camera, targets.size, sample) | self._light_uniforms(look, moment, sample)
        self._draw_scene(targets, moment, uniforms)
        if not moment.as_fluid:
            self._draw_points(targets, look, uniforms)
            return targets.scene_colour
        pixels_per_metre = targets.size[1] / (2.0 * np.tan(np.radians(camera.field_of_view) / 2))
        return self._fluid.draw(targets, self._frame.radius, self._stage.size, pixels_per_metre, uniforms)

    def _moment(self, look: Look, sample: int) -> lights.Moment:
        shutter_time = look.shutter * ((sample + 0.5) / look.samples - 0.5)
        centres = self._frame.centres_at(shutter_time)
        return lights.Moment(centres, self._frame.radius, shutter_time, as_fluid=look.style == "fluid")

    def _draw_scene(self, targets: Targets, moment: lights.Moment, uniforms: dict) -> None:
        self.context.enable_only(self.context.NOTHING)
        targets.scene.clear(depth=1.0)
        targets.backdrop.use()
        set_uniforms(self._screen["backdrop"], **uniforms)
        self._triangles["backdrop"].render(self.context.TRIANGLES, vertices=3)
        targets.scene.use()
        self._stage.draw(moment.centres, uniforms)

    def _draw_points(self, targets: Targets, look: Look, uniforms: dict) -> None:
        self.particles.show(look.color_by)
        self._color_map(look.color_map).use(_MAP_UNIT)
        value_range = look.color_range or self._frame.value_range(look.color_by)
        own = {"radius": self._frame.radius, "value_range": value_range, "color_map": _MAP_UNIT, "size_by_crowd": 0.0}
        set_uniforms(self.particles.programs["points"], **own, **uniforms)
        self.context.enable_only(self.context.DEPTH_TEST)
        targets.scene.use()
        self.particles.draw("points")

    def _camera_uniforms(self, camera: Camera, size: tuple[int, int], sample: int) -> dict:
        shift = (0.5 + _PLASTIC * sample) % 1.0 - 0.5
        view = camera.view_matrix()
        half = np.tan(np.radians(camera.field_of_view) / 2)
        return {
            "view": view,
            "projection": camera.projection_matrix(size, tuple(shift)),
            "camera_to_world": np.linalg.inv(view),
            "lens": (half * size[0] / size[1], half, -2.0 * shift[0] / size[0], -2.0 * shift[1] / size[1]),
        }

    def _light_uniforms(self, look: Look, moment: lights.Moment, sample: int) -> dict:
        """Draws the light maps of a sample. One sample alone has the sky straight above, with wide soft edges."""
        place = (0.5 + _GOLDEN * sample) % 1.0
        sun = lights.sun_direction(tuple(place)) if look.samples > 1 else lights.SUN
        sky = lights.sky_direction(tuple(place[::-1])) if look.samples > 1 else np.array([0.0, 1.0, 0.0])
        scene = (self._stage, self.particles, moment)
        self._noise.use(_NOISE_UNIT)
        return {
            "sun_direction": sun,
            "noise_cube": _NOISE_UNIT,
            "ripple_time": _RIPPLE_SPEED * self._frame.time,
            "free_fall": np.sqrt(2.0 * _GRAVITY * self._frame.simulation_scale * self._stage.size),
            "shutter_time": moment.shutter_time,
            "light_absorption": tuple(share / self._stage.size for share in look.absorption),
            **self._sun.draw(sun, _SUN_SPREAD, *scene),
            **self._sky.draw(sky, 3.0 if look.samples > 1 else _SKY_SPREAD, *scene),
        }

    def _add(self, picture: object, targets: Targets, share: float) -> None:
        gl = self.context
        targets.averaged.use()
        gl.enable_only(gl.BLEND)
        gl.blend_func = gl.ONE, gl.ONE
        self._screen_pass("tone", picture, "light", share=share)

    def _screen_pass(self, name: str, texture: object, sampler: str, **uniforms: object) -> None:
        texture.use(_PICTURE_UNIT)
        set_uniforms(self._screen[name], **{sampler: _PICTURE_UNIT}, **uniforms)
        self._triangles[name].render(self.context.TRIANGLES, vertices=3)

    def _targets_of(self, size: tuple[int, int]) -> Targets:
        if self.targets is None or self.targets.size != size:
            if self.targets:
                self.targets.release()
            self.targets = Targets(self.context, size)
        return self.targets

    def _color_map(self, name: str) -> object:
        if name not in self._color_maps:
            self._color_maps[name] = color_map_texture(self.context, name)
        return self._color_maps[name]

    def _make_noise(self) -> object:
        values = np.random.default_rng(1).integers(0, 256, _NOISE_SIZE**3, dtype=np.uint8)
        return self.context.texture3d((_NOISE_SIZE,) * 3, 1, values.tobytes())
