"""USD, read back by Pixar's own library and checked by its validators."""

from __future__ import annotations

import os
import re
import resource
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line import error_line, fontana_command
from pxr import Usd, UsdGeom, UsdValidation
from small_scenes import SPLASH_FRAMES as FRAMES

from fontana.export import usd
from fontana.runs.cache import Cache
from fontana.surface import SurfaceSettings, reconstruct


def complaints(stage: Usd.Stage) -> list[str]:
    """What usdchecker checks: every validator that comes with USD."""
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 10
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    return [f"{error.GetName()}: {error.GetMessage()}" for error in errors]


def assert_layout(stage: Usd.Stage, first: int, last: int) -> None:
    assert complaints(stage) == []
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert stage.HasAuthoredMetadata("metersPerUnit") and UsdGeom.GetStageMetersPerUnit(stage) == 1
    assert stage.GetTimeCodesPerSecond() == stage.GetFramesPerSecond() == 24
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (first, last)
    assert stage.GetDefaultPrim().GetPath() == "/splash"


@pytest.mark.parametrize("suffix", ["usdc", "usda", "usd"])
def test_particles_are_one_stage_of_points(fontana, splash: Path, tmp_path: Path, suffix: str) -> None:
    fontana("export", splash, "-o", f"s.{suffix}", "--quiet")
    assert [path.name for path in tmp_path.iterdir()] == [f"s.{suffix}"]
    stage = Usd.Stage.Open(str(tmp_path / f"s.{suffix}"))
    assert_layout(stage, 1, FRAMES)
    points = UsdGeom.Points(stage.GetPrimAtPath("/splash/particles"))
    assert points.GetPointsAttr().GetTimeSamples() == list(range(1, FRAMES + 1))
    assert points.GetWidthsInterpolation() == "vertex"
    cache = Cache(splash)
    for frame in cache.frames:
        arrays = cache.read(frame)
        assert np.array_equal(points.GetPointsAttr().Get(frame), arrays["position"])
        assert np.array_equal(points.GetVelocitiesAttr().Get(frame), arrays["velocity"])
        assert np.array_equal(points.GetIdsAttr().Get(frame), arrays["id"])
        assert np.allclose(points.GetWidthsAttr().Get(frame), 0.05)
        extent = np.array(points.GetExtentAttr().Get(frame))
        assert np.allclose(extent[0], arrays["position"].min(axis=0) - 0.025, atol=1e-6)
        assert np.allclose(extent[1], arrays["position"].max(axis=0) + 0.025, atol=1e-6)


def test_a_stage_saved_in_parts_is_the_same(splash: Path, tmp_path: Path, monkeypatch) -> None:
    """Long runs do not fit in memory."""
    monkeypatch.setattr(usd, "_SAVE_EVERY_BYTES", 1)
    cache = Cache(splash)
    with usd.points_stage(tmp_path / "s.usdc", usd.StageLayout("splash", 24, 1, 1, FRAMES)) as writer:
        for frame in cache.frames:
            writer.add(frame, cache.read(frame))
    stage = Usd.Stage.Open(str(tmp_path / "s.usdc"))
    assert_layout(stage, 1, FRAMES)
    points = UsdGeom.Points(stage.GetPrimAtPath("/splash/particles"))
    for frame in cache.frames:
        assert np.array_equal(points.GetPointsAttr().Get(frame), cache.read(frame)["position"])


def test_surfaces_are_layers_that_a_stage_plays(fontana, splash: Path, tmp_path: Path) -> None:
    fontana("mesh", splash, "-o", "w.usdc", "--frames", "1-5", "--cell-size", 1.5, "--quiet")
    done = fontana("mesh", splash, "-o", "w.usdc", "--frames", "4-6", "--cell-size", 1.5)
    assert "w.usda plays what is there" in done.stdout
    stage = Usd.Stage.Open(str(tmp_path / "w.usda"))
    assert_layout(stage, 1, 6)
    assert_layout(Usd.Stage.Open(str(tmp_path / "w.0003.usdc")), 3, 3)
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/splash/surface"))
    assert mesh.GetSubdivisionSchemeAttr().Get() == "none"
    cache = Cache(splash)
    for frame in range(1, 7):
        arrays = cache.read(frame)
        expected = reconstruct(arrays["position"], arrays["velocity"], 0.025, SurfaceSettings(cell_size=1.5))
        assert np.array_equal(mesh.GetPointsAttr().Get(frame), expected.position)
        assert np.array_equal(mesh.GetNormalsAttr().Get(frame), expected.normal)
        assert np.array_equal(mesh.GetVelocitiesAttr().Get(frame), expected.velocity)
        indices = np.array(mesh.GetFaceVertexIndicesAttr().Get(frame)).reshape(-1, 3)
        assert np.array_equal(indices, expected.triangles)
        assert set(mesh.GetFaceVertexCountsAttr().Get(frame)) == {3}


def test_harmed_frames_are_skipped_and_named(fontana, harmed: Path, tmp_path: Path) -> None:
    line = error_line(fontana("export", harmed, "-o", "s.usdc", "--quiet", code=6))
    assert "all is done but frames 3, 7 to 8" in line
    stage = Usd.Stage.Open(str(tmp_path / "s.usdc"))
    points = UsdGeom.Points(stage.GetPrimAtPath("/splash/particles"))
    assert points.GetPointsAttr().GetTimeSamples() == [1, 2, 4, 5, 6, 9, 10, 11, 12]
    fontana("mesh", harmed, "-o", "w.usdc", "--cell-size", 1.5, "--quiet", code=6)
    assert_layout(Usd.Stage.Open(str(tmp_path / "w.usda")), 1, FRAMES)


def test_frames_without_particles(fontana, empty: Path, tmp_path: Path) -> None:
    fontana("export", empty, "-o", "s.usdc", "--quiet")
    stage = Usd.Stage.Open(str(tmp_path / "s.usdc"))
    assert complaints(stage) == []
    points = UsdGeom.Points(stage.GetPrimAtPath("/splash/particles"))
    counts = [len(points.GetPointsAttr().Get(frame)) for frame in range(1, 5)]
    assert counts[:2] == [0, 0] and counts[3] > counts[2] > 0


def test_ctrl_c_leaves_the_frames_so_far(splash: Path, tmp_path: Path) -> None:
    command = fontana_command("export", splash, "-o", "s.usdc", "--json")
    program = "import os, runpy, signal, sys\n"  # the signal comes after the fifth frame
    program += "from fontana.export import usd\nadd = usd.PointsStage.add\n"
    program += "def hit(self, frame, arrays):\n    add(self, frame, arrays)\n"
    program += "    frame == 5 and os.kill(os.getpid(), signal.SIGINT)\nusd.PointsStage.add = hit\n"
    program += f"sys.argv = {command[2:]!r}\nrunpy.run_module('fontana', run_name='__main__')"
    done = subprocess.run([command[0], "-c", program], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 128 + signal.SIGINT, done.stderr
    assert re.search(r'"s.usdc" has 5 of 12 frames; the same command makes it anew', done.stderr)
    stage = Usd.Stage.Open(str(tmp_path / "s.usdc"))
    assert stage.GetEndTimeCode() == 5


def test_a_full_disk_leaves_nothing_half_done(fontana, splash: Path, tmp_path: Path) -> None:
    (tmp_path / "s.usdc").write_text("what was there")

    def limit_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    done = fontana("export", splash, "-o", "s.usdc", "--quiet", code=6, preexec_fn=limit_files)
    assert 'cannot write "s.usdc"' in done.stderr.splitlines()[-1]
    assert [path.name for path in tmp_path.iterdir()] == ["s.usdc"]
    assert (tmp_path / "s.usdc").read_text() == "what was there"


def test_a_cache_without_a_sound_frame_replaces_nothing(fontana, harmed: Path, tmp_path: Path) -> None:
    for suffix in ("usdc", "abc"):
        (tmp_path / f"s.{suffix}").write_text("what was there")
        done = fontana("export", harmed, "-o", f"s.{suffix}", "--frames", "7-8", "--quiet", code=6)
        assert "none of the frames can be read" in error_line(done)
        assert (tmp_path / f"s.{suffix}").read_text() == "what was there"


def test_what_cannot_be_is_one_sentence(fontana, splash: Path) -> None:
    line = error_line(fontana("export", splash, "-o", "s.usdz", code=2))
    assert "expected a name that ends in .usd, .usdc, .usda, .abc or .vdb" in line
    assert "did you mean .vdb?" in error_line(fontana("export", splash, "-o", "s.vbd", code=2))
    line = error_line(fontana("export", splash, "-o", "/proc/s.usdc", code=6))
    assert line == 'fontana: cannot write "/proc/s.usdc": No such file or directory'
    line = error_line(fontana("export", splash, "-o", splash / "run.json/s.usdc", code=6))
    assert line.endswith('run.json" is a file, not a folder')
    line = error_line(fontana("export", splash, "-o", os.fsdecode(b"lat\xedn.usdc"), code=2))
    assert line.endswith("expected a name in UTF-8, the only ones that writers of .usdc take")
    blocked = {"PYTHONPATH": str(Path(__file__).parent / "without_usd")}
    done = fontana("export", splash, "-o", "s.usdc", code=2, env=blocked)
    assert f"USD needs usd-core, which is not here: {sys.executable} -m pip install 'fontana[usd]'" in error_line(done)
    assert done.stdout == ""
