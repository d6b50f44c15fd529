"""The errors that are not the library's, and how a path or a value is written inside a sentence."""

from __future__ import annotations

import json
from collections.abc import Iterable

from fontana import _core


class SceneError(_core.BadInput):
    """A scene that cannot be used. The text is one sentence: where, what is wrong, and what was expected."""


class BeyondLimit(_core.FontanaError):
    """Something was measured beyond its limit: a result, not a defect. The text has what `beyond` says of each."""

    def __init__(self, findings: Iterable[str]):
        super().__init__("; ".join(findings))


def beyond(case: str, figure: str, measured: float, limit: float, unit: str = "") -> str:
    """What BeyondLimit tells of a figure."""
    measured_text, limit_text = (f"{value:g} {unit}".strip() for value in (measured, limit))
    return f"{case}: {figure} is {measured_text}, beyond its limit of {limit_text}"


def path_text(path: Iterable[str | int]) -> str:
    """("emitters", 0, "radius") becomes "emitters[0].radius"."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            text += f"{'.' if text else ''}{clean(part)}"
    return text or "the scene"


def clean(text: str, limit: int = 60) -> str:
    """Text from a file, safe to print in one line: no control characters, no lone surrogates, not too long."""
    safe = "".join(c if c.isprintable() and not "\ud800" <= c <= "\udfff" else "?" for c in text[: limit + 1])
    return safe if len(safe) <= limit else safe[: limit - 3] + "..."


def show_value(value: object) -> str:
    """A JSON value as a sentence quotes it."""
    if isinstance(value, str):
        return f'"{clean(value)}"'
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return "a list" if len(value) > 4 else clean(json.dumps(value))
    return clean(json.dumps(value))
