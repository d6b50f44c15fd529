"""What the tests of the Python package share."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

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
