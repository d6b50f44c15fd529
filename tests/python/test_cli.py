"""The command line: help, listings, and one sentence with the right exit code for each kind of trouble."""

from __future__ import annotations

import itertools
import json
import os
import subprocess
from pathlib import Path

import pytest
from command_line import error_line, fontana_command

import fontana as package
import fontana.cli.verify as verify_module
from fontana import exit_codes
from fontana.errors import BeyondLimit

COMMANDS = ["run", "resume", "devices", "verify", "bench", "scenes", "schema", "explain", "fluids"]


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_examples(fontana, command: str) -> None:
    text = fontana(command, "--help").stdout
    assert "Examples:" in text
    assert f"fontana {command}" in text


def test_the_main_help_tells_commands_and_exit_codes(fontana) -> None:
    text = fontana("--help").stdout
    for command in COMMANDS:
        assert f"\n  {command} " in text
    for code in (0, 2, 3, 4, 5, 6, 7, 70, 130, 143):
        assert f"\n    {code} " in text
    assert package.version() in fontana("--version").stdout
    assert "..." not in text.partition("Commands:")[2], "a summary is cut"


def test_devices_lists_the_cpu_and_what_auto_takes(fontana) -> None:
    assert "--backend auto takes" in fontana("devices").stdout
    devices = json.loads(fontana("devices", "--json").stdout)
    assert any(device["backend"] == "cpu" and device["available"] for device in devices)
    assert all(device["available"] or device["reason"] for device in devices)


def test_an_absent_opencl_is_explained_and_refused(fontana, drop_file: Path) -> None:
    absent = {"FONTANA_OPENCL_LIBRARY": "/nowhere/libOpenCL.so"}
    assert "not available: opencl" in fontana("devices", env=absent).stdout
    done = fontana("run", drop_file, "--backend", "opencl", env=absent, code=5)
    assert "/nowhere/libOpenCL.so" in error_line(done)


def test_explain_knows_parameters_and_offers_the_nearest(fontana) -> None:
    text = fontana("explain", "viscosity").stdout
    assert "fluid.viscosity: Viscosity" in text
    assert "Pa.s" in text
    everything = fontana("explain").stdout
    assert all(parameter.name in everything for parameter in package.parameters())
    assert "cutoff" in fontana("explain", "cylinder_inside").stdout
    assert "did you mean fluid.viscosity?" in error_line(fontana("explain", "fluid.viscocity", code=2))


def test_fluids_show_ranges_and_sources(fontana) -> None:
    assert "honey" in fontana("fluids").stdout
    text = fontana("fluids", "honey").stdout
    assert "2 to 40 Pa.s" in text
    assert "source" in text
    assert "did you mean honey?" in error_line(fontana("fluids", "honney", code=2))
    assert json.loads(fontana("fluids", "--json").stdout)[0]["key"] == "water"


def test_a_reader_that_has_enough_is_no_error() -> None:
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(fontana_command("schema"), stdout=write, stderr=subprocess.PIPE, text=True)
    os.close(write)
    assert (done.returncode, done.stderr) == (0, "")


def test_scenes_and_schema(fontana) -> None:
    names = {entry["name"] for entry in json.loads(fontana("scenes", "--json").stdout)}
    assert names >= {"box", "fountain", "fountain_rock", "thesis_box", "thesis_fountain"}
    assert "box" in fontana("scenes").stdout
    assert json.loads(fontana("schema").stdout) == package.scene_schema()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"fluid": {"viscocity": 1}}, "did you mean fluid.viscosity?"),
        ({"fluid": {"particle_mass": -1}}, "fluid.particle_mass: -1 is below the least allowed, 0"),
        ({"time": {"substeps": -1}}, "time.substeps: -1 is below the least allowed, 0"),
        ({"emitters": []}, "the scene has no emitters"),
        ({"emitters": [{"type": "sphere", "radius": 1, "first_frame": 99}]}, "no emitter makes a particle by frame 6"),
        ({"fluid": {"viscosity": 1e5}}, "substeps a frame"),
        ({"fluid": {"viscosity": 1e3}, "time": {"substeps": 2}}, "viscosity of 1e+03"),
    ],
)
def test_a_bad_scene_is_exit_code_2_and_one_sentence(fontana, drop: dict, tmp_path: Path, change, sentence) -> None:
    (tmp_path / "bad.json").write_text(json.dumps(drop | change))
    done = fontana("run", "bad.json", code=2)
    assert sentence in error_line(done)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["run", "fountian"], "did you mean fountain"),
        (["run", "box", "--set", "fluid.viscosity=fast"], 'fluid.viscosity: "fast": expected a number'),
        (["run", "box", "--set", "nonsense"], "expected path=value"),
        (["resume", "."], "it is not the folder of a run"),
    ],
)
def test_bad_arguments_are_exit_code_2(fontana, arguments: list[str], sentence: str) -> None:
    assert sentence in error_line(fontana(*arguments, code=2))


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["run", "box", "--bakend", "cpu"], "no such option '--bakend'; did you mean '--backend'?"),
        (["runn", "box"], "no such command 'runn'; did you mean 'run'?"),
        (["bench", "thesi"], "no such command 'thesi'; did you mean thesis?"),
        (["run"], "missing argument 'SCENE'; fontana run --help says more"),
        (["run", "box", "--backend", "opencll"], '--backend: "opencll" is not one of auto, cpu, cuda, opencl; did you'),
        (["run", "box", "--frames", "0"], "--frames: 0 is not in the range x>=1"),
        (["bench", "thesis", "--counts", "a"], '--counts: "a": expected particle counts from 1'),
        (["bench", "thesis", "--budget", "inf"], "--budget: inf is not a finite number"),
        (["render", "out", "-o", "a.gif", "--fps", "nan"], "--fps: nan is not a finite number"),
        (["mesh", "out", "--cell-size", "nan"], "--cell-size: nan is not a finite number"),
        (["export", "out", "-o", "a.vdb", "--voxel-size", "nan"], "--voxel-size: nan is not a finite number"),
    ],
)
def test_a_command_line_that_is_wrong_is_one_sentence(fontana, arguments: list[str], sentence: str) -> None:
    assert error_line(fontana(*arguments, code=2)).startswith(f"fontana: {sentence}")


def test_what_is_wrong_with_a_change_is_not_laid_to_the_file(fontana, drop_file: Path) -> None:
    line = error_line(fontana("run", drop_file, "--set", "fluid.viscosty=3", code=2))
    assert line == "fontana: fluid.viscosty: there is no such key; did you mean fluid.viscosity?"
    drop_file.write_text(drop_file.read_text().replace('"fluid"', '"fluids"'))
    line = error_line(fontana("run", drop_file, "--set", "fluid.viscosity=3", code=2))
    assert line.startswith(f"fontana: {drop_file}: fluids: there is no such")


def test_json_has_the_error_too(fontana) -> None:
    done = fontana("run", "fountian", "--json", code=2)
    event = json.loads(done.stdout)
    assert event["event"] == "error"
    assert event["code"] == 2
    assert "did you mean fountain" in event["message"]


def test_dry_run_says_the_costs_and_writes_nothing(fontana, drop_file: Path, tmp_path: Path) -> None:
    text = fontana("run", drop_file, "--dry-run").stdout
    for word in ("216 particles", "memory", "disk", "substeps", "convergence", "M particle-substeps/s", "run it:"):
        assert word in text
    result = json.loads(fontana("run", drop_file, "--dry-run", "--json").stdout)
    assert result["particles"] == 216
    assert result["seconds"] > 0
    assert result["disk_bytes"] >= 6 * 216 * 48
    assert not (tmp_path / "out").exists()


def test_verify_compares_every_device_by_every_method(fontana) -> None:
    result = json.loads(fontana("verify", "--json").stdout)
    schemes = {(row["method"], row["backend"], row["neighbors"], row["precision"]) for row in result["rows"]}
    wanted = itertools.product(verify_module.METHODS, ["cpu"], ("grid", "all-pairs"), ("strict", "fast"))
    assert set(wanted) <= schemes
    devices = {(row["backend"], row["device"]) for row in result["rows"]}
    assert len(devices) == sum(device.available for device in package.devices())
    assert all(row["passed"] for row in result["rows"])


def test_verify_takes_methods(fontana) -> None:
    rows = json.loads(fontana("verify", "--method", "wcsph", "--json").stdout)["rows"]
    assert {row["method"] for row in rows} == {"wcsph"}
    assert '"sph" is not one of' in error_line(fontana("verify", "--method", "sph", code=2))


@pytest.mark.parametrize(
    ("method", "name", "change", "finding"),
    [
        ("mueller", "density", 2.4e-7, "not the bits of the first device"),
        ("mueller", "acceleration", 1e-3, r"the disagreement of acceleration is [\d.]+, beyond its limit of 2e-05"),
        ("dfsph", "velocity", 1e-3, r"the disagreement of velocity is [\d.]+, beyond its limit of 0.0001"),
    ],
)
def test_verify_notices_a_last_bit_in_strict_and_a_small_error_elsewhere(
    monkeypatch, capsys, method, name, change, finding
) -> None:
    """The results of the schemes are those of the library, but for one number of all. A result, not a defect."""
    plain = verify_module._results
    calls = []

    def changed(*scheme: object) -> dict:
        results = plain(*scheme)
        calls.append(scheme)
        if len(calls) == 2:  # the first is the reference, the second its own scheme once more
            results[name].flat[5] = results[name].flat[5] * (1 + change) + (change > 1e-6) * results[name].max()
        return results

    monkeypatch.setattr(verify_module, "_results", changed)
    cpu = next(device for device in package.devices() if device.backend == "cpu")
    monkeypatch.setattr(verify_module, "_numbered", lambda devices: [(cpu, 0)])
    with pytest.raises(BeyondLimit, match=f"^{method}/cpu/0/all-pairs/strict: {finding}") as raised:
        verify_module.verify.callback((method,), as_json=True)
    assert exit_codes.exit_code(raised.value) == 7
    assert exit_codes.sentence(raised.value) == str(raised.value)
    assert [row["passed"] for row in json.loads(capsys.readouterr().out)["rows"]] == [False, True, True, True]
    assert calls[0] == calls[1]


def test_a_bug_is_reported_without_a_traceback(fontana, tmp_path: Path) -> None:
    """sitecustomize breaks one function in the child, as a defect of ours would."""
    (tmp_path / "sitecustomize.py").write_text(
        "import fontana.scene\ndef broken():\n    raise KeyError('on purpose')\nfontana.scene.bundled_scenes = broken\n"
    )
    done = fontana("scenes", env={"PYTHONPATH": str(tmp_path)}, code=70)
    assert "internal error" in error_line(done)
    shown = fontana("scenes", env={"PYTHONPATH": str(tmp_path), "FONTANA_DEBUG": "1"}, code=70)
    assert "Traceback" in shown.stderr
