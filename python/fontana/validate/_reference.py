"""Experiments from the literature (fontana/data/reference; README.md there has the sources)."""

from __future__ import annotations

from importlib import resources

import numpy as np


def read_reference(name: str) -> np.ndarray:
    """(N, columns) numbers of a CSV file there; comments begin with #, the first other line names the columns."""
    text = (resources.files("fontana") / "data" / "reference" / name).read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return np.array([[float(value) for value in line.split(",")] for line in lines[1:]])
