"""Fontana: an SPH fluid solver for visual effects.

    import fontana
    sim = fontana.Simulation("fountain", backend="cpu")
    for frame in sim.frames(48):
        print(frame.number, frame.position.shape)

Units are SI (metres, seconds, kilograms) and Y points up. Errors are subclasses of FontanaError, each with one
sentence: BadInput (SceneError for scenes), OutOfMemory, Unstable, Interrupted, DeviceUnavailable, DeviceLost, IoError,
InternalError.
"""

from fontana import cuda_runtime, opencl_runtime
from fontana._core import (
    BadInput,
    DeviceLost,
    DeviceUnavailable,
    FontanaError,
    InternalError,
    Interrupted,
    IoError,
    OutOfMemory,
    Unstable,
    devices,
    parameters,
    version,
)
from fontana.errors import SceneError
from fontana.fluid_table import fluids
from fontana.formats import read_frame
from fontana.scene import Scene, bundled_scenes, load_scene
from fontana.schema import scene_schema
from fontana.simulation import Frame, Simulation, StaleFrameError

cuda_runtime.prepare()
opencl_runtime.prepare()

__version__ = version()

__all__ = [
    "BadInput",
    "DeviceLost",
    "DeviceUnavailable",
    "FontanaError",
    "Frame",
    "InternalError",
    "Interrupted",
    "IoError",
    "OutOfMemory",
    "Scene",
    "SceneError",
    "Simulation",
    "StaleFrameError",
    "Unstable",
    "bundled_scenes",
    "devices",
    "fluids",
    "load_scene",
    "parameters",
    "read_frame",
    "scene_schema",
    "version",
]
