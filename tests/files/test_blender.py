"""Blender, as the Python module bpy, reads the USD, Alembic and VDB files, and renders a frame.

It lives in an environment of its own, .venv/blender (`make blender`): it is large, and wants another numpy.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from command_line import error_line
from matplotlib.image import imread

from fontana.runs.cache import Cache

pytestmark = pytest.mark.blender

ROOT = Path(__file__).parents[2]
PYTHON = Path(os.environ.get("FONTANA_BLENDER_PYTHON", ROOT / ".venv" / "blender" / "bin" / "python"))
FRAME = 9


@pytest.fixture(scope="module")
def bpy_folder(tmp_path_factory) -> Path:
    """A folder with nothing but bpy, which lends its OpenVDB to whoever has it on the path."""
    if not PYTHON.exists():
        reason = f"no Blender at {PYTHON}: make blender"
        pytest.fail(reason) if os.environ.get("CI") == "true" else pytest.skip(reason)
    command = [PYTHON, "-c", "import importlib.util; print(importlib.util.find_spec('bpy').origin)"]
    origin = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    folder = tmp_path_factory.mktemp("bpy")
    (folder / "bpy").symlink_to(Path(origin).parent)
    return folder


@pytest.fixture
def files(fontana, splash: Path, bpy_folder: Path, tmp_path: Path) -> Path:
    fontana("export", splash, "-o", "points.usdc", "--quiet")
    fontana("export", splash, "-o", "points.abc", "--quiet")
    fontana("mesh", splash, "-o", "surface.usdc", "--frames", "7-10", "--quiet")
    with_openvdb = {"PYTHONPATH": str(bpy_folder)}
    fontana("export", splash, "-o", "volume.vdb", "--frames", f"{FRAME}", "--quiet", env=with_openvdb)
    return tmp_path


def test_blender_reads_all_and_renders(files: Path, splash: Path) -> None:
    picture = Path(os.environ.get("FONTANA_BLENDER_PICTURE", files / "surface.png"))
    script = Path(__file__).with_name("blender_reads.py")
    done = subprocess.run([PYTHON, script, files, str(FRAME), picture], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    said = json.loads(done.stdout.strip().splitlines()[-1])
    arrays = Cache(splash).read(FRAME)
    low, high = arrays["position"].min(axis=0), arrays["position"].max(axis=0)
    speed = float(np.linalg.norm(arrays["velocity"], axis=1).max())

    points = said["points"]
    assert points["type"] == "POINTCLOUD" and points["count"] == len(arrays["id"])
    assert np.allclose(points["low"], low) and np.allclose(points["high"], high)
    assert points["radius"] == pytest.approx(0.025)
    assert points["speed"] == pytest.approx(speed, rel=1e-5)
    assert points["frames"] == [1, 12, 24]
    assert np.allclose(points["up"], [0, 0, 1], atol=1e-6)  # our y is Blender's z

    surface = said["surface"]
    assert surface["type"] == "MESH" and surface["count"] > 1000
    assert np.allclose(surface["low"], low, atol=0.06) and np.allclose(surface["high"], high, atol=0.06)
    assert 0.5 * speed < surface["speed"] < 1.1 * speed
    assert surface["frames"] == [7, 10, 24]

    archive = said["alembic"]
    assert archive["count"] == points["count"] and archive["radius"] == pytest.approx(0.025)

    volume = said["volume"]
    assert volume["listed"] == {"surface": "FLOAT", "vel": "VECTOR_FLOAT"}
    assert volume["class"] == "level set" and volume["vector_type"] == "contravariant relative"
    assert np.allclose(volume["voxel"], [0.025, 0.05])
    assert np.allclose(volume["low"], low, atol=0.06) and np.allclose(volume["high"], high, atol=0.06)
    assert 0.7 * speed < volume["speed"] <= 1.01 * speed

    pixels = imread(picture)[..., :3]
    sky = pixels[2, 2]
    is_water = (pixels[..., 2] > 1.15 * pixels[..., 0]) & (np.abs(pixels - sky).sum(axis=-1) > 0.1)
    assert 0.05 < is_water.mean() < 0.6


def test_an_empty_frame_is_an_empty_volume(fontana, empty: Path, bpy_folder: Path, tmp_path: Path) -> None:
    fontana("export", empty, "-o", "v.vdb", "--quiet", env={"PYTHONPATH": str(bpy_folder)})
    assert len(list(tmp_path.glob("v.*.vdb"))) == 4


def test_without_openvdb_a_sentence_says_what_to_install(fontana, splash: Path) -> None:
    line = error_line(fontana("export", splash, "-o", "v.vdb", code=2))
    assert f"openvdb, which is not here: {sys.executable} -m pip install 'fontana[vdb]'" in line
