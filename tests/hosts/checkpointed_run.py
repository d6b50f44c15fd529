"""A small run that can be killed at any instant and started again: test_checkpoint.py imports it and runs it.

python checkpointed_run.py FOLDER FRAME_COUNT
"""

import sys
from pathlib import Path

from fontana import _core

TAG = "Brünnchen, 流体"


def build_scene(backend="cpu", threads=1, method="mueller", **parameters):
    """A moving floor, a block that appears in the second frame, a jet; what a checkpoint has to bring back."""
    simulation = _core.Simulation()
    simulation.set("solver.backend", backend)
    simulation.set("solver.threads", threads)
    simulation.set("fluid.method", method)
    simulation.set("time.frame_rate", 120.0)
    simulation.set("time.cfl_factor", 0.5)
    for name, value in parameters.items():
        simulation.set(name.replace("__", "."), value)
    floor = simulation.add_collider("plane_y")
    simulation.set_collider_keys(floor, [0.0, 0.05], [(0.0, -0.05, 0.0), (0.0, 0.0, 0.0)])
    simulation.add_emitter("block", centre=(0.0, 0.1, 0.0), size=(0.12, 0.12, 0.12), first_frame=2, jitter=0.2)
    simulation.add_emitter("disc", centre=(0.2, 0.1, 0.0), radius=0.05, direction=(-1.0, 0.3, 0.0), speed=2.0)
    return simulation


def frame_path(folder: Path, frame: int) -> Path:
    return folder / f"run.{frame:04d}.bgeo"


def checkpoint_path(folder: Path) -> Path:
    return folder / "run.checkpoint"


def previous_path(folder: Path) -> Path:
    return folder / "run.checkpoint.previous"


def load_newest(simulation, folder: Path) -> bool:
    """Continues from the newest checkpoint that is whole; False if there is none."""
    for path in (checkpoint_path(folder), previous_path(folder)):
        if path.exists():
            simulation.load_checkpoint(str(path))
            return True
    return False


def build_large_scene():
    """Enough particles that the files are written in several pieces; short frames, so that they come quickly."""
    simulation = build_scene(time__timestep=5e-4, time__substeps=1)
    simulation.add_emitter("block", centre=(0.0, 0.6, 0.0), size=(0.6, 0.6, 0.6))
    return simulation


def main(folder: Path, frame_count: int) -> None:
    simulation = build_large_scene()
    load_newest(simulation, folder)
    print("ready", flush=True)
    while simulation.frame < frame_count:
        simulation.step_frame()
        simulation.write_bgeo(str(frame_path(folder, simulation.frame)))
        simulation.save_checkpoint(str(checkpoint_path(folder)), TAG)


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))
