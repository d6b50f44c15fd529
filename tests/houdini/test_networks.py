"""The scripts of the package on a double of Houdini's Python module: node types, parameters, wires, keys, figures.

Parameter names of Fontana's nodes are the plugin's own, as it gives them to the double of the HDK; those of Houdini's
nodes are what the double lists. Nothing here has run in Houdini.
"""

import importlib
import json
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fontana

ROOT = Path(__file__).parents[2]
TOOL = ROOT / "tools" / "make_houdini_package.py"


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """The package's shared folder, made by its command: the scripts read their scenes there."""
    out = tmp_path_factory.mktemp("package")
    subprocess.run([sys.executable, TOOL, "--out", out], check=True, capture_output=True)
    return next(out.glob("*/fontana/shared"))


@pytest.fixture
def networks(hou, panels, shared, monkeypatch):
    hou.panels.update(panels)
    monkeypatch.syspath_prepend(str(shared / "scripts" / "python"))
    for name in ("fontana_networks", "fontana_selftest"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    return importlib.import_module("fontana_networks")


def chain(node):
    """The types from a node upwards along first inputs."""
    types = []
    while node is not None:
        types.append(node.type().name())
        node = node.inputs()[0] if node.inputs() else None
    return types


def test_the_box_is_the_network_of_figures_11_and_12(hou, networks):
    solver = networks.box()
    assert chain(solver) == ["fontana::solver::1.0", "fontana::source::1.0", "xform", "merge", "box"]
    (surface,) = solver.outputs()
    (water,) = surface.outputs()
    assert [surface.type().name(), water.type().name()] == ["particlefluidsurface", "material"]
    assert water.flags == {"display", "render"}
    assert hou.node(water.parm("shop_materialpath1").eval()).type().name() == "principledshader"
    assert surface.parm("particlesep").eval() == solver.parm("fluid_particle_spacing").eval() == 0.02
    assert solver.inputs()[0].parm("particle_spacing").eval() == 0.02
    comments = {node.comment for node in solver.parent().children()}
    assert comments >= {"Fig. 12: SOURCE_GEO", "Fig. 12: TRANSFORM", "Fig. 11: SOURCE", "Fig. 12: SURFACE_GEO"}


@pytest.mark.parametrize("function", ["box", "fountain"])
def test_the_numbers_are_those_of_the_scene(networks, function):
    scene = fontana.load_scene({"box": "box", "fountain": "fountain_rock"}[function])
    solver = getattr(networks, function)()
    for name, value in scene.parameters.items():
        assert solver.parm(name.replace(".", "_")).eval() == value, name
    assert solver.parm("colliders").eval() == len(scene.colliders)
    for number, collider in enumerate(scene.colliders, start=1):
        assert solver.parm(f"collider_type{number}").eval() == collider["type"]
        assert bool(solver.parm(f"collider_use_cutoff{number}").eval()) == ("cutoff" in collider)
        for field in ("radius", "cutoff", "thickness", "flip"):
            if field in collider:
                assert solver.parm(f"collider_{field}{number}").eval() == collider[field]
    blocks = solver.inputs()[0].inputs()[0].inputs()[0].inputs()
    assert [(list(b.parmTuple("t").eval()), list(b.parmTuple("size").eval())) for b in blocks] == [
        (emitter["centre"], emitter["size"]) for emitter in scene.emitters
    ]


def test_the_rock_of_figure_14_is_seen_where_the_fluid_feels_it(hou, networks):
    solver = networks.fountain()
    scene = fontana.load_scene("fountain_rock")
    keys = next(collider["keys"] for collider in scene.colliders if "keys" in collider)
    felt, seen = solver.parmTuple("collider_centre5"), hou.node("/obj/fontana_rock").parmTuple("t")
    for axis in range(3):
        for parm in (felt[axis], seen[axis]):
            assert [(key.frame, key.value) for key in parm.keys] == [(1 + k["frame"], k["centre"][axis]) for k in keys]
            assert {key.expression for key in parm.keys} == {"linear()"}
    assert hou.node("/obj/fontana_rock/rock").parmTuple("rad").eval() == (0.17, 0.17, 0.17)
    assert len(hou.node("/obj/fontana_basins/basins").inputs()) == 3
    assert hou.playbar.frame_range == (1, 65)


def test_the_camera_looks_at_its_target(hou, networks):
    networks.fountain()
    camera = hou.node("/obj/fontana_camera")
    x, y, _ = (math.radians(angle) for angle in camera.parmTuple("r").eval())
    # A camera looks along -z; Houdini turns it about x, then about y.
    direction = np.array([-math.sin(y) * math.cos(x), math.sin(x), -math.cos(y) * math.cos(x)])
    view = fontana.load_scene("fountain_rock").view
    wanted = np.array(view["target"]) - np.array(view["eye"])
    assert direction == pytest.approx(wanted / np.linalg.norm(wanted), abs=1e-6)
    opening = 2 * math.atan(networks.APERTURE * 720 / 1280 / 2 / camera.parm("focal").eval())
    assert math.degrees(opening) == pytest.approx(view["field_of_view"])


def test_every_object_has_a_light_and_a_camera(hou, networks):
    networks.box()
    assert {node.type().name() for node in hou.node("/obj").children()} == {"geo", "cam", "hlight", "envlight"}


def test_a_second_network_stands_beside_the_first(hou, networks):
    first, second = networks.box(), networks.box()
    assert first.path() != second.path()
    assert len(hou.node("/mat").children()) == 1


def test_without_the_plugin_the_sentence_says_what_to_do(hou, networks):
    hou.panels.clear()
    with pytest.raises(hou.OperationFailed, match="BUILD.txt"):
        networks.box()
    assert not hou.node("/obj").children()


def test_the_scenes_of_the_package_are_plain_numbers(shared):
    for path in (shared / "scenes").iterdir():
        scene = json.loads(path.read_text())
        texts = [value for value in scene["parameters"].values() if isinstance(value, str)]
        assert texts == ([scene["parameters"]["fluid.method"]] if "fluid.method" in scene["parameters"] else [])
        assert scene["emitters"] and {emitter["type"] for emitter in scene["emitters"]} == {"block"}


class Fluid:
    """What the solver node cooks to in the self-test's trial: the same fluid through the Python package.

    `spoil` gets each frame's arrays by attribute, as a defect of the node would leave them.
    """

    def __init__(self, hou, spoil=lambda frame, arrays: None):
        self.hou, self.spoil, self.frames = hou, spoil, {}

    def cook(self, node, frame):
        gravity = tuple(node.parmTuple("forces_gravity").eval())
        gravity = gravity if any(gravity) else (0.0, -9.81, 0.0)  # the double's parameters begin at 0
        if gravity not in self.frames:
            self.frames[gravity] = list(self._simulate(node, gravity))
        arrays = dict(self.frames[gravity][frame - 1])
        self.spoil(frame, arrays)
        geometry = self.hou.Geometry()
        geometry.createPoints(arrays["P"])
        for name, values in arrays.items():
            if name != "P":
                zero = 0 if values.dtype.kind == "i" else 0.0
                geometry.addAttrib(self.hou.attribType.Point, name, zero if values.ndim == 1 else (zero,) * 3)
                setter = "Int" if values.dtype.kind == "i" else "Float"
                getattr(geometry, f"setPoint{setter}AttribValuesFromString")(name, values.tobytes())
        return geometry

    def _simulate(self, node, gravity):
        simulation = fontana.Simulation(
            "box", backend="cpu", particle_spacing=0.03, **{"forces.gravity": gravity, "time.substeps": 40}
        )
        yield self._arrays(simulation.core, 0, node)
        for number in range(1, 24):
            simulation.step()
            yield self._arrays(simulation.core, number, node)

    @staticmethod
    def _arrays(core, number, node):
        if (
            core.particle_count == 0
        ):  # the node shows its source at the first frame; the library emits in the first step
            twin = fontana.Simulation("box", backend="cpu", particle_spacing=0.03)
            twin.set("time.timestep", 1e-6)
            twin.step()
            core = twin.core
        count = core.particle_count
        names = {"P": "position", "v": "velocity", "density": "density", "pressure": "pressure", "id": "id"}
        arrays = {name: core.read(attribute) for name, attribute in names.items()}
        return arrays | {
            "pscale": np.full(count, 0.5 * node.parm("fluid_particle_spacing").eval(), np.float32),
            "age": np.full(count, number / 24, np.float32),
        }


@pytest.fixture(scope="module")
def frames_of_all():
    """Frames that were simulated once, for all trials."""
    return {}


def self_test(hou, networks, frames, tmp_path, spoil=lambda frame, arrays: None):
    fluid = Fluid(hou, spoil)
    fluid.frames = frames
    hou.cooks["fontana::solver::1.0"] = fluid.cook
    hou.cooks["particlefluidsurface"] = lambda node, frame: types_geometry(hou)
    module = importlib.import_module("fontana_selftest")
    holds = module.run(str(tmp_path / "report.txt"))
    return holds, (tmp_path / "report.txt").read_text()


def types_geometry(hou):
    geometry = hou.Geometry()
    geometry.intrinsicValue = lambda name: 1
    return geometry


def test_the_self_test_reports_a_sound_node(hou, networks, frames_of_all, tmp_path):
    holds, report = self_test(hou, networks, frames_of_all, tmp_path)
    assert holds, report
    assert report.count("\nok ") == 8 and "all checks hold" in report
    assert "Device: the double" in report
    assert not hou.node("/obj").children() and not hou.node("/mat").children()


def diameter(frame, arrays):
    arrays["pscale"] = 2 * arrays["pscale"]


def no_number(frame, arrays):
    if frame == 24:
        arrays["v"] = np.where(np.arange(len(arrays["v"]))[:, None] == 7, np.nan, arrays["v"])


def stands_still(frame, arrays):
    arrays["P"] = arrays["P"] + np.float32(0.0)
    arrays["P"][:, 1] = 0.3 + 1e-4 * frame


def falls_through(frame, arrays):
    arrays["P"] = arrays["P"] - np.float32(0.05 * frame) * np.array([0, 1, 0], np.float32)


def other_ids(frame, arrays):
    arrays["id"] = arrays["id"][::-1].copy()


class DriftsWithEachCook:
    def __init__(self):
        self.cooks = 0

    def __call__(self, frame, arrays):
        self.cooks += 1
        arrays["P"] = arrays["P"] + np.float32(1e-6 * self.cooks)


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (diameter, "FAILED  pscale is the radius"),
        (no_number, "v has a value that is no number"),
        (stands_still, "it fell"),
        (falls_through, "below the floor"),
        (other_ids, "FAILED  ids are 0, 1, 2"),
        (DriftsWithEachCook(), "differs from when it was played"),
    ],
    ids=["diameter", "no number", "stands still", "falls through", "ids", "drift"],
)
def test_the_self_test_finds_a_defect(hou, networks, frames_of_all, tmp_path, spoil, sentence):
    holds, report = self_test(hou, networks, frames_of_all, tmp_path, spoil)
    assert not holds
    assert sentence in report and "FAILED\n" in report
