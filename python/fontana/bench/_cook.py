"""The program that cooks the solver node on a double of the HDK, houdini/bench/cook_bench.cpp: built, asked, heard."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import tempfile
from pathlib import Path

from fontana import _core
from fontana.bench._scenes import METHOD, SPACING, BenchScene
from fontana.bench._schemes import Scheme
from fontana.bench._timing import SUBSTEPS_PER_FRAME
from fontana.tables import COLLIDERS, parameters

TARGETS = ("fontana_cook_bench", "fontana_houdini")


def build_driver(checkout: Path) -> tuple[Path, Path]:
    """Builds the program and the plugin with the preset `release`. Returns where they are.

    Raises BadInput where `checkout` is not one of Fontana, or where it does not build.
    """
    cmake = shutil.which("cmake")
    if not (checkout / "houdini/bench/cook_bench.cpp").exists() or cmake is None:
        missing = "cmake" if cmake is None else "Fontana's sources"
        raise _core.BadInput(
            f"fontana bench houdini builds the node against a double of the HDK and finds no {missing}: expected to "
            "run in a checkout, with cmake on the path (`make build` puts one into .venv/bin)"
        )
    for arguments in (
        ["--preset", "release", "--log-level=WARNING"],
        ["--build", "--preset", "release", "-j", "2", "--target", *TARGETS],
    ):
        done = subprocess.run([cmake, *arguments], cwd=checkout, capture_output=True, text=True)
        if done.returncode != 0:
            lines = (done.stdout + done.stderr).strip().splitlines()
            raise _core.BadInput(f"the node does not build: cmake says {lines[-1] if lines else 'nothing'}")
    build = checkout / "build" / "release"
    return _find(build, TARGETS[0]), _find(build, f"{TARGETS[1]}.so")


def _find(folder: Path, name: str) -> Path:
    return next(path for path in folder.rglob(name) if path.is_file())


def run_driver(
    driver: tuple[Path, Path],
    scene: BenchScene,
    scheme: Scheme,
    dt: float,
    repeats: tuple[int, int, float],
    threads: int,
) -> dict:
    """Seconds of frames through the node and through the library, as lists "node_seconds" and "library_seconds"; and
    "node_processor_seconds", "library_processor_seconds": the time of all threads.

    `repeats`: frames of warming up, the most pairs, and seconds after which no pair is begun. Raises InternalError
    where the program fails, or where both did not end with the same positions.
    """
    program, plugin = driver
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene.position.tofile(folder / "position.f32")
        scene.velocity.tofile(folder / "velocity.f32")
        request = folder / "request.txt"
        particles = f"particles {scene.particle_count} {folder / 'position.f32'} {folder / 'velocity.f32'}"
        lines = [f"plugin {plugin}", particles, "repeats {} {} {:g}".format(*repeats)]
        request.write_text("\n".join([*lines, *_settings(scene, scheme, dt, threads)]) + "\n", encoding="utf-8")
        done = subprocess.run([program, request], capture_output=True, text=True)
    if done.returncode != 0:
        raise _core.InternalError(done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "the driver crashed")
    heard = json.loads(done.stdout)
    if not heard["same_positions"]:
        raise _core.InternalError("the node and the library do not agree on where the particles are")
    return heard


def _settings(scene: BenchScene, scheme: Scheme, dt: float, threads: int) -> list[str]:
    """The same settings for both: the library knows "time.substeps", the node's panel time_substeps."""
    numbers = {
        "fluid.particle_spacing": SPACING,
        "time.timestep": SUBSTEPS_PER_FRAME * dt,
        "time.substeps": SUBSTEPS_PER_FRAME,
        "solver.threads": threads,
    }
    texts = {"fluid.method": METHOD, "solver.backend": scheme.backend, "solver.neighbors": scheme.neighbors}
    lines = [f"number {path} {value!r}" for path, value in numbers.items()]
    lines += [f"node_number {_token(path)} 0 {value!r}" for path, value in numbers.items()]
    lines += [f"text {path} {value}" for path, value in texts.items()]
    # The panel's menus are numbered in the order of the table.
    lines += [
        f"node_number {_token(path)} 0 {parameters()[path].choices.index(value)}" for path, value in texts.items()
    ]
    lines.append(f"node_number colliders 0 {len(scene.colliders)}")
    for number, collider in enumerate(scene.colliders, start=1):
        lines += _collider(collider, number)
    return lines


def _token(path: str) -> str:
    return path.replace(".", "_")


def _collider(collider: dict, number: int) -> list[str]:
    kind, flip = list(COLLIDERS).index(collider["type"]), int(collider.get("flip", False))
    centre = [float(part) for part in collider.get("centre", (0, 0, 0))]
    radius = collider.get("radius", 1.0)
    cutoff, thickness = collider.get("cutoff", math.inf), collider.get("thickness", math.inf)
    values = (kind, flip, *centre, radius, cutoff, thickness)
    panel = {"type": kind, "flip": flip, "radius": radius, "thickness": 0.0 if thickness == math.inf else thickness}
    if cutoff != math.inf:
        panel |= {"use_cutoff": 1, "cutoff": cutoff}
    lines = ["collider " + " ".join(map(repr, values))]
    lines += [f"node_number collider_centre{number} {part} {value!r}" for part, value in enumerate(centre)]
    return lines + [f"node_number collider_{name}{number} 0 {value!r}" for name, value in panel.items()]
