"""Alembic: particles as one archive, through the wheel `alembic3d` of Alembic's own Python module."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.export.staged import staged
from fontana.export.usd import StageLayout
from fontana.optional import require


class PointsArchive:
    """OPoints at /NAME/particles that grow by frames; a sample's time in seconds is its frame over the frame rate."""

    def __init__(self, path: Path, layout: StageLayout):
        self._abc = require("alembic3d.Abc", "alembic3d", "Alembic")
        self._geometry = require("alembic3d.AbcGeom", "alembic3d", "Alembic")
        self._imath = require("imath", "alembic3d", "Alembic")
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
        core = require("alembic3d.AbcCoreAbstract", "alembic3d", "Alembic")
        sampling = core.TimeSampling(1.0 / self._frame_rate, frame / self._frame_rate)
        self._points.getSchema().setTimeSampling(self._archive.addTimeSampling(sampling))


@contextlib.contextmanager
def points_archive(path: Path, layout: StageLayout) -> Iterator[PointsArchive]:
    """An archive to add frames to; the file is there once the block ends. Raises IoError."""
    with staged(path) as temporary:
        archive = PointsArchive(temporary, layout)
        try:
            yield archive
        finally:
            archive.close()
