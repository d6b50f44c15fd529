"""Whatever a scene file holds, it either loads or is refused with one line."""

from __future__ import annotations

import json

from hypothesis import given, settings
from hypothesis import strategies as st

import fontana
from fontana.reader import parse_json
from fontana.scene import load_scene, resolve
from fontana.tables import COLLIDERS, EMITTERS, parameters

KEYS = sorted(
    {part for path in parameters() for part in path.split(".")}
    | {field.name for fields in (EMITTERS | COLLIDERS).values() for field in fields}
    | {"name", "preset", "type", "emitters", "colliders", "keys", "frame", "time", "output", "frames", "view", "label"}
)
WORDS = [*EMITTERS, *COLLIDERS, "honey", "thesis", "cpu", "5 mm", "300 cP", "1e-3 m2/s", "-1 kg", "1 m^9", "nan"]

numbers = st.one_of(st.integers(), st.floats(allow_nan=False, allow_infinity=False))
leaves = st.one_of(st.none(), st.booleans(), numbers, st.text(max_size=8), st.sampled_from(WORDS))
documents = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(st.one_of(st.sampled_from(KEYS), st.text(max_size=4)), inner, max_size=5),
    ),
    max_leaves=30,
)
shapes = st.sampled_from([*EMITTERS.items(), *COLLIDERS.items()]).flatmap(
    lambda item: st.fixed_dictionaries(
        {"type": st.just(item[0])},
        optional={field.name: st.one_of(leaves, st.lists(leaves, min_size=3, max_size=3)) for field in item[1]},
    )
)
scenes = st.fixed_dictionaries(
    {},
    optional={
        "fluid": st.dictionaries(st.sampled_from(KEYS), leaves, max_size=4),
        "time": st.dictionaries(st.sampled_from(KEYS), leaves, max_size=4),
        "emitters": st.lists(shapes, max_size=3),
        "colliders": st.lists(shapes, max_size=3),
    },
)


def loads_or_refuses(load) -> None:
    try:
        load()
    except fontana.SceneError as error:
        text = str(error)
        assert text and text.isprintable(), text
        text.encode()


@given(st.one_of(documents, scenes))
@settings(max_examples=400, deadline=None)
def test_any_document(document: object) -> None:
    loads_or_refuses(lambda: resolve(parse_json(json.dumps(document)), "fuzz").build())


@given(st.dictionaries(st.sampled_from(KEYS), documents, max_size=4))
@settings(max_examples=100, deadline=None)
def test_any_dict(document: dict) -> None:
    loads_or_refuses(lambda: load_scene(document).build())


@given(st.one_of(st.text(max_size=60), st.text(alphabet='{}[]":,-1e9.nulNaN \n', max_size=60)))
@settings(max_examples=300, deadline=None)
def test_any_text(text: str) -> None:
    loads_or_refuses(lambda: resolve(parse_json(text), "fuzz"))


@given(st.text(max_size=30), documents)
@settings(max_examples=200, deadline=None)
def test_any_override(path: str, value: object) -> None:
    loads_or_refuses(lambda: load_scene({"fluid": "water"}, {path: value}))


@given(st.text(alphabet="0123456789.eE+-*/^ mkgsPaN%()µ°_", max_size=30))
@settings(max_examples=300, deadline=None)
def test_any_quantity(text: str) -> None:
    loads_or_refuses(lambda: load_scene({"fluid": {"viscosity": text}}))
