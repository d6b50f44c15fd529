"""The simulation as Python sees it: scenes in, frames of numpy arrays out."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from fontana import _core
from fontana.resolve import dynamic_viscosity, resolve_value
from fontana.scene import Scene, load_scene
from fontana.tables import find_parameter, parameters


class StaleFrameError(RuntimeError):
    """An attribute of a frame was asked for after the simulation had gone on, and had not been read before."""


class Frame:
    """One finished frame. Its attributes are numpy arrays in order of particle id, read from the device when first
    asked for and kept from then on:

        position (N, 3) float32, m          velocity (N, 3) float32, m/s
        acceleration (N, 3) float32, m/s^2  force (N, 3) float32, N
        density (N,) float32, kg/m^3        pressure (N,) float32, Pa
        mass (N,) float32, kg               id (N,) int32

    What was not read before the next step is gone: StaleFrameError says so.
    """

    def __init__(self, core: _core.Simulation, report: object, is_current: Callable[[], bool]):
        self._core = core
        self._is_current = is_current
        self._arrays: dict[str, np.ndarray] = {}
        self.report = report

    @property
    def number(self) -> int:
        """Frames finished when this one was: 1 is the first."""
        return self.report.frame

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self.report.time

    @property
    def particle_count(self) -> int:
        return self.report.particle_count

    def read(self, name: str) -> np.ndarray:
        """The attribute `name`: (N,) or (N, 3). Raises BadInput for an unknown name, StaleFrameError if too late."""
        if name not in self._arrays:
            if not self._is_current():
                raise StaleFrameError(
                    f"frame {self.number} was not asked for its {name} before the simulation went on; "
                    f"read frame.{name} before the next step"
                )
            self._arrays[name] = self._core.read(name)
        return self._arrays[name]

    position = property(lambda self: self.read("position"), doc="(N, 3) float32, m")
    velocity = property(lambda self: self.read("velocity"), doc="(N, 3) float32, m/s")
    acceleration = property(lambda self: self.read("acceleration"), doc="(N, 3) float32, m/s^2")
    force = property(lambda self: self.read("force"), doc="(N, 3) float32, N: what set_force gave")
    density = property(lambda self: self.read("density"), doc="(N,) float32, kg/m^3")
    pressure = property(lambda self: self.read("pressure"), doc="(N,) float32, Pa")
    mass = property(lambda self: self.read("mass"), doc="(N,) float32, kg")
    id = property(lambda self: self.read("id"), doc="(N,) int32, in order of arrival")

    def __repr__(self) -> str:
        return f"<Frame {self.number}: {self.particle_count} particles at {self.time:.6g} s>"


class Simulation:
    """A fluid that can be stepped frame by frame.

        sim = fontana.Simulation("scenes/box.json", backend="opencl", viscosity="0.3 Pa.s")
        for frame in sim.frames(48):
            print(frame.number, frame.position.mean(axis=0))

    scene      path of a scene file, name of a bundled scene, a dict of the same shape, a Scene; None starts empty
    backend    "auto", "cpu", "cuda", "opencl"; None leaves it to the scene
    overrides  parameters by path or by the last part of it, in SI or as text with a unit: viscosity="300 cP",
               or **{"fluid.viscosity": 0.3, "emitters[0].speed": 2}

    Raises SceneError (one sentence) for a scene that cannot be used. No device is touched before the first step.
    """

    def __init__(
        self,
        scene: str | os.PathLike | Mapping | Scene | None = None,
        backend: str | None = None,
        **overrides: object,
    ):
        if backend is not None:
            overrides["solver.backend"] = backend
        self.scene = load_scene({} if scene is None else scene, overrides)
        self._core = self.scene.build()
        self._generation = 0

    @property
    def core(self) -> _core.Simulation:
        """The library's own object, for what this class does not cover: checkpoints, profiles, limits."""
        return self._core

    @property
    def frame(self) -> int:
        """Frames finished so far."""
        return self._core.frame

    @property
    def particle_count(self) -> int:
        return self._core.particle_count

    @property
    def backend(self) -> str:
        """Where the kernels run: "auto", "cpu", "cuda" or "opencl". Setting it moves the particles there before the
        next frame.

        Raises BadInput for an unknown word; DeviceUnavailable comes with the next step.
        """
        return self._core.get("solver.backend")

    @backend.setter
    def backend(self, name: str) -> None:
        self.set("solver.backend", name)

    @property
    def device(self) -> object:
        """The device in use: backend, name, driver, memory_bytes, compute_units, is_gpu. Starts it if none runs yet."""
        return self._core.device()

    def set(self, name: str, value: object) -> None:
        """Sets a parameter from the next frame on: set("fluid.viscosity", "300 cP"). Numbers are SI.

        Raises BadInput with the nearest name or the allowed range.
        """
        path = find_parameter(name)
        parameter = parameters()[path]
        if parameter.type == "vector" or isinstance(value, str) and parameter.type == "float":
            value = resolve_value(value, parameter, (path,))
        if path == "fluid.viscosity":
            value = dynamic_viscosity(value, self._core.get("fluid.rest_density"))
        self._core.set(path, value)

    def get(self, name: str) -> object:
        """The value of a parameter in SI."""
        return self._core.get(find_parameter(name))

    def add_particles(self, position: object, velocity: object = None, mass: object = None) -> None:
        """Adds particles, at any time between frames.

        position (N, 3) m; velocity (N, 3) m/s, at rest if left out; mass (N,) kg, one that gives the rest density at
        the particle spacing if left out. Anything numpy can make float32 of. Raises BadInput for other shapes, for
        values that are not finite and for masses that are not positive.
        """
        position = _array("position", position, (None, 3))
        count = len(position)
        velocity = None if velocity is None else _array("velocity", velocity, (count, 3))
        mass = None if mass is None else _array("mass", mass, (count,))
        self._generation += 1
        self._core.add_particles(position, velocity, mass)

    def set_force(self, force: object | None) -> None:
        """A force on each particle, (N, 3) newtons in order of id, held until set again; None clears it."""
        self._core.set_force(None if force is None else _array("force", force, (self.particle_count, 3)))

    def push(self, acceleration: Sequence[float], centre: Sequence[float], radius: float) -> None:
        """A hand in the fluid: `acceleration` (m/s^2) at `centre`, fading to nothing at `radius`; 0 takes it out.

        Centre and radius are in the unit of the scene, as positions are. Raises BadInput.
        """
        set_push(self._core, acceleration, centre, radius)

    def step(self, progress: Callable[[float], object] | None = None) -> Frame:
        """Simulates one frame. `progress` gets the finished share after each substep and stops it by an
        answer that is true; None goes on.

        A stop raises Interrupted; the next step finishes that frame. Raises Unstable, OutOfMemory, DeviceUnavailable,
        DeviceLost.
        """
        self._generation += 1
        report = self._core.step_frame(progress or _go_on)
        generation = self._generation
        return Frame(self._core, report, lambda: self._generation == generation)

    def frames(self, count: int | None = None) -> Iterator[Frame]:
        """Simulates and yields `count` frames; without a count, those that the scene's output still asks for.

        Raises BadInput, at the first of them, for a count below 0.
        """
        if count is not None and count < 0:
            raise _core.BadInput(f"frames: expected a count of 0 or more, got {count}")
        remaining = self.scene.frame_count - self.frame if count is None else count
        for _ in range(remaining):
            yield self.step()


def set_push(
    simulation: _core.Simulation, acceleration: Sequence[float], centre: Sequence[float], radius: float
) -> None:
    """`Simulation.push` for the library's own object."""
    scale = simulation.get("time.simulation_scale")
    simulation.set("forces.push", tuple(map(float, acceleration)))
    simulation.set("forces.push_centre", tuple(scale * float(x) for x in centre))
    simulation.set("forces.push_radius", scale * radius)


def _go_on(fraction: float) -> bool:
    """Gives Ctrl-C a chance between substeps: Python handles signals only while its own code runs."""
    return False


def _array(name: str, values: object, shape: tuple[int | None, ...]) -> np.ndarray:
    """A contiguous float32 array of the shape, where None is any length. Raises BadInput."""
    try:
        array = np.ascontiguousarray(values, dtype=np.float32)
    except (TypeError, ValueError) as error:
        raise _core.BadInput(f"{name}: expected numbers of shape {_shape_text(shape)}") from error
    if array.ndim != len(shape) or any(want not in (None, got) for want, got in zip(shape, array.shape, strict=True)):
        raise _core.BadInput(f"{name}: expected shape {_shape_text(shape)}, got {_shape_text(array.shape)}")
    return array


def _shape_text(shape: tuple[int | None, ...]) -> str:
    return str(tuple("N" if length is None else length for length in shape)).replace("'", "")
