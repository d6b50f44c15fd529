"""The benchmarks at tiny counts: what they write and print, and that they end well. No timing is asserted."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from matplotlib import image

from fontana import BadInput, bench

REPOSITORY = Path(__file__).resolve().parents[2]
SCHEMES = ("CPU simple", "CPU grid", "GPU simple", "GPU grid")
# Seconds for a number, so that no machine, however busy, cuts one off; and so that each cuts off all but the first row.
ENOUGH, TOO_LITTLE = 10000, 1e-9
RATES = ("substep_seconds", "frames_per_second", "million_particle_substeps_per_second")


def environment(**extra: str) -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name != "FONTANA_DEBUG"} | extra


def call(command: list, folder: Path, code: int = 0, **extra: str) -> subprocess.CompletedProcess:
    words = [sys.executable, *map(str, command)]
    done = subprocess.run(words, cwd=folder, env=environment(**extra), capture_output=True, text=True, timeout=300)
    assert done.returncode == code, f"code {done.returncode}\n{done.stdout}\n{done.stderr}"
    assert "Traceback" not in done.stderr
    return done


def thesis(folder: Path, *options: object, code: int = 0, **extra: str) -> subprocess.CompletedProcess:
    return call(["-m", "fontana", "bench", "thesis", *options], folder, code, **extra)


def read(path: Path) -> dict:
    return json.loads(path.read_text())


def assert_is_picture(path: Path) -> None:
    assert path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    pixels = image.imread(path)
    assert 300 < pixels.shape[0] < 3000
    assert 400 < pixels.shape[1] < 4000
    assert len(np.unique(pixels.reshape(-1, pixels.shape[2]), axis=0)) > 20, "nothing is drawn"


@pytest.fixture(scope="module")
def small_run(tmp_path_factory) -> tuple[Path, subprocess.CompletedProcess]:
    """Both scenes at two counts."""
    folder = tmp_path_factory.mktemp("thesis")
    return folder / "out/bench", thesis(folder, "--counts", "500,100", "--budget", ENOUGH, "--threads", 1)


def test_thesis_writes_every_number_with_its_conditions(small_run):
    results = read(small_run[0] / "thesis.json")
    assert results["state"] == "finished"
    assert results["command"] == f"fontana bench thesis --counts 500,100 --budget {ENOUGH} --threads 1"
    assert {"cpu", "cores", "usable_cores", "memory_bytes", "os", "load_average_before", "load_average_after"} <= set(
        results["machine"]
    )
    assert {device["backend"] for device in results["devices"]} == {"cpu", "cuda", "opencl"}
    assert results["versions"]["fontana"]
    assert results["commit"] is None, "the folder of the run is no checkout"
    assert list(results["scenes"]) == ["fountain", "box"]
    for rows in results["scenes"].values():
        assert [row["particles"] for row in rows] == [100, 500]
        for row in rows:
            assert row["mean_neighbors"] > 5
            assert tuple(row["cells"]) == SCHEMES
            assert row["cells"]["CPU simple"]["ratio_to_cpu_simple"] == 1.0
            for cell in row["cells"].values():
                assert_is_sound(cell, row["particles"])


def assert_is_sound(cell: dict, particles: int) -> None:
    if cell["state"] == "not run":
        assert cell["reason"]
        return
    assert cell["state"] == "measured"
    for name in RATES:
        assert 0 < cell[name]["minimum"] <= cell[name]["median"] <= cell[name]["maximum"]
        assert cell[name]["repeats"] >= 1
    substep = cell["substep_seconds"]["median"]
    if cell["substep_seconds"]["repeats"] % 2:  # else the median lies between two samples
        assert cell["frames_per_second"]["median"] == pytest.approx(1 / (10 * substep), rel=1e-3)
        work = cell["million_particle_substeps_per_second"]["median"]
        assert work == pytest.approx(1e-6 * particles / substep, rel=1e-3)


def test_thesis_prints_both_tables_and_draws_them(small_run):
    folder, done = small_run
    for line in (
        "fountain: frames per second (Table 1 of the thesis)",
        "box: frames per second (Table 2 of the thesis)",
    ):
        assert line in done.stdout
    assert "million particle-substeps per second" in done.stdout
    assert "(1.00x)" in done.stdout
    assert "1 thread;" in done.stdout
    assert_is_picture(folder / "thesis.png")


def test_plot_draws_the_same_picture_again(small_run, tmp_path):
    call(["-m", "fontana", "bench", "plot", small_run[0] / "thesis.json", "--out", "again.png"], tmp_path)
    assert (tmp_path / "again.png").read_bytes() == (small_run[0] / "thesis.png").read_bytes()


@pytest.mark.parametrize("text", ["{}", "[1]", '{"benchmark": "scaling"}', "{", ""])
def test_plot_refuses_other_files(tmp_path, text):
    (tmp_path / "other.json").write_text(text)
    done = call(["-m", "fontana", "bench", "plot", "other.json"], tmp_path, code=2)
    assert "other.json" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not (tmp_path / "other.png").exists()


@pytest.mark.parametrize("benchmark", ["thesis", "houdini"])
@pytest.mark.parametrize("state", ["measured", "cut off"])
def test_plot_refuses_a_cell_without_its_number(small_run, tmp_path, benchmark, state):
    results = read(small_run[0] / "thesis.json") | {"benchmark": benchmark}
    results["scenes"] = {"box": [{"particles": 100, "cells": {"CPU grid": {"state": state}}}]}
    (tmp_path / "other.json").write_text(json.dumps(results))
    done = call(["-m", "fontana", "bench", "plot", "other.json"], tmp_path, code=2)
    assert "CPU grid" in done.stderr and "required" in done.stderr


def test_all_pairs_is_cut_off_by_time(tmp_path):
    done = thesis(tmp_path, "--counts", "100,500", "--budget", TOO_LITTLE, "--scenes", "box")
    cell = read(tmp_path / "out/bench/thesis.json")["scenes"]["box"][1]["cells"]["CPU simple"]
    assert cell["state"] == "cut off"
    assert cell["predicted_substep_seconds"] > TOO_LITTLE
    assert "cut off (about " in done.stdout
    assert f"cut off: box, 500 particles, CPU simple: {cell['reason']}" in done.stdout
    assert "one substep would take about" in cell["reason"]
    assert_is_picture(tmp_path / "out/bench/thesis.png")


def test_first_row_is_cut_off_too(tmp_path):
    thesis(tmp_path, "--counts", "1000000", "--budget", TOO_LITTLE, "--scenes", "box")
    cells = read(tmp_path / "out/bench/thesis.json")["scenes"]["box"][0]["cells"]
    assert cells["CPU simple"]["state"] == "cut off"
    assert cells["CPU grid"]["state"] == "cut off"


def test_without_opencl_the_columns_say_why(tmp_path):
    nowhere = str(tmp_path / "libNone.so")
    done = thesis(tmp_path, "--counts", 100, "--budget", 0.05, "--scenes", "box", FONTANA_OPENCL_LIBRARY=nowhere)
    cells = read(tmp_path / "out/bench/thesis.json")["scenes"]["box"][0]["cells"]
    assert {name: cell["state"] for name, cell in cells.items()} == {
        "CPU simple": "measured",
        "CPU grid": "measured",
        "GPU simple": "not run",
        "GPU grid": "not run",
    }
    assert cells["GPU grid"]["reason"]
    assert f"OpenCL (the GPU columns) did not run: {cells['GPU grid']['reason']}" in done.stdout


def test_interrupt_keeps_what_is_measured(tmp_path):
    command = [sys.executable, "-m", "fontana", "bench", "thesis", "--scenes", "box", "--counts", "100,20000"]
    process = subprocess.Popen(
        [*command, "--budget", "60"], cwd=tmp_path, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    path = tmp_path / "out/bench/thesis.json"
    deadline = time.monotonic() + 120
    while not (path.exists() and read(path)["scenes"]["box"]):
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    output, complaints = process.communicate(timeout=120)
    assert process.returncode == 130, complaints.decode()
    results = read(path)
    assert results["state"] == "interrupted"
    assert results["scenes"]["box"][0]["cells"]["CPU grid"]["state"] == "measured"
    assert "interrupted: these are the numbers until then" in output.decode()
    assert_is_picture(path.with_suffix(".png"))


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--counts", "10,many"), "expected particle counts"),
        (("--counts", "0"), "expected particle counts"),
        (("--scenes", "boxx"), "did you mean box?"),
        (("--budget", "0"), "--budget"),
        (("--out", "file/bench"), "file/bench"),
    ],
)
def test_bad_options_are_one_sentence(tmp_path, options, sentence):
    (tmp_path / "file").write_text("")
    code = 6 if "--out" in options else 2
    assert sentence in thesis(tmp_path, *options, code=code).stderr


@pytest.mark.parametrize("name", ["box", "fountain"])
def test_scenes_have_exactly_the_count_and_about_thirty_neighbours(name):
    scene = bench.bench_scene(name, 30_001)
    assert scene.position.shape == scene.velocity.shape == (30_001, 3)
    again = bench.bench_scene(name, 30_001)
    np.testing.assert_array_equal(scene.position, again.position)
    simulation, dt = scene.build("cpu")
    clocked = bench.clock_substeps(simulation, dt, "grid", 0.01)
    assert clocked.seconds
    assert simulation.particle_count == 30_001
    assert 24 < simulation.count_neighbors().mean() < 34
    assert simulation.read("position")[:, 1].min() >= 0.0


def test_unknown_scene_is_refused():
    with pytest.raises(BadInput, match="expected box or fountain"):
        bench.bench_scene("pool", 100)


def test_statistics():
    assert bench.statistics([3.0, 1.0, 2.0]) == {"median": 2.0, "minimum": 1.0, "maximum": 3.0, "repeats": 3}
    assert bench.significant(1.23456789) == 1.2346


def test_scaling_states_the_bound_and_the_profile(tmp_path):
    options = ["--counts", "200,10000,12000", "--profile-count", 500, "--opencl-most", 200, "--budget", 0.05]
    done = call([REPOSITORY / "benchmarks/scaling.py", *options, "--out", tmp_path], tmp_path)
    results = read(tmp_path / "scaling.json")
    assert [row["particles"] for row in results["costs"]["cpu"]] == [200, 10_000, 12_000]
    bound = results["bound"]["cpu"]
    assert bound["kept"] == (bound["ratio"] <= 1.5)
    assert (bound["from"], bound["to"]) == (10_000, 12_000)
    rows = {row["name"]: row for row in results["profiles"]["cpu"]["rows"]}
    assert {"density", "fluid_force", "integrate", "sort"} <= set(rows)
    assert sum(row["share"] for row in rows.values()) == pytest.approx(1.0, abs=1e-3)
    density = rows["density"]
    assert density["launches"] == results["profiles"]["cpu"]["substeps"]
    flops = density["flops_per_particle"] * 500 * density["launches"]
    assert density["gigaflops"] == pytest.approx(1e-6 * flops / density["milliseconds"], rel=1e-3)
    assert "GFLOP/s" in done.stdout
    assert "the bound of 1.5" in done.stdout
    assert_is_picture(tmp_path / "scaling.png")


@pytest.mark.skipif(not (os.environ.get("CXX") or shutil.which("g++") or shutil.which("c++")), reason="no C++ compiler")
def test_pointer_grid_agrees_and_notices_full_cells(tmp_path):
    done = call([REPOSITORY / "benchmarks/pointer_grid.py", "--counts", "1000", "--out", tmp_path], tmp_path)
    results = read(tmp_path / "pointer_grid.json")
    assert [row["order"] for row in results["rows"]] == ["lattice", "shuffled"]
    for row in results["rows"]:
        assert row["disagreement"] <= 1e-5
        assert row["pointer_grid"]["grid_bytes"] > row["sorted_grid"]["grid_bytes"]
    packed = results["packed"]
    assert packed["full_cells"] > 0
    assert f"{packed['particles_without_place']:,} particles have no place" in done.stdout
