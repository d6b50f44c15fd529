"""The JSON Schema of a scene, made from the table of parameters and the fields of emitters and colliders."""

from __future__ import annotations

import functools
import math

from fontana.fluid_table import fluids
from fontana.tables import COLLIDERS, EMITTERS, KEY_FIELDS, VIEW_FIELDS, Field, groups
from fontana.units import readable

MAXIMUM_LIST = 10_000
MAXIMUM_FRAMES = 10_000_000
PRESETS = ("thesis",)


@functools.cache
def scene_schema() -> dict:
    """The schema of a scene document (JSON Schema, draft 2020-12).

    Quantities are numbers in SI or text with a unit. A schema cannot check such text: `fontana.scene` does, and it
    also holds converted values against minimum and maximum.
    """
    properties = {
        "$schema": {"type": "string", "description": "Lets an editor find this schema; not used."},
        "name": {
            "type": "string",
            "pattern": r"^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$",
            "description": "Letters, digits, - and _: the files of the run begin with it.",
        },
        "description": {"type": "string", "description": "What the scene shows, in a sentence."},
        "preset": {"enum": list(PRESETS), "description": "Parameters to begin with."},
    }
    properties |= {group: _group_schema(table) for group, table in groups().items()}
    properties["fluid"] = _fluid_schema(properties["fluid"])
    properties |= {
        "emitters": _typed_list("Where the particles come from.", EMITTERS, {}),
        "colliders": _typed_list("Surfaces that keep the fluid in, or out.", COLLIDERS, {"keys": _keys_schema()}),
        "output": _object_schema({"frames": _frames_schema()}, "What a run leaves behind."),
        "view": _object_schema(
            {field.name: _value_schema(field) for field in VIEW_FIELDS}
            | {"frames": {"type": "array", "items": _frames_schema(), "maxItems": 16, "minItems": 1}},
            "The camera of the contact sheet, and the frames it shows.",
        ),
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Fontana scene",
        **_object_schema(properties, "A fluid, what drives it, where it comes from and what it runs into."),
    }


def _object_schema(properties: dict, description: str, required: tuple[str, ...] = ()) -> dict:
    schema = {"type": "object", "description": description, "properties": properties, "additionalProperties": False}
    return schema | ({"required": list(required)} if required else {})


def _group_schema(table: dict) -> dict:
    return _object_schema({name: _value_schema(item) for name, item in table.items()}, "Parameters of the solver.")


def _fluid_schema(group: dict) -> dict:
    """The group of parameters, which also takes the name of a fluid: "honey" or {"type": "honey", ...}."""
    named = {"enum": list(fluids()), "description": "A fluid that gives density, viscosity and surface tension."}
    return group | {
        "type": ["string", "object"],
        "properties": {"type": named} | group["properties"],
        "if": {"type": "string"},
        "then": {"enum": list(fluids())},
    }


def _value_schema(field) -> dict:
    """The schema of one parameter or field."""
    schema = {"description": field.doc}
    if field.unit:
        schema["description"] += f" [{readable(field.unit)}]"
    if hasattr(field, "default"):
        schema["default"] = list(field.default) if isinstance(field.default, tuple) else field.default
    if field.type == "bool":
        return schema | {"type": "boolean"}
    if field.type == "choice":
        return schema | {"enum": list(field.choices)}
    number = {"type": "integer" if field.type == "int" else ["number", "string"]}
    if math.isfinite(field.minimum):
        number["minimum"] = field.minimum
    if math.isfinite(field.maximum):
        number["maximum"] = field.maximum
    if field.type == "vector":
        return schema | {"type": "array", "items": number, "minItems": 3, "maxItems": 3}
    return schema | number


def _frames_schema() -> dict:
    return {"type": "integer", "minimum": 1, "maximum": MAXIMUM_FRAMES, "description": "A number of frames."}


def _keys_schema() -> dict:
    key = _object_schema({field.name: _value_schema(field) for field in KEY_FIELDS}, "Where it is, and when.")
    return {
        "type": "array",
        "items": key | {"required": ["centre"]},
        "minItems": 1,
        "maxItems": MAXIMUM_LIST,
        "description": "Motion of the centre: straight between keys, still before and after.",
    }


def _typed_list(description: str, types: dict[str, tuple[Field, ...]], extra: dict) -> dict:
    """A list of objects whose fields depend on their "type".

    if/then keeps the complaints about an object next to the object; oneOf would bury them among the other types'.
    """
    common = {"type": {"enum": list(types)}, "label": {"type": "string", "description": "A name for people."}} | extra
    cases = []
    for name, fields in types.items():
        properties = common | {field.name: _value_schema(field) for field in fields}
        required = [field.name for field in fields if field.required]
        cases.append(
            {
                "if": {"properties": {"type": {"const": name}}, "required": ["type"]},
                "then": {"properties": properties, "required": required, "additionalProperties": False},
            }
        )
    item = {"type": "object", "required": ["type"], "properties": {"type": common["type"]}, "allOf": cases}
    return {"type": "array", "items": item, "maxItems": MAXIMUM_LIST, "description": description}
