"""Reads JSON strictly: what the standard leaves open (duplicate keys, NaN, size, depth) is refused with a sentence."""

from __future__ import annotations

import json
import math
from pathlib import Path

from fontana.errors import SceneError, clean, path_text

MAXIMUM_BYTES = 64 * 2**20
MAXIMUM_DEPTH = 64
MAXIMUM_TEXT = 65536


def read_json(path: Path) -> object:
    """The document in a file. Raises SceneError, whose sentence begins with the file's name."""
    name = clean(str(path), 200)
    try:
        with path.open("rb") as file:
            data = file.read(MAXIMUM_BYTES + 1)
    except OSError as error:
        raise SceneError(f"{name}: cannot be read: {error.strerror or error}") from error
    except ValueError as error:  # a null byte in the path
        raise SceneError(f"{name}: is not a file name") from error
    if len(data) > MAXIMUM_BYTES:
        raise SceneError(f"{name}: is larger than {MAXIMUM_BYTES // 2**20} MiB, the most a scene may have")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SceneError(f"{name}: byte {error.start} is not UTF-8 text") from error
    try:
        return parse_json(text)
    except SceneError as error:
        raise SceneError(f"{name}: {error}") from error


def parse_json(text: str) -> object:
    """The document in a text, already checked by `normalized`. Raises SceneError."""
    try:
        document = json.loads(
            text, object_pairs_hook=_object, parse_constant=_constant, parse_float=_float, parse_int=_integer
        )
    except json.JSONDecodeError as error:
        raise SceneError(f"line {error.lineno}, column {error.colno}: not JSON: {_reason(error)}") from error
    except RecursionError as error:
        raise SceneError(_too_deep()) from error
    return normalized(document)


def normalized(value: object, path: tuple[str | int, ...] = ()) -> object:
    """The same document as plain dicts, lists, text and finite numbers; tuples and arrays become lists.

    Raises SceneError on anything else, on depth and on text beyond the limits.
    """
    if len(path) > MAXIMUM_DEPTH:
        raise SceneError(_too_deep())
    if hasattr(value, "tolist"):  # numpy arrays and scalars
        value = value.tolist()
    if isinstance(value, str):
        if len(value) > MAXIMUM_TEXT:
            raise SceneError(f"{path_text(path)}: text longer than {MAXIMUM_TEXT} characters")
        return value
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, (int, float)):
        if not _is_finite(value):
            raise SceneError(f"{path_text(path)}: {value if value != value else 'infinity'} is not a finite number")
        return value
    if isinstance(value, (list, tuple)):
        return [normalized(item, (*path, index)) for index, item in enumerate(value)]
    if isinstance(value, dict):
        for key in value:
            if not isinstance(key, str):
                raise SceneError(f"{path_text(path)}: the key {clean(repr(key))} is not text")
        return {key: normalized(item, (*path, key)) for key, item in value.items()}
    raise SceneError(f"{path_text(path)}: a {type(value).__name__} cannot stand in a scene")


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False


def _object(pairs: list[tuple[str, object]]) -> dict[str, object]:
    result: dict[str, object] = {}
    for key, value in pairs:
        if key in result:
            raise SceneError(f'the key "{clean(key)}" stands twice in one object')
        result[key] = value
    return result


def _constant(word: str) -> None:
    raise SceneError(f"{word} is not a finite number")


def _float(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise SceneError(f"the number {clean(text)} is too large")
    return value


def _integer(text: str) -> int:
    if len(text) > 300:
        raise SceneError(f"the number {clean(text)} is too large")
    return int(text)


def _too_deep() -> str:
    return f"lists and objects are nested deeper than {MAXIMUM_DEPTH}"


def _reason(error: json.JSONDecodeError) -> str:
    """json's words, or what is wrong where other languages than JSON would go on."""
    rest, before = error.doc[error.pos :], error.doc[: error.pos].rstrip()
    if not rest.strip():
        return "the file is empty" if not before else "it ends too early"
    if rest.startswith(("//", "/*", "#")):
        return "it has no comments; a label or description can say such a thing"
    if rest.startswith("'"):
        return "text stands between \", not between '"
    if before.endswith(",") and rest[0] in "}]":
        return f"expected no comma before {rest[0]}"
    return clean(error.msg[:1].lower() + error.msg[1:])
