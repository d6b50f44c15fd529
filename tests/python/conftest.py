"""What the tests of the Python package share."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest
from command_line import fontana_command

DROP = {
    "name": "drop",
    "fluid": {"particle_spacing": 0.05, "viscosity": 5},
    "time": {"max_substeps": 500},
    "emitters": [{"type": "block", "centre": [0, 0.3, 0], "size": [0.3, 0.3, 0.3], "jitter": 0.1}],
    "colliders": [
        {"type": "plane_y"},
        {"type": "sphere_outside", "radius": 0.1, "keys": [{"frame": 0, "centre": [0.3, 0.1, 0]}]},
    ],
    "output": {"frames": 6},
}


@pytest.fixture
def drop() -> dict:
    """A scene of 216 particles that runs in a moment; a copy to change."""
    return json.loads(json.dumps(DROP))


@pytest.fixture
def drop_file(drop: dict, tmp_path: Path) -> Path:
    path = tmp_path / "drop.json"
    path.write_text(json.dumps(drop))
    return path


@pytest.fixture
def fontana(tmp_path: Path):
    """Runs the command line in a folder of its own and returns the finished process."""

    def call(*arguments: object, code: int = 0, env: dict | None = None, **options) -> subprocess.CompletedProcess:
        done = subprocess.run(
            fontana_command(*arguments),
            cwd=tmp_path,
            env=os.environ | {"FONTANA_DEBUG": ""} | (env or {}),
            capture_output=True,
            text=True,
            **options,
        )
        assert done.returncode == code, f"code {done.returncode}\n{done.stdout}\n{done.stderr}"
        assert "Traceback" not in done.stderr or (env or {}).get("FONTANA_DEBUG")
        return done

    return call
