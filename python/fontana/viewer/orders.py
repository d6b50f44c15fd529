"""What the window asks of a running simulation, until its thread gets to it."""

from __future__ import annotations

from dataclasses import dataclass, field

# A change of where or how it is computed does not wait for the end of a frame that may take minutes.
_AT_ONCE = "solver."


@dataclass(frozen=True)
class Push:
    """A hand in the fluid, in the scene's unit: acceleration (m/s^2) at `centre`, fading to nothing at `radius`."""

    acceleration: tuple[float, float, float]
    centre: tuple[float, float, float]
    radius: float


@dataclass
class Orders:
    """All of it is read and written under the source's lock.

    values, colliders  changes by path and by index, newest only
    steps              frames to simulate although it is paused
    """

    is_playing: bool = True
    steps: int = 0
    restart: bool = True
    close: bool = False
    push: Push | None = None
    values: dict[str, object] = field(default_factory=dict)
    colliders: dict[int, dict] = field(default_factory=dict)

    def due_values(self, is_within_frame: bool) -> dict[str, object]:
        """The changes that may be made now."""
        return {path: value for path, value in self.values.items() if not is_within_frame or path.startswith(_AT_ONCE)}

    def take_changes(self, is_within_frame: bool) -> tuple[dict[str, object], dict[int, dict]]:
        """The changes that may be made now, which are then no longer due."""
        values = self.due_values(is_within_frame)
        self.values = {path: value for path, value in self.values.items() if path not in values}
        colliders, self.colliders = ({}, self.colliders) if is_within_frame else (self.colliders, {})
        return values, colliders

    def has_changes(self, is_within_frame: bool) -> bool:
        return bool(self.due_values(is_within_frame)) or bool(self.colliders and not is_within_frame)

    @property
    def wants_frames(self) -> bool:
        return self.is_playing or self.steps > 0

    @property
    def wants_a_stop(self) -> bool:
        """Whether a frame in the making should be left: it is finished later, or never if all begins anew."""
        return self.close or self.restart or not self.wants_frames or bool(self.due_values(is_within_frame=True))
