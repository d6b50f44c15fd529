"""The files of results: JSON that is written after every row, read back to draw it, and the picture beside it."""

from __future__ import annotations

import json
from pathlib import Path

from jsonschema import Draft202012Validator

from fontana import _core
from fontana.errors import clean
from fontana.output_folder import make_output_folder
from fontana.reader import read_json

_STATISTICS = {"type": "object", "required": ["median", "minimum", "maximum", "repeats"]}
_CELL = {
    "type": "object",
    "required": ["state"],
    "properties": {
        "state": {"enum": ["measured", "cut off", "not run", "failed"]},
        "frames_per_second": _STATISTICS,
        "node_seconds": _STATISTICS,
        "predicted_substep_seconds": {"type": "number", "exclusiveMinimum": 0},
        "predicted_frame_seconds": {"type": "number", "exclusiveMinimum": 0},
    },
}
# What a cell has to have, by the benchmark and the state of the cell.
_NUMBERS = {
    "thesis": {
        "measured": ["frames_per_second", "million_particle_substeps_per_second"],
        "cut off": ["predicted_substep_seconds"],
    },
    "houdini": {"measured": ["node_seconds"], "cut off": ["predicted_frame_seconds"]},
}


def _where(key: str, value: str, then: dict) -> dict:
    return {"if": {"properties": {key: {"const": value}}}, "then": then}


def _scenes(benchmark: str) -> dict:
    conditions = [_where("state", state, {"required": keys}) for state, keys in _NUMBERS[benchmark].items()]
    row = {
        "type": "object",
        "required": ["particles", "cells"],
        "properties": {
            "particles": {"type": "integer", "minimum": 1},
            "cells": {"type": "object", "additionalProperties": _CELL | {"allOf": conditions}},
        },
    }
    return {"type": "object", "additionalProperties": {"type": "array", "items": row}}


_SCHEMA = {
    "type": "object",
    "required": ["benchmark", "machine", "devices", "settings", "scenes"],
    "properties": {
        "benchmark": {"enum": list(_NUMBERS)},
        "machine": {"type": "object", "required": ["cpu", "usable_cores"]},
        "devices": {"type": "array", "items": {"type": "object", "required": ["backend", "is_gpu", "available"]}},
        "settings": {"type": "object", "required": ["substeps_per_frame", "threads"]},
    },
    "allOf": [_where("benchmark", name, {"properties": {"scenes": _scenes(name)}}) for name in _NUMBERS],
}


def publish_json(path: Path, results: dict) -> None:
    """Writes the results, in one step. Raises IoError."""
    make_output_folder(path.parent)
    _core.publish_file(str(path), (json.dumps(results, indent=1, allow_nan=False) + "\n").encode())


def publish_picture(results: dict, path: Path) -> None:
    """Draws results as `load_results` gives them to a PNG. Raises IoError."""
    from fontana.bench._thesis_figure import draw_figure  # matplotlib is slow to import

    _core.publish_file(str(path), draw_figure(results))


def load_results(path: Path) -> dict:
    """The results of `fontana bench thesis` or `fontana bench houdini`. Raises BadInput for any other file."""
    results = read_json(path)
    error = next(Draft202012Validator(_SCHEMA).iter_errors(results), None)
    if error:
        place = f" ({error.json_path}: {clean(error.message, 100)})"
        raise _core.BadInput(f"{path} is not a result of `fontana bench thesis` or `fontana bench houdini`{place}")
    return results
