"""`fontana bench houdini` at tiny counts: what it writes and refuses, and that it notices a node that simulates another
fluid. No timing is asserted, and none decides: a budget is more than any machine needs, or less."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import fontana
from fontana.bench import _cook, bench_scene
from fontana.bench._schemes import SCHEMES

ROOT = Path(__file__).parents[2]


def bench_houdini(folder: Path, *options: object) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "fontana", "bench", "houdini", *map(str, options)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=600, env=os.environ)


@pytest.fixture(scope="module")
def small_run(tmp_path_factory, native_build) -> tuple[dict, str, Path]:
    path = tmp_path_factory.mktemp("bench") / "houdini.json"
    done = bench_houdini(ROOT, "--counts", "100,300", "--budget", 10000, "--threads", 1, "--out", path.parent)
    assert done.returncode == 0, done.stderr
    return json.loads(path.read_text()), done.stdout, path


def test_every_number_of_the_tables_is_there(small_run):
    results, _, _ = small_run
    assert results["state"] == "finished" and set(results["scenes"]) == {"fountain", "box"}
    for rows in results["scenes"].values():
        assert [row["particles"] for row in rows] == [100, 300]
        for row in rows:
            for scheme in SCHEMES:
                cell = row["cells"][scheme.name]
                if cell["state"] == "not run":
                    assert scheme.backend == "opencl"
                    continue
                assert cell["state"] == "measured", cell
                for key in ("node_seconds", "library_seconds"):
                    assert cell[key]["median"] > 0 and cell[key]["repeats"] >= 1
                found = cell["overhead_percent"]
                assert found["lower_quartile"] <= found["median"] <= found["upper_quartile"]
    assert results["overhead_percent_100k"] is None


def test_the_tables_show_the_thesis_and_say_what_they_are_not(small_run):
    _, text, _ = small_run
    assert "Table 3" in text and "Table 4" in text
    assert "(3.4)" in text  # Table 3, 100 particles, CPU simple
    assert "not in Houdini" in text


def test_the_figures_are_drawn_and_drawn_again(small_run, tmp_path):
    _, _, path = small_run
    picture = path.with_suffix(".png").read_bytes()
    again = tmp_path / "again.png"
    command = [sys.executable, "-m", "fontana", "bench", "plot", path, "--out", again]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    assert picture[:4] == b"\x89PNG" and again.read_bytes() == picture


def test_a_row_that_is_cut_off_says_so_and_why(tmp_path, native_build):
    path = tmp_path / "houdini.json"
    options = ("--counts", "100,300", "--scenes", "box", "--budget", 1e-9, "--threads", 1)
    done = bench_houdini(ROOT, *options, "--out", path.parent)
    assert done.returncode == 0, done.stderr
    first, second = json.loads(path.read_text())["scenes"]["box"]
    assert {cell["state"] for cell in first["cells"].values()} <= {"measured", "not run"}
    for name, cell in second["cells"].items():
        if cell["state"] == "not run":
            continue
        assert cell["state"] == "cut off" and cell["predicted_frame_seconds"] > 0
        assert "5 pairs of frames would take about" in cell["reason"]
        assert "budget of a number is 1e-09 s" in cell["reason"]
        assert f"cut off: box, 300 particles, {name}: {cell['reason']}" in done.stdout
        assert f"box, 300 particles, {name}: cut off: {cell['reason']}" in done.stderr


def test_outside_a_checkout_the_sentence_says_so(tmp_path):
    done = bench_houdini(tmp_path, "--counts", "100")
    assert done.returncode != 0 and "Traceback" not in done.stderr
    assert "expected to run in a checkout" in done.stderr.replace("\n", " ")


def test_an_unknown_scene_is_refused(tmp_path):
    done = bench_houdini(tmp_path, "--scenes", "bx")
    assert done.returncode != 0 and "did you mean box" in done.stderr.replace("\n", " ")


def test_a_node_that_simulates_another_fluid_is_noticed(native_build, monkeypatch):
    driver = native_build("fontana_cook_bench"), native_build("fontana_houdini")
    scene, scheme = bench_scene("box", 200), SCHEMES[1]
    _, dt = scene.build(scheme.backend)
    assert _cook.run_driver(driver, scene, scheme, dt, (0, 2, 1.0), 1)["same_positions"]
    settings = _cook._settings

    def without_gravity(*arguments):
        return [*settings(*arguments), "node_number forces_gravity 1 0"]

    monkeypatch.setattr(_cook, "_settings", without_gravity)
    with pytest.raises(fontana.InternalError, match="do not agree"):
        _cook.run_driver(driver, scene, scheme, dt, (0, 2, 1.0), 1)


def test_what_the_driver_cannot_read_is_a_sentence(native_build, tmp_path):
    request = tmp_path / "request.txt"
    for text, sentence in (
        ("nonsense 1\n", "no word 'nonsense'"),
        ("particles 5 none none\n", "cannot read 15 floats"),
    ):
        request.write_text(text)
        done = subprocess.run([native_build("fontana_cook_bench"), request], capture_output=True, text=True)
        assert done.returncode == 1 and sentence in done.stderr
