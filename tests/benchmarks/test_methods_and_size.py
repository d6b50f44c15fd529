"""benchmarks/methods.py and benchmarks/large.py at tiny counts: what they write. No timing is asserted."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from fontana import _core

REPOSITORY = Path(__file__).resolve().parents[2]


def script(name, *options, folder):
    call = [sys.executable, str(REPOSITORY / "benchmarks" / name), "--out", str(folder), *map(str, options)]
    done = subprocess.run(call, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    results = json.loads((folder / name.replace(".py", ".json")).read_text())
    assert {"machine", "commit", "command", "devices", "settings"} <= set(results)
    assert (folder / name.replace(".py", ".png")).read_bytes()[:4] == b"\x89PNG"
    return results, done.stdout


def test_methods_are_compared_at_the_same_error(tmp_path):
    results, said = script("methods.py", "--particles", 1500, "--seconds", 0.2, "--repeats", 1, folder=tmp_path)
    for at in results["errors"]:
        assert set(at["methods"]) == {"mueller", "wcsph", "pcisph", "dfsph"}
        for name, row in at["methods"].items():
            assert row["particles"] == 1372 and row["substeps"] >= 10
            if name in ("mueller", "wcsph"):
                assert row["error_percent"] == pytest.approx(at["error_percent"], rel=0.11)
                assert row["pressure_constant"] > 0 and row["iterations"] == 0
            else:
                assert row["iterations"] >= 2 * row["substeps"] and row["pressure_constant"] is None
        ratio = at["speed_over"]["mueller"]["dfsph"]
        assert ratio * at["speed_over"]["dfsph"]["mueller"] == pytest.approx(1, rel=1e-3)
    stiffness = [at["methods"]["wcsph"]["pressure_constant"] for at in results["errors"]]
    assert stiffness[1] > 3 * stiffness[0], "a tenth of the error takes a stiffer fluid"
    assert "the thesis expects 10" in said


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc/self/status")
def test_time_and_memory_are_measured_by_count(tmp_path):
    counts = ("--counts", "1000,8000", "--opencl-most", 1000, "--repeats", 1)
    results, said = script("large.py", *counts, folder=tmp_path)
    rows = [row for row in results["rows"] if row["backend"] == "cpu"]
    assert [(row["method"], row["particles"]) for row in rows] == [
        (method, count) for count in (1000, 8000) for method in ("dfsph", "mueller")
    ]
    for row in rows:
        assert row["nanoseconds_per_particle_substep"]["median"] > 0
        assert (2 <= row["iterations_per_substep"] <= 5) == (row["method"] == "dfsph")
        assert row["bytes_per_particle"] > 0.5 * row["estimated_bytes_per_particle"]
    assert "bytes/particle" in said


@pytest.mark.parametrize(
    "column, backend, precision", [(1, "cpu", "fast"), (2, "cpu", "strict"), (2, "opencl", "fast"), (3, "cuda", "fast")]
)
def test_the_documents_say_what_a_million_particles_take(use_backend, column, backend, precision):
    use_backend(backend)
    text = (REPOSITORY / "docs/methods.md").read_text()
    for method in ("mueller", "wcsph", "pcisph", "dfsph"):
        said = re.search(rf"^\| `{method}` \|" + 3 * r" (\d+) MB \|" + "$", text, re.MULTILINE)
        assert said, f"docs/methods.md does not say what {method} takes"
        simulation = _core.Simulation()
        simulation.set("fluid.method", method)
        simulation.set("solver.backend", backend)
        simulation.set("solver.precision", precision)
        if backend == "opencl" and simulation.device().is_gpu:
            column = 3
        assert int(said[column]) == pytest.approx(simulation.estimate_memory(1_000_000) / 1e6, abs=0.6)
