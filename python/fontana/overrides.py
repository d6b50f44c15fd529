"""Changes a scene document by path: "fluid.viscosity=0.3 Pa.s", "emitters[0].speed=2", "output.frames=48"."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping

from fontana.errors import SceneError, clean
from fontana.fluid_table import FLUID_PATHS
from fontana.reader import normalized
from fontana.tables import parameters

_PART = re.compile(r"([A-Za-z_$][A-Za-z0-9_$]*)((?:\[\d{1,6}\])*)")


def parse_assignments(texts: Iterable[str]) -> dict[str, object]:
    """The changes that several "path=value" ask for, in their order; of two for the same path the last."""
    changes: dict[str, object] = {}
    for text in texts:
        path, value = parse_assignment(text)
        changes.pop(path, None)
        changes[path] = value
    return changes


def parse_assignment(text: str) -> tuple[str, object]:
    """Reads "path=value" as the command line has it: the value is JSON if it parses as such, else text.

    Three quantities with commas between them are a vector: forces.gravity=0,-9.81 m/s2,0.
    """
    path, equals, value = text.partition("=")
    if not equals or not path.strip():
        raise SceneError(f'"{clean(text)}": expected path=value, such as fluid.viscosity=0.3')
    return _full_path(path.strip()), _read_value(value.strip())


def _read_value(text: str) -> object:
    try:
        return normalized(json.loads(text))
    except (ValueError, RecursionError, SceneError):  # NaN and the like go on as text, and are refused as a quantity
        pass
    parts = [part.strip() for part in text.split(",")]
    return [_read_value(part) for part in parts] if len(parts) == 3 else text


def apply_overrides(document: object, overrides: Mapping[str, object]) -> object:
    """A copy of the document with each value put at its path. Whether it fits is checked with the rest of the scene.

    Raises SceneError where a path does not lead anywhere.
    """
    if not overrides:
        return document
    changed = json.loads(json.dumps(document))
    names = {path: value for path, value in overrides.items() if path in ("fluid", "fluid.type")}
    for path, value in (names | dict(overrides)).items():  # the name of a fluid first: the rest changes its values
        value = normalized(value, (path,))
        if path in names and isinstance(value, str) and isinstance(changed, dict):
            changed["fluid"] = _another_fluid(changed.get("fluid"), value)
        else:
            _assign(changed, path, value)
    return changed


def _another_fluid(fluid: object, name: str) -> object:
    """The fluid of a scene under another name: it keeps its particles and loses the values the name stands for."""
    kept = fluid if isinstance(fluid, dict) else {}
    own = ("type", *(path.split(".")[1] for path in FLUID_PATHS))
    return {"type": name} | {key: value for key, value in kept.items() if key not in own}


def _assign(document: object, path: str, value: object) -> None:
    parts = list(_split(path))
    place = document
    for index, part in enumerate(parts):
        last = index == len(parts) - 1
        _check_step(place, part, path)
        if last:
            place[part] = value
        elif isinstance(part, str):
            following = place.setdefault(part, {})
            if part == "fluid" and isinstance(following, str):  # "fluid": "honey" grows into an object
                following = place[part] = {"type": following}
            place = following
        else:
            place = place[part]


def _check_step(place: object, part: str | int, path: str) -> None:
    if isinstance(part, str) and isinstance(place, dict):
        return
    if isinstance(part, int) and isinstance(place, list):
        if part < len(place):
            return
        raise SceneError(f"{clean(path)}: there are only {len(place)} entries, counted from 0")
    raise SceneError(f"{clean(path)}: there is no such place in the scene")


def _split(path: str) -> Iterable[str | int]:
    for part in _full_path(path).split("."):
        match = _PART.fullmatch(part)
        if not match:
            raise SceneError(f'"{clean(path)}" is not a path such as fluid.viscosity or emitters[0].speed')
        yield match[1]
        yield from (int(number) for number in re.findall(r"\d+", match[2]))


def _full_path(path: str) -> str:
    """A parameter may go by the last part of its name: viscosity is fluid.viscosity."""
    if "." in path or "[" in path:
        return path
    return next((name for name in parameters() if name.split(".")[1] == path), path)
