"""Turns what JSON Schema finds into one sentence: the path, what is wrong, what was expected, the nearest name."""

from __future__ import annotations

from collections.abc import Callable

from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError

from fontana.errors import SceneError, clean, path_text, show_value
from fontana.schema import scene_schema
from fontana.tables import nearest, suggestion

_TYPE_WORDS = {
    "object": "an object",
    "array": "a list",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "true or false",
}


def check(document: object) -> None:
    """Raises SceneError for the most telling violation of the scene schema, if there is one."""
    errors = list(Draft202012Validator(scene_schema()).iter_errors(document))
    if errors:
        raise SceneError(_sentence(min(errors, key=_rank)))


def _rank(error: ValidationError) -> tuple:
    """Unknown names first: a misspelt key also shows up as a missing one."""
    order = {"additionalProperties": 0, "type": 1, "enum": 2}
    return order.get(error.validator, 3), [str(part) for part in error.absolute_path]


def _sentence(error: ValidationError) -> str:
    describe = _SENTENCES.get(error.validator)
    where = path_text(error.absolute_path)
    return describe(error, where) if describe else f"{where}: {clean(error.message, 200)}"


def _unknown_key(error: ValidationError, where: str) -> str:
    known = error.schema["properties"]
    path = list(error.absolute_path)
    key = next(key for key in error.instance if key not in known)
    if nearest(key, known):
        hint = f"; did you mean {path_text([*path, nearest(key, known)])}?"
    else:
        hint = _elsewhere(key, is_bare=not path) or suggestion(key, known)
    return f"{path_text([*path, key])}: there is no such {'key' if path else 'part of a scene'}{hint}"


def _elsewhere(key: str, is_bare: bool) -> str:
    """A hint where a known parameter stands in the wrong group, such as a bare "viscosity" or, if bare, nearly so."""
    groups = {name: part["properties"] for name, part in scene_schema()["properties"].items() if "properties" in part}
    places = {name: f"{group}.{name}" for group, properties in groups.items() for name in properties}
    near = nearest(key, places) if is_bare else key
    return f"; did you mean {places[near]}?" if near in places else ""


def _wrong_type(error: ValidationError, where: str) -> str:
    types = error.validator_value if isinstance(error.validator_value, list) else [error.validator_value]
    expected = " or ".join(_TYPE_WORDS[name] for name in types)
    if types == ["number", "string"]:
        expected = "a number or text with a unit"
    if types == ["array"] and error.schema.get("maxItems") == 3:
        expected = "a list of three numbers"
    if types == ["string", "object"]:
        expected = "an object, or the name of a fluid"
    return f"{where}: expected {expected}, got {show_value(error.instance)}"


def _not_a_choice(error: ValidationError, where: str) -> str:
    choices = error.validator_value
    hint = suggestion(error.instance, choices) if isinstance(error.instance, str) else ""
    return f"{where}: {show_value(error.instance)} is not one of {_shortened(choices)}{_unless_listed(hint)}"


def _shortened(choices: list) -> str:
    return ", ".join(choices) if len(choices) <= 20 else ", ".join(choices[:20]) + ", ..."


def _unless_listed(hint: str) -> str:
    return "" if hint.startswith("; known are") else hint


def _out_of_range(word: str) -> Callable[[ValidationError, str], str]:
    def describe(error: ValidationError, where: str) -> str:
        return f"{where}: {show_value(error.instance)} is {word} {error.validator_value:g}"

    return describe


def _missing(error: ValidationError, where: str) -> str:
    key = next(key for key in error.validator_value if key not in error.instance)
    kind = error.instance.get("type")
    return f"{where}: {f'a {kind} needs' if isinstance(kind, str) else 'needs'} {key}"


def _wrong_length(error: ValidationError, where: str) -> str:
    schema, count = error.schema, len(error.instance)
    if schema.get("minItems") == schema.get("maxItems"):
        return f"{where}: expected {schema['minItems']} numbers, got {count}"
    bound = f"at least {schema['minItems']}" if error.validator == "minItems" else f"at most {schema['maxItems']}"
    return f"{where}: expected {bound} entries, got {count}"


def _wrong_name(error: ValidationError, where: str) -> str:
    return f"{where}: {show_value(error.instance)} cannot begin a file's name: use letters, digits, - and _"


_SENTENCES: dict[str, Callable[[ValidationError, str], str]] = {
    "additionalProperties": _unknown_key,
    "type": _wrong_type,
    "enum": _not_a_choice,
    "minimum": _out_of_range("below the least allowed,"),
    "maximum": _out_of_range("above the most allowed,"),
    "required": _missing,
    "minItems": _wrong_length,
    "maxItems": _wrong_length,
    "pattern": _wrong_name,
}
