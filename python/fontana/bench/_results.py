"""The files of results: JSON that is written after every row, and read back to draw it."""

from __future__ import annotations

import json
from pathlib import Path

from jsonschema import Draft202012Validator

from fontana import _core
from fontana.errors import clean
from fontana.reader import read_json

_STATISTICS = {"type": "object", "required": ["median", "minimum", "maximum", "repeats"]}
_CELL = {
    "type": "object",
    "required": ["state"],
    "properties": {
        "state": {"enum": ["measured", "cut off", "not run", "failed"]},
        "frames_per_second": _STATISTICS,
        "predicted_substep_seconds": {"type": "number", "exclusiveMinimum": 0},
    },
    "if": {"properties": {"state": {"const": "measured"}}},
    "then": {"required": ["frames_per_second", "million_particle_substeps_per_second"]},
}
_ROW = {
    "type": "object",
    "required": ["particles", "cells"],
    "properties": {
        "particles": {"type": "integer", "minimum": 1},
        "cells": {"type": "object", "additionalProperties": _CELL},
    },
}
_SCHEMA = {
    "type": "object",
    "required": ["benchmark", "machine", "devices", "scenes"],
    "properties": {
        "benchmark": {"const": "thesis"},
        "machine": {"type": "object", "required": ["cpu", "usable_cores"]},
        "devices": {"type": "array", "items": {"type": "object", "required": ["backend", "is_gpu", "available"]}},
        "scenes": {"type": "object", "additionalProperties": {"type": "array", "items": _ROW}},
    },
}


def publish_json(path: Path, results: dict) -> None:
    """Writes the results, in one step. Raises IoError."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _core.IoError(f'the folder "{path.parent}" cannot be made: {error.strerror}') from error
    _core.publish_file(str(path), (json.dumps(results, indent=1, allow_nan=False) + "\n").encode())


def load_results(path: Path) -> dict:
    """The results of `fontana bench thesis`. Raises BadInput for any other file."""
    results = read_json(path)
    error = next(Draft202012Validator(_SCHEMA).iter_errors(results), None)
    if error:
        place = f" ({error.json_path}: {clean(error.message, 100)})"
        raise _core.BadInput(f"{path} is not a result of `fontana bench thesis`{place}")
    return results
