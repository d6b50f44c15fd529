"""`fontana mesh`: what it leaves, how it continues, what it refuses, and that nothing finished is lost."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import time
from pathlib import Path

import pytest
import trimesh
from command_line import error_line, fontana_command
from pxr import Usd
from small_scenes import SPLASH_FRAMES as FRAMES

from fontana import bgeo

COARSE = ("--cell-size", 1.5, "--jobs", 2)


def files_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob("*.[0-9]*")}


def test_a_surface_a_frame_beside_the_run(fontana, splash: Path, tmp_path: Path) -> None:
    run = tmp_path / "splash"
    run.symlink_to(splash)
    done = fontana("mesh", "splash", "-o", "water/w.####.ply", *COARSE)
    names = {f"w.{frame:04d}.ply" for frame in range(1, FRAMES + 1)}
    assert {path.name for path in (tmp_path / "water").iterdir()} == names | {"w.ply.json"}
    assert "w.0001.ply to w.0012.ply (" in done.stdout and "frame   12  " in done.stdout
    for name in names:
        assert trimesh.load(tmp_path / "water" / name).is_watertight
    again = fontana("mesh", "splash", "-o", "water/w.ply", *COARSE)
    assert "12 of them there already" in again.stdout and "done: 0 of 12" in again.stdout


def test_the_number_stands_where_it_was_asked_for(fontana, splash: Path, tmp_path: Path) -> None:
    common = ["mesh", splash, "--frames", "9-10", *COARSE]
    done = fontana(*common, "-o", "w_##.usdc")
    assert {path.name for path in tmp_path.glob("*.usdc")} == {"w_09.usdc", "w_10.usdc"}
    assert "w_09.usdc to w_10.usdc" in done.stdout
    stage = Usd.Stage.Open(str(tmp_path / "w.usda"))
    surface = stage.GetPrimAtPath("/splash/surface")
    counts = [len(surface.GetAttribute("points").Get(frame)) for frame in (9, 10)]
    assert min(counts) > 100 and counts[0] != counts[1]
    assert "2 of them there already" in fontana(*common, "-o", "w_##.usdc").stdout
    (tmp_path / "w.usdc.json").unlink()
    assert '"w_09.usdc" is there, but no w.usdc.json' in error_line(fontana(*common, "-o", "w_##.usdc", code=2))


def test_by_default_bgeo_in_a_folder_of_the_run(fontana, harmed: Path) -> None:
    fontana("mesh", harmed, "--frames", "1-2,9", *COARSE, "--quiet")
    folder = harmed / "surface"
    assert {path.name for path in folder.iterdir()} == {
        "splash.0001.bgeo",
        "splash.0002.bgeo",
        "splash.0009.bgeo",
        "splash.bgeo.json",
    }
    attributes, triangles = bgeo.read((folder / "splash.0009.bgeo").read_bytes())
    assert trimesh.Trimesh(attributes["P"], triangles, process=False).is_watertight


def test_other_settings_are_refused_and_restart_replaces(fontana, splash: Path, tmp_path: Path) -> None:
    common = ["mesh", splash, "--frames", "1", "-o", "w.ply"]
    fontana(*common, "--cell-size", 1.5)
    first = files_of(tmp_path)
    line = error_line(fontana(*common, "--cell-size", 1.0, "--smoothing", 0, code=2))
    assert "made with another cell_size, smoothing" in line and "--restart" in line
    assert files_of(tmp_path) == first
    fontana(*common, "--cell-size", 1.0, "--restart", "--quiet")
    assert files_of(tmp_path) != first
    (tmp_path / "w.ply.json").unlink()
    assert "no w.ply.json that speaks of it" in error_line(fontana(*common, code=2))


def test_damaged_and_missing_frames_are_skipped_and_named(fontana, harmed: Path, tmp_path: Path) -> None:
    done = fontana("mesh", harmed, "-o", "w.obj", *COARSE, code=6)
    assert "all is done but frames 3, 7 to 8: " in error_line(done)
    assert "splash.0003.bgeo" in error_line(done) and "damaged" in error_line(done)
    assert "frame 7 is skipped" in done.stdout and "No such file" in done.stdout
    assert len(list(tmp_path.glob("w.*.obj"))) == FRAMES - 3


def test_a_changed_source_is_made_again(fontana, splash: Path, harmed: Path, tmp_path: Path) -> None:
    for frame in (3, 7, 8):
        name = f"splash.{frame:04d}.bgeo"
        (harmed / name).write_bytes((splash / name).read_bytes())
    fontana("mesh", harmed, "--frames", "1-4", "-o", "w.ply", *COARSE, "--quiet")
    before = files_of(tmp_path)
    (tmp_path / "w.0002.ply").write_bytes(b"cut")
    record = json.loads((tmp_path / "w.ply.json").read_text())
    record["frames"][3]["source"] = "0" * 16
    (tmp_path / "w.ply.json").write_text(json.dumps(record))
    done = fontana("mesh", harmed, "--frames", "1-4", "-o", "w.ply", *COARSE)
    assert "2 of them there already" in done.stdout
    assert files_of(tmp_path) == before


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_keeps_what_is_done_and_the_same_command_continues(
    fontana, splash: Path, tmp_path: Path, number: int, code: int
) -> None:
    """The signal goes to the whole group of processes, as a terminal sends it."""
    command = ["mesh", splash, "-o", "w.ply", "--cell-size", 0.3, "--jobs", 2, "--json"]
    process = subprocess.Popen(
        fontana_command(*command),
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    while '"frame"' not in (line := process.stdout.readline()):
        assert line, process.stderr.read()
    os.killpg(process.pid, number)
    _, stderr = process.communicate(timeout=60)
    assert process.returncode == code, stderr
    assert "stopping after the frames in work" in stderr and "Traceback" not in stderr
    kept = files_of(tmp_path)
    assert 0 < len(kept) < FRAMES
    assert f"stopped with {len(kept)} of {FRAMES} frames" in stderr
    assert f"{len(kept)} of them there already" in fontana(*command[:-1]).stdout
    assert len(files_of(tmp_path)) == FRAMES
    assert {name: content for name, content in files_of(tmp_path).items() if name in kept} == kept


def test_ctrl_c_while_workers_begin_is_no_traceback(splash: Path, tmp_path: Path) -> None:
    """They import for a while before they can ask not to be interrupted."""
    command = fontana_command("mesh", splash, "-o", "w.ply", "--jobs", 2, "--json")
    process = subprocess.Popen(
        command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    assert '"start"' in process.stdout.readline()
    time.sleep(0.15)
    os.killpg(process.pid, signal.SIGINT)
    _, stderr = process.communicate(timeout=60)
    assert process.returncode == 130, stderr
    assert "Traceback" not in stderr


def test_workers_do_not_outlive_a_killed_parent(splash: Path, tmp_path: Path) -> None:
    command = fontana_command("mesh", splash, "-o", "w.ply", "--cell-size", 0.2, "--jobs", 2, "--json")
    process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True, start_new_session=True)
    assert '"start"' in process.stdout.readline()
    assert (tmp_path / "w.ply.json").exists(), "a file without it is refused as another's"
    time.sleep(2)
    process.kill()
    process.stdout.read()  # ends once no process has the other end
    process.wait()


def test_a_full_disk_is_one_sentence_and_keeps_what_is_done(fontana, splash: Path, tmp_path: Path) -> None:
    """A limit on the size of a file: the surface grows past it."""
    fontana("mesh", splash, "--frames", "1,12", "-o", "all/w.ply", *COARSE, "--quiet")
    sizes = [(tmp_path / "all" / f"w.{frame:04d}.ply").stat().st_size for frame in (1, 12)]
    assert sizes[0] < sizes[1]
    limit = sizes[1] - 1

    def limit_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    done = fontana("mesh", splash, "-o", "w.ply", *COARSE, "--quiet", code=6, preexec_fn=limit_files)
    assert "cannot write" in error_line(done) and ".ply" in error_line(done)
    names = {path.name for path in tmp_path.glob("w.*")}
    assert "w.0001.ply" in names and "w.0012.ply" not in names
    assert not list(tmp_path.glob("*.tmp*"))


def test_frames_without_particles_have_empty_files(fontana, empty: Path, tmp_path: Path) -> None:
    for suffix in ("bgeo", "ply", "obj", "usdc"):
        fontana("mesh", empty, "-o", f"w.{suffix}", *COARSE, "--quiet")
        assert len(list(tmp_path.glob(f"w.0*.{suffix}"))) == 4
    attributes, triangles = bgeo.read((tmp_path / "w.0001.bgeo").read_bytes())
    assert len(attributes["P"]) == len(triangles) == 0


def test_what_cannot_be_is_one_sentence(fontana, splash: Path, tmp_path: Path) -> None:
    def refusal(*arguments: object) -> str:
        return error_line(fontana("mesh", *arguments, code=2))

    assert "expected a name that ends in .bgeo, .ply, .obj" in refusal(splash, "-o", "w.stl")
    assert "did you mean .ply?" in refusal(splash, "-o", "w.pyl")
    assert "it has no suffix" in refusal(splash, "-o", "water")
    assert "expected a name beside the number" in refusal(splash, "-o", "####.ply")
    assert '"nowhere" has no run.json' in refusal("nowhere")
    assert "there is no frame 48" in refusal(splash, "--frames", "1-48")
    assert "runs backwards; use 2-5" in refusal(splash, "--frames", "5-2")
    assert "expected numbers such as 1-48" in refusal(splash, "--frames", "all")
    (tmp_path / "w.ply.json").write_text('{"frames": 3}')
    assert "is not the record of a sequence" in refusal(splash, "-o", "w.ply")
