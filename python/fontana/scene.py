"""Scenes: JSON in, checked and resolved to SI, out to a simulation.

    scene = load_scene("scenes/fountain.json", {"fluid.viscosity": "0.3 Pa.s"})
    simulation = scene.build()

Whatever is wrong with a scene is raised as SceneError with one sentence.
"""

from __future__ import annotations

import contextlib
import copy
import hashlib
import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from fontana import _core
from fontana.errors import SceneError, clean
from fontana.overrides import apply_overrides
from fontana.reader import normalized, read_json
from fontana.resolve import resolve_document
from fontana.tables import groups, suggestion

DEFAULT_FRAME_COUNT = 120
# Parameters of the solver that say where and by which scheme, and change a frame by no more than rounding.
WHERE = ("backend", "neighbors", "precision", "threads", "device", "profile")


@dataclass
class Scene:
    """A scene in SI units: metres, seconds, kilograms, pascals; vectors are lists of three floats.

    parameters  values that differ from the defaults because the scene (or its fluid) says so, by path
    emitters    {"type": ..., field: value}; fields left out have the library's defaults
    colliders   likewise; "keys" is a list of {"frame" or "time": float, "centre": [x, y, z]}
    view        camera of the contact sheet: eye, target, field_of_view, frames; any may be missing
    notes       what an artist should know before the run, in sentences
    """

    name: str = "scene"
    description: str = ""
    preset: str = ""
    parameters: dict[str, object] = field(default_factory=dict)
    emitters: list[dict] = field(default_factory=list)
    colliders: list[dict] = field(default_factory=list)
    frame_count: int = DEFAULT_FRAME_COUNT
    view: dict = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def build(self) -> _core.Simulation:
        """A simulation of this scene, before its first frame. Raises SceneError; touches no device."""
        try:
            return self._build()
        except SceneError:
            raise
        except _core.BadInput as error:
            raise SceneError(f"{self.name}: {error}") from error

    def _build(self) -> _core.Simulation:
        simulation = _core.Simulation()
        if self.preset:
            simulation.apply_preset(self.preset)
        for path, value in self.parameters.items():
            simulation.set(path, value)
        for index, emitter in enumerate(self.emitters):
            with _place(f"emitters[{index}]"):
                simulation.add_emitter(**_without(emitter, "label"))
        frame_duration = simulation.derived().frame_duration
        for index, collider in enumerate(self.colliders):
            with _place(f"colliders[{index}]"):
                simulation.add_collider(**_without(collider, "label", "keys"))
                if "keys" in collider:
                    simulation.set_collider_keys(index, *_key_track(collider["keys"], frame_duration))
        return simulation

    def resolved(self, simulation: _core.Simulation) -> dict:
        """The whole scene as a document with every parameter spelled out; loading it gives the same simulation.

        `simulation` is one built from this scene, whose values are read back.
        """
        document: dict = {"name": self.name, "description": self.description}
        for group, table in groups().items():
            document[group] = {name: _plain(simulation.get(f"{group}.{name}")) for name in table}
        frame_duration = simulation.derived().frame_duration
        document["emitters"] = copy.deepcopy(self.emitters)
        document["colliders"] = [_with_timed_keys(collider, frame_duration) for collider in self.colliders]
        document["output"] = {"frames": self.frame_count}
        document["view"] = copy.deepcopy(self.view)
        return document


def load_scene(source: str | os.PathLike | Mapping | Scene, overrides: Mapping[str, object] | None = None) -> Scene:
    """Loads a scene from a file, from the name of a bundled scene, or from a dict of the same shape.

    `overrides` maps paths to values ({"fluid.viscosity": "0.3 Pa.s"}) and wins over the scene. Raises SceneError.
    """
    if isinstance(source, Scene):
        return _override_scene(source, overrides or {})
    if isinstance(source, Mapping):
        return resolve(normalized(dict(source)), "scene", overrides)
    path = find_scene(source)
    document = read_json(path)
    try:
        return resolve(document, path.stem, overrides)
    except SceneError as error:
        if overrides and _is_sound(document):
            raise  # the overrides are to blame, and the file is no part of the sentence
        raise SceneError(f"{clean(str(path), 200)}: {error}") from error


def resolve(document: object, name: str, overrides: Mapping[str, object] | None = None) -> Scene:
    """A scene from a document that `fontana.reader` has read; `name` is for a scene that has none of its own."""
    values = resolve_document(apply_overrides(document, overrides or {}))
    return Scene(**{"name": _file_name(name)} | values)


def _is_sound(document: object) -> bool:
    try:
        resolve(document, "scene")
    except SceneError:
        return False
    return True


def _override_scene(scene: Scene, overrides: Mapping[str, object]) -> Scene:
    if not overrides:
        return scene
    return resolve(normalized(scene.resolved(scene.build())), scene.name, overrides)


def find_scene(source: str | os.PathLike) -> Path:
    """The file behind a path or the name of a bundled scene. Raises SceneError with the nearest name."""
    text = os.fspath(source)
    path = Path(text)
    try:
        if path.is_file():
            return path
    except ValueError as error:  # a null byte in the path
        raise SceneError(f"{clean(text)}: is not a file name") from error
    bundled = bundled_scenes()
    if text in bundled:
        return bundled[text]
    if text and path.is_dir():  # pathlib takes "" for the present folder
        raise SceneError(f'"{clean(text, 200)}" is a folder, not a scene file')
    stem = path.stem if path.suffix == ".json" else text
    shown = clean(text, 200) or '""'
    raise SceneError(f"{shown}: no such file or bundled scene{suggestion(stem, bundled)}")


def bundled_scenes() -> dict[str, Path]:
    """The scenes that come with Fontana, by name: beside the installed package or in the source tree."""
    package = Path(__file__).parent
    for folder in (package / "scenes", package.parents[1] / "scenes"):
        if folder.is_dir():
            return {path.stem: path for path in sorted(folder.glob("*.json"))}
    return {}


def digest(document: Mapping) -> str:
    """A fingerprint of what a resolved scene simulates: equal for two scenes that give the same frames.

    Where it is computed, how long it runs and how it is looked at do not count.
    """
    text = json.dumps(physics(document), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def physics(document: Mapping) -> dict:
    """The parts of a resolved scene that its frames depend on."""
    result = {key: value for key, value in document.items() if key not in ("output", "view", "description")}
    return result | {"solver": _without(document["solver"], *WHERE)}


def changed_keys(before: object, after: object, path: str = "") -> list[str]:
    """The paths at which two documents differ."""
    if isinstance(before, Mapping) and isinstance(after, Mapping):
        keys = [*before, *(key for key in after if key not in before)]
        prefix = f"{path}." if path else ""
        return [change for key in keys for change in changed_keys(before.get(key), after.get(key), prefix + key)]
    if isinstance(before, list) and isinstance(after, list) and len(before) == len(after):
        pairs = enumerate(zip(before, after, strict=True))
        return [change for index, (old, new) in pairs for change in changed_keys(old, new, f"{path}[{index}]")]
    return [] if before == after else [path]


@contextlib.contextmanager
def _place(path: str) -> Iterator[None]:
    """Puts the path before what the library says about a part of the scene."""
    try:
        yield
    except _core.BadInput as error:
        raise _core.BadInput(f"{path}: {error}") from error


def _without(fields: Mapping, *names: str) -> dict:
    return {name: value for name, value in fields.items() if name not in names}


def _plain(value: object) -> object:
    return list(value) if isinstance(value, tuple) else value


def _key_track(keys: list[dict], frame_duration: float) -> tuple[list[float], list[list[float]]]:
    times = [key["time"] if "time" in key else key["frame"] * frame_duration for key in keys]
    return times, [key["centre"] for key in keys]


def _with_timed_keys(collider: dict, frame_duration: float) -> dict:
    result = copy.deepcopy(collider)
    if "keys" in result:
        times, centres = _key_track(result["keys"], frame_duration)
        result["keys"] = [{"time": time, "centre": list(centre)} for time, centre in zip(times, centres, strict=True)]
    return result


def _file_name(text: str) -> str:
    """A scene without a name goes by its file's; only characters that every file system takes remain."""
    safe = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in text)[:64].lstrip("-_")
    return safe or "scene"
