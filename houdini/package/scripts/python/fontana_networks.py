"""Builds networks around Fontana's nodes: those of the thesis's Figs. 11, 12 and 14, with today's nodes.

    import fontana_networks
    fontana_networks.box()        # a block of water falls into an open box
    fontana_networks.fountain()   # a rock falls into a fountain of two basins

Each makes objects in /obj and a material in /mat, and returns the solver node. For Houdini's Python shell, hython and
the shelf. Positions, sizes and times come from Fontana's scenes, which the package carries as JSON in SI units.
"""

from __future__ import annotations

import json
import math
from pathlib import Path

import hou

SOURCE = "fontana::source::1.0"
SOLVER = "fontana::solver::1.0"
SCENES = Path(__file__).parents[2] / "scenes"
START_FRAME = 1  # shows the fluid as it came in; the scene's frame f is Houdini's frame START_FRAME + f
APERTURE = 41.4214  # mm, Houdini's default


def box() -> hou.Node:
    """The box of the thesis's first environment, in the network of its Figs. 11 and 12."""
    return build("box")


def fountain() -> hou.Node:
    """The fountain and the rock of its Fig. 14."""
    return build("fountain_rock")


def build(scene_name: str) -> hou.Node:
    """The network of one of the package's scenes. Returns the solver node.

    Raises hou.OperationFailed where the plugin is not loaded.
    """
    if hou.nodeType(hou.sopNodeTypeCategory(), SOLVER) is None:
        raise hou.OperationFailed(
            "Fontana's nodes are not there: expected a plugin for this Houdini in the package's dso folder, where "
            "BUILD.txt says how to make it"
        )
    scene = json.loads((SCENES / f"{scene_name}.json").read_text(encoding="utf-8"))
    with hou.undos.group(f"Fontana {scene_name}"):
        solver = _fluid(scene)
        _rocks(scene)
        _basins(scene)
        _camera(scene)
        _lights(scene)
    hou.playbar.setFrameRange(START_FRAME, START_FRAME + scene["frames"])
    hou.playbar.setPlaybackRange(START_FRAME, START_FRAME + scene["frames"])
    return solver


def _fluid(scene: dict) -> hou.Node:
    """Source geometry, transform, source, solver, surface and material, as one object."""
    spacing = scene["particle_spacing"]
    geo = hou.node("/obj").createNode("geo", f"fontana_{scene['name']}")
    shape = _comment(_merge(geo, [_block(geo, emitter) for emitter in scene["emitters"]]), "Fig. 12: SOURCE_GEO")
    place = _comment(_after(shape, "xform", "transform"), "Fig. 12: TRANSFORM")
    source = _comment(_after(place, SOURCE, "source"), "Fig. 11: SOURCE")
    source.parm("particle_spacing").set(spacing)
    solver = _comment(_after(source, SOLVER, "solver"), "Figs. 11 and 12: POPNET with SOLVE_SPH")
    for name, value in scene["parameters"].items():
        set_parameter(solver, name, value)
    set_colliders(solver, scene["colliders"])
    surface = _comment(_after(solver, "particlefluidsurface", "surface"), "Fig. 12: SURFACE_GEO")
    surface.parm("particlesep").set(spacing)
    water = _after(surface, "material", "water")
    water.parm("shop_materialpath1").set(_water_material().path())
    water.setDisplayFlag(True)
    water.setRenderFlag(True)
    geo.layoutChildren()
    return solver


def set_parameter(solver: hou.Node, name: str, value: object) -> None:
    """Sets a parameter by its name in a scene: set_parameter(node, "fluid.viscosity", 1.0)."""
    token = name.replace(".", "_")
    if isinstance(value, (list, tuple)):
        solver.parmTuple(token).set(value)
    else:
        solver.parm(token).set(value)


def set_colliders(solver: hou.Node, colliders: list[dict]) -> None:
    """Fills the node's list of implicit surfaces. Fields that a collider lacks keep the panel's defaults."""
    solver.parm("colliders").set(len(colliders))
    for number, collider in enumerate(colliders, start=1):
        solver.parm(f"collider_type{number}").set(collider["type"])
        solver.parm(f"collider_use_cutoff{number}").set("cutoff" in collider)
        for field in ("radius", "cutoff", "thickness", "elasticity", "friction", "flip"):
            if field in collider:
                solver.parm(f"collider_{field}{number}").set(collider[field])
        centre = solver.parmTuple(f"collider_centre{number}")
        centre.set(collider.get("centre", (0.0, 0.0, 0.0)))
        _animate(centre, collider.get("keys", []))


def _animate(parameters: hou.ParmTuple, keys: list[dict]) -> None:
    """Straight lines between the keys, as the solver moves a collider."""
    for key in keys:
        for parameter, value in zip(parameters, key["centre"], strict=True):
            keyframe = hou.Keyframe()
            keyframe.setFrame(START_FRAME + key["frame"])
            keyframe.setValue(value)
            keyframe.setExpression("linear()", hou.exprLanguage.Hscript)
            parameter.setKeyframe(keyframe)


def _block(geo: hou.Node, emitter: dict) -> hou.Node:
    node = geo.createNode("box", "block")
    node.parmTuple("size").set(emitter["size"])
    node.parmTuple("t").set(emitter["centre"])
    return node


def _merge(geo: hou.Node, nodes: list[hou.Node]) -> hou.Node:
    merge = geo.createNode("merge", "source_geo")
    for index, node in enumerate(nodes):
        merge.setInput(index, node)
    return merge


def _after(node: hou.Node, type_name: str, name: str) -> hou.Node:
    """A node whose first input is `node`."""
    following = node.parent().createNode(type_name, name)
    following.setInput(0, node)
    return following


def _comment(node: hou.Node, text: str) -> hou.Node:
    node.setComment(text)
    node.setGenericFlag(hou.nodeFlag.DisplayComment, True)
    return node


def _rocks(scene: dict) -> None:
    """What one sees of a collider that is a ball: a sphere that moves as it does."""
    for collider in scene["colliders"]:
        if collider["type"] == "sphere_outside":
            geo = hou.node("/obj").createNode("geo", "fontana_rock")
            sphere = geo.createNode("sphere", "rock")
            sphere.parm("type").set("polymesh")
            sphere.parmTuple("rad").set([collider["radius"]] * 3)
            geo.parmTuple("t").set(collider.get("centre", (0.0, 0.0, 0.0)))
            _animate(geo.parmTuple("t"), collider.get("keys", []))


def _basins(scene: dict) -> None:
    """What one sees of the cylinders: a tube for each wall that has a height."""
    walls = [item for item in scene["colliders"] if item["type"].startswith("cylinder") and "cutoff" in item]
    if not walls:
        return
    geo = hou.node("/obj").createNode("geo", "fontana_basins")
    merge = geo.createNode("merge", "basins")
    for index, wall in enumerate(walls):
        tube = geo.createNode("tube", "wall")
        tube.parm("type").set("poly")
        tube.parmTuple("rad").set((wall["radius"], wall["radius"]))
        tube.parm("height").set(wall["cutoff"])
        centre = wall["centre"]
        tube.parmTuple("t").set((centre[0], centre[1] + 0.5 * wall["cutoff"], centre[2]))
        merge.setInput(index, tube)
    merge.setDisplayFlag(True)
    merge.setRenderFlag(True)
    geo.layoutChildren()


def _camera(scene: dict) -> None:
    view = scene["view"]
    camera = hou.node("/obj").createNode("cam", "fontana_camera")
    width, height = 1280, 720
    camera.parmTuple("res").set((width, height))
    camera.parmTuple("t").set(view["eye"])
    camera.parmTuple("r").set(look_at(view["eye"], view["target"]))
    opening = math.radians(view["field_of_view"])  # vertical, while Houdini's aperture is the horizontal one
    camera.parm("focal").set(0.5 * APERTURE * height / width / math.tan(0.5 * opening))


def look_at(eye: list[float], target: list[float]) -> tuple[float, float, float]:
    """Rotations in degrees (x, then y) that turn a camera at `eye`, which looks along -z, towards `target`."""
    dx, dy, dz = (towards - here for towards, here in zip(target, eye, strict=True))
    return (math.degrees(math.atan2(dy, math.hypot(dx, dz))), math.degrees(math.atan2(-dx, -dz)), 0.0)


def _lights(scene: dict) -> None:
    sky = hou.node("/obj").createNode("envlight", "fontana_sky")
    sky.parm("light_intensity").set(0.5)
    sun = hou.node("/obj").createNode("hlight", "fontana_sun")
    eye, target = scene["view"]["eye"], scene["view"]["target"]
    sun.parmTuple("t").set((eye[0] - 2.0, eye[1] + 2.0, eye[2]))
    sun.parmTuple("r").set(look_at([eye[0] - 2.0, eye[1] + 2.0, eye[2]], target))
    sun.parm("light_type").set("distant")


def _water_material() -> hou.Node:
    existing = hou.node("/mat/fontana_water")
    if existing is not None:
        return existing
    water = hou.node("/mat").createNode("principledshader", "fontana_water")
    water.parmTuple("basecolor").set((0.8, 0.92, 1.0))
    water.parm("rough").set(0.02)
    water.parm("ior").set(1.33)
    water.parm("transparency").set(1.0)
    return water
