"""What the tests of the Python package share."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from small_scenes import DROP


@pytest.fixture
def drop() -> dict:
    """A scene of 216 particles that runs in a moment; a copy to change."""
    return json.loads(json.dumps(DROP))


@pytest.fixture
def drop_file(drop: dict, tmp_path: Path) -> Path:
    path = tmp_path / "drop.json"
    path.write_text(json.dumps(drop))
    return path
