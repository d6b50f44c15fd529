"""Alembic: particles as one archive, through the wheel `alembic3d` of Alembic's own Python module.

The archive is written in a process of its own: where a byte cannot be written, a destructor of Alembic throws, and that
ends the process it is in.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Iterator
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.export.staged import staged
from fontana.export.usd import StageLayout
from fontana.optional import OptionalPackage

_ALEMBIC = OptionalPackage("alembic3d", "alembic", "Alembic")
_ATTRIBUTES = ("position", "velocity", "id", "radius")


class PointsArchive:
    """OPoints at /NAME/particles that grow by frames; a sample's time in seconds is its frame over the frame rate."""

    def __init__(self, path: Path, layout: StageLayout):
        self._abc = _ALEMBIC.module("alembic3d.Abc")
        self._geometry = _ALEMBIC.module("alembic3d.AbcGeom")
        self._imath = _ALEMBIC.module("imath")
        self._frame_rate = layout.frame_rate
        note = f"Y up, {layout.unit:g} m a unit"
        self._archive = self._abc.CreateArchiveWithInfo(
            str(path), layout.frame_rate, f"Fontana {_core.version()}", note
        )
        parent = self._geometry.OXform(self._archive.getTop(), layout.name)
        self._points = self._geometry.OPoints(parent, "particles")
        self._last_frame: int | None = None

    def add(self, frame: int, arrays: dict[str, np.ndarray]) -> None:
        """The particles of a frame, with their diameters as widths; frames left out before it repeat the last."""
        schema = self._points.getSchema()
        if self._last_frame is None:
            self._begin(frame)
        else:
            for _ in range(self._last_frame + 1, frame):
                schema.setFromPrevious()
        self._last_frame = frame
        widths = self._imath.FloatArrayFromBuffer((2.0 * arrays["radius"]).astype(np.float32))
        schema.set(
            self._geometry.OPointsSchemaSample(
                self._imath.V3fArrayFromBuffer(np.ascontiguousarray(arrays["position"])),
                self._imath.IntArrayFromBuffer(np.ascontiguousarray(arrays["id"])),
                self._imath.V3fArrayFromBuffer(np.ascontiguousarray(arrays["velocity"])),
                self._geometry.OFloatGeomParamSample(widths, self._geometry.GeometryScope.kVertexScope),
            )
        )

    def close(self) -> None:
        """Writes what is left: an archive ends when nothing holds on to it."""
        del self._points, self._archive

    def _begin(self, frame: int) -> None:
        core = _ALEMBIC.module("alembic3d.AbcCoreAbstract")
        sampling = core.TimeSampling(1.0 / self._frame_rate, frame / self._frame_rate)
        self._points.getSchema().setTimeSampling(self._archive.addTimeSampling(sampling))


class ArchiveProcess:
    """A PointsArchive in another process. Its methods raise RuntimeError where that one's fail or end the process."""

    def __init__(self, path: Path, layout: StageLayout):
        context = multiprocessing.get_context("spawn")
        self._pipe, other = context.Pipe()
        self._process = context.Process(target=_serve, args=(other, path, layout), daemon=True)
        self._process.start()
        other.close()
        self._await_answer()

    def add(self, frame: int, arrays: dict[str, np.ndarray]) -> None:
        self._ask((frame, {name: arrays[name] for name in _ATTRIBUTES}))

    def close(self) -> None:
        self._ask(None)

    def leave(self) -> None:
        """The other process ends; without `close` its file is not complete."""
        self._pipe.close()
        self._process.join()

    def _ask(self, request: tuple | None) -> None:
        with contextlib.suppress(OSError):  # it may be gone; then it has left an answer, or none ever comes
            self._pipe.send(request)
        self._await_answer()

    def _await_answer(self) -> None:
        try:
            complaint = self._pipe.recv()
        except (EOFError, OSError):
            complaint = "Alembic's writer ended early"
        if complaint:
            raise RuntimeError(complaint)


def _serve(pipe: Connection, path: Path, layout: StageLayout) -> None:
    """In a process of its own: opens the archive, adds what comes through the pipe, and closes it at a None.

    Each of these is answered with a complaint, or with "".
    """
    for number in (signal.SIGINT, signal.SIGTERM):  # they are the parent's to answer
        signal.signal(number, signal.SIG_IGN)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # the last words of a process that Alembic ends
    with contextlib.suppress(EOFError, OSError):  # the parent left
        try:
            archive = PointsArchive(path, layout)
            pipe.send("")
            while request := pipe.recv():
                archive.add(*request)
                pipe.send("")
            archive.close()
            pipe.send("")
        except Exception as error:  # whatever it is becomes the parent's sentence
            pipe.send(str(error) or type(error).__name__)


@contextlib.contextmanager
def points_archive(path: Path, layout: StageLayout) -> Iterator[ArchiveProcess]:
    """An archive to add frames to; the file is there once the block ends. Raises IoError."""
    _ALEMBIC.module("alembic3d.Abc")
    with staged(path) as temporary:
        archive = ArchiveProcess(temporary, layout)
        try:
            yield archive
            archive.close()
        finally:
            archive.leave()
