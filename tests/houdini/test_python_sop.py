"""fontana.houdini against a double of Houdini's Python module; in Houdini itself it has not run."""

import numpy as np
import pytest

import fontana
from fontana import houdini

SCENE = {"fluid": {"particle_spacing": 0.02}, "solver": {"backend": "cpu"}, "colliders": [{"type": "plane_y"}]}


class PythonSop:
    """What hou.pwd() gives in a Python SOP, as far as fontana.houdini uses it."""

    def __init__(self, hou, source=None):
        self._geometry = hou.Geometry()
        self._source = source
        self._data = {}

    def inputs(self):
        return (self._source,) if self._source else ()

    def geometry(self):
        return self._geometry

    def cachedUserData(self, name):  # noqa: N802
        return self._data.get(name)

    def setCachedUserData(self, name, value):  # noqa: N802
        self._data[name] = value


class Source:
    """A node upstream, whose points fall from where they are."""

    def __init__(self, hou, position, **attributes):
        self._geometry = hou.Geometry()
        self._geometry.createPoints(position)
        for name, values in attributes.items():
            self._geometry.addAttrib(hou.attribType.Point, name, np.zeros_like(values[0]))
            self._geometry.setPointFloatAttribValuesFromString(name, values.astype(np.float32).tobytes())
        self._geometry.is_modifiable = False

    def geometryAtFrame(self, frame):  # noqa: N802
        return self._geometry


def floats(geometry, name, *shape):
    return np.frombuffer(geometry.pointFloatAttribValuesAsString(name), np.float32).reshape(-1, *shape)


@pytest.fixture
def drop(hou, random_block):
    position, velocity = random_block(5)
    return Source(hou, position + 0.05, v=velocity)


def cook_at(hou, node, frame, scene=SCENE, **arguments):
    hou.setFrame(frame)
    houdini.cook(node, scene, **arguments)
    return node.geometry()


def test_points_and_their_attributes_arrive_and_leave(hou, random_block):
    position, velocity = random_block(4)
    mass = np.linspace(0.007, 0.009, len(position)).astype(np.float32)
    simulation = fontana.Simulation(SCENE)
    assert houdini.add_points(simulation, Source(hou, position, v=velocity, mass=mass).geometryAtFrame(1)) == 64
    geometry = hou.Geometry()
    houdini.write_points(simulation, geometry)
    assert np.array_equal(floats(geometry, "P", 3), position)
    assert np.array_equal(floats(geometry, "v", 3), velocity)
    assert np.array_equal(floats(geometry, "mass"), mass)
    assert np.all(floats(geometry, "density") == 1000.0)
    assert np.frombuffer(geometry.pointIntAttribValuesAsString("id"), np.int32).tolist() == list(range(64))


def test_pscale_is_the_radius_in_units_of_the_scene(hou, drop):
    scene = SCENE | {"time": {"simulation_scale": 0.5}}
    geometry = cook_at(hou, PythonSop(hou, drop), 1, scene)
    assert floats(geometry, "pscale") == pytest.approx(0.02 / 0.5 / 2)


def test_the_frames_are_those_of_a_simulation(hou, drop):
    node = PythonSop(hou, drop)
    simulation = fontana.Simulation(SCENE)
    houdini.add_points(simulation, drop.geometryAtFrame(1))
    assert np.array_equal(floats(cook_at(hou, node, 1), "P", 3), floats(drop.geometryAtFrame(1), "P", 3))
    for number in (2, 3, 4):
        geometry = cook_at(hou, node, number)
        assert np.array_equal(floats(geometry, "P", 3), simulation.step().position)


def test_a_jump_and_going_back_give_the_same_bytes(hou, drop):
    played, jumped = PythonSop(hou, drop), PythonSop(hou, drop)
    for number in range(1, 6):
        cook_at(hou, played, number)
    at_five = played.geometry().pointFloatAttribValuesAsString("P")
    assert cook_at(hou, jumped, 5).pointFloatAttribValuesAsString("P") == at_five
    at_three = cook_at(hou, jumped, 3).pointFloatAttribValuesAsString("P")
    assert at_three != at_five
    assert cook_at(hou, jumped, 5).pointFloatAttribValuesAsString("P") == at_five


def test_another_scene_starts_anew_and_frames_before_the_start_wait(hou, drop):
    node = PythonSop(hou, drop)
    cook_at(hou, node, 4)
    heavy = SCENE | {"forces": {"gravity": [0, -50, 0]}}
    fresh = cook_at(hou, PythonSop(hou, drop), 4, heavy).pointFloatAttribValuesAsString("P")
    assert cook_at(hou, node, 4, heavy).pointFloatAttribValuesAsString("P") == fresh
    waiting = cook_at(hou, node, 4, heavy, start_frame=10)
    assert np.array_equal(floats(waiting, "P", 3), floats(drop.geometryAtFrame(1), "P", 3))


def test_points_come_and_go(hou, drop):
    jet = {"type": "disc", "centre": [0, 0.5, 0], "radius": 0.05, "direction": [0, -1, 0], "speed": 2.0}
    node = PythonSop(hou)
    counts = [cook_at(hou, node, n, SCENE | {"emitters": [jet]}).intrinsicValue("pointcount") for n in (1, 3, 6, 2)]
    assert counts[0] == 0 < counts[3] < counts[1] < counts[2]
    assert np.isfinite(floats(node.geometry(), "P", 3)).all()


def test_esc_keeps_what_is_finished(hou, drop):
    node = PythonSop(hou, drop)
    expected = cook_at(hou, PythonSop(hou, drop), 6).pointFloatAttribValuesAsString("P")
    hou.InterruptableOperation.esc_at_update = 5
    with pytest.raises(hou.OperationInterrupted):
        cook_at(hou, node, 6)
    hou.InterruptableOperation.esc_at_update = None
    assert cook_at(hou, node, 6).pointFloatAttribValuesAsString("P") == expected


def test_an_attribute_of_another_kind_is_refused(hou, random_block):
    position, _ = random_block(2)
    simulation = fontana.Simulation(SCENE)
    with pytest.raises(fontana.BadInput, match="the point attribute v cannot be used: expected 3 floats, got 1"):
        houdini.add_points(simulation, Source(hou, position, v=np.ones(8)).geometryAtFrame(1))


def test_no_points_are_no_error(hou):
    geometry = cook_at(hou, PythonSop(hou, Source(hou, np.zeros((0, 3)))), 3)
    assert geometry.intrinsicValue("pointcount") == 0


def test_without_houdini_the_sentence_says_where_to_run():
    with pytest.raises(fontana.BadInput, match="Python SOP"):
        houdini.cook(None, SCENE)
