"""What a run says while it runs: a bar for people at a terminal, lines for logs, JSON lines for programs."""

from __future__ import annotations

import sys
import time
from collections import deque

from rich.console import Group
from rich.live import Live
from rich.progress import BarColumn, Progress, TextColumn
from rich.text import Text

from fontana import _core
from fontana.bench import print_table
from fontana.launch_profile import profile_notes, profile_table
from fontana.runs.folder import RunFolder
from fontana.runs.manifest import MANIFEST_NAME, Manifest
from fontana.runs.standard_output import OutputConsole, print_json, printing
from fontana.runs.text import clock, describe_device, describe_fluid, frame_details, length, pace_text
from fontana.scene import Scene

_RATE_WINDOW = 8  # frames over which speed and remaining time are averaged


class Reporter:
    """Says nothing; the base of the others, and what --quiet uses."""

    def note(self, sentence: str) -> None:
        """Something an artist should know."""

    def start(self, scene: Scene, simulation: _core.Simulation, folder: RunFolder, done: int) -> None:
        """The run begins after `done` finished frames."""

    def substep(self, fraction: float) -> None:
        """A share of the present frame is done."""

    def frame(self, record: dict, frame_count: int) -> None:
        """A frame is on disk; `record` is its entry in run.json."""

    def finish(self, simulation: _core.Simulation, folder: RunFolder, manifest: Manifest, advice: str) -> None:
        """All frames are on disk; `advice` is a command to try next."""

    def close(self) -> None:
        """Leaves the terminal as it was; safe to call twice."""


class JsonReporter(Reporter):
    """One JSON object a line: {"event": "start" | "note" | "frame" | "profile" | "finish" | "error", ...}."""

    def note(self, sentence: str) -> None:
        print_json("note", message=sentence)

    def start(self, scene: Scene, simulation: _core.Simulation, folder: RunFolder, done: int) -> None:
        device = simulation.device()
        print_json(
            "start",
            scene=scene.name,
            out=str(folder.path),
            frames=scene.frame_count,
            done=done,
            backend=device.backend,
            device=device.name,
            final_particle_count=simulation.emitted_by(scene.frame_count),
        )

    def frame(self, record: dict, frame_count: int) -> None:
        print_json("frame", **record)

    def finish(self, simulation: _core.Simulation, folder: RunFolder, manifest: Manifest, advice: str) -> None:
        if "profile" in manifest.data:
            print_json("profile", **manifest.data["profile"])
        print_json("finish", frames=len(manifest.frames), manifest=str(folder.path / MANIFEST_NAME))


class LineReporter(Reporter):
    """A line a frame: for logs, and wherever there is no terminal."""

    def __init__(self) -> None:
        self.console = OutputConsole(highlight=False)
        self._pace = Pace()

    def note(self, sentence: str) -> None:
        self.print(f"note: {sentence}")

    def start(self, scene: Scene, simulation: _core.Simulation, folder: RunFolder, done: int) -> None:
        count = simulation.emitted_by(scene.frame_count)
        self._pace = Pace(count)
        spacing = length(simulation.get("fluid.particle_spacing"))
        self.print(f"{scene.name}: {scene.frame_count} frames, {count:,} particles at the last, {spacing} apart")
        self.print(f"fluid: {describe_fluid(simulation)}")
        self.print(f"device: {describe_device(simulation)}")

    def frame(self, record: dict, frame_count: int) -> None:
        self._pace.add(record)
        width = len(str(frame_count))
        pace = pace_text(self._pace.rate, self._pace.remaining(frame_count))
        self.print(f"frame {record['frame']:{width}d}/{frame_count}  {frame_details(record)}  {pace}")

    def finish(self, simulation: _core.Simulation, folder: RunFolder, manifest: Manifest, advice: str) -> None:
        seconds = sum(frame.get("seconds", 0.0) for frame in manifest.frames)
        work = sum(frame.get("particles", 0) * frame.get("substeps", 0) for frame in manifest.frames)
        speed = f": {work / seconds / 1e6:.2f} M particle-substeps/s" if seconds > 0 else ""
        frames = len(manifest.frames)
        self.print("")
        self.print(f"done: {frames} frames in {clock(seconds)} on {describe_device(simulation)}{speed}")
        self.print(f"  frames   {folder.frame_path(1, manifest.data['formats'][0])} to {frames:04d}")
        if folder.picture_path.exists():
            self.print(f"  picture  {folder.picture_path}")
        self.print(f"  report   {folder.path / MANIFEST_NAME}")
        self._print_profile(manifest)
        self.print(f"next: {advice}")

    def _print_profile(self, manifest: Manifest) -> None:
        if "profile" not in manifest.data:
            return
        self.print("")
        print_table("", *profile_table(manifest.data["profile"]))
        for note in profile_notes(manifest.data["profile"]):
            self.print(note)

    def print(self, text: str) -> None:
        with printing():
            self.console.print(text, markup=False, soft_wrap=True)


class BarReporter(LineReporter):
    """A bar on a terminal, under it what the last frame was like."""

    def __init__(self) -> None:
        super().__init__()
        # Colours that every terminal has: of 16, the usual ones make a full bar as grey as an empty one.
        bar = BarColumn(bar_width=32, complete_style="cyan", finished_style="green")
        columns = (TextColumn("{task.description}"), bar, TextColumn("{task.fields[pace]}"))
        self._progress = Progress(*columns, console=self.console)
        self._details = Text("", style="dim")
        self._live = Live(Group(self._progress, self._details), console=self.console, refresh_per_second=8)
        self._task = self._progress.add_task("first frame", total=None, pace="")
        self._done = 0

    def start(self, scene: Scene, simulation: _core.Simulation, folder: RunFolder, done: int) -> None:
        super().start(scene, simulation, folder, done)
        self._done = done
        self._progress.update(self._task, total=scene.frame_count, completed=done)
        self._live.start()

    def substep(self, fraction: float) -> None:
        self._progress.update(self._task, completed=self._done + fraction)

    def frame(self, record: dict, frame_count: int) -> None:
        self._pace.add(record)
        self._done = record["frame"]
        pace = pace_text(self._pace.rate, self._pace.remaining(frame_count))
        label = f"frame {self._done}/{frame_count}"
        self._progress.update(self._task, completed=self._done, description=label, pace=pace)
        self._details.plain = frame_details(record)

    def close(self) -> None:
        self._live.stop()

    def finish(self, simulation: _core.Simulation, folder: RunFolder, manifest: Manifest, advice: str) -> None:
        self.close()
        super().finish(simulation, folder, manifest, advice)


class Pace:
    """Speed over the last frames, and how long the rest will take at it."""

    def __init__(self, final_particle_count: int = 0) -> None:
        self._final_particle_count = final_particle_count
        self._recent: deque[tuple[dict, float]] = deque(maxlen=_RATE_WINDOW)
        self._clock = time.monotonic()

    def add(self, record: dict) -> None:
        now = time.monotonic()
        self._recent.append((record, now - self._clock))
        self._clock = now

    @property
    def rate(self) -> float:
        """Particle-substeps a second, of the simulation alone."""
        seconds = sum(record["seconds"] for record, _ in self._recent)
        return _work(self._recent) / seconds if seconds > 0 else 0.0

    def remaining(self, frame_count: int) -> float:
        """Seconds, writing included. Particles are taken to grow evenly to their final count."""
        elapsed, work = sum(seconds for _, seconds in self._recent), _work(self._recent)
        if not self._recent or work == 0:
            return 0.0
        record = self._recent[-1][0]
        substeps = sum(record["substeps"] for record, _ in self._recent) / len(self._recent)
        particles = 0.5 * (record["particles"] + max(self._final_particle_count, record["particles"]))
        return (frame_count - record["frame"]) * substeps * particles * elapsed / work


def _work(recent: deque[tuple[dict, float]]) -> int:
    return sum(record["particles"] * record["substeps"] for record, _ in recent)


def make_reporter(as_json: bool, quiet: bool) -> Reporter:
    """The one that fits where the output goes."""
    if as_json:
        return JsonReporter()
    if quiet:
        return Reporter()
    return BarReporter() if sys.stdout.isatty() else LineReporter()
