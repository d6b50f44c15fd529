"""Tries Fontana in this Houdini: 24 frames of a small box of water, about a minute. Its report helps a bug report.

    hython fontana_selftest.py [REPORT]                             from a shell, in this file's folder
    import fontana_selftest; fontana_selftest.run("report.txt")     in Houdini's Python shell

The scene that is open is not changed: the test works in objects of its own and deletes them.
"""

from __future__ import annotations

import array
import math
import platform
import sys
import time
import traceback

import fontana_networks
import hou

FRAMES = range(fontana_networks.START_FRAME, fontana_networks.START_FRAME + 24)
SPACING = 0.03  # m: some thousand particles
FLOATS = {"P": 3, "v": 3, "density": 1, "pressure": 1, "pscale": 1, "age": 1}


class Failed(Exception):  # noqa: N818 - a finding, not an error of this program
    """What a check found, in a sentence."""


def require(holds: bool, sentence: str) -> None:
    if not holds:
        raise Failed(sentence)


def floats(geometry: hou.Geometry, name: str) -> array.array:
    return array.array("f", geometry.pointFloatAttribValuesAsString(name))


class SelfTest:
    """The network, and the checks in their order: each method's first line says what it checks."""

    def __init__(self) -> None:
        self.solver = fontana_networks.box()
        self.solver.parm("fluid_particle_spacing").set(SPACING)
        self.solver.inputs()[0].parm("particle_spacing").set(SPACING)
        self.played: dict[int, bytes] = {}
        self.seconds: list[float] = []

    def geometry(self, frame: int) -> hou.Geometry:
        geometry = self.solver.geometryAtFrame(frame)
        require(not self.solver.errors(), f"frame {frame}: {'; '.join(self.solver.errors())}")
        require(geometry is not None, f"frame {frame}: no geometry")
        return geometry

    def position(self, frame: int) -> bytes:
        return self.geometry(frame).pointFloatAttribValuesAsString("P")

    def check_playing(self) -> None:
        """24 frames cook, and each is another one"""
        for frame in FRAMES:
            begin = time.perf_counter()
            self.played[frame] = self.position(frame)
            self.seconds.append(time.perf_counter() - begin)
        require(len(self.played[FRAMES[0]]) > 12000, "too few particles came in")
        require(len(set(map(len, self.played.values()))) == 1, "the number of particles changes")
        require(len(set(self.played.values())) == len(self.played), "two frames are the same")

    def check_attributes(self) -> None:
        """attributes have their sizes, and no value is infinite or no number"""
        geometry = self.geometry(FRAMES[-1])
        count = geometry.intrinsicValue("pointcount")
        for name, size in FLOATS.items():
            attribute = geometry.findPointAttrib(name)
            require(attribute is not None, f"there is no point attribute {name}")
            require(attribute.size() == size, f"{name} has {attribute.size()} components, not {size}")
            values = floats(geometry, name)
            require(len(values) == count * size, f"{name} has {len(values)} values for {count} points")
            require(all(map(math.isfinite, values)), f"{name} has a value that is no number")

    def check_ids(self) -> None:
        """ids are 0, 1, 2, ... in order of the points"""
        geometry = self.geometry(FRAMES[-1])
        ids = array.array("i", geometry.pointIntAttribValuesAsString("id"))
        require(list(ids) == list(range(len(ids))), f"ids begin {list(ids[:5])}")

    def check_radius(self) -> None:
        """pscale is the radius, half the particle spacing"""
        radius = set(floats(self.geometry(FRAMES[0]), "pscale"))
        require(all(abs(value - SPACING / 2) < 1e-6 for value in radius), f"pscale is {sorted(radius)[:3]}")

    def check_physics(self) -> None:
        """the water falls and stays in its box"""
        first, last = (array.array("f", self.played[frame]) for frame in (FRAMES[0], FRAMES[-1]))
        fall = (sum(first[1::3]) - sum(last[1::3])) / (len(first) / 3)
        require(fall > 0.1, f"it fell {fall:.3f} m on average in 23 frames")
        require(min(last[1::3]) > -SPACING, f"a particle is at y = {min(last[1::3]):.3f}, below the floor")
        require(max(map(abs, last[0::3])) < 0.5 + SPACING, "a particle is outside the walls")

    def check_scrubbing(self) -> None:
        """going back and jumping ahead gives the same bytes as playing"""
        for frame in (FRAMES[11], FRAMES[19], FRAMES[3], FRAMES[-1], FRAMES[0]):
            require(self.position(frame) == self.played[frame], f"frame {frame} differs from when it was played")

    def check_editing(self) -> None:
        """an edited parameter changes the frames, and undoing it brings them back"""
        frame = FRAMES[11]
        gravity = self.solver.parmTuple("forces_gravity")
        before = gravity.eval()
        gravity.set((0.0, -3.0, 0.0))
        edited = self.position(frame)
        gravity.set(before)
        require(edited != self.played[frame], "gravity has no effect")
        require(self.position(frame) == self.played[frame], f"frame {frame} differs after the edit was undone")

    def check_surface(self) -> None:
        """Particle Fluid Surface makes a surface of the particles"""
        surface = self.solver.outputs()[0]
        geometry = surface.geometryAtFrame(FRAMES[11])
        require(not surface.errors(), "; ".join(surface.errors()))
        require(geometry is not None and geometry.intrinsicValue("primitivecount") > 0, "there is no surface")


def run(report_path: str = "fontana_selftest.txt") -> bool:
    """Runs all checks, prints the report and writes it to a file. Returns whether all hold."""
    lines = _heading()
    before = {node.path() for root in ("/obj", "/mat") for node in hou.node(root).children()}
    try:
        with hou.undos.disabler():
            failures = _run_checks(lines)
    finally:
        for root in ("/obj", "/mat"):
            for node in hou.node(root).children():
                if node.path() not in before:
                    node.destroy()
    lines.append("all checks hold" if not failures else f"{failures} checks FAILED")
    text = "\n".join(lines) + "\n"
    print(text)
    with open(report_path, "w", encoding="utf-8") as file:
        file.write(text)
    return failures == 0


def _heading() -> list[str]:
    return [
        "Fontana self-test",
        f"Houdini {hou.applicationVersionString()}, {hou.applicationPlatformInfo()}",
        f"Python {platform.python_version()}, {platform.platform()}",
    ]


def _run_checks(lines: list[str]) -> int:
    """Appends a line for each check. Returns how many failed."""
    try:
        test = SelfTest()
    except hou.OperationFailed as error:
        lines.append(f"FAILED  the network is built: {error}")
        return 1
    failures = 0
    for name in [name for name in vars(SelfTest) if name.startswith("check_")]:
        check = getattr(test, name)
        try:
            check()
            lines.append(f"ok      {check.__doc__}")
        except Failed as finding:
            failures += 1
            lines.append(f"FAILED  {check.__doc__}: {finding}")
        except Exception:  # noqa: BLE001 - whatever it was belongs into the report
            failures += 1
            lines.append(f"FAILED  {check.__doc__}:\n{traceback.format_exc()}")
    if test.seconds:
        slowest, total = max(test.seconds), sum(test.seconds)
        lines.append(f"24 frames in {total:.2f} s, the slowest {slowest:.2f} s")
    lines += _solver_information(test.solver)
    return failures


def _solver_information(solver: hou.Node) -> list[str]:
    """What the node's info panel says: the device, the memory, the steps."""
    lines = []
    trees = [("", solver.infoTree())]
    while trees:
        name, tree = trees.pop()
        if "Fontana" in name:
            lines += [": ".join(row) for row in tree.rows()]
        trees += tree.branches().items()
    return lines


if __name__ == "__main__":
    sys.exit(0 if run(*sys.argv[1:2]) else 1)
