"""What `fontana render` says while it draws: a bar at a terminal, lines for logs, JSON lines for programs."""

from __future__ import annotations

import json
import sys
import time

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from fontana.render.job import Report
from fontana.runs.text import clock, data_size


class Reporter:
    """Says nothing; the base of the others, and what --quiet uses."""

    def frame(self, frame: int, reason: str) -> None:
        """A frame is done; `reason` says why it was skipped, or is "" if it was not."""

    def finish(self, report: Report) -> None:
        """All frames are done."""

    def close(self) -> None:
        """Leaves the terminal as it was; safe to call twice."""


class JsonReporter(Reporter):
    """One JSON object a line: {"event": "frame" | "skipped" | "finish", ...}."""

    def frame(self, frame: int, reason: str) -> None:
        self._emit("skipped", frame=frame, message=reason) if reason else self._emit("frame", frame=frame)

    def finish(self, report: Report) -> None:
        self._emit(
            "finish",
            drawn=len(report.drawn),
            found=len(report.found),
            skipped=sorted(report.skipped),
            files=[str(path) for path in report.files],
        )

    def _emit(self, event: str, **values: object) -> None:
        print(json.dumps({"event": event} | values), flush=True)


class LineReporter(Reporter):
    """A line a frame."""

    def __init__(self, frame_count: int) -> None:
        self.console = Console(highlight=False, soft_wrap=True)
        self._count, self._done = frame_count, 0
        self._begin = time.monotonic()

    def frame(self, frame: int, reason: str) -> None:
        self._done += 1
        remaining = (time.monotonic() - self._begin) / self._done * (self._count - self._done)
        text = f"skipped: {reason}" if reason else f"ETA {clock(remaining)}"
        self.print(f"picture {self._done:{len(str(self._count))}d}/{self._count}  frame {frame}  {text}")

    def finish(self, report: Report) -> None:
        found = f", {len(report.found)} were there" if report.found else ""
        self.print(f"done: {len(report.drawn)} drawn{found} in {clock(time.monotonic() - self._begin)}")
        if report.skipped:
            self.print(f"  skipped  {', '.join(map(str, sorted(report.skipped)))}: missing or damaged")
        if report.files:
            more = f" to {report.files[-1].name}" if len(report.files) > 1 else ""
            size = data_size(sum(path.stat().st_size for path in report.files))
            self.print(f"  written  {report.files[0]}{more} ({size})")

    def print(self, text: str) -> None:
        self.console.print(text, markup=False)


class BarReporter(LineReporter):
    """A bar at a terminal; what was skipped stays above it."""

    def __init__(self, frame_count: int) -> None:
        super().__init__(frame_count)
        columns = (
            TextColumn("{task.description}"),
            BarColumn(bar_width=32),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
        )
        self._progress = Progress(*columns, console=self.console)
        self._task = self._progress.add_task("rendering", total=frame_count)
        self._progress.start()

    def frame(self, frame: int, reason: str) -> None:
        if reason:
            self.print(f"frame {frame} is skipped: {reason}")
        self._progress.advance(self._task)

    def finish(self, report: Report) -> None:
        self.close()
        super().finish(report)

    def close(self) -> None:
        self._progress.stop()


def make_reporter(as_json: bool, quiet: bool, frame_count: int) -> Reporter:
    """The one that fits where the output goes."""
    if as_json:
        return JsonReporter()
    if quiet:
        return Reporter()
    return BarReporter(frame_count) if sys.stdout.isatty() else LineReporter(frame_count)
