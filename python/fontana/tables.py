"""The tables a scene is made of: the solver's parameters, and the fields of emitters and colliders.

The parameters come from the library (scene/parameters.def), so that a default stands in one place only. The fields of
emitters and colliders mirror `fontana_emitter` and `fontana_collider` in fontana.h; their defaults are the library's.
"""

from __future__ import annotations

import difflib
import functools
import math
from collections.abc import Iterable
from dataclasses import dataclass

from fontana import _core


@dataclass(frozen=True)
class Field:
    """One value of an emitter, a collider or a key. It has the attributes that checking needs of a parameter."""

    name: str
    type: str  # "float", "int", "bool", "vector"
    unit: str
    doc: str
    minimum: float = -math.inf
    maximum: float = math.inf
    choices: tuple[str, ...] = ()
    required: bool = False


_CENTRE = Field("centre", "vector", "m", "Where it is.")
_RADIUS = Field("radius", "float", "m", "Its radius.", minimum=1e-6, required=True)
_JITTER = Field("jitter", "float", "", "Random shift of each particle, in particle spacings.", 0.0, 0.5)
_VELOCITY = Field("velocity", "vector", "m/s", "Velocity the particles start with.")
_FIRST_FRAME = Field("first_frame", "int", "", "The frame it starts in; 1 is the first one simulated.", 1, 2**31 - 1)

EMITTERS: dict[str, tuple[Field, ...]] = {
    "block": (
        _CENTRE,
        Field("size", "vector", "m", "Its edges; filled once, at first_frame.", minimum=0.0, required=True),
        _VELOCITY,
        _JITTER,
        _FIRST_FRAME,
    ),
    "sphere": (_CENTRE, _RADIUS, _VELOCITY, _JITTER, _FIRST_FRAME),
    "disc": (
        _CENTRE,
        _RADIUS,
        Field("direction", "vector", "", "Where the jet points; its length does not matter."),
        Field("speed", "float", "m/s", "Speed of the jet along its direction.", minimum=0.0),
        Field("rate", "float", "1/s", "Particles a second; 0: as many as keep the rest density.", minimum=0.0),
        _JITTER,
        _FIRST_FRAME,
        Field("last_frame", "int", "", "The last frame it runs in; without it, it never stops.", 1, 2**31 - 1),
    ),
}

_SURFACE = (
    _CENTRE,
    Field("enabled", "bool", "", "Whether it takes part."),
    Field("elasticity", "float", "", "Kept share of the normal velocity.", 0.0, 1.0),
    Field("friction", "float", "", "Lost share of the tangential velocity at a hit.", 0.0, 1.0),
    Field("velocity", "vector", "m/s", "Velocity of its centre, where it has no keys."),
)
_FLIP = Field("flip", "bool", "", "False keeps the fluid on the positive side, true on the negative.")
_THICKNESS = Field("thickness", "float", "m", "Of its wall; without it, solid.", minimum=1e-6)
_CUTOFF = Field("cutoff", "float", "m", "Height (y) up to which the wall stands; without it, for ever.")

COLLIDERS: dict[str, tuple[Field, ...]] = {
    "plane_x": (*_SURFACE, _FLIP),
    "plane_y": (*_SURFACE, _FLIP),
    "plane_z": (*_SURFACE, _FLIP),
    "sphere_inside": (*_SURFACE, _RADIUS, _THICKNESS),
    "sphere_outside": (*_SURFACE, _RADIUS, _THICKNESS),
    "cylinder_inside": (*_SURFACE, _RADIUS, _CUTOFF, _THICKNESS),
    "cylinder_outside": (*_SURFACE, _RADIUS, _CUTOFF, _THICKNESS),
}

KEY_FIELDS = (
    Field("frame", "float", "", "When, in frames: 0 is the start.", minimum=0.0),
    Field("time", "float", "s", "When, in seconds from the start.", minimum=0.0),
    Field("centre", "vector", "m", "Where the collider's centre is then.", required=True),
)

VIEW_FIELDS = (
    Field("eye", "vector", "m", "Where the camera of the contact sheet stands."),
    Field("target", "vector", "m", "What it looks at."),
    Field("field_of_view", "float", "", "Its vertical opening in degrees.", 1.0, 150.0),
)


@functools.cache
def parameters() -> dict[str, object]:
    """Every parameter of the solver by its path, such as "fluid.viscosity"."""
    return {parameter.name: parameter for parameter in _core.parameters()}


@functools.cache
def groups() -> dict[str, dict[str, object]]:
    """The parameters by group and by the last part of their path."""
    result: dict[str, dict[str, object]] = {}
    for path, parameter in parameters().items():
        result.setdefault(parameter.group, {})[path.split(".", 1)[1]] = parameter
    return result


def nearest(word: str, valid: Iterable[str]) -> str | None:
    """The valid name closest to `word`, or None if nothing is close."""
    matches = difflib.get_close_matches(word, list(valid), n=1, cutoff=0.6)
    return matches[0] if matches else None


def suggestion(word: str, valid: Iterable[str]) -> str:
    """The end of a sentence about an unknown name: "; did you mean X?" or, if nothing is near, what there is."""
    names = list(valid)
    near = nearest(word, names)
    if near:
        return f"; did you mean {near}?"
    if not names:
        return ""
    return f"; known are {', '.join(names)}" if len(names) <= 12 else ""


def find_parameter(name: str) -> str:
    """The full path of a parameter given as "fluid.viscosity" or just "viscosity".

    Raises fontana.BadInput with the nearest name if there is none.
    """
    known = parameters()
    if name in known:
        return name
    short = {path.rsplit(".", 1)[1]: path for path in known}
    if name in short:
        return short[name]
    near = nearest(name, [*known, *short])
    hint = f"; did you mean {short.get(near, near)}?" if near else "; `fontana explain` lists them all"
    raise _core.BadInput(f'unknown parameter "{name}"{hint}')
