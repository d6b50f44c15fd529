"""tools/gpu_check, run through without a GPU: on the CPU's OpenCL where that is allowed, and one sentence where not."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from fontana import _core

ROOT = Path(__file__).parents[2]
TOOL = ROOT / "tools" / "gpu_check"
TINY = ("--counts", "300", "--profile-count", "300", "--budget", "0.05", "--tests", "tests/unit")
sys.path.insert(0, str(ROOT / "tools"))

import gpu_report  # noqa: E402


def gpu_check(*options, **environment):
    command = [TOOL, "--no-build", *map(str, options)]
    variables = {"PATH": "/usr/bin:/bin", "PYTHON": sys.executable} | environment
    return subprocess.run(command, env=variables, capture_output=True, text=True, timeout=600)


@pytest.fixture(scope="module")
def report(opencl_device, tmp_path_factory):
    """The finished process and the folder of its report."""
    if any(device.is_gpu for device in _core.devices()):
        pytest.skip("there is a GPU: tools/gpu_check itself says more than its test")
    folder = tmp_path_factory.mktemp("report")
    return gpu_check(
        "--allow-cpu", *TINY, "--out", folder, PATH=str(Path(sys.executable).parent) + ":/usr/bin:/bin"
    ), folder


def test_every_part_is_done_and_in_the_report(report):
    done, folder = report
    assert done.returncode == 0, done.stdout + done.stderr
    parts = json.loads((folder / "report.json").read_text())["parts"]
    assert {name: part["state"] for name, part in parts.items()} == dict.fromkeys(
        ("agreement", "tests", "speed", "profiles", "compilers"), "done"
    )
    assert {row["method"] for row in parts["agreement"]["rows"]} == {"dfsph", "pcisph", "wcsph", "mueller"}
    assert " passed" in parts["tests"]["end"][-1]
    for row in parts["speed"]["rows"]:
        ratio = next(value for name, value in row.items() if name.startswith("ratio"))
        device = next(value for name, value in row.items() if name.startswith("opencl"))
        assert ratio == pytest.approx(device["median"] / row["cpu"]["median"], rel=1e-3)
    for shown in parts["profiles"]["rows"]:
        assert shown["copy_gigabytes_per_second"] > 0
        assert any("share_of_copy" in row for row in shown["rows"])


def test_the_page_has_every_part_and_says_that_it_was_no_gpu(report):
    _, folder = report
    page = (folder / "report.md").read_text()
    assert "no GPU is present: what follows ran on a CPU and says nothing about GPUs" in page
    for words in (
        "| mueller | opencl 0 | tiles | strict |",
        "| dfsph | 300 |",
        "| fluid_force |",
        "### dfsph on opencl 0",
    ):
        assert words in page
    assert "Failed" not in page
    assert "host" not in page.lower()


def test_without_a_gpu_it_says_so_in_a_sentence(report, tmp_path):
    done = gpu_check(*TINY, "--out", tmp_path / "none")
    assert done.returncode == 1
    assert done.stderr.startswith("gpu_check: no GPU is present here (")
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "none").exists()


def test_a_part_that_fails_is_told_and_does_not_stop_the_others():
    def lost() -> dict:
        raise _core.DeviceLost("the device is lost")

    assert gpu_report.guarded(lost) == {"state": "failed", "reason": "the device is lost"}
    assert gpu_report.guarded(lambda: {"rows": []}) == {"state": "done", "rows": []}
    unknown = gpu_report.Device("opencl", 63, "none")
    assert "no OpenCL device" in gpu_report.clocked("mueller", 100, unknown, 0.01)["failed"]


def test_tests_that_fail_make_the_part_fail(tmp_path):
    (tmp_path / "test_broken.py").write_text("def test_broken():\n    assert False\n")
    part = gpu_report.guarded(lambda: gpu_report.run_tests(str(tmp_path)))
    assert (part["state"], part["reason"]) == ("failed", "exit code 1")
    assert gpu_report.run_tests("") == {"state": "left out"}


def test_the_folder_is_named_after_the_device():
    assert gpu_report.folder_name("NVIDIA H100 80GB HBM3 (MIG)").startswith("gpu-nvidia-h100-80gb-hbm3-mig-2")
