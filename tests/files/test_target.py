"""Names and numbers of frames."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from fontana import _core
from fontana.export.target import parse_target
from fontana.runs.cache import Cache
from fontana.runs.frame_numbers import frame_list


@pytest.mark.parametrize(
    ("text", "file"),
    [
        ("out/w.ply", "out/w.0007.ply"),
        ("out/w.####.ply", "out/w.0007.ply"),
        ("out/w####.PLY", "out/w0007.ply"),
        ("out/w_##.ply", "out/w_07.ply"),
        ("out/w.###.v2.ply", "out/w.007.v2.ply"),
    ],
)
def test_the_number_stands_where_the_name_has_it(text: str, file: str) -> None:
    target = parse_target(text, [".ply"])
    assert target.frame(7) == Path(file)
    assert target.frame(12345) == Path(re.sub("0*7", "12345", file))
    assert target.record == Path(re.sub("[._-]?0*7", "", file) + ".json")


def test_a_range_is_a_list_of_frames(splash: Path) -> None:
    cache = Cache(splash)
    assert cache.select("2-4,9, 3") == [2, 3, 4, 9]
    assert cache.select("1-9/4,12") == [1, 5, 9, 12]
    assert cache.select(None) == list(range(1, 13))
    for text in ("", "-3", "1-", "0", "13", "1-2-3", "1-9/0", "3/2", "99999999999999"):
        with pytest.raises(_core.BadInput, match="--frames"):
            cache.select(text)


def test_frames_in_a_sentence() -> None:
    assert frame_list([8, 3, 7, 1, 2]) == "1 to 3, 7 to 8"
    assert frame_list([5]) == "5"


def test_the_rate_and_the_unit_are_the_scenes(fontana, tmp_path: Path) -> None:
    scene = '{"name": "s", "time": {"frame_rate": 30, "simulation_scale": 0.01}, "fluid": {"particle_spacing": 0.02},'
    scene += '"emitters": [{"type": "block", "size": [10, 10, 10]}], "output": {"frames": 1}}'
    (tmp_path / "s.json").write_text(scene)
    fontana("run", "s.json", "--out", "s", "--no-picture", "--quiet")
    cache = Cache(tmp_path / "s")
    assert (cache.frame_rate, cache.unit) == (30, 0.01)
    assert cache.particle_radius == pytest.approx(1.0)
    assert cache.read(1)["radius"][0] == pytest.approx(1.0)
