"""The sun and the sky: what each of them sees, as maps of depths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fontana.gl.particles import Particles
from fontana.gl.shader_files import set_uniforms
from fontana.gl.stage import Stage

SUN = np.array([-0.62, 0.74, 0.34]) / np.linalg.norm([-0.62, 0.74, 0.34])
SUN_WIDTH = np.radians(1.6)  # of the disc; wider than the real one by three, for a softer edge
MAP_SIZE = 1024  # texels
_BEHIND = 3.0  # how far towards the light things still cast shadows, over the radius of the stage
_SPHERE_SCALE = 1.6  # of the discs that fill the map of the water, over the particle radius


@dataclass(frozen=True)
class Moment:
    """The scene at one time of the exposure, `shutter_time` seconds from that of the frame.

    centres are where the colliders are, radius (m) is that of a particle.
    """

    centres: Sequence[np.ndarray]
    radius: float
    shutter_time: float
    as_fluid: bool


class LightMap:
    """Depths of solids and of water from one direction. `spread` is the width of a shadow's edge in texels."""

    def __init__(self, context: object, name: str, units: tuple[int, int]):
        self.context, self.name, self._units = context, name, units
        size = (MAP_SIZE, MAP_SIZE)
        self.solid = context.depth_texture(size)
        self.solid.compare_func = ""
        self.water = context.texture(size, 4, dtype="f2")
        for texture in (self.solid, self.water):
            texture.repeat_x = texture.repeat_y = False
        self._solid_target = context.framebuffer(depth_attachment=self.solid)
        self._water_target = context.framebuffer([self.water])

    def draw(self, direction: np.ndarray, spread: float, stage: Stage, particles: Particles, moment: Moment) -> dict:
        """Draws what stands in the way of light from `direction`, and returns the uniforms that ask for it."""
        matrix, right, up, texel, depth = self._place(direction, stage)
        common = {"light_matrix": matrix, "light_right": right, "light_up": up, "depth_range": depth}
        common["shutter_time"] = moment.shutter_time
        self._solid_target.use()
        self._solid_target.clear(depth=1.0)
        self.context.enable_only(self.context.DEPTH_TEST)
        stage.draw_shadows(moment.centres, matrix)
        if not moment.as_fluid:
            set_uniforms(particles.programs["light_points"], radius=moment.radius, **common)
            particles.draw("light_points")
        self._water_target.use()
        self._water_target.clear(0.0, 0.0, 0.0, 1.0)
        if moment.as_fluid:
            self._draw_water(particles, moment.radius, common)
        return self._uniforms(matrix, texel, depth, spread)

    def _draw_water(self, particles: Particles, radius: float, common: dict) -> None:
        gl = self.context
        gl.enable_only(gl.BLEND)
        gl.blend_func = gl.ONE, gl.ONE
        gl.blend_equation = gl.FUNC_ADD, gl.MIN
        wide = _SPHERE_SCALE * radius
        set_uniforms(particles.programs["light_fluid"], radius=wide, filling=filling(wide, radius), **common)
        particles.draw("light_fluid")
        gl.blend_equation = gl.FUNC_ADD

    def _place(self, direction: np.ndarray, stage: Stage) -> tuple[np.ndarray, np.ndarray, np.ndarray, float, float]:
        """World to clip space of a parallel view that holds the stage; its axes, metres a texel and of its depth."""
        reach = 0.5 * float(np.linalg.norm(np.ptp(stage.bounds, axis=0)))
        helper = np.array([0.0, 0.0, 1.0]) if abs(direction[1]) > 0.9 else np.array([0.0, 1.0, 0.0])
        right = np.cross(helper, direction)
        right /= np.linalg.norm(right)
        up = np.cross(direction, right)
        depth = (_BEHIND + 1.0) * reach
        matrix = np.eye(4)
        matrix[0, :3], matrix[1, :3] = right / reach, up / reach
        matrix[2, :3] = -2.0 / depth * direction
        matrix[:3, 3] = -matrix[:3, :3] @ stage.middle
        matrix[2, 3] += 2.0 * _BEHIND / (_BEHIND + 1.0) - 1.0
        return matrix, right, up, 2.0 * reach / MAP_SIZE, depth

    def _uniforms(self, matrix: np.ndarray, texel: float, depth: float, spread: float) -> dict:
        to_map = np.diag([0.5, 0.5, 0.5, 1.0])
        to_map[:3, 3] = 0.5
        solid_unit, water_unit = self._units
        self.solid.use(solid_unit)
        self.water.use(water_unit)
        return {
            f"{self.name}_map.matrix": to_map @ matrix,
            f"{self.name}_map.texel": (texel, depth, spread),
            f"{self.name}_solid": solid_unit,
            f"{self.name}_fluid": water_unit,
        }


def filling(sphere_radius: float, particle_radius: float) -> float:
    """The volume a particle stands for, a cube of twice its radius, over that of the sphere it is drawn with."""
    return (2.0 * particle_radius) ** 3 / (4.0 / 3.0 * np.pi * sphere_radius**3)


def sun_direction(sample: tuple[float, float]) -> np.ndarray:
    """Towards a place on the disc of the sun; `sample` is two numbers in 0 to 1."""
    angle, away = 2.0 * np.pi * sample[0], np.tan(SUN_WIDTH / 2) * np.sqrt(sample[1])
    right = np.cross(SUN, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    direction = SUN + away * (np.cos(angle) * right + np.sin(angle) * np.cross(right, SUN))
    return direction / np.linalg.norm(direction)


def sky_direction(sample: tuple[float, float]) -> np.ndarray:
    """Towards a place in the sky, more often high than low, as light falls on level ground."""
    angle, away = 2.0 * np.pi * sample[0], np.sqrt(0.95 * sample[1])
    return np.array([away * np.cos(angle), np.sqrt(1.0 - away * away), away * np.sin(angle)])
