"""A simulation that runs in a thread of its own while the window shows its latest frame."""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

from fontana import _core
from fontana.backends import absent_backends, absent_neighbors
from fontana.exit_codes import sentence
from fontana.formats import particle_radius
from fontana.gl.frame_data import FrameData
from fontana.runs.runner import frame_record
from fontana.scene import Scene
from fontana.simulation import set_push
from fontana.tables import parameters
from fontana.viewer.orders import Orders, Push
from fontana.viewer.rates import SchemeRates
from fontana.viewer.settings import FROM_THE_START, Settings, surface
from fontana.viewer.snapshot import Snapshot

_ATTRIBUTES = ("position", "velocity", "density", "pressure", "id")
# After these the state of the particles is sound: another value, or another device, and it goes on.
_MENDABLE = (_core.BadInput, _core.DeviceUnavailable)


@dataclass(frozen=True)
class Failure:
    """Why the simulation stands still, and whether only a restart helps."""

    sentence: str
    is_final: bool


class LiveSource:
    """Simulates `scene`. Methods are the window's thread's; none of them waits for a frame.

    settings  the parameters and colliders; change them through `set` and `set_collider`
    rates     frames a second by scheme
    """

    is_live = True

    def __init__(self, scene: Scene, is_playing: bool = True):
        self.scene = scene
        self.settings = Settings(scene)
        self.rates = SchemeRates()
        self._devices = _core.devices()
        self._chosen = {word: _core.choose_device(word) for word in parameters()["solver.backend"].choices}
        self.frames_per_second = float("inf")  # at most
        self._condition = threading.Condition()
        self._orders = Orders(is_playing=is_playing)
        self._snapshot: Snapshot | None = None
        self._failure: Failure | None = None
        self._fraction: float | None = None
        self._simulation: _core.Simulation | None = None
        self._profile: dict[str, float] = {}
        self._due = 0.0
        self._thread = threading.Thread(target=self._run, name="simulation", daemon=True)
        self._thread.start()

    # ---- what the window reads

    @property
    def snapshot(self) -> Snapshot | None:
        """The latest frame; None until the simulation is made."""
        return self._snapshot

    @property
    def failure(self) -> Failure | None:
        return self._failure

    @property
    def is_playing(self) -> bool:
        return self._orders.is_playing

    @property
    def fraction(self) -> float | None:
        """The finished share of the frame in the making; None between frames."""
        return self._fraction

    @property
    def frame_rate(self) -> float:
        """Frames a second at which it looks natural."""
        return 1.0 / self.settings.derived().frame_duration

    def absent_choices(self, path: str) -> dict[str, str]:
        """Words of a parameter that the rest of the settings or this machine cannot have, each with the reason."""
        if path == "solver.backend":
            return absent_backends(self._devices)
        device = self._chosen[self.settings.get("solver.backend")]
        if path == "solver.neighbors" and device.available:
            return absent_neighbors(device, self.settings.get("fluid.method"))
        return {}

    # ---- what the window asks for

    def set_playing(self, is_playing: bool) -> None:
        self._order(is_playing=is_playing)
        if is_playing and self._failure and not self._failure.is_final:
            self._try_again()

    def step(self, count: int = 1) -> None:
        """Simulates `count` more frames and stays paused; a simulation does not go back."""
        if count > 0:
            self._order(is_playing=False, steps=count)

    def restart(self) -> None:
        """From the start, with all changes."""
        self._order(restart=True)

    def set(self, path: str, value: object) -> None:
        """Changes a parameter as soon as it can be. Raises BadInput and changes nothing if the value is refused."""
        self.settings.set(path, value)
        if path in FROM_THE_START:
            return
        with self._condition:
            self._orders.values[path] = self.settings.get(path)
        self._try_again()

    def set_collider(self, index: int, field: str, value: object) -> None:
        """Changes a field of a collider. Raises BadInput and changes nothing if the value is refused."""
        self.settings.set_collider(index, field, value)
        with self._condition:
            self._orders.colliders[index] = surface(self.settings.colliders[index])
        self._try_again()

    def push(self, push: Push | None) -> None:
        """From the next frame on, until called again; None takes the hand out."""
        self._order(push=push)

    def close(self) -> None:
        """Ends the thread, between two substeps."""
        self._order(close=True)
        self._thread.join()

    def _order(self, **changes: object) -> None:
        with self._condition:
            for name, value in changes.items():
                setattr(self._orders, name, value)
            self._condition.notify()

    def _try_again(self) -> None:
        with self._condition:
            if self._failure and not self._failure.is_final:
                self._failure = None
            self._condition.notify()

    # ---- the thread

    def _run(self) -> None:
        while self._wait():
            try:
                self._obey()
            except _core.Interrupted:
                self.rates.interrupt()
            except Exception as error:  # the thread must live to restart: whatever it is becomes a sentence
                self._failure = Failure(sentence(error), not isinstance(error, _MENDABLE))
                self._fraction = None
                self.rates.interrupt()

    def _wait(self) -> bool:
        """Until there is something to do. False: the window closes."""
        with self._condition:
            while not self._orders.close:
                if self._orders.restart or self._orders.has_changes(self._is_within_frame):
                    return True
                pause = self._seconds_to_next_frame()
                if pause is not None and pause <= 0:
                    return True
                self._condition.wait(pause)
            return False

    def _seconds_to_next_frame(self) -> float | None:
        if self._failure or not self._orders.wants_frames:
            return None
        is_due = self._orders.steps or self._is_within_frame
        return 0.0 if is_due else self._due - time.monotonic()

    @property
    def _is_within_frame(self) -> bool:
        return self._fraction is not None

    def _obey(self) -> None:
        with self._condition:
            restart, self._orders.restart = self._orders.restart, False
            if restart:
                self._orders.values.clear()
                self._orders.colliders.clear()
            values, colliders = self._orders.take_changes(self._is_within_frame)
        if restart:
            self._begin()
        elif self._simulation:
            self._change(values, colliders)
        pause = self._seconds_to_next_frame()
        if self._simulation and pause is not None and pause <= 0:
            self._step()

    def _begin(self) -> None:
        self._simulation, self._fraction, self._failure, self._profile = None, None, None, {}
        self.rates.interrupt()
        self._simulation = self.settings.build()
        self._show({}, "", {})

    def _change(self, values: Mapping[str, object], colliders: Mapping[int, dict]) -> None:
        for path, value in values.items():
            self._simulation.set(path, value)
        for index, fields in colliders.items():
            self._simulation.set_collider(index, **fields)
        if colliders:
            data = replace(self._snapshot.data, centres=self._centres(self._snapshot.time))
            self._snapshot = replace(self._snapshot, data=data)

    def _step(self) -> None:
        self._set_push(self._orders.push)
        if not self._is_within_frame:
            self._fraction = 0.0
            self._due = time.monotonic() + 1.0 / self.frames_per_second
        report = self._simulation.step_frame(self._on_substep)
        self._fraction = None
        scheme = f"{self._simulation.device().backend} {self._simulation.get('solver.neighbors')}"
        self._show(frame_record(report), scheme, {"simulate": report.seconds})
        self.rates.note(scheme, time.monotonic(), report.seconds, report.particle_count)
        with self._condition:
            self._orders.steps = max(0, self._orders.steps - 1)
            if not self._orders.is_playing:
                self.rates.interrupt()

    def _on_substep(self, fraction: float) -> bool:
        self._fraction = fraction
        return self._orders.wants_a_stop

    def _set_push(self, push: Push | None) -> None:
        """The hand's, or else what the settings say."""
        if push is not None:
            set_push(self._simulation, push.acceleration, push.centre, push.radius)
            return
        for path in ("forces.push", "forces.push_centre", "forces.push_radius"):
            self._simulation.set(path, self.settings.get(path))

    def _show(self, record: Mapping[str, object], scheme: str, phases: Mapping[str, float]) -> None:
        """Reads the frame and makes it the one to be seen."""
        start = time.monotonic()
        arrays = {name: self._simulation.read(name) for name in _ATTRIBUTES}
        number, now = self._simulation.frame, record.get("time", 0.0)
        radius, density = particle_radius(self._simulation), self._simulation.get("fluid.rest_density")
        data = FrameData(
            **arrays,
            radius=radius,
            rest_density=density,
            centres=self._centres(now),
            time=now,
            simulation_scale=self._simulation.get("time.simulation_scale"),
        )
        phases = dict(phases) | {"read": time.monotonic() - start} | self._kernels()
        self._snapshot = Snapshot(number, now, data, record, scheme, phases)

    def _centres(self, now: float) -> list[tuple[float, float, float]]:
        return [self._simulation.collider_centre(index, now) for index in range(self._simulation.collider_count)]

    def _kernels(self) -> dict[str, float]:
        """Seconds of this frame by launch, where solver.profile is on."""
        if not self._simulation.get("solver.profile"):
            return {}
        before, self._profile = self._profile, {row.name: row.seconds for row in self._simulation.profile()}
        return {name: max(0.0, seconds - before.get(name, 0.0)) for name, seconds in self._profile.items()}
