"""A short run that the tests of files share, whole and harmed."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest
from command_line import fontana_command
from small_scenes import SPLASH


@pytest.fixture(scope="session")
def splash(tmp_path_factory) -> Path:
    """The folder of its run; to look at, not to change."""
    folder = tmp_path_factory.mktemp("splash")
    (folder / "splash.json").write_text(json.dumps(SPLASH))
    command = fontana_command("run", "splash.json", "--out", "splash", "--no-picture", "--quiet")
    subprocess.run(command, cwd=folder, check=True)
    return folder / "splash"


@pytest.fixture
def harmed(splash: Path, tmp_path: Path) -> Path:
    """A copy of the run in which frame 3 is damaged and 7 and 8 are gone."""
    copy = tmp_path / "harmed"
    shutil.copytree(splash, copy)
    third = copy / "splash.0003.bgeo"
    content = bytearray(third.read_bytes())
    content[len(content) // 2] ^= 1
    third.write_bytes(content)
    for frame in (7, 8):
        (copy / f"splash.{frame:04d}.bgeo").unlink()
    return copy


@pytest.fixture
def empty(tmp_path: Path) -> Path:
    """A run whose first two frames have no particles yet."""
    scene = json.loads(json.dumps(SPLASH))
    scene["emitters"] = [scene["emitters"][1] | {"first_frame": 3}]
    scene["output"]["frames"] = 4
    (tmp_path / "late.json").write_text(json.dumps(scene))
    command = fontana_command("run", "late.json", "--out", "late", "--no-picture", "--quiet")
    subprocess.run(command, cwd=tmp_path, check=True)
    return tmp_path / "late"
