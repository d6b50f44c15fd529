"""The pictures the renderer draws on the way, made anew when the size changes."""

from __future__ import annotations

THICKNESS_SCALE = 2  # the thickness of water is smooth: half the pixels on each axis do


class Targets:
    """Textures and framebuffers for pictures of one size (pixels)."""

    def __init__(self, context: object, size: tuple[int, int]):
        self.context, self.size = context, size
        self.small_size = tuple(max(1, -(-length // THICKNESS_SCALE)) for length in size)
        self._made: list[object] = []
        self.scene_colour = self._texture(size, 4, "f2")
        self.scene_depth = self._texture(size, 1, "f4", linear=False)
        self.fluid_depths = [self._texture(size, 2, "f4", linear=False) for _ in range(2)]
        self.thickness = self._texture(self.small_size, 2, "f2")
        self.water_colour = self._texture(size, 4, "f2")
        self.average = self._texture(size, 4, "f4", linear=False)
        self.picture = self._texture(size, 3, "f1", linear=False)
        depth = self._keep(context.depth_renderbuffer(size))
        self.scene = self._framebuffer([self.scene_colour, self.scene_depth], depth)
        self.backdrop = self._framebuffer([self.scene_colour, self.scene_depth])
        self.fluid = self._framebuffer([self.fluid_depths[0]], depth)
        self.smoothing = [self._framebuffer([texture]) for texture in self.fluid_depths]
        self.water_thickness = self._framebuffer([self.thickness])
        self.water = self._framebuffer([self.water_colour])
        self.averaged = self._framebuffer([self.average])
        self.shown = self._framebuffer([self.picture])

    def release(self) -> None:
        for thing in reversed(self._made):
            thing.release()

    def _texture(self, size: tuple[int, int], components: int, dtype: str, linear: bool = True) -> object:
        texture = self.context.texture(size, components, dtype=dtype)
        kind = self.context.LINEAR if linear else self.context.NEAREST
        texture.filter = (kind, kind)
        texture.repeat_x = texture.repeat_y = False
        return self._keep(texture)

    def _framebuffer(self, textures: list[object], depth: object = None) -> object:
        return self._keep(self.context.framebuffer(textures, depth))

    def _keep(self, thing: object) -> object:
        self._made.append(thing)
        return thing
