"""The particles of a frame on the device, drawn as squares that cover their spheres."""

from __future__ import annotations

import numpy as np

from fontana.gl.frame_data import FrameData
from fontana.gl.shader_files import load_program

_CORNERS = np.array([[-1, -1], [1, -1], [-1, 1], [1, 1]], dtype="f4")
_GROWTH = 1.5  # of the buffers, so that an emitter does not make new ones each frame


class Particles:
    """Buffers for position, velocity, state and a value to colour by, and programs that draw them.

    State is density over rest density, and speed.

    Programs are named by their files; each has the inputs it asks for.
    """

    def __init__(self, context: object, programs: dict[str, tuple[str, str]]):
        self.context = context
        self.programs = {name: load_program(context, *files) for name, files in programs.items()}
        self.count = 0
        self._capacity = 0
        self._corners = context.buffer(_CORNERS.tobytes())
        self._arrays: dict[str, object] = {}
        self._shown: str | None = None
        self._frame: FrameData | None = None

    def upload(self, frame: FrameData) -> None:
        self._frame, self._shown = frame, None
        self.count = frame.particle_count
        if self.count > self._capacity or not self._arrays:
            self._allocate(max(1, int(self.count * _GROWTH)))
        if not self.count:
            return
        state = np.stack([frame.density / frame.rest_density, frame.values("speed")], axis=1)
        self._position.write(np.ascontiguousarray(frame.position, dtype="f4"))
        self._velocity.write(np.ascontiguousarray(frame.velocity, dtype="f4"))
        self._state.write(np.ascontiguousarray(state, dtype="f4"))

    def show(self, color_by: str) -> None:
        """Uploads what the points are coloured by, unless it is there."""
        if self.count and self._shown != color_by:
            self._value.write(np.ascontiguousarray(self._frame.values(color_by), dtype="f4"))
            self._shown = color_by

    def draw(self, program: str) -> None:
        if self.count:
            self._arrays[program].render(self.context.TRIANGLE_STRIP, vertices=4, instances=self.count)

    def _allocate(self, capacity: int) -> None:
        for thing in (*self._arrays.values(), *(self._buffers() if self._capacity else ())):
            thing.release()
        self._position = self.context.buffer(reserve=12 * capacity)
        self._velocity = self.context.buffer(reserve=12 * capacity)
        self._state = self.context.buffer(reserve=8 * capacity)
        self._value = self.context.buffer(reserve=4 * capacity)
        self._capacity = capacity
        inputs = {
            "in_corner": (self._corners, "2f"),
            "in_position": (self._position, "3f/i"),
            "in_velocity": (self._velocity, "3f/i"),
            "in_state": (self._state, "2f/i"),
            "in_value": (self._value, "1f/i"),
        }
        self._arrays = {
            name: self.context.vertex_array(
                program, [(buffer, kind, key) for key, (buffer, kind) in inputs.items() if key in program]
            )
            for name, program in self.programs.items()
        }

    def _buffers(self) -> tuple[object, ...]:
        return self._position, self._velocity, self._state, self._value
