"""`fontana run --profile`: its figures follow from the launches of a real run and from the costs a kernel states."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from fontana import _core, launch_profile
from fontana.launch_profile import profile_notes, profile_of
from fontana.roofline import gpus

KERNELS = Path(__file__).parents[2] / "src" / "fontana" / "kernels"
LATER_BLOCK = {"type": "block", "centre": [0, 0.8, 0], "size": [0.2, 0.2, 0.2], "first_frame": 4}


def stated_costs() -> dict[str, tuple[int, int]]:
    rows = re.findall(r"^KERNEL_ENTRY\((\w+), (\d+), (\d+)\)", (KERNELS / "kernel_list.def").read_text(), re.MULTILINE)
    return {name: (int(moved), int(flops)) for name, moved, flops in rows}


@pytest.fixture
def profiled(fontana, drop: dict, tmp_path: Path):
    """Runs a scene whose particles become more in frame 4, and returns the events by name."""

    def call(*options: object) -> dict[str, list[dict]]:
        drop["fluid"]["method"] = "mueller"  # each of its kernels runs once a substep over all particles
        drop["emitters"].append(LATER_BLOCK)
        (tmp_path / "scene.json").write_text(json.dumps(drop))
        lines = fontana("run", "scene.json", "--json", "--no-picture", *options).stdout.splitlines()
        events: dict[str, list[dict]] = {}
        for event in map(json.loads, lines):
            events.setdefault(event["event"], []).append(event)
        return events

    return call


def test_figures_follow_from_launches_and_stated_costs(backend, profiled, tmp_path: Path) -> None:
    events = profiled("--profile", "--roofline", "h100", "--backend", backend)
    profile = events["profile"][0]
    in_file = json.loads((tmp_path / "out" / "drop" / "run.json").read_text())["profile"]
    assert in_file == {key: value for key, value in profile.items() if key != "event"}
    rows = {row["name"]: row for row in profile["rows"]}
    assert {"density", "fluid_force", "integrate", "reduce_step"} <= rows.keys()
    assert sum(row["share"] for row in rows.values()) == pytest.approx(1.0, abs=1e-3)

    frames = events["frame"]
    assert frames[0]["particles"] < frames[-1]["particles"]
    visits = sum(frame["particles"] * frame["substeps"] for frame in frames)
    for name in ("density", "fluid_force", "integrate", "reduce_step"):  # the last with fewer threads than particles
        assert rows[name]["elements"] == visits, name
        assert rows[name]["launches"] == sum(frame["substeps"] for frame in frames)
    assert "gigaflops" not in rows["sort" if backend == "cpu" else "sort: scatter"]

    costs = stated_costs()
    for row in rows.values():
        if "gigaflops" not in row:
            continue
        moved, flops = costs[row["name"]]
        assert (row["bytes_per_particle"], row["flops_per_particle"]) == (moved, flops)
        per_second = row["elements"] / (1e-3 * row["milliseconds"])
        assert row["gigabytes_per_second"] == pytest.approx(1e-9 * moved * per_second, rel=1e-3)
        assert row["gigaflops"] == pytest.approx(1e-9 * flops * per_second, rel=1e-3)
        share = row["gigabytes_per_second"] / profile["copy_gigabytes_per_second"]
        assert row["share_of_copy"] == pytest.approx(share, rel=1e-3)
        least = max(moved / 3.35e12, flops / 67e12) * row["elements"]
        assert row["roofline_milliseconds"] == pytest.approx(1e3 * least, rel=1e-3)
    assert profile["copy_gigabytes_per_second"] > 0.01
    assert profile["roofline"]["estimate"] is True
    assert 1 < profile["mean_neighbors"] < 60


def test_people_get_a_table_and_what_it_assumes(fontana, drop_file: Path) -> None:
    mueller = ("--set", "fluid.method=mueller")
    shown = fontana("run", drop_file, "--no-picture", "--roofline", "MI300X", *mueller).stdout
    assert re.search(r"^ *launch .*bytes/particle .*GB/s .*GFLOP/s .*of copy .*estimate, ms *$", shown, re.MULTILINE)
    assert re.search(r"^ *fluid_force +\d+ .*%", shown, re.MULTILINE)
    assert "counted for 30 neighbours out of 216 candidates" in shown
    assert re.search(r"estimate: the least time on AMD Instinct MI300X .*\(https://\S+.*; not measured", shown)
    assert "profile" not in fontana("run", drop_file, "--json", "--no-picture", "--restart", *mueller).stdout


def test_all_pairs_states_no_cost(backend, profiled) -> None:
    profile = profiled("--profile", "--backend", backend, "--neighbors", "all-pairs")["profile"][0]
    assert not any("gigaflops" in row for row in profile["rows"])
    assert "bytes and flops are stated for the grid only" in profile_notes(profile)


def test_what_was_before_is_taken_off(backend) -> None:
    simulation = _core.Simulation()
    simulation.set("solver.backend", backend)
    simulation.set("fluid.method", "mueller")
    simulation.set("solver.profile", True)
    simulation.set("time.substeps", 3)
    simulation.set("time.timestep", 3e-4)
    simulation.add_particles(np.eye(5, 3, dtype=np.float32))
    simulation.step_frame()
    before = simulation.profile()
    simulation.step_frame()
    density = next(row for row in profile_of(simulation, before)["rows"] if row["name"] == "density")
    assert (density["launches"], density["elements"]) == (3, 15)


def test_a_device_without_room_has_no_copy_bandwidth(monkeypatch) -> None:
    monkeypatch.setattr(_core.Simulation, "measure_copy", _no_memory)
    profile = profile_of(_core.Simulation())
    assert profile["copy_gigabytes_per_second"] is None
    assert "copying found no memory to measure in" in profile_notes(profile)


def _no_memory(simulation: object, size: int) -> float:
    raise _core.OutOfMemory("out of memory")


def test_an_unknown_gpu_is_refused(fontana, drop_file: Path) -> None:
    assert '"Voodoo2" is not one of H100, A100' in fontana("run", drop_file, "--roofline", "Voodoo2", code=2).stderr


def test_the_peaks_of_gpus_have_a_source() -> None:
    assert len(gpus()) >= 6
    for gpu in gpus().values():
        assert gpu.source.startswith("https://")
        assert 1e12 < gpu.flops < 1e15
        assert 1e11 < gpu.bandwidth < 1e13


def test_the_stated_costs_are_for_what_is_said() -> None:
    said = re.search(r"with (\d+) neighbours out of (\d+)\s", (KERNELS / "kernel_list.def").read_text())
    assert said.groups() == (str(launch_profile.COUNTED_NEIGHBORS), str(launch_profile.COUNTED_CANDIDATES))


def test_every_kernel_says_first_how_much_it_goes_through() -> None:
    """Profiles take the number of particles from there."""
    text = "".join(file.read_text() for file in KERNELS.glob("*.h"))
    first = dict(re.findall(r"^KERNEL void (\w+)\(THREAD_ARG const (\w+ \w+)", text, re.MULTILINE))
    costs = stated_costs()
    assert first.keys() == costs.keys()
    for name, argument in first.items():
        assert argument in ("StepConstants c", "uint count") or costs[name] == (0, 0), name
