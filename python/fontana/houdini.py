"""Points between Houdini and a simulation, for those who cannot load the plugin: a Python SOP is enough.

    from fontana import houdini
    houdini.cook(hou.pwd(), {"fluid": {"particle_spacing": 0.02}, "colliders": [{"type": "plane_y"}]})

Every array crosses in one call (hou.Geometry.pointFloatAttribValuesAsString, setPointFloatAttribValuesFromString): a
call for each point is what made this slow in 2012. The node `fontana::solver` does more: it keeps the frames it has
made, so that scrubbing back costs nothing, and its parameters can be keyframed. docs/houdini-networks.md has both.

Positions are metres at a `time.simulation_scale` of 1. `pscale` is a particle's radius, half the particle spacing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fontana import _core
from fontana.scene import Scene
from fontana.simulation import Simulation

# What an attribute of the simulation is called in Houdini; pscale comes with them.
ATTRIBUTES = {
    "position": "P",
    "velocity": "v",
    "id": "id",
    "density": "density",
    "pressure": "pressure",
    "mass": "mass",
}
_STATE = "fontana"  # under this name a node keeps its simulation between cooks; it is not saved with the scene


def add_points(simulation: Simulation, geometry: object) -> int:
    """Adds the points of a hou.Geometry to the simulation as particles, with `v` (m/s) and `mass` (kg) where they have
    them. Returns how many there were.

    Raises BadInput for an attribute of another size, and for values that are not finite or masses that are not
    positive.
    """
    position = _read(geometry, "P", 3)
    if len(position):
        simulation.add_particles(position, _read(geometry, "v", 3), _read(geometry, "mass", 1))
    return len(position)


def write_points(simulation: Simulation, geometry: object) -> None:
    """Makes the points of a modifiable hou.Geometry the particles: P, v, id, density, pressure, mass and pscale.

    Points come in order of id, so that a point keeps its number for life. What else the geometry had goes, unless it
    has as many points already: then other attributes stay.
    """
    count = simulation.particle_count
    _resize(geometry, count)
    for name, attribute in ATTRIBUTES.items():
        _write(geometry, attribute, simulation.core.read(name))
    spacing = simulation.get("fluid.particle_spacing") / simulation.get("time.simulation_scale")
    _write(geometry, "pscale", np.full(count, 0.5 * spacing, np.float32))


def cook(node: object, scene: Mapping | str | Scene, start_frame: int = 1) -> Simulation:
    """The whole of a Python SOP: simulates up to the frame that is being cooked and writes its particles.

    node         the Python SOP, hou.pwd(); its first input, if there is one, brings particles at `start_frame`
    scene        as for fontana.Simulation: the fluid, colliders and emitters; another scene starts anew
    start_frame  shows the particles as they came in; the frame after it is the first one simulated

    The next frame costs one step. A frame further back starts again at `start_frame`: nothing is kept but the latest
    state. Esc stops between substeps, and the next cook goes on from there. Raises SceneError and what Simulation.step
    raises; Houdini shows the sentence on the node.
    """
    hou = _hou()
    wanted = max(0, round(hou.frame()) - start_frame)
    state = node.cachedUserData(_STATE)
    if state is None or state.key != (scene, start_frame) or state.simulation.frame > wanted:
        state = _State((scene, start_frame), _start(node, scene, start_frame))
        node.setCachedUserData(_STATE, state)
    _advance(state.simulation, wanted, hou)
    write_points(state.simulation, node.geometry())
    return state.simulation


@dataclass(frozen=True)
class _State:
    """A simulation between two cooks of a node, and what it was made from."""

    key: tuple
    simulation: Simulation


def _start(node: object, scene: Mapping | str | Scene, start_frame: int) -> Simulation:
    simulation = Simulation(scene)
    for source in node.inputs()[:1]:
        if source is not None:
            add_points(simulation, source.geometryAtFrame(start_frame))
    return simulation


def _advance(simulation: Simulation, wanted: int, hou: object) -> None:
    count = wanted - simulation.frame
    if count <= 0:
        return
    first = simulation.frame
    with hou.InterruptableOperation("Fontana: simulating", open_interrupt_dialog=True) as operation:

        def report(fraction: float) -> bool:
            operation.updateProgress((simulation.frame - first + fraction) / count)  # raises OperationInterrupted
            return False

        for _ in range(count):
            simulation.step(report)


def _resize(geometry: object, count: int) -> None:
    """Only as many new points as are missing; points that are too many cannot be told apart, so all go."""
    present = geometry.intrinsicValue("pointcount")
    if present > count:
        geometry.clear()
        present = 0
    if present < count:
        geometry.createPoints([(0.0, 0.0, 0.0)] * (count - present))


def _read(geometry: object, name: str, components: int) -> np.ndarray | None:
    """(N, components) or (N,) float32; None where the geometry has no such attribute."""
    hou = _hou()
    attribute = geometry.findPointAttrib(name)
    if attribute is None:
        return None
    if attribute.dataType() != hou.attribData.Float or attribute.size() != components:
        wanted = "a float" if components == 1 else f"{components} floats"
        raise _core.BadInput(f"the point attribute {name} cannot be used: expected {wanted}, got {attribute.size()}")
    data = geometry.pointFloatAttribValuesAsString(name, float_type=hou.numericData.Float32)
    values = np.frombuffer(data, np.float32)
    return values if components == 1 else values.reshape(-1, components)


def _write(geometry: object, name: str, values: np.ndarray) -> None:
    hou = _hou()
    is_whole = values.dtype.kind == "i"
    if geometry.findPointAttrib(name) is None:
        zero = 0 if is_whole else 0.0
        default = zero if values.ndim == 1 else (zero,) * values.shape[1]
        geometry.addAttrib(hou.attribType.Point, name, default)
    data = np.ascontiguousarray(values).tobytes()
    if is_whole:
        geometry.setPointIntAttribValuesFromString(name, data, int_type=hou.numericData.Int32)
    else:
        geometry.setPointFloatAttribValuesFromString(name, data, float_type=hou.numericData.Float32)


def _hou() -> object:
    try:
        import hou
    except ImportError as error:
        raise _core.BadInput(
            "there is no Houdini here: expected to run in a Python SOP, in Houdini's Python shell or in hython"
        ) from error
    return hou
