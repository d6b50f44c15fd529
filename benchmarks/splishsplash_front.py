"""The dam break of `fontana validate martin-moyce` in SPlisHSPlasH, in two dimensions and in a process of its own.

    LD_PRELOAD=/lib/x86_64-linux-gnu/libGLdispatch.so.0 python benchmarks/splishsplash_front.py 32 2.4 1 dfsph

Spacings to the column's width, seconds, threads, method (dfsph or iisph); needs what splishsplash_run.py needs. Water
1 m wide and 2 m high at one end of a tank of 16 m. Its last line is a JSON object: times (s) and the front (m), the
foremost particle and half a spacing before it, after every step.
"""

import json
import sys

from splishsplash_run import RADIUS, WALL_GAP, np, prepare, sph
from splishsplash_run import scene as cube_of_water

METHODS = {"dfsph": 4, "iisph": 3}
METHOD = METHODS[sys.argv[4]]
TANK_LENGTH, TANK_HEIGHT = 16.0, 4.0


def scene(cube):
    widen = 2 * (WALL_GAP - RADIUS)
    document = cube_of_water(cube)
    document["Configuration"] |= {"sim2D": True, "simulationMethod": METHOD, "timeStepSize": 0.0005}
    document["RigidBodies"][0] |= {
        "translation": [TANK_LENGTH / 2, TANK_HEIGHT / 2, 0],
        "scale": [TANK_LENGTH + widen, TANK_HEIGHT + widen, 1],
    }
    document["FluidBlocks"][0] |= {"start": [-RADIUS, -RADIUS, -0.5], "end": [1 + RADIUS, 2 + RADIUS, 0.5]}
    return document


def main():
    base, fluid, count = prepare(scene)
    times, fronts = [], []

    def note():
        times.append(sph.TimeManager.getCurrent().getTime())
        position = np.array(fluid.getFieldBuffer("position"), copy=False)[:count]
        fronts.append(float(position.reshape(count, 3)[:, 0].max()) + RADIUS)

    note()
    base.setTimeStepCB(note)
    base.runSimulation()
    print(json.dumps({"particles": count, "steps": len(times) - 1, "times": times, "fronts": fronts}))


if __name__ == "__main__":
    main()
