"""Runs in Blender's Python: imports files, says on the last line what Blender made of them, and renders a picture.

Arguments: the folder of the files, the frame to look at, the picture to draw.
"""

import json
import sys
from pathlib import Path

import bpy
import mathutils
import numpy as np

FOLDER, FRAME, PICTURE = Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3]


def describe(thing) -> dict:
    """Count, box in the file's own axes, radius and largest speed of an object at the present frame."""
    data = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    elements = data.vertices if thing.type == "MESH" else data.points
    position = np.empty(3 * len(elements), dtype=np.float32)
    elements.foreach_get("co", position)
    position = position.reshape(-1, 3)
    said = {
        "type": thing.type,
        "count": len(position),
        "low": position.min(0).tolist(),
        "high": position.max(0).tolist(),
    }
    velocity = np.empty(3 * len(elements), dtype=np.float32)
    data.attributes["velocity"].data.foreach_get("vector", velocity)
    said["speed"] = float(np.linalg.norm(velocity.reshape(-1, 3), axis=1).max())
    if thing.type == "POINTCLOUD":
        said["radius"] = data.points[0].radius
    return said


def imported(operator, name: str) -> dict:
    """What the import of a file makes at FRAME, and the range of frames it gives the scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    operator(filepath=str(FOLDER / name))
    scene = bpy.context.scene
    frames = [scene.frame_start, scene.frame_end, scene.render.fps]
    scene.frame_set(FRAME)
    thing = next(thing for thing in bpy.data.objects if thing.type in ("MESH", "POINTCLOUD"))
    up = thing.matrix_world.to_3x3() @ mathutils.Vector((0, 1, 0))
    return describe(thing) | {"frames": frames, "up": list(up)}


def volume(name: str) -> dict:
    """The grids of a .vdb as Blender lists them, and as its OpenVDB reads them."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.object.volume_import(filepath=str(FOLDER / name), files=[{"name": name}])
    thing = bpy.context.object
    thing.data.grids.load()
    listed = {grid.name: grid.data_type for grid in thing.data.grids}
    bpy.utils.expose_bundled_modules()
    import openvdb

    grids = {grid.name: grid for grid in openvdb.readAll(str(FOLDER / name))[0]}
    surface, vel = grids["surface"], grids["vel"]
    points, quads = surface.convertToQuads()
    speeds = [np.linalg.norm(item.value) for item in vel.iterOnValues()]
    return {
        "listed": listed,
        "class": str(surface.gridClass),
        "voxel": [surface.transform.voxelSize()[0], vel.transform.voxelSize()[0]],
        "low": points.min(0).tolist(),
        "high": points.max(0).tolist(),
        "speed": float(max(speeds)),
        "vector_type": vel["vector_type"],
    }


def render(name: str) -> None:
    """The surface under a sun, small, on the CPU."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=str(FOLDER / name))
    scene = bpy.context.scene
    scene.frame_set(FRAME)
    thing = next(thing for thing in bpy.data.objects if thing.type == "MESH")
    material = bpy.data.materials.new("water")
    material.use_nodes = True
    principled = material.node_tree.nodes["Principled BSDF"]
    principled.inputs["Base Color"].default_value = (0.05, 0.25, 0.5, 1)
    principled.inputs["Roughness"].default_value = 0.15
    thing.data.materials.clear()
    thing.data.materials.append(material)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.rotation_euler, sun.data.energy = (0.7, 0.2, 0.4), 4
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (0.0, -3.2, 1.6), (1.15, 0.0, 0.0)
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.6, 0.7, 0.8, 1)
    scene.world = world
    for each in (sun, camera):
        scene.collection.objects.link(each)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 8, False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 240, 160, 100
    scene.render.filepath = PICTURE
    bpy.ops.render.render(write_still=True)


result = {
    "version": bpy.app.version_string,
    "points": imported(bpy.ops.wm.usd_import, "points.usdc"),
    "surface": imported(bpy.ops.wm.usd_import, "surface.usda"),
    "alembic": imported(bpy.ops.wm.alembic_import, "points.abc"),
    "volume": volume(f"volume.{FRAME:04d}.vdb"),
}
render("surface.usda")
print(json.dumps(result))
