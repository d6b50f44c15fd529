"""The cases of `fontana validate` at small size: each keeps its figures. And the parts that say so."""

import json
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from fontana import BadInput
from fontana.validate import Figure, Stage, case_names, elliptical_drop, find_case, martin_moyce
from fontana.validate._dam_break import TIME_UNIT, best_lag, peer_front
from fontana.validate._reference import read_reference


def measure(name, **overrides):
    case = find_case(name)
    stage = Stage({"solver.backend": "cpu"} | {key.replace("__", "."): value for key, value in overrides.items()})
    outcome = case.measure(stage, case.resolutions["small"])
    assert all(run["unconverged"] <= 0.01 * run["substeps"] for run in stage.runs)
    return {figure.name: figure for figure in outcome.figures}


def assert_kept(figures):
    assert any(figure.limit is not None for figure in figures.values())
    assert all(np.isfinite(figure.value) for figure in figures.values())
    beyond = {name: (figure.value, figure.limit) for name, figure in figures.items() if not figure.is_kept}
    assert not beyond


@pytest.mark.parametrize("method", ["dfsph", "pcisph"])
@pytest.mark.parametrize("name", ["hydrostatic", "elliptical-drop", "martin-moyce", "koshizuka-oka", "round-pool"])
def test_a_case_keeps_its_figures(name, method):
    assert_kept(measure(name, fluid__method=method))


@pytest.mark.parametrize("name", ["methods-agree", "falling-rock", "convergence"])
def test_a_case_of_one_method_keeps_its_figures(name):
    assert_kept(measure(name))


def test_martin_moyce_is_within_what_is_aimed_at():
    figures = measure("martin-moyce")
    assert figures["arrival time, mean error"].value < 5.0
    assert figures["arrival time, largest error"].value < 12.0


def test_taylor_green_loses_its_energy_as_reported():
    """No acceptance figure: a net for what docs/validation.md says."""
    figures = measure("taylor-green")
    assert figures["speed after 1 s, off"].value > -20.0
    assert figures["velocities after 1 s, off from the vortex"].value < 20.0


def test_the_exact_drop_is_monaghans():
    """Both semi-axes after 0.0076 s at 100/s, as the literature has them: 1.95 for the long one."""
    a = elliptical_drop.semi_axes(np.array([0.0, 0.76]))
    assert a[0] == 1.0
    assert 1 / a[1] == pytest.approx(1.945, abs=0.005)


def test_the_reference_data_are_whole():
    martin_moyce = read_reference("martin_moyce_1952_n2_2.csv")
    assert martin_moyce.shape == (25, 3)
    assert (martin_moyce[:, 0] == 2.25).sum() == 15
    tip = read_reference("koshizuka_oka_1996_tip.csv")
    assert tip.shape == (15, 2)
    assert np.all(np.diff(tip, axis=0) > 0)
    hu = read_reference("hu_2010_tip.csv")
    assert [(hu[:, 0] == run).sum() for run in (1, 2)] == [19, 23]
    assert read_reference("lobovsky_2014_tip.csv").shape == (137, 2)
    times, fronts = peer_front()
    assert (times[-1], fronts[0]) == (2.3, 1.0)


def test_the_best_lag_is_found():
    recorded = np.array([1.0, 2.0, 4.0])
    assert best_lag(lambda lag: np.abs(recorded - 0.2 + lag - recorded), 0.4) == pytest.approx(0.2, abs=0.002)


def test_a_late_front_cannot_hide_in_the_lag_of_martin_moyce(monkeypatch):
    """SPlisHSPlasH's own front, and the same 0.3 time units later: the lag stays, the error grows."""
    times, fronts = peer_front()
    figures = {}
    for late in (0.0, 0.3):
        monkeypatch.setattr(martin_moyce, "front", lambda *_, late=late: (times + late * TIME_UNIT, fronts))
        outcome = martin_moyce.measure(Stage(), 32)
        figures[late] = {figure.name: figure.value for figure in outcome.figures}
    lag = "lag of the experiment's clock, of sqrt(a / 2g), by SPlisHSPlasH"
    own = "the lag that would fit this result best"
    assert figures[0.3][lag] == figures[0.0][lag] == figures[0.0][own]
    assert figures[0.3][own] == 0.0
    assert figures[0.3]["arrival time, mean error"] > 3 * figures[0.0]["arrival time, mean error"]


def test_a_figure_is_kept_by_its_absolute_value():
    assert Figure("x", -1.9, 2.0).is_kept
    assert not Figure("x", -2.1, 2.0).is_kept
    assert Figure("x", 1e9).is_kept


def test_an_unknown_case_is_refused_with_the_nearest():
    with pytest.raises(BadInput, match="did you mean hydrostatic"):
        find_case("hydrostatics")


def fontana(*words, folder, code=0):
    call = [sys.executable, "-m", "fontana", *map(str, words)]
    done = subprocess.run(call, cwd=folder, capture_output=True, text=True, timeout=300)
    assert done.returncode == code, done.stderr
    assert "Traceback" not in done.stderr
    return done


def test_the_command_writes_figures_with_their_conditions(tmp_path):
    done = fontana("validate", "koshizuka-oka", "--threads", 1, folder=tmp_path)
    results = json.loads((tmp_path / "out/validate/koshizuka-oka.json").read_text())
    assert results["command"].startswith("fontana validate koshizuka-oka")
    assert {"machine", "commit", "versions", "devices", "settings", "runs", "curves"} <= set(results)
    assert results["runs"][0]["substeps"] > 50
    for figure in results["figures"]:
        assert figure["name"] in done.stdout
    assert (tmp_path / "out/validate/koshizuka-oka.png").read_bytes()[:4] == b"\x89PNG"
    again = fontana("validate", "koshizuka-oka", "--threads", 1, "--resume", "--json", folder=tmp_path)
    assert json.loads(again.stdout)["cases"] == [results], "a finished case is kept, not run again"


def test_the_command_lists_and_refuses(tmp_path):
    listed = fontana("validate", "--list", folder=tmp_path).stdout
    assert all(name in listed for name in case_names())
    assert "did you mean martin-moyce" in fontana("validate", "martin-moice", folder=tmp_path, code=2).stderr


def test_a_figure_beyond_its_limit_is_a_failure(tmp_path):
    """The thesis's springy fluid runs ahead of water."""
    done = fontana("validate", "koshizuka-oka", "--method", "mueller", folder=tmp_path, code=7)
    assert "BEYOND" in done.stdout
    (sentence,) = done.stderr.splitlines()
    finding = r"koshizuka-oka: tip, mean error, of the column's width is [\d.]+ %, beyond its limit of 5 %"
    assert re.match(f"fontana: {finding}(; |$)", sentence), sentence
    again = fontana("validate", "koshizuka-oka", "--method", "mueller", "--json", folder=tmp_path, code=7)
    assert json.loads(again.stdout)["cases"], "one document, whatever it says"
    assert again.stderr == done.stderr


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_keeps_what_is_finished(tmp_path):
    words = [sys.executable, "-m", "fontana", "validate", "koshizuka-oka", "convergence", "--size", "full"]
    process = subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    first = tmp_path / "out/validate/koshizuka-oka.png"
    for _ in range(1200):
        if first.exists():
            break
        time.sleep(0.1)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130, errors
    assert "finished and kept: koshizuka-oka" in errors and "--resume" in errors
    assert "Traceback" not in errors
    assert not (tmp_path / "out/validate/convergence.json").exists()
