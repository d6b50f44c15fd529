"""What making files out of a cache says: a bar at a terminal, a line a frame in a log, JSON lines for programs."""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from pathlib import Path

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from fontana.runs.standard_output import OutputConsole, print_json, printing
from fontana.runs.text import clock, data_size


class Quiet:
    """Says nothing; the base of the others."""

    def note(self, sentence: str) -> None:
        """Something the user should know."""

    def start(self, what: str, total: int, done: int) -> None:
        """`total` frames are asked for, of which `done` are there."""

    def frame(self, entry: dict) -> None:
        """A frame is done: {"frame": ..., "text": what it is like, ...}."""

    def skip(self, frame: int, reason: str) -> None:
        """A frame cannot be read."""

    def finish(self, files: Sequence[Path]) -> None:
        """All is on disk, in these files."""

    def close(self) -> None:
        """Leaves the terminal as it was; safe to call twice."""


class Lines(Quiet):
    """A line a frame."""

    def __init__(self) -> None:
        self.console = OutputConsole(highlight=False, soft_wrap=True)
        self._begin, self._made, self._left, self._total = time.monotonic(), 0, 0, 0

    def note(self, sentence: str) -> None:
        self._print(f"note: {sentence}")

    def start(self, what: str, total: int, done: int) -> None:
        self._begin, self._total, self._left = time.monotonic(), total, total - done
        there = f", {done} of them there already" if done else ""
        self._print(f"{what}: {total} frame{'s' * (total != 1)}{there}")

    def frame(self, entry: dict) -> None:
        self._made, self._left = self._made + 1, self._left - 1
        remaining = (time.monotonic() - self._begin) / self._made * self._left
        self._print(f"frame {entry['frame']:4d}  {entry['text']}  ETA {clock(remaining)}")

    def skip(self, frame: int, reason: str) -> None:
        self._left -= 1
        self.note(f"frame {frame} is skipped: {reason}")

    def finish(self, files: Sequence[Path]) -> None:
        self.close()
        seconds = time.monotonic() - self._begin
        self._print(f"done: {self._made} of {self._total} frames made now, in {clock(seconds)}")
        self._print(f"  files  {_describe(files)}")

    def _print(self, text: str) -> None:
        with printing():
            self.console.print(text, markup=False)


class Bar(Lines):
    """A bar on a terminal; what is skipped stays above it."""

    def __init__(self) -> None:
        super().__init__()
        columns = (TextColumn("{task.description}"), BarColumn(bar_width=32), MofNCompleteColumn())
        self._progress = Progress(
            *columns, TimeRemainingColumn(), TextColumn("{task.fields[text]}"), console=self.console
        )
        self._task = self._progress.add_task("first frame", total=None, text="")

    def start(self, what: str, total: int, done: int) -> None:
        super().start(what, total, done)
        self._progress.update(self._task, total=total, completed=done)
        self._progress.start()

    def frame(self, entry: dict) -> None:
        self._made += 1
        self._progress.update(self._task, advance=1, description=f"frame {entry['frame']}", text=entry["text"])

    def skip(self, frame: int, reason: str) -> None:
        super().skip(frame, reason)
        self._progress.advance(self._task)

    def close(self) -> None:
        self._progress.stop()


class Json(Quiet):
    """One JSON object a line: {"event": "start" | "note" | "frame" | "skipped" | "finish" | "error", ...}."""

    def note(self, sentence: str) -> None:
        print_json("note", message=sentence)

    def start(self, what: str, total: int, done: int) -> None:
        print_json("start", what=what, frames=total, done=done)

    def frame(self, entry: dict) -> None:
        print_json("frame", **{name: value for name, value in entry.items() if name != "text"})

    def skip(self, frame: int, reason: str) -> None:
        print_json("skipped", frame=frame, message=reason)

    def finish(self, files: Sequence[Path]) -> None:
        print_json("finish", files=[str(path) for path in files])


def _describe(files: Sequence[Path]) -> str:
    """ "water/w.0001.ply to w.0048.ply (3.2 MB)"."""
    last = f" to {files[-1].name}" if len(files) > 1 else ""
    return f"{files[0]}{last} ({data_size(sum(path.stat().st_size for path in files))})"


def make_progress(as_json: bool, quiet: bool) -> Quiet:
    """The one that fits where the output goes."""
    if as_json:
        return Json()
    if quiet:
        return Quiet()
    return Bar() if sys.stdout.isatty() else Lines()
