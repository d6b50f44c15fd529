"""Alembic, read back by Alembic's own reader; Blender reads it in test_blender.py."""

from __future__ import annotations

import resource
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from alembic3d import Abc, AbcGeom
from command_line import error_line

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


def test_a_full_disk_is_one_sentence(fontana, splash: Path, tmp_path: Path) -> None:
    """A limit on the size of a file: it ends among the frames, and where the archive is closed."""
    command = ["export", splash, "-o", "s.abc", "--frames", "1-4", "--quiet"]
    fontana(*command)
    whole = (tmp_path / "s.abc").read_bytes()
    for limit in (len(whole) // 2, len(whole) - 8):
        limit_files = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (limit, limit))
        done = fontana(*command, code=6, preexec_fn=limit_files)
        assert 'cannot write "s.abc"' in error_line(done)
        assert [path.name for path in tmp_path.iterdir()] == ["s.abc"]
        assert (tmp_path / "s.abc").read_bytes() == whole


def test_frames_without_particles(fontana, empty: Path, tmp_path: Path) -> None:
    fontana("export", empty, "-o", "s.abc", "--quiet")
    _archive, schema = schema_of(tmp_path / "s.abc")
    counts = [len(schema.getValue(index).getPositions()) for index in range(4)]
    assert counts[:2] == [0, 0] and counts[3] > counts[2] > 0
