"""`fontana view` as a command: what it refuses, and how it ends."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time

import pytest
from small_scenes import DROP
from virtual_screen import virtual_screen

PATIENCE = 60  # s
COMMAND = [sys.executable, "-m", "fontana", "view"]


@pytest.fixture(scope="module")
def screen():
    yield from virtual_screen()


@pytest.fixture
def drop_file(tmp_path):
    path = tmp_path / "drop.json"
    path.write_text(json.dumps(DROP))
    return path


def view(*words, env=None):
    """The finished command and its one line of complaint."""
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    done = subprocess.run(
        [*COMMAND, *map(str, words)], env=environment | (env or {}), capture_output=True, text=True, timeout=PATIENCE
    )
    assert "Traceback" not in done.stderr
    assert len(done.stderr.strip().splitlines()) <= 1 or done.returncode == 2
    return done.returncode, done.stderr.strip()


def focus_window(screen):
    """Waits for the viewer's window; one that is not on the screen yet cannot have the keys."""
    screen.do("search", "--sync", "--onlyvisible", "--name", "^drop - Fontana$", "windowfocus", "--sync")


def test_the_help_has_examples():
    done = subprocess.run([*COMMAND, "--help"], capture_output=True, text=True, timeout=PATIENCE)
    assert "fontana view out/fountain" in done.stdout


def test_without_a_display_it_names_the_way_without(screen, drop_file):
    code, text = view(drop_file)
    assert code == 5
    assert "no window can be opened here" in text
    assert "fontana render" in text


def test_without_opengl_3_3_it_says_so(screen, drop_file):
    code, text = view(drop_file, env=screen.environment | {"MESA_GL_VERSION_OVERRIDE": "2.1"})
    assert code == 5
    assert "no OpenGL 3.3" in text
    assert "fontana render" in text


def test_what_cannot_be_shown_is_refused(tmp_path, drop_cache):
    assert "did you mean fountain?" in view("fountian")[1]
    assert "not the folder of a run" in view(tmp_path)[1]
    code, text = view(drop_cache, "--set", "fluid.viscosity=3")
    assert (code, "played as it is" in text) == (2, True)
    assert view("fountain", "--size", "0x0")[0] == 2


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_closes_the_window_and_completes_the_movie(screen, drop_file, tmp_path, number, code):
    from imageio_ffmpeg import count_frames_and_secs

    viewer = subprocess.Popen(
        [*COMMAND, str(drop_file), "--size", "400x200"],
        cwd=tmp_path,
        env=screen.environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        focus_window(screen)
        screen.do("key", "m")
        end = time.monotonic() + PATIENCE
        while not list(tmp_path.glob(".drop.view.0001.mp4.*.part")):
            assert viewer.poll() is None
            assert time.monotonic() < end
            time.sleep(0.05)
        viewer.send_signal(number)
        said, complaint = viewer.communicate(timeout=PATIENCE)
    finally:
        viewer.kill()
    assert viewer.returncode == code
    assert "drop.view.0001.mp4" in said
    assert complaint.splitlines()[-1] == "fontana: the window was closed by a signal"
    assert [path.name for path in tmp_path.glob("*drop.view*")] == ["drop.view.0001.mp4"]
    assert count_frames_and_secs(str(tmp_path / "drop.view.0001.mp4"))[0] >= 1


def test_a_window_closed_in_the_middle_of_a_frame(screen, drop_file):
    """A frame of 100 000 substeps, and a key that quits."""
    words = [str(drop_file), "--set", "time.substeps=100000", "--set", "time.timestep=1", "--size", "400x200"]
    viewer = subprocess.Popen(
        [*COMMAND, *words], env=screen.environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        focus_window(screen)
        time.sleep(0.5)  # into the frame
        assert viewer.poll() is None
        screen.do("key", "q")
        _, complaint = viewer.communicate(timeout=PATIENCE)
    finally:
        viewer.kill()
    assert (viewer.returncode, complaint) == (0, "")
