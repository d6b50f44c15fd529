"""Frames as files, read back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import fontana
from fontana.formats import ATTRIBUTES, FORMATS, write_frame


@pytest.mark.parametrize("format", FORMATS)
def test_what_is_written_is_read_bit_for_bit(format: str, drop: dict, tmp_path: Path) -> None:
    simulation = fontana.Simulation(drop)
    frame = simulation.step()
    path = tmp_path / f"drop.0001.{format}"
    size, _ = write_frame(simulation.core, path, format)
    assert path.stat().st_size == size
    arrays = fontana.read_frame(path)
    for name in ATTRIBUTES:
        assert arrays[name].dtype == frame.read(name).dtype
        assert np.array_equal(arrays[name], frame.read(name)), name
    assert arrays["radius"] == pytest.approx(0.025)
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("format", FORMATS)
def test_no_particles_make_a_file_too(format: str, tmp_path: Path) -> None:
    simulation = fontana.Simulation()
    simulation.step()
    path = tmp_path / f"empty.{format}"
    write_frame(simulation.core, path, format)
    assert len(fontana.read_frame(path)["position"]) == 0


@pytest.mark.parametrize("format", FORMATS)
def test_a_cut_file_is_refused(format: str, drop: dict, tmp_path: Path) -> None:
    simulation = fontana.Simulation(drop)
    simulation.step()
    path = tmp_path / f"drop.{format}"
    write_frame(simulation.core, path, format)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with pytest.raises(fontana.IoError, match="damaged"):
        fontana.read_frame(path)


def test_unknown_and_missing_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(fontana.BadInput, match="expected a file that ends in"):
        fontana.read_frame(tmp_path / "frame.abc")
    with pytest.raises(fontana.IoError, match="No such file"):
        fontana.read_frame(tmp_path / "frame.bgeo")
