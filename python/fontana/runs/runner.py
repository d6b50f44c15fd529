"""Runs a scene into a folder, or continues there."""

from __future__ import annotations

import contextlib
import shlex
import time
from dataclasses import dataclass, field
from pathlib import Path

from fontana import _core
from fontana.formats import BYTES_PER_PARTICLE, write_frame
from fontana.launch_profile import profile_of
from fontana.roofline import Gpu
from fontana.runs.estimate import check_memory
from fontana.runs.folder import RunFolder
from fontana.runs.lock import FolderLock
from fontana.runs.manifest import Manifest, hash_text
from fontana.runs.reporters import Reporter
from fontana.runs.stop import StoppedError, StopSignals
from fontana.runs.text import length
from fontana.scene import Scene, changed_keys, digest, physics

DEFAULT_CHECKPOINT_EVERY = 10
_NOTHING_SAVED = -1


@dataclass
class RunOptions:
    """What a run is asked for beside its scene."""

    out: Path
    formats: tuple[str, ...] = ("bgeo",)
    checkpoint_every: int = DEFAULT_CHECKPOINT_EVERY
    restart: bool = False
    accept_changed: bool = False
    picture: bool = True
    gpu: Gpu | None = None  # to estimate the launches of a profiled run for
    variation: list[str] = field(default_factory=list)  # the command so far, to which changes can be added
    command: list[str] = field(default_factory=list)


def run_scene(scene: Scene, options: RunOptions, reporter: Reporter) -> None:
    """Simulates the frames of the scene that are not in the folder yet, and leaves run.json and a picture there.

    Raises StoppedError on Ctrl-C and SIGTERM, and the errors of the library; in each case the frames so far stay, and
    run.json says what happened.
    """
    simulation = scene.build()
    simulation.check()
    _check_source(scene, simulation)
    # Starts the device. What it refuses leaves the frames of a former run alone, with --restart too.
    check_memory(simulation, simulation.emitted_by(scene.frame_count))
    folder = RunFolder(options.out, scene.name)
    folder.create()
    with FolderLock(folder.path) as lock, StopSignals("stopping after this frame and saving a checkpoint") as stop:
        for note in [*lock.notes, *scene.notes]:
            reporter.note(note)
        _Run(scene, simulation, options, folder, reporter, stop).execute()


def _check_source(scene: Scene, simulation: _core.Simulation) -> None:
    if not scene.emitters:
        raise _core.BadInput(f"{scene.name}: the scene has no emitters, so there is nothing to simulate")
    if simulation.emitted_by(scene.frame_count) == 0:
        raise _core.BadInput(f"{scene.name}: no emitter makes a particle by frame {scene.frame_count}")


class _Run:
    def __init__(
        self,
        scene: Scene,
        simulation: _core.Simulation,
        options: RunOptions,
        folder: RunFolder,
        reporter: Reporter,
        stop: StopSignals,
    ):
        self.scene, self.simulation, self.options = scene, simulation, options
        self.folder, self.reporter, self.stop = folder, reporter, stop
        self.resolved = scene.resolved(simulation)
        self.digest = digest(self.resolved)
        self._saved_frame = 0  # the start needs no checkpoint
        self.manifest = self._open_manifest()

    def execute(self) -> None:
        self._preflight()
        self.reporter.start(self.scene, self.simulation, self.folder, len(self.manifest.frames))
        self.manifest.publish()
        try:
            while len(self.manifest.frames) < self.scene.frame_count and not self.stop.requested:
                self._step()
        except _core.Interrupted:
            self._saved_frame = _NOTHING_SAVED  # in mid-frame: the next checkpoint holds the part done
        except (_core.FontanaError, MemoryError) as error:
            self._leave("failed", str(error) or "out of memory")
            raise
        if self.stop.requested:
            self._save_and_stop()
        self._checkpoint()
        self._leave("finished", "")
        self._draw()
        self.reporter.finish(self.simulation, self.folder, self.manifest, self._next_command())

    def _next_command(self) -> str:
        """Something to try after this run: the same with finer particles, or more of it."""
        if not self.options.variation:
            more = str(2 * self.scene.frame_count)
            return shlex.join(["fontana", "resume", str(self.folder.path), "--frames", more])
        spacing = length(0.8 * self.simulation.get("fluid.particle_spacing")).replace(" ", "")
        out = self.folder.path.with_name(f"{self.folder.path.name}_fine")
        finer = ["--set", f"fluid.particle_spacing={spacing}", "--out", str(out)]
        return shlex.join([*self.options.variation, *finer])

    def _open_manifest(self) -> Manifest:
        """The manifest to go on with: that of the run in the folder, cut to its checkpoint, or a new one."""
        if self.options.restart:
            self._clear()
        former = Manifest.load(self.folder.path)
        if former is None:
            self._refuse_foreign_frames()
            return self._new_manifest([])
        self._refuse_changes(former)
        frames = self._continue_from(former)
        if former.data["digest"] != self.digest:
            self._saved_frame = _NOTHING_SAVED  # the old checkpoint carries the old digest, the manifest the new one
            self._checkpoint()
        return self._new_manifest(frames, former)

    def _clear(self) -> None:
        former = None
        with contextlib.suppress(_core.BadInput):  # a damaged run.json is one reason to restart
            former = Manifest.load(self.folder.path)
        self.folder.clear(former)

    def _refuse_foreign_frames(self) -> None:
        foreign = self.folder.foreign_frames()
        if foreign:
            raise _core.BadInput(
                f'"{self.folder.path}" has {foreign[0]} but no run.json that speaks of it; '
                "use another --out, or --restart to replace such files"
            )

    def _refuse_changes(self, former: Manifest) -> None:
        if sorted(former.data["formats"]) != sorted(self.options.formats):
            raise _core.BadInput(
                f'the frames in "{self.folder.path}" are {", ".join(former.data["formats"])}; '
                "use the same --format, another --out, or --restart"
            )
        if former.data["digest"] == self.digest or self.options.accept_changed:
            return
        changes = changed_keys(physics(former.data["scene"]), physics(self.resolved)) or ["the version of Fontana"]
        shown = ", ".join(changes[:8]) + (f" and {len(changes) - 8} more" if len(changes) > 8 else "")
        raise _core.BadInput(
            f'the scene changed since the frames in "{self.folder.path}" were made: {shown}; use another --out, '
            "--restart to begin anew, or --accept-changed to go on with the change"
        )

    def _continue_from(self, former: Manifest) -> list[dict]:
        """The frames to keep; the simulation then stands right after them."""
        sound = former.count_sound_frames()
        if sound < len(former.frames):
            self.reporter.note(f"frame {sound + 1} on disk is damaged or missing; it is simulated again")
        frame, notes = self.folder.load_checkpoint(self.simulation, {self.digest, former.data["digest"]}, sound)
        for note in notes:
            self.reporter.note(note)
        if frame is None and former.frames:
            self.reporter.note("no checkpoint to continue from; starting at frame 1 again")
        self._saved_frame = frame or 0
        if frame:
            is_done = frame >= self.scene.frame_count
            self.reporter.note(f"all {frame} frames are there" if is_done else f"continues after frame {frame}")
        return former.frames[: frame or 0]

    def _new_manifest(self, frames: list[dict], former: Manifest | None = None) -> Manifest:
        derived = self.simulation.derived()
        names = ("support_radius", "particle_mass", "kinematic_viscosity", "speed_of_sound", "frame_duration")
        now = time.strftime("%Y-%m-%dT%H:%M:%S%z")
        data = {
            "fontana": _core.version(),
            "state": "running",
            "message": "",
            "started": former.data.get("started", now) if former else now,
            "command": self.options.command,
            "scene": self.resolved,
            "derived": {name: getattr(derived, name) for name in names},
            "digest": self.digest,
            "device": {},
            "formats": list(self.options.formats),
            "checkpoint_every": self.options.checkpoint_every,
            "picture": self.options.picture,
            "frames": frames,
        }
        return Manifest(self.folder.path, data)

    def _preflight(self) -> None:
        """Refuses, before any work, what would fail at the last frame for want of disk."""
        device = self.simulation.device()
        names = ("backend", "name", "driver", "memory_bytes", "compute_units")
        self.manifest.data["device"] = {name: getattr(device, name) for name in names}
        count = self.simulation.emitted_by(self.scene.frame_count)
        frame_bytes = count * sum(BYTES_PER_PARTICLE[format] for format in self.options.formats)
        self.folder.check_space(frame_bytes, count)

    def _step(self) -> None:
        report = self.simulation.step_frame(self._on_substep)
        files = [self._write(report.frame, format) for format in self.options.formats]
        self.manifest.frames.append(frame_record(report) | {"files": files})
        if report.frame % self.options.checkpoint_every == 0:
            self._checkpoint()
        self.manifest.publish()
        self.reporter.frame(self.manifest.frames[-1], self.scene.frame_count)

    def _on_substep(self, fraction: float) -> bool:
        self.reporter.substep(fraction)
        return self.stop.is_overdue

    def _write(self, frame: int, format: str) -> dict:
        path = self.folder.frame_path(frame, format)
        size, hash = write_frame(self.simulation, path, format)
        return {"file": path.name, "bytes": size, "hash": hash_text(hash)}

    def _checkpoint(self) -> None:
        """Saves what is not in a checkpoint yet."""
        if self._saved_frame != self.simulation.frame:
            self.folder.save_checkpoint(self.simulation, self.digest)
            self._saved_frame = self.simulation.frame

    def _save_and_stop(self) -> None:
        self._checkpoint()
        message = f"stopped after frame {len(self.manifest.frames)} of {self.scene.frame_count}"
        self._leave("interrupted", message)
        going_on = shlex.join(["fontana", "resume", str(self.folder.path)])
        raise StoppedError(self.stop.requested, f"{message}; {going_on} goes on")

    def _leave(self, state: str, message: str) -> None:
        self.manifest.data |= {"state": state, "message": message}
        if state == "failed":
            with contextlib.suppress(_core.IoError):  # what failed first is what counts; the disk may be full
                self.manifest.publish()
            return
        if self.resolved["solver"]["profile"]:
            self.manifest.data["profile"] = profile_of(self.simulation, gpu=self.options.gpu)
        self.manifest.publish()

    def _draw(self) -> None:
        if self.options.picture:
            from fontana.contact_sheet import contact_sheet  # matplotlib is slow to import

            contact_sheet(self.folder.path)


def frame_record(report: object) -> dict:
    """What run.json says of a frame beside its files."""
    return {
        "frame": report.frame,
        "time": report.time,
        "particles": report.particle_count,
        "substeps": report.substeps,
        "dt_min": report.dt_min,
        "dt_max": report.dt_max,
        "limit": report.dt_limit,
        "iterations": report.iterations,
        "unconverged": report.unconverged,
        "density_error_mean": report.density_error_mean,
        "density_error_max": report.density_error_max,
        "max_speed": report.max_speed,
        "seconds": report.seconds,
    }
