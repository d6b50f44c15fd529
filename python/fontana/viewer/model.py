"""What the user has chosen, and what can be asked of the viewer. No window, no OpenGL."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping

import numpy as np

from fontana import _core
from fontana.gl.camera import Camera
from fontana.gl.frame_data import COLOR_UNITS, Look
from fontana.tables import parameters
from fontana.viewer.bounds import worth_seeing
from fontana.viewer.grip import Grip
from fontana.viewer.messages import Messages
from fontana.viewer.value_range import steady_range

SPEEDS = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0, math.inf)
THESIS_FRAME_RATE = 24.0  # "Frames per second limited to a maximum of 24": the captions of Figs. 15, 16, 19 and 20


class ViewerModel:
    """Everything about the window but the window.

    source  a LiveSource or a CachePlayer
    camera  where one looks from
    look    how it is drawn
    """

    def __init__(self, source: object):
        self.source = source
        self.look = Look(style="points", color_by="speed")
        self.grip = Grip()
        self.messages = Messages()
        self.speed = 1.0
        self.is_capped = False
        self.shows_panel = source.is_live
        self.shows_statistics = True
        self.shows_colliders = True
        self.shows_keys = False
        self.is_open = True
        self.is_screenshot_due = self.is_window_shot_due = False
        self.is_recording = False
        self.aspect = 16 / 9
        self.snapshot = source.snapshot
        self.stage_version = 0  # raised when colliders are to be drawn anew
        self._ranges: dict[str, tuple[float, float]] = {}
        self._told: set[object] = set()
        self.camera = self._scene_camera()
        self._pace()

    # ---- each time the window draws

    def update(self) -> None:
        """Moves a cache on, says what went wrong since, and takes up the frame that all of this turn shows."""
        if not self.source.is_live:
            self.source.tick(time.monotonic())
            for number in sorted(set(self.source.skipped) - self._told):
                self._told.add(number)
                self.messages.say(self.source.skipped[number], is_error=True)
        self.snapshot = self.source.snapshot

    @property
    def colliders(self) -> list[dict]:
        """Those to be drawn."""
        if not self.shows_colliders:
            return []
        return self.source.settings.colliders if self.source.is_live else self.source.scene.colliders

    def bounds(self) -> np.ndarray:
        """The box (2, 3) of what is worth seeing."""
        snapshot = self.snapshot
        position = snapshot.data.position if snapshot else np.zeros((0, 3), np.float32)
        return worth_seeing(self.source.scene, position)

    def color_range(self) -> tuple[float, float]:
        """The values at the ends of the colour map: they widen at once and narrow only when they are far too wide."""
        name, snapshot = self.look.color_by, self.snapshot
        if snapshot and snapshot.data.particle_count:
            self._ranges[name] = steady_range(self._ranges.get(name), snapshot.data.value_range(name))
        return self._ranges.get(name, (0.0, 1.0))

    # ---- playing

    def toggle_playing(self) -> None:
        self.source.set_playing(not self.source.is_playing)

    def step_forward(self) -> None:
        self.source.step(1)

    def step_back(self) -> None:
        if self.source.is_live:
            self.messages.say("a simulation does not go back; R restarts it")
        else:
            self.source.step(-1)

    def restart(self) -> None:
        self._ranges.clear()
        self.source.restart()

    def faster(self) -> None:
        self.set_speed(SPEEDS[min(SPEEDS.index(self.speed) + 1, len(SPEEDS) - 1)])

    def slower(self) -> None:
        self.set_speed(SPEEDS[max(SPEEDS.index(self.speed) - 1, 0)])

    def set_speed(self, speed: float) -> None:
        """Seconds of the fluid in a second of the clock; math.inf: as fast as it goes."""
        self.speed = speed
        self._pace()

    def set_capped(self, is_capped: bool) -> None:
        """At most 24 frames a second, as in the thesis's tables."""
        self.is_capped = is_capped
        self._pace()

    def _pace(self) -> None:
        most = THESIS_FRAME_RATE if self.is_capped else math.inf
        wanted = self.source.frame_rate * self.speed
        if not self.source.is_live and math.isinf(wanted):
            wanted = 1000.0  # a cache always has the next frame: more than any screen shows
        self.source.frames_per_second = min(most, wanted)

    # ---- the simulation

    def set(self, path: str, value: object) -> None:
        """Changes a parameter; a value that is refused becomes a message."""
        self._try(lambda: self.source.set(path, value))
        self._pace()

    def set_collider(self, index: int, field: str, value: object) -> None:
        """Changes a field of a collider; a value that is refused becomes a message."""
        self._try(lambda: self.source.set_collider(index, field, value))
        self.stage_version += 1

    def absent_choices(self, path: str) -> Mapping[str, str]:
        """Words of a parameter that cannot be taken, each with the reason."""
        return self.source.absent_choices(path) if self.source.is_live else {}

    def next_backend(self) -> None:
        self._next_choice("solver.backend")

    def next_neighbors(self) -> None:
        self._next_choice("solver.neighbors")

    def _next_choice(self, path: str) -> None:
        if not self.source.is_live:
            self.messages.say("a cache is played, not computed: there is nothing to switch")
            return
        choices, absent = parameters()[path].choices, self.absent_choices(path)
        now = choices.index(self.source.settings.get(path))
        choice = next(word for word in choices[now + 1 :] + choices[: now + 1] if word not in absent)
        self.set(path, choice)
        self.messages.say(f"{parameters()[path].label}: {choice}")

    def _try(self, change: object) -> None:
        try:
            change()
        except _core.FontanaError as error:
            self.messages.say(str(error), is_error=True)

    # ---- the hand

    def take(self, pixel: tuple[float, float], size: tuple[int, int]) -> None:
        """The mouse goes down on the fluid."""
        if not self.source.is_live:
            self.messages.say("a cache cannot be pushed; view its scene to play with the fluid")
        elif self.snapshot:
            data = self.snapshot.data
            self.grip.take(*self.camera.ray(pixel, size), data.position, 2.0 * data.radius)

    def drag(self, pixel: tuple[float, float], size: tuple[int, int]) -> None:
        if self.grip.centre is not None:
            self.grip.move(*self.camera.ray(pixel, size), self.camera)
            self.source.push(self.grip.push())

    def release(self) -> None:
        if self.grip.centre is not None:
            self.grip.release()
            self.source.push(None)

    # ---- what one sees

    def frame_all(self) -> None:
        self.camera.frame_all(self.bounds(), self.aspect)

    def scene_view(self) -> None:
        self.camera = self._scene_camera()

    def _scene_camera(self) -> Camera:
        return Camera.of_scene(self.source.scene.view, worth_seeing(self.source.scene, np.zeros((0, 3))))

    def draw_points(self) -> None:
        self.look.style = "points"

    def draw_fluid(self) -> None:
        self.look.style = "fluid"

    def next_color(self) -> None:
        names = list(COLOR_UNITS)
        self.look.color_by = names[(names.index(self.look.color_by) + 1) % len(names)]
        self.draw_points()

    def toggle_colliders(self) -> None:
        self.shows_colliders = not self.shows_colliders
        self.stage_version += 1

    def toggle_panel(self) -> None:
        self.shows_panel = not self.shows_panel

    def toggle_statistics(self) -> None:
        self.shows_statistics = not self.shows_statistics

    def toggle_keys(self) -> None:
        self.shows_keys = not self.shows_keys

    # ---- files, and the end

    def ask_for_screenshot(self) -> None:
        self.is_screenshot_due = True

    def ask_for_window_shot(self) -> None:
        self.is_window_shot_due = True

    def toggle_movie(self) -> None:
        self.is_recording = not self.is_recording

    def quit(self) -> None:
        self.is_open = False
