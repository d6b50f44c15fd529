"""benchmarks/dam_break_clock.py with few particles: what it writes, and that its gate is one."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "benchmarks/dam_break_clock.py"


def test_a_gate_that_is_pulled_up_makes_the_front_earlier(tmp_path):
    call = [sys.executable, str(SCRIPT), "--spacings", "8", "--out", str(tmp_path)]
    done = subprocess.run(call, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    results = json.loads((tmp_path / "dam_break_clock.json").read_text())
    assert {"machine", "commit", "command", "settings"} <= set(results)
    rows = {row["name"]: row for row in results["rows"]}
    assert all(name in done.stdout for name in rows)
    at_once, slowest = rows["let go at once"], rows["gate, gone in 1 sqrt(2 H / g)"]
    assert slowest["tip_mean"] > 1.3 * at_once["tip_mean"]
    assert slowest["lobovsky"]["ahead_first"] > at_once["lobovsky"]["ahead_first"] + 1.0


def test_a_closed_gate_holds_the_water():
    specification = importlib.util.spec_from_file_location("dam_break_clock", SCRIPT)
    script = importlib.util.module_from_spec(specification)
    sys.modules["dam_break_clock"] = script  # a dataclass asks for its module by name
    specification.loader.exec_module(script)
    _, fronts = script.foremost(script.Setup(1 / 8, seconds=0.5, gate=1e6))
    assert fronts[-1] < 1.0 + 0.5 / 8
