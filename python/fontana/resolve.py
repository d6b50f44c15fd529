"""From a scene document to values in SI: units are converted, fluids looked up, ranges and key frames checked."""

from __future__ import annotations

from collections.abc import Mapping

from fontana.complaints import check
from fontana.errors import SceneError, path_text, show_value
from fontana.fluid_table import fluid_parameters, fluids
from fontana.tables import COLLIDERS, EMITTERS, KEY_FIELDS, VIEW_FIELDS, groups, parameters
from fontana.units import KINEMATIC_VISCOSITY, UnitError, has_unit, parse_quantity, show

Path = tuple[str | int, ...]


def resolve_document(document: object) -> dict:
    """Checks a document against the schema and returns what `Scene` takes as keywords. Raises SceneError."""
    check(document)
    assert isinstance(document, dict)
    values, notes = _resolve_parameters(document)
    scale = values.get("time.simulation_scale", 1.0)
    result = {key: document[key] for key in ("name", "description", "preset") if key in document}
    result |= {"parameters": values, "notes": notes}
    result["emitters"] = _resolve_list(document, "emitters", EMITTERS, scale)
    result["colliders"] = _resolve_list(document, "colliders", COLLIDERS, scale)
    result["view"] = _resolve_fields(document.get("view", {}), VIEW_FIELDS, ("view",), scale)
    if "frames" in document.get("output", {}):
        result["frame_count"] = int(document["output"]["frames"])
    return result


def _resolve_parameters(document: dict) -> tuple[dict[str, object], list[str]]:
    fluid = document.get("fluid", {})
    if isinstance(fluid, str):
        fluid = {"type": fluid}
    given = {group: document.get(group, {}) for group in groups()} | {"fluid": dict(fluid)}
    kind = given["fluid"].pop("type", None)
    explicit = {
        f"{group}.{name}": resolve_value(value, parameters()[f"{group}.{name}"], (group, name))
        for group, table in given.items()
        for name, value in table.items()
    }
    named, notes = {}, []
    if kind is not None:
        spacing = explicit.get("fluid.particle_spacing", parameters()["fluid.particle_spacing"].default)
        named, notes = fluid_parameters(fluids()[kind], spacing)
    values = named | explicit
    if "fluid.viscosity" in values:
        density = values.get("fluid.rest_density", parameters()["fluid.rest_density"].default)
        values["fluid.viscosity"] = dynamic_viscosity(values["fluid.viscosity"], density)
    return values, [note for note in notes if not _overruled(note, explicit)]


def _overruled(note: str, explicit: Mapping[str, object]) -> bool:
    return note.startswith("surface tension") and "fluid.surface_tension" in explicit


class Kinematic(float):
    """A viscosity in m^2/s, waiting for the density that makes it a dynamic one."""


def dynamic_viscosity(value: float, density: float) -> float:
    """A viscosity in Pa s from what `resolve_value` returned; `density` in kg/m^3. Raises SceneError."""
    if not isinstance(value, Kinematic):
        return value
    value = float(value) * density
    _check_range(value, parameters()["fluid.viscosity"], ("fluid", "viscosity"))
    return value


def resolve_value(value: object, field, path: Path, scale: float = 1.0) -> object:
    """The value of a parameter or field in SI. `field` is one of the tables'. Raises SceneError.

    A place, size or speed of a scene whose unit is not the metre: `scale` is time.simulation_scale, by which the solver
    will multiply it. A plain number is meant in that unit; text with a unit says what it is and is divided beforehand.
    """
    if field.type == "vector":
        return [_number(part, field, (*path, index), scale) for index, part in enumerate(value)]
    if field.type == "float":
        return _number(value, field, path, scale)
    return int(value) if field.type == "int" else value


def _number(value: float | str, field, path: Path, scale: float) -> float:
    number, unit = float(value) if not isinstance(value, str) else value, field.unit
    if isinstance(number, str):
        try:
            number, unit = parse_quantity(number, field.unit)
        except UnitError as error:
            raise SceneError(f"{path_text(path)}: {show_value(value)}: {error}") from error
    if unit == KINEMATIC_VISCOSITY and field.unit != unit:
        number = Kinematic(number)
    if isinstance(value, str) and has_unit(value) and field.unit in ("m", "m/s"):
        number /= scale
    _check_range(number, field, path)
    return number


def _check_range(value: float, field, path: Path) -> None:
    word, bound = ("below the least", field.minimum) if value < field.minimum else ("above the most", field.maximum)
    if not field.minimum <= value <= field.maximum:
        raise SceneError(f"{path_text(path)}: {show(value, field.unit)} is {word} allowed, {show(bound, field.unit)}")


def _resolve_list(document: dict, name: str, types: dict, scale: float) -> list[dict]:
    return [
        {"type": entry["type"]} | _resolve_fields(entry, types[entry["type"]], (name, index), scale)
        for index, entry in enumerate(document.get(name, []))
    ]


def _resolve_fields(entry: dict, fields: tuple, path: Path, scale: float) -> dict:
    values = {
        field.name: resolve_value(entry[field.name], field, (*path, field.name), scale)
        for field in fields
        if field.name in entry
    }
    values |= {name: entry[name] for name in ("label", "frames") if name in entry}
    if "keys" in entry:
        values["keys"] = _resolve_keys(entry["keys"], (*path, "keys"), scale)
    return values


def _resolve_keys(keys: list[dict], path: Path, scale: float) -> list[dict]:
    result = [_resolve_fields(key, KEY_FIELDS, (*path, index), scale) for index, key in enumerate(keys)]
    clock = next((word for word in ("frame", "time") if word in result[0]), "frame")
    for index, key in enumerate(result):
        place = path_text((*path, index))
        if ("frame" in key) == ("time" in key):
            raise SceneError(f"{place}: a key needs either frame or time")
        if clock not in key:
            raise SceneError(f"{place}: the keys before it count in {clock}, so this one must too")
        if index and not key[clock] > result[index - 1][clock]:
            raise SceneError(f"{place}.{clock}: {key[clock]:g} does not come after the key before it")
    return result
