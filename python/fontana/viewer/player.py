"""A cache that is played: a thread reads ahead while the window shows the frame whose turn it is."""

from __future__ import annotations

import threading
import time
from pathlib import Path

from fontana import _core
from fontana.gl.footage import Footage
from fontana.runs.cache import Cache
from fontana.viewer.settings import Settings
from fontana.viewer.snapshot import Snapshot

_READ_AHEAD = 8  # frames
_MOST_BYTES = 2**30  # of frames kept in memory
_BYTES_PER_PARTICLE = 44


class CachePlayer:
    """Plays the run in `folder`. Raises BadInput if there is none. Methods are the window's thread's.

    numbers   the frames there are
    skipped   those that could not be read, each with its sentence
    loops     whether it begins anew after the last frame
    """

    is_live = False
    fraction = None
    failure = None

    def __init__(self, folder: Path, is_playing: bool = True):
        self.cache = Cache(folder)
        self.footage = Footage(self.cache)
        self.scene = self.cache.scene
        self.settings = Settings(self.scene)
        self.numbers = self.cache.frames
        self.skipped: dict[int, str] = {}
        self.loops = True
        self.is_playing = is_playing
        self.frames_per_second = self.cache.frame_rate
        self._number = self.numbers[0]
        self._shown: Snapshot | None = None
        self._loaded: dict[int, Snapshot] = {}
        self._last_turn = time.monotonic()
        self._is_closing = False
        self._condition = threading.Condition()
        self._thread = threading.Thread(target=self._read_ahead, name="cache reader", daemon=True)
        self._thread.start()

    @property
    def frame_rate(self) -> float:
        """Frames a second at which it looks natural."""
        return self.cache.frame_rate

    @property
    def number(self) -> int:
        """The frame whose turn it is; it may still be on its way."""
        return self._number

    @property
    def snapshot(self) -> Snapshot | None:
        """The frame whose turn it is, or until it is read the one before. None if there is no sound frame at all."""
        with self._condition:
            self._leave_skipped()
            self._shown = self._loaded.get(self._number, self._shown)
            return self._shown

    def set_playing(self, is_playing: bool) -> None:
        self.is_playing = is_playing
        self._last_turn = time.monotonic()

    def step(self, count: int = 1) -> None:
        """Goes `count` frames on, or back, and stays paused."""
        self.is_playing = False
        self._go(self._moved(count))

    def restart(self) -> None:
        self._go(self.numbers[0])

    def seek(self, number: int) -> None:
        """Goes to a frame, or the nearest there is."""
        self._go(min(self.numbers, key=lambda known: abs(known - number)))

    def tick(self, now: float) -> None:
        """Moves on if it is time; `now` is time.monotonic(). A frame that is still being read is waited for."""
        turns = int((now - self._last_turn) * self.frames_per_second)
        if not self.is_playing or turns < 1:
            return
        with self._condition:
            is_ready = self._number in self._loaded or self._number in self.skipped
        if not is_ready:
            self._last_turn = now
            return
        self._last_turn += turns / self.frames_per_second
        if self._number == self.numbers[-1]:
            if not self.loops:
                self.is_playing = False
                return
            self.restart()
            return
        self._go(self._moved(turns))

    def close(self) -> None:
        """Ends the thread."""
        with self._condition:
            self._is_closing = True
            self._condition.notify()
        self._thread.join()

    def _moved(self, count: int) -> int:
        index = self.numbers.index(self._number) + count
        return self.numbers[max(0, min(index, len(self.numbers) - 1))]

    def _go(self, number: int) -> None:
        with self._condition:
            self._number = number
            self._condition.notify()

    def _leave_skipped(self) -> None:
        """A frame that cannot be read gives its turn to the next sound one, or the last."""
        if self._number in self.skipped and len(self.skipped) < len(self.numbers):
            sound = [number for number in self.numbers if number not in self.skipped]
            self._number = next((number for number in sound if number > self._number), sound[-1])
            self._condition.notify()

    # ---- the thread

    def _read_ahead(self) -> None:
        while True:
            with self._condition:
                number = self._next_to_read()
                while number is None and not self._is_closing:
                    self._condition.wait()
                    number = self._next_to_read()
                if self._is_closing:
                    return
            self._load(number)

    def _next_to_read(self) -> int | None:
        start = self.numbers.index(self._number)
        ahead = (self.numbers + self.numbers)[start : start + min(_READ_AHEAD, len(self.numbers))]
        return next((number for number in ahead if number not in self._loaded and number not in self.skipped), None)

    def _load(self, number: int) -> None:
        start = time.monotonic()
        try:
            data = self.footage.load(number)
        except (_core.FontanaError, KeyError, MemoryError) as error:
            with self._condition:
                self.skipped[number] = f"frame {number} is skipped: {error}"
            return
        phases = {"read": time.monotonic() - start}
        record = self.cache.record(number)
        if "seconds" in record:
            phases = {"simulate": record["seconds"]} | phases
        with self._condition:
            self._loaded[number] = Snapshot(number, data.time, data, record, "", phases)
            self._forget_distant()

    def _forget_distant(self) -> None:
        """Frees the frames whose turn comes last while there are too many."""
        held = sum(_BYTES_PER_PARTICLE * snapshot.data.particle_count for snapshot in self._loaded.values())
        by_turn = sorted(self._loaded, key=lambda number: (number - self._number) % (self.numbers[-1] + 1))
        while held > _MOST_BYTES and len(by_turn) > _READ_AHEAD:
            held -= _BYTES_PER_PARTICLE * self._loaded.pop(by_turn.pop()).data.particle_count
