"""Alembic, read back by Alembic's own reader; Blender reads it in test_blender.py."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from alembic3d import Abc, AbcGeom

from fontana.runs.cache import Cache


def schema_of(path: Path):
    archive = Abc.IArchive(str(path))
    return archive, AbcGeom.IPoints(archive.getTop().getChild(0), "particles").getSchema()


def vectors(array) -> np.ndarray:
    return np.array([tuple(value) for value in array], dtype=np.float32).reshape(-1, 3)


def test_particles_are_one_archive(fontana, splash: Path, tmp_path: Path) -> None:
    fontana("export", splash, "-o", "s.abc", "--frames", "3-6", "--quiet")
    _archive, schema = schema_of(tmp_path / "s.abc")
    assert schema.getNumSamples() == 4
    cache = Cache(splash)
    for index, frame in enumerate(range(3, 7)):
        arrays, sample = cache.read(frame), schema.getValue(index)
        assert schema.getTimeSampling().getSampleTime(index) == pytest.approx(frame / 24)
        assert np.array_equal(vectors(sample.getPositions()), arrays["position"])
        assert np.array_equal(vectors(sample.getVelocities()), arrays["velocity"])
        assert list(sample.getIds()) == arrays["id"].tolist()
        widths = schema.getWidthsParam().getExpandedValue(index).getVals()
        assert np.allclose(list(widths), 0.05)


def test_a_skipped_frame_repeats_the_one_before(fontana, harmed: Path, tmp_path: Path) -> None:
    fontana("export", harmed, "-o", "s.abc", "--quiet", code=6)
    _archive, schema = schema_of(tmp_path / "s.abc")
    assert schema.getNumSamples() == 12
    counts = [len(schema.getValue(index).getPositions()) for index in range(12)]
    assert counts[2] == counts[1] and counts[6] == counts[7] == counts[5]


def test_frames_without_particles(fontana, empty: Path, tmp_path: Path) -> None:
    fontana("export", empty, "-o", "s.abc", "--quiet")
    _archive, schema = schema_of(tmp_path / "s.abc")
    counts = [len(schema.getValue(index).getPositions()) for index in range(4)]
    assert counts[:2] == [0, 0] and counts[3] > counts[2] > 0
