"""Scenes: what is accepted, how it is resolved, and one clear sentence for each mistake."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import fontana
from fontana.overrides import parse_assignment, parse_assignments
from fontana.reader import parse_json
from fontana.scene import bundled_scenes, changed_keys, digest, load_scene, resolve

MISTAKES = [
    ({"fluid": {"viscocity": 1}}, "fluid.viscocity: there is no such key; did you mean fluid.viscosity?"),
    ({"viscosity": 1}, "did you mean fluid.viscosity?"),
    ({"emiters": []}, "did you mean emitters?"),
    ({"fluid": "hony"}, "did you mean honey?"),
    ({"fluid": {"type": "hony"}}, "did you mean honey?"),
    ({"fluid": 3}, "fluid: expected an object, or the name of a fluid, got 3"),
    ({"fluid": {"viscosity": [1]}}, "fluid.viscosity: expected a number or text with a unit, got [1]"),
    ({"fluid": {"viscosity": "5 mm"}}, '"mm" is not a unit of this value: expected a number in Pa.s'),
    ({"fluid": {"viscosity": float("nan")}}, "fluid.viscosity: nan is not a finite number"),
    ({"fluid": {"particle_mass": -1}}, "fluid.particle_mass: -1 is below the least allowed, 0"),
    ({"fluid": {"particle_mass": "-1 g"}}, "fluid.particle_mass: -0.001 kg is below the least allowed, 0 kg"),
    ({"fluid": {"particle_spacing": 0}}, "fluid.particle_spacing: 0 is below the least allowed"),
    ({"time": {"substeps": -1}}, "time.substeps: -1 is below the least allowed, 0"),
    ({"time": {"substeps": "ten"}}, 'time.substeps: expected a whole number, got "ten"'),
    ({"time": {"max_substeps": 0}}, "time.max_substeps: 0 is below the least allowed, 1"),
    ({"forces": {"gravity": -9.81}}, "forces.gravity: expected a list of three numbers, got -9.81"),
    ({"forces": {"gravity": [0, -9.81]}}, "forces.gravity: expected 3 numbers, got 2"),
    ({"solver": {"backend": "open-cl"}}, "did you mean opencl?"),
    (
        {"emitters": [{"type": "blok"}]},
        'emitters[0].type: "blok" is not one of block, sphere, disc; did you mean block?',
    ),
    ({"emitters": [{"type": "block"}]}, "emitters[0]: a block needs size"),
    ({"emitters": [{}]}, "emitters[0]: needs type"),
    ({"emitters": [{"type": "block", "size": [1, 1, -1]}]}, "emitters[0].size[2]: -1 is below"),
    ({"emitters": [{"type": "sphere", "radius": 1, "size": [1, 1, 1]}]}, "emitters[0].size: there is no such key"),
    ({"emitters": [{"type": "disc", "radius": 1, "direction": [0, 0, 0]}]}, "emitters[0]:"),
    ({"colliders": [{"type": "plane_y", "friction": 2}]}, "colliders[0].friction: 2 is above the most allowed, 1"),
    (
        {"colliders": [{"type": "sphere_outside", "radius": 1, "keys": [{"centre": [0, 0, 0]}]}]},
        "colliders[0].keys[0]: a key needs either frame or time",
    ),
    (
        {"colliders": [{"type": "plane_y", "keys": [{"time": t, "centre": [0, 0, 0]} for t in (1, 1)]}]},
        "colliders[0].keys[1].time: 1 does not come after the key before it",
    ),
    ({"output": {"frames": 0}}, "output.frames: 0 is below the least allowed, 1"),
    ({"name": "../escape"}, 'name: "../escape" cannot begin a file\'s name'),
    ({"preset": "tesis"}, "did you mean thesis?"),
    ([], "the scene: expected an object"),
]


@pytest.mark.parametrize(("document", "sentence"), MISTAKES)
def test_a_mistake_is_one_sentence(document: object, sentence: str) -> None:
    with pytest.raises(fontana.SceneError) as error:
        resolve(document if isinstance(document, list) else _checked(document), "scene").build()
    assert sentence in str(error.value)
    assert "\n" not in str(error.value)


def _checked(document: dict) -> object:
    from fontana.reader import normalized

    return normalized(document)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('{"fluid": }', "line 1, column 11: not JSON: expecting value"),
        ('{"a": 1, "a": 2}', 'the key "a" stands twice in one object'),
        ('{"a": NaN}', "NaN is not a finite number"),
        ('{"a": -Infinity}', "-Infinity is not a finite number"),
        ('{"a": 1e999}', "the number 1e999 is too large"),
        ('{"a": ' + "9" * 5000 + "}", "is too large"),
        ("[" * 100000, "nested deeper than 64"),
        ('{"a":' * 70 + "1" + "}" * 70, "nested deeper than 64"),
        ("", "not JSON: the file is empty"),
        ('{"name": "a"', "line 1, column 13: not JSON: it ends too early"),
        ('{"name": "a" // b\n}', "line 1, column 14: not JSON: it has no comments"),
        ('{"name": "a",\n}', "line 2, column 1: not JSON: expected no comma before }"),
        ('{"emitters": [1,]}', "not JSON: expected no comma before ]"),
        ("{'name': 1}", "line 1, column 2: not JSON: text stands between "),
        ('{"name": "' + "x" * 70000 + '"}', "text longer than"),
    ],
)
def test_json_is_read_strictly(text: str, sentence: str) -> None:
    with pytest.raises(fontana.SceneError) as error:
        parse_json(text)
    assert sentence in str(error.value)
    assert "\n" not in str(error.value)


def test_files_that_cannot_be_scenes(tmp_path: Path) -> None:
    binary = tmp_path / "binary.json"
    binary.write_bytes(b'{"name": "\xff"}')
    with pytest.raises(fontana.SceneError, match="binary.json: byte 10 is not UTF-8 text"):
        load_scene(binary)
    huge = tmp_path / "huge.json"
    with huge.open("wb") as file:
        file.truncate(65 * 2**20)
    with pytest.raises(fontana.SceneError, match="larger than 64 MiB"):
        load_scene(huge)
    with pytest.raises(fontana.SceneError, match="is a folder"):
        load_scene(tmp_path)
    with pytest.raises(fontana.SceneError, match="did you mean fountain"):
        load_scene("fountian")
    with pytest.raises(fontana.SceneError, match='"": no such file or bundled scene; known are'):
        load_scene("")


def test_units_become_si() -> None:
    scene = load_scene(
        {
            "fluid": {"particle_spacing": "2 cm", "viscosity": "300 cP"},
            "forces": {"gravity": [0, "-981 cm/s2", 0]},
            "emitters": [{"type": "block", "size": ["50 cm", 1, 1]}],
        }
    )
    assert scene.parameters["fluid.particle_spacing"] == pytest.approx(0.02)
    assert scene.parameters["fluid.viscosity"] == pytest.approx(0.3)
    assert scene.parameters["forces.gravity"] == pytest.approx([0, -9.81, 0])
    assert scene.emitters[0]["size"] == pytest.approx([0.5, 1, 1])


def test_text_with_a_unit_is_not_scaled_again() -> None:
    """In a scene in centimetres plain numbers are centimetres, and "5 cm" is five of them."""
    sphere = {"type": "sphere_outside", "centre": [0, "10 cm", 30], "radius": "5 cm", "velocity": ["1 m/s", 0, 0]}
    scene = load_scene({"time": {"simulation_scale": 0.01}, "colliders": [sphere]})
    collider = scene.colliders[0]
    assert collider["centre"] == pytest.approx([0, 10, 30])
    assert collider["radius"] == pytest.approx(5)
    assert collider["velocity"] == pytest.approx([100, 0, 0])


def test_kinematic_viscosity_takes_the_density_of_the_scene() -> None:
    simulation = load_scene({"fluid": {"viscosity": "7e-3 m2/s", "rest_density": 1420}}).build()
    assert simulation.get("fluid.viscosity") == pytest.approx(9.94)
    assert simulation.derived().kinematic_viscosity == pytest.approx(7e-3)


def test_a_named_fluid_sets_its_values_and_is_overridden() -> None:
    honey = fontana.fluids()["honey"]
    scene = load_scene({"fluid": "honey"})
    assert scene.parameters["fluid.rest_density"] == honey.density
    assert scene.parameters["fluid.viscosity"] == honey.viscosity
    thinner = load_scene({"fluid": {"type": "honey", "viscosity": 2}})
    assert thinner.parameters["fluid.viscosity"] == 2
    assert thinner.parameters["fluid.rest_density"] == honey.density


def test_surface_tension_only_below_the_capillary_length() -> None:
    coarse, fine = (load_scene({"fluid": {"type": "water", "particle_spacing": d}}) for d in ("5 mm", "1 mm"))
    assert "fluid.surface_tension" not in coarse.parameters
    assert any("surface tension" in note for note in coarse.notes)
    assert fine.parameters["fluid.surface_tension"] == pytest.approx(0.0728)
    assert not fine.notes


def test_overrides_win_and_reach_every_part() -> None:
    overrides = dict(
        parse_assignment(text)
        for text in (
            "fluid.viscosity=300 cP",
            "forces.gravity=0,-1 m/s2,0",
            "emitters[0].size=[1,1,2]",
            "output.frames=7",
            "particle_spacing=3cm",
        )
    )
    document = {"fluid": "honey", "emitters": [{"type": "block", "size": [1, 1, 1]}]}
    scene = load_scene(document, overrides)
    assert scene.parameters["fluid.viscosity"] == pytest.approx(0.3)
    assert scene.parameters["fluid.rest_density"] == 1420
    assert scene.parameters["fluid.particle_spacing"] == pytest.approx(0.03)
    assert scene.parameters["forces.gravity"] == [0, -1, 0]
    assert scene.emitters[0]["size"] == [1, 1, 2]
    assert scene.frame_count == 7
    assert document["fluid"] == "honey"


def test_of_two_changes_of_the_same_value_the_last_wins() -> None:
    changes = parse_assignments(["viscosity=1", "fluid.viscosity=2", 'fluid={"particle_spacing": 0.1}', "viscosity=3"])
    scene = load_scene({"name": "a", "emitters": []}, changes)
    assert scene.parameters == {"fluid.particle_spacing": 0.1, "fluid.viscosity": 3.0}


def test_another_fluid_keeps_the_particles_and_loses_the_values() -> None:
    document = {"fluid": {"particle_spacing": 0.01, "viscosity": 3, "rest_density": 900, "surface_tension": 0.1}}
    for override in ({"fluid": "honey"}, {"fluid.type": "honey"}):
        scene = load_scene(document, {"fluid.surface_tension": 0.5} | override)
        honey = fontana.fluids()["honey"]
        assert scene.parameters == {
            "fluid.particle_spacing": 0.01,
            "fluid.rest_density": honey.density,
            "fluid.viscosity": honey.viscosity,
            "fluid.surface_tension": 0.5,
        }


@pytest.mark.parametrize(
    ("assignment", "sentence"),
    [
        ("fluid.viscosity", "expected path=value"),
        ("fluid.viscocity=1", "did you mean fluid.viscosity?"),
        ("viscocity=1", "viscocity: there is no such part of a scene; did you mean fluid.viscosity?"),
        ("emitters[4].speed=1", "there are only 0 entries"),
        ("fluid..x=1", "is not a path"),
        ("fluid.viscosity.x=1", "fluid.viscosity: expected a number"),
        ("fluid.viscosity=NaN", 'fluid.viscosity: "NaN": expected a number'),
        ("name.x=1", "there is no such place"),
    ],
)
def test_overrides_that_lead_nowhere(assignment: str, sentence: str) -> None:
    with pytest.raises(fontana.SceneError) as error:
        load_scene({"name": "a", "emitters": []}, dict([parse_assignment(assignment)]))
    assert sentence in str(error.value)


def test_key_frames_follow_the_frame_duration() -> None:
    keys = [{"frame": 0, "centre": [0, 1, 0]}, {"frame": 24, "centre": [0, 3, 0]}]
    document = {
        "time": {"frame_rate": 48},
        "colliders": [{"type": "sphere_outside", "radius": 0.1, "keys": keys}],
    }
    simulation = load_scene(document).build()
    assert simulation.collider_centre(0, 0.25) == pytest.approx((0, 2, 0))
    assert simulation.collider_centre(0, 9.0) == pytest.approx((0, 3, 0))


def test_the_resolved_scene_loads_to_itself(drop: dict) -> None:
    scene = load_scene(drop)
    resolved = scene.resolved(scene.build())
    again = load_scene(json.loads(json.dumps(resolved)))
    assert again.resolved(again.build()) == resolved
    jsonschema.validate(resolved, fontana.scene_schema())


def test_the_digest_is_that_of_the_physics(drop: dict) -> None:
    def of(overrides: dict) -> str:
        scene = load_scene(drop, overrides)
        return digest(scene.resolved(scene.build()))

    assert of({}) == of({"solver.threads": 1, "solver.neighbors": "all-pairs", "output.frames": 99, "description": "x"})
    assert of({}) != of({"fluid.viscosity": 4.9})
    assert of({}) != of({"solver.max_iterations": 7})
    assert of({}) != of({"colliders[1].radius": 0.11})


def test_changed_keys_are_named() -> None:
    before = {"a": {"b": 1, "c": [1, {"d": 2}]}, "e": 1}
    after = {"a": {"b": 2, "c": [1, {"d": 3}]}, "f": 1}
    assert changed_keys(before, after) == ["a.b", "a.c[1].d", "e", "f"]


def test_dicts_may_hold_arrays_and_tuples() -> None:
    scene = load_scene({"emitters": [{"type": "block", "size": np.ones(3), "centre": (0, 1, 0)}]})
    assert scene.emitters[0]["size"] == [1.0, 1.0, 1.0]


@pytest.mark.parametrize("name", ["box", "fountain", "fountain_rock", "thesis_box", "thesis_fountain"])
def test_bundled_scenes_load(name: str) -> None:
    scene = load_scene(bundled_scenes()[name])
    assert scene.name == name
    assert scene.description
    simulation = scene.build()
    simulation.check()
    assert 500 < simulation.emitted_by(scene.frame_count) < 50_000


def test_the_schema_is_a_schema_and_knows_every_parameter() -> None:
    schema = fontana.scene_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    for parameter in fontana.parameters():
        group, name = parameter.name.split(".")
        assert name in schema["properties"][group]["properties"]
    for path in bundled_scenes().values():
        jsonschema.validate(json.loads(path.read_text()), schema)


def test_fluids_are_complete_and_consistent() -> None:
    for fluid in fontana.fluids().values():
        assert fluid.sources and fluid.confidence in ("high", "medium-high", "medium", "low")
        for value, bounds in (
            (fluid.viscosity, fluid.viscosity_range),
            (fluid.surface_tension, fluid.surface_tension_range),
        ):
            assert value > 0
            assert bounds is None or bounds[0] <= value <= bounds[1]
