"""The dam break of vs_splishsplash.py in SPlisHSPlasH, in a process of its own; its last line is a JSON object.

    LD_PRELOAD=/lib/x86_64-linux-gnu/libGLdispatch.so.0 python benchmarks/splishsplash_run.py 32 0.3 1

needs `pip install pysplishsplash==2.19.0 numpy`; the preload keeps the wheel's own copy of that library, which clashes
with the system's, out of the way. A cube of water of 1 m in the corner of a tank of 2 x 2 x 1 m, N^3 particles, DFSPH,
boundary particles (Akinci et al. 2012), mean density error 0.05 %, CFL factor 1.
"""

import json
import os
import sys
import tempfile
import time

PER_METRE, SECONDS, THREADS = int(sys.argv[1]), float(sys.argv[2]), sys.argv[3]
os.environ["OMP_NUM_THREADS"] = THREADS

import numpy as np  # noqa: E402  the libraries read the number of threads when they are loaded
import pysplishsplash as sph  # noqa: E402

DFSPH, STANDARD_VISCOSITY = 4, 1
RADIUS = 0.5 / PER_METRE
WALL_GAP = 2.5 * RADIUS  # first layer of the fluid to the wall's particles: SPlisHSPlasH's own habit at rest
FACES = ((0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5), (2, 3, 7), (2, 7, 6),
         (3, 0, 4), (3, 4, 7))  # fmt: skip


def write_cube(folder):
    """A cube of side 1 around the origin, for the walls."""
    corners = [(x, y, z) for z in (-0.5, 0.5) for x, y in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + ["f " + " ".join(str(i + 1) for i in face) for face in FACES]
    path = os.path.join(folder, "cube.obj")
    with open(path, "w") as file:
        file.write("\n".join(lines) + "\n")
    return path


def scene(cube):
    widen = 2 * (WALL_GAP - RADIUS)
    return {
        "Configuration": {
            "particleRadius": RADIUS, "simulationMethod": DFSPH, "gravitation": [0, -9.81, 0],
            "timeStepSize": 0.001, "cflMethod": 1, "cflFactor": 1, "cflMaxTimeStepSize": 0.005,
            "cflMinTimeStepSize": 1e-5, "boundaryHandlingMethod": 0, "stepsPerSecond": 0,
            "minIterations": 2, "maxIterations": 100, "maxError": 0.05,
            "DFSPH": {"minIterations": 2, "maxIterations": 100, "maxError": 0.05, "maxIterationsV": 100,
                      "maxErrorV": 0.1, "enableDivergenceSolver": True},
        },
        "Materials": [{"id": "Fluid", "density0": 1000, "viscosityMethod": STANDARD_VISCOSITY,
                       "Standard viscosity": {"viscosity": 0.01}}],
        "RigidBodies": [{"geometryFile": cube, "translation": [1, 1, 0.5], "rotationAxis": [1, 0, 0],
                         "rotationAngle": 0, "scale": [2 + widen, 2 + widen, 1 + widen], "isDynamic": False,
                         "isWall": True, "mapInvert": True, "mapThickness": 0.0, "mapResolution": [10, 10, 10]}],
        "FluidBlocks": [{"id": "Fluid", "denseMode": 0, "start": [-RADIUS] * 3, "end": [1 + RADIUS] * 3}],
    }  # fmt: skip


def prepare(scene_of):
    """The simulator, its fluid and how many particles that has; `scene_of` makes a scene from the walls' file."""
    folder = tempfile.mkdtemp()
    path = os.path.join(folder, "scene.json")
    with open(path, "w") as file:
        json.dump(scene_of(write_cube(folder)), file)
    base = sph.Exec.SimulatorBase()
    base.init(sceneFile=path, useCache=False, outputDir=folder, initialPause=False, useGui=False, stopAt=SECONDS - 1e-6)
    base.initSimulation()
    fluid = sph.Simulation.getCurrent().getFluidModel(0)
    count = fluid.numActiveParticles()
    return base, fluid, count


def main():
    base, fluid, count = prepare(scene)
    clock = {"steps": 0, "largest": [], "times": [], "mean": 0.0, "seconds": 0.0, "last": None}

    def after_step():
        """Errors at every step; the time they take is not counted."""
        now = time.perf_counter()
        if clock["last"] is not None:
            clock["seconds"] += now - clock["last"]
        clock["steps"] += 1
        error = np.maximum(np.array(fluid.getFieldBuffer("density"), copy=False)[:count] / 1000.0 - 1.0, 0.0)
        clock["largest"].append(float(error.max()))
        clock["times"].append(sph.TimeManager.getCurrent().getTime())
        clock["mean"] += float(error.mean())
        clock["last"] = time.perf_counter()

    base.setTimeStepCB(after_step)
    base.runSimulation()
    x = np.array(fluid.getFieldBuffer("position"), copy=True)[:count].reshape(count, 3)
    steps = clock["steps"]
    print(json.dumps({
        "particles": count, "simulated": sph.TimeManager.getCurrent().getTime(), "steps": steps,
        # The first step ran before the clock did; it counts as a mean one.
        "seconds": clock["seconds"] * steps / max(1, steps - 1),
        "density_error_mean": clock["mean"] / steps, "density_errors": clock["largest"],
        "times": clock["times"],
        "front": float(x[:, 0].max()), "centre_of_mass": x.mean(axis=0).astype(float).tolist(),
    }))  # fmt: skip


if __name__ == "__main__":
    main()
