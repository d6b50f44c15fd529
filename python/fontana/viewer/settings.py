"""The parameters and colliders that the user turns: checked at once, whatever the simulation is doing."""

from __future__ import annotations

import copy

from fontana import _core
from fontana.scene import Scene
from fontana.tables import COLLIDERS, parameters

# Particles in flight were made with the former value of these.
FROM_THE_START = ("fluid.particle_spacing", "time.simulation_scale")


class Settings:
    """A scene and what was changed in it.

    Values live in a simulation of their own that never steps and touches no device: it checks each of them as the
    running one will, and never makes the user wait for a frame.
    """

    def __init__(self, scene: Scene):
        self.scene = scene
        self._core = scene.build()
        self._original = {path: self._core.get(path) for path in parameters()}
        self.colliders = [with_defaults(collider) for collider in scene.colliders]
        self._original_colliders = copy.deepcopy(self.colliders)

    def get(self, path: str) -> object:
        """The value of a parameter in SI."""
        return self._core.get(path)

    def set(self, path: str, value: object) -> None:
        """Raises BadInput with one sentence, and keeps the former value."""
        self._core.set(path, value)

    def set_collider(self, index: int, field: str, value: object) -> None:
        """Changes a field of collider `index`. Raises BadInput with one sentence, and keeps the former value."""
        changed = self.colliders[index] | {field: value}
        self._core.set_collider(index, **surface(changed))
        self.colliders[index] = changed

    def is_changed(self, path: str) -> bool:
        return self.get(path) != self._original[path]

    def original(self, path: str) -> object:
        """The value that the scene gives a parameter."""
        return self._original[path]

    def is_collider_changed(self, index: int) -> bool:
        return self.colliders[index] != self._original_colliders[index]

    def changes(self) -> dict[str, object]:
        """The parameters that differ from the scene's."""
        return {path: self.get(path) for path in self._original if self.is_changed(path)}

    def complaint(self) -> str:
        """Why the present values cannot be integrated stably; "" if they can."""
        try:
            self._core.check()
        except _core.FontanaError as error:
            return str(error)
        return ""

    def derived(self) -> object:
        """What the solver works out from the values: support_radius, particle_mass, ..."""
        return self._core.derived()

    def build(self) -> _core.Simulation:
        """A simulation of the scene with all changes, before its first frame. Raises BadInput."""
        simulation = self.scene.build()
        for path, value in self.changes().items():
            simulation.set(path, value)
        for index, collider in enumerate(self.colliders):
            simulation.set_collider(index, **surface(collider))
        return simulation


def with_defaults(collider: dict) -> dict:
    """A collider of a scene with every field of its type spelled out."""
    defaults = _core.collider_defaults(collider["type"])
    return {field.name: defaults[field.name] for field in COLLIDERS[collider["type"]]} | copy.deepcopy(collider)


def surface(collider: dict) -> dict:
    """The fields that the library's set_collider takes: no label, no keys."""
    return {"type": collider["type"]} | {field.name: collider[field.name] for field in COLLIDERS[collider["type"]]}
