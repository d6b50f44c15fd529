"""What the tests of the viewer share: a cache to play, and a display that nobody sees."""

from __future__ import annotations

import shutil

import pytest
from scenes_to_view import DROP

from fontana.runs.reporters import make_reporter
from fontana.runs.runner import RunOptions, run_scene
from fontana.scene import load_scene
from fontana.viewer.player import CachePlayer


@pytest.fixture(scope="session")
def finished_run(tmp_path_factory):
    """The folder of a run of the drop; not to be changed."""
    folder = tmp_path_factory.mktemp("runs") / "drop"
    scene = load_scene(DROP, {"solver.backend": "cpu"})
    run_scene(scene, RunOptions(folder, picture=False), make_reporter(as_json=False, quiet=True))
    return folder


@pytest.fixture
def drop_cache(finished_run, tmp_path):
    """A copy of it."""
    return shutil.copytree(finished_run, tmp_path / "drop")


@pytest.fixture
def play():
    """Makes players of a folder that begin paused, and ends them."""
    made = []

    def make(folder):
        made.append(CachePlayer(folder, is_playing=False))
        return made[-1]

    yield make
    for player in made:
        player.close()
