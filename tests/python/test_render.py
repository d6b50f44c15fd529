"""`fontana render`: pictures and films of a run, what is refused, and what survives."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
from importlib import resources
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from command_line import error_line, fontana_command
from PIL import Image

import fontana as package
from fontana.gl.camera import Camera
from fontana.gl.context import create_headless_context
from fontana.render.options import parse_camera, parse_size

SMALL = ("--size", "96x64", "--samples", 1)
FRAME_COUNT = 6

pytestmark = pytest.mark.usefixtures("opengl")


def drawn_of(done: subprocess.CompletedProcess) -> tuple[int, int]:
    """How many pictures a command with --json drew, of how many it was asked for."""
    events = [json.loads(line) for line in done.stdout.splitlines()]
    return sum(event["event"] == "frame" for event in events), events[0]["frames"]


def pictures(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.glob("*.png"))}


def test_pictures_are_numbered_and_have_the_size(fontana, drop_cache, tmp_path):
    fontana("render", drop_cache, "-o", "p/drop.####.png", *SMALL)
    names = sorted(path.name for path in (tmp_path / "p").iterdir())
    assert names == [f"drop.{frame:04d}.png" for frame in range(1, FRAME_COUNT + 1)]
    images = [np.asarray(Image.open(tmp_path / "p" / name)).astype(int) for name in names]
    assert {image.shape for image in images} == {(64, 96, 3)}
    assert np.abs(images[0] - images[-1]).max() > 40  # something falls


def test_the_same_command_again_draws_what_is_missing_and_nothing_else(fontana, drop_cache, tmp_path):
    command = ("render", drop_cache, "-o", "p/x.##.png", *SMALL, "--json")
    fontana(*command, "--frames", "1-4")
    before = pictures(tmp_path / "p")
    (tmp_path / "p" / "x.02.png").unlink()
    times = {name: (tmp_path / "p" / name).stat().st_mtime_ns for name in ("x.01.png", "x.04.png")}
    again = fontana(*command)
    assert drawn_of(again) == (3, 6)
    assert json.loads(again.stdout.splitlines()[-1])["files"] == [f"p/x.{frame:02d}.png" for frame in range(1, 7)]
    assert {name: (tmp_path / "p" / name).stat().st_mtime_ns for name in times} == times
    assert pictures(tmp_path / "p")["x.02.png"] == before["x.02.png"]


def test_a_picture_of_other_settings_is_drawn_again_and_a_foreign_one_refused(fontana, drop_cache, tmp_path):
    command = ("render", drop_cache, "-o", "x.png", "--frames", 3, *SMALL, "--json")
    assert drawn_of(fontana(*command)) == (1, 1)
    assert drawn_of(fontana(*command, "--style", "points")) == (1, 1)
    Image.new("RGB", (4, 4)).save(tmp_path / "x.png")  # as another program would
    assert "was not made by fontana render" in fontana(*command, code=2).stdout
    assert Image.open(tmp_path / "x.png").size == (4, 4)
    fontana(*command, "--restart")
    assert Image.open(tmp_path / "x.png").size == (96, 64)


@pytest.mark.parametrize("name", ["drop.mp4", "drop.gif", "drop.webp"])
def test_a_film_has_every_frame_and_the_rate_of_the_run(fontana, drop_cache, tmp_path, name):
    fontana("render", drop_cache, "-o", name, "--style", "points", *SMALL)
    assert sorted(path.name for path in tmp_path.glob("*drop.*")) == [name]
    if name.endswith(".mp4"):
        reader = imageio_ffmpeg.read_frames(str(tmp_path / name))
        facts = next(reader)
        assert facts["size"] == (96, 64)
        assert facts["fps"] == pytest.approx(24)
        assert len(list(reader)) == FRAME_COUNT
    else:
        film = Image.open(tmp_path / name)
        assert film.size == (96, 64)
        assert film.n_frames == FRAME_COUNT


def test_missing_and_damaged_frames_are_skipped_and_named(fontana, drop_cache, tmp_path):
    (drop_cache / "drop.0002.bgeo").unlink()
    damaged = drop_cache / "drop.0004.bgeo"
    data = bytearray(damaged.read_bytes())
    data[-5] ^= 0xFF
    damaged.write_bytes(bytes(data))
    done = fontana("render", drop_cache, "-o", "p/x.#.png", *SMALL, code=6)
    assert "frame 2 is skipped: " in done.stdout
    assert "drop.0002.bgeo" in done.stdout
    assert "drop.0004.bgeo" in done.stdout
    assert "all is done but frames 2, 4: " in error_line(done)
    assert sorted(pictures(tmp_path / "p")) == ["x.1.png", "x.3.png", "x.5.png", "x.6.png"]


def test_a_run_without_a_sound_frame_says_so(fontana, drop_cache, tmp_path):
    for path in drop_cache.glob("*.bgeo"):
        path.write_bytes(b"")
    done = fontana("render", drop_cache, "-o", "x.gif", *SMALL, "--quiet", code=6)
    assert error_line(done).startswith("fontana: none of the frames can be read: ")
    assert not list(tmp_path.glob("*x.gif*"))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            ("-o", "x.mp5"),
            'x.mp5": expected a name that ends in .png, .mp4, .gif or .webp, not in .mp5; did you mean .mp4?',
        ),
        (("-o", "x"), "expected a name that ends in .png, .mp4, .gif or .webp, it has no suffix"),
        (("-o", "x.png"), '6 frames need a number in the name, as "x.####.png"'),
        (("-o", "x.gif", "--frames", "2-9"), "there is no frame 9; the run has 1 to 6"),
        (("-o", "x.gif", "--frames", "a"), "expected numbers such as 1-48, 1-48/2"),
        (("-o", "x.gif", "--size", "big"), "expected WIDTHxHEIGHT"),
        (("-o", "x.mp4", "--size", "95x64"), "needs an even width and height, got 95x64"),
        (("-o", "x.gif", "--camera", "eyes=1,2,3"), 'there is no "eyes"; did you mean eye?'),
        (("-o", "x.gif", "--camera", "eye=1,2"), "eye: expected 3 numbers with commas between"),
        (("-o", "x.gif", "--camera", "eye=1,2,3 azimuth=4"), "leave out azimuth"),
        (("-o", "x.gif", "--camera", "fov=0"), "1 to 150, got 0"),
        (("-o", "x.gif", "--color-range", "3,1"), "expected the lower value first"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(fontana, drop_cache, arguments, words):
    assert words in error_line(fontana("render", drop_cache, *arguments, code=2))


def test_a_name_that_is_too_long_is_a_sentence(fontana, drop_cache):
    line = error_line(fontana("render", drop_cache, "-o", f"{'x' * 300}.png", "--frames", 1, *SMALL, "--quiet", code=6))
    assert line.startswith("fontana: cannot create a file in the folder of 'xxx")
    assert line.endswith("File name too long")


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="/proc is the folder that even root cannot write to")
def test_a_folder_that_cannot_be_written_is_refused_before_a_picture_is_drawn(fontana, drop_cache):
    for name in ("x.gif", "x.####.png"):
        done = fontana("render", drop_cache, "-o", f"/proc/{name}", *SMALL, code=6)
        assert error_line(done).startswith('fontana: cannot write to "/proc"')
        assert done.stdout == ""


def test_a_folder_without_a_run_is_refused(fontana, tmp_path):
    (tmp_path / "empty").mkdir()
    assert "it is not the folder of a run" in error_line(fontana("render", "empty", "-o", "x.gif", code=2))


def test_without_opengl_there_is_a_sentence(fontana, drop_cache):
    missing = {"GLCONTEXT_LINUX_LIBEGL": "libnone.so", "GLCONTEXT_LINUX_LIBGL": "libnone.so"}
    line = error_line(fontana("render", drop_cache, "-o", "x.gif", *SMALL, code=5, env=missing))
    assert "no OpenGL 3.3 without a window here" in line
    assert "apt install libegl1" in line


def test_without_a_display_it_works(fontana, drop_cache):
    hidden = {"DISPLAY": "", "WAYLAND_DISPLAY": ""}
    fontana("render", drop_cache, "-o", "x.png", "--frames", 1, *SMALL, env=hidden)


def test_without_moderngl_there_is_a_sentence(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "moderngl", None)
    with pytest.raises(
        package.BadInput, match=r"a picture needs moderngl, which is not here: .* -m pip install 'fontana\[view\]'"
    ):
        create_headless_context()


@pytest.mark.parametrize(("name", "film"), [("x.mp4", True), ("p/x.####.png", False)])
def test_ctrl_c_keeps_what_is_drawn(drop_cache, tmp_path, name, film):
    """The signal goes to the whole group, as a terminal sends it."""
    call = fontana_command("render", drop_cache, "-o", name, "--size", "240x160", "--samples", 6, "--json")
    process = subprocess.Popen(
        call, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    assert [json.loads(process.stdout.readline())["event"] for _ in range(2)] == ["start", "frame"]
    os.killpg(process.pid, signal.SIGINT)
    rest, errors = process.communicate(timeout=60)
    assert process.returncode == 130, errors
    assert "Traceback" not in errors
    count = 1 + sum(json.loads(line)["event"] == "frame" for line in rest.splitlines())
    assert f"stopped after {count} of {FRAME_COUNT} pictures" in errors
    if film:
        reader = imageio_ffmpeg.read_frames(str(tmp_path / name))
        next(reader)
        assert len(list(reader)) == count
    else:
        assert len(pictures(tmp_path / "p")) == count
    assert not list(tmp_path.rglob("*.part"))


@pytest.mark.parametrize("name", ["x.mp4", "x.#.png"])
def test_a_full_disk_is_a_sentence_and_leaves_no_half_file(fontana, drop_cache, tmp_path, name):
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))

    done = fontana("render", drop_cache, "-o", name, *SMALL, "--quiet", code=6, preexec_fn=limit)
    assert error_line(done).startswith("fontana: cannot write ")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drop"]


def test_a_film_that_was_there_stays_until_the_next_is_complete(fontana, drop_cache, tmp_path):
    (tmp_path / "x.gif").write_bytes(b"former")
    for path in drop_cache.glob("*.bgeo"):
        path.unlink()
    fontana("render", drop_cache, "-o", "x.gif", *SMALL, code=6)
    assert (tmp_path / "x.gif").read_bytes() == b"former"


def test_the_camera_turns_over_the_frames(fontana, drop_cache, tmp_path):
    still, turning = ("--camera", "azimuth=0 distance=2"), ("--camera", "azimuth=0 distance=2 turn=90")
    fontana("render", drop_cache, "-o", "a.#.png", *SMALL, *still)
    fontana("render", drop_cache, "-o", "b.#.png", *SMALL, *turning)
    difference = [
        np.abs(np.asarray(Image.open(f"{tmp_path}/a.{k}.png")).astype(int) - Image.open(f"{tmp_path}/b.{k}.png")).max()
        for k in (1, FRAME_COUNT)
    ]
    assert difference[0] == 0
    assert difference[1] > 40


def test_a_size_out_of_text():
    assert parse_size("640x360") == (640, 360)


def test_a_camera_out_of_text():
    start = Camera.looking([0, 1, 4], [0, 0.5, 0], 30.0)
    camera, turn = parse_camera("eye=1,2,3 target=0,1,0 fov=40 turn=-20", start)
    assert camera.eye == pytest.approx([1, 2, 3])
    assert camera.target == pytest.approx([0, 1, 0])
    assert (camera.field_of_view, turn) == (40.0, -20.0)
    same, _ = parse_camera("", start)
    assert same.eye == pytest.approx(start.eye)
    moved, _ = parse_camera("target=1,0.5,0", start)
    assert moved.eye == pytest.approx([1, 1, 4])
    around, _ = parse_camera("azimuth=90 elevation=0 distance=2", start)
    assert around.eye == pytest.approx([2, 0.5, 0])


def test_the_shaders_are_in_the_package():
    source = Path(__file__).parents[2] / "python" / "fontana" / "gl" / "shaders"
    installed = {file.name for file in resources.files("fontana.gl").joinpath("shaders").iterdir()}
    assert installed >= {file.name for file in source.iterdir()}
