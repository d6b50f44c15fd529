"""A file a frame, several at once: read, made and published by processes of their own.

Processes, not threads: encoding files holds Python's lock, and a library that dies takes only its own process along.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing.connection import wait as wait_for_process
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.export.record import Record
from fontana.export.target import Target
from fontana.output_folder import make_output_folder
from fontana.runs.cache import Cache, read_checked
from fontana.runs.frame_numbers import refuse_skipped
from fontana.runs.lock import FolderLock
from fontana.runs.progress import Quiet
from fontana.runs.stop import StoppedError, StopSignals

_SIGNAL_DELAY = 0.2  # s until a signal that reached another process has reached this one too

# Makes and publishes a frame's file at a path; returns what there is to say about it: {"text": ..., ...}. Travels to
# another process, so it is an instance of a dataclass rather than a closure.
FrameMaker = Callable[[dict[str, np.ndarray], int, Path], dict]


@dataclass(frozen=True)
class _Task:
    frame: int
    source: Path
    source_hash: str
    target: Path


@dataclass(frozen=True)
class SequenceOptions:
    """How a sequence is made. `settings` is what its files depend on, beside their sources."""

    target: Target
    settings: dict
    jobs: int
    restart: bool = False


@dataclass(frozen=True)
class SequenceResult:
    """What came of the frames `asked` for: all of the run that are there, those skipped
    with the reason, and how a stop reads, if it came."""

    asked: int
    there: list[int]
    skipped: dict[int, str]
    stopped: StoppedError | None

    def raise_if_incomplete(self) -> None:
        """Raises StoppedError after Ctrl-C or SIGTERM, and IoError that names the skipped frames."""
        if self.stopped:
            raise self.stopped
        refuse_skipped(self.skipped, self.asked)


def make_sequence(
    cache: Cache, frames: list[int], make: FrameMaker, options: SequenceOptions, progress: Quiet
) -> SequenceResult:
    """Makes the files of `frames` that are not there yet.

    Frames whose source is missing or damaged are skipped; Ctrl-C and SIGTERM end it after the frames at work, and the
    same call continues. Raises IoError and OutOfMemory, when what was finished stays.
    """
    target = options.target
    make_output_folder(target.folder)
    with FolderLock(target.folder) as lock, StopSignals("stopping after the frames in work") as stop:
        for note in lock.notes:
            progress.note(note)
        record = Record(target, options.settings, options.restart)
        tasks = [
            _Task(frame, cache.path(frame), cache.hash(frame), target.frame(frame))
            for frame in frames
            if not record.has(frame, cache.hash(frame))
        ]
        if tasks:
            record.publish()
        progress.start(str(target.pattern), len(frames), len(frames) - len(tasks))
        skipped: dict[int, str] = {}
        for entry in _run(tasks, make, options.jobs, stop):
            if "skipped" in entry:
                skipped[entry["frame"]] = entry["skipped"]
                progress.skip(entry["frame"], entry["skipped"])
            else:
                progress.frame(entry)
                record.add({name: value for name, value in entry.items() if name != "text"})
        there = [frame for frame in cache.frames if record.has(frame, cache.hash(frame))]
        done = len(set(there) & set(frames))
        stopped = None
        if stop.requested and done + len(skipped) < len(frames):
            message = f"stopped with {done} of {len(frames)} frames; the same command continues"
            stopped = StoppedError(stop.requested, message)
        return SequenceResult(len(frames), there, skipped, stopped)


def _run(tasks: list[_Task], make: FrameMaker, jobs: int, stop: StopSignals) -> Iterator[dict]:
    """The entries of the tasks as they are done; after a stop, only of those already at work."""
    if not tasks:
        return
    context = multiprocessing.get_context("spawn")  # a fork would copy the locks of this process's threads
    waiting, at_work = list(reversed(tasks)), set()
    with ProcessPoolExecutor(min(jobs, len(tasks)), mp_context=context, initializer=_begin_worker) as pool:
        try:
            while at_work or (waiting and not stop.requested):
                while waiting and len(at_work) < jobs and not stop.requested:
                    with _interrupts_held():  # a process that is about to begin has not got to _begin_worker yet
                        at_work.add(pool.submit(_work, waiting.pop(), make))
                done, at_work = wait(at_work, return_when=FIRST_COMPLETED)
                for future in done:
                    if not _was_ended(future, stop):
                        yield _entry_of(future)
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


@contextlib.contextmanager
def _interrupts_held() -> Iterator[None]:
    """Ctrl-C comes after the `with` block; processes that begin in it never see one."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _was_ended(future: Future, stop: StopSignals) -> bool:
    """Whether a signal to the whole group of processes ended the one that had this frame. Raises OutOfMemory if its
    process is gone without such a signal."""
    error = future.exception()
    if not isinstance(error, BrokenProcessPool):
        return False
    time.sleep(_SIGNAL_DELAY)
    if stop.requested:
        return True
    raise _core.OutOfMemory(
        "a process that made a frame was ended, most likely for want of memory; try --jobs 1 or coarser settings"
    ) from error


def _entry_of(future: Future) -> dict:
    entry = future.result()
    if "error" in entry:
        raise getattr(_core, entry["error"])(entry["message"])
    return entry


def _work(task: _Task, make: FrameMaker) -> dict:
    """In a process of its own: a frame from its source to its file."""
    try:
        arrays = read_checked(task.source, task.source_hash)
    except _core.IoError as error:
        return {"frame": task.frame, "skipped": str(error)}
    try:
        said = make(arrays, task.frame, task.target)
    except _core.FontanaError as error:  # by name: the classes of the library do not travel
        return {"frame": task.frame, "error": _kind(error), "message": f"frame {task.frame}: {error}"}
    except MemoryError:
        return {"frame": task.frame, "error": "OutOfMemory", "message": f"frame {task.frame}: out of memory"}
    size = task.target.stat().st_size
    return {"frame": task.frame, "source": task.source_hash, "file": task.target.name, "bytes": size} | said


def _kind(error: _core.FontanaError) -> str:
    return next(kind.__name__ for kind in type(error).__mro__ if getattr(_core, kind.__name__, None) is kind)


def _begin_worker() -> None:
    """Ctrl-C reaches the whole group of processes: here it is the parent's to answer. Without it, workers leave."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    threading.Thread(target=_leave_with_parent, daemon=True).start()


def _leave_with_parent() -> None:
    wait_for_process([multiprocessing.parent_process().sentinel])
    os._exit(1)
