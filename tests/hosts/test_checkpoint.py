"""Checkpoints from Python: a run goes on from them bit for bit, whatever stopped it."""

import gzip
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import checkpointed_run
import numpy as np
import pytest
from checkpointed_run import (
    TAG,
    build_large_scene,
    build_scene,
    checkpoint_path,
    frame_path,
    load_newest,
    previous_path,
)

from fontana import _core

METHODS = ("mueller", "wcsph", "pcisph", "dfsph")
KILL_COUNT = 30
FRAME_COUNT = 12


@pytest.fixture(
    params=[("cpu", 1), ("cpu", 2), ("cuda", 0), ("opencl", 0)], ids=lambda device: f"{device[0]}-{device[1]}"
)
def device(request, use_backend):
    """Backend and threads."""
    use_backend(request.param[0])
    return request.param


def state(simulation) -> dict[str, bytes]:
    attributes = {name: simulation.read(name).tobytes() for name, _, _ in simulation.attributes()}
    return attributes | {"frame": simulation.frame}


def step(simulation, frame_count: int) -> None:
    for _ in range(frame_count):
        simulation.step_frame()


def stop_after(substep_count: int):
    """A progress callback."""
    left = iter(range(substep_count - 1, -1, -1))
    return lambda fraction: next(left) == 0


def set_forces(simulation) -> None:
    force = np.zeros((simulation.particle_count, 3), dtype=np.float32)
    force[:, 0] = 1e-3 * np.arange(simulation.particle_count)
    simulation.set_force(force)


@pytest.mark.parametrize("method", METHODS)
def test_a_run_resumes_between_frames(device, method, tmp_path):
    path = str(tmp_path / "state.checkpoint")
    original = build_scene(*device, method)
    step(original, 3)
    set_forces(original)
    original.save_checkpoint(path)
    resumed = build_scene(*device, method)
    resumed.load_checkpoint(path)
    assert state(resumed) == state(original)
    particle_count = original.particle_count
    for _ in range(3):
        expected, found = original.step_frame(), resumed.step_frame()
        assert (found.substeps, found.dt_min, found.dt_max) == (expected.substeps, expected.dt_min, expected.dt_max)
        assert (found.dt_limit, found.density_error_max) == (expected.dt_limit, expected.density_error_max)
        assert state(resumed) == state(original)
    assert original.particle_count > particle_count, "the jet goes on"


@pytest.mark.parametrize("method", METHODS)
def test_a_run_resumes_in_the_middle_of_a_frame(device, method, tmp_path):
    path = str(tmp_path / "state.checkpoint")
    timing = {"time__cfl_factor": 0.1}  # several substeps in a frame, by every method
    original, untouched = build_scene(*device, method, **timing), build_scene(*device, method, **timing)
    step(original, 2)
    with pytest.raises(_core.Interrupted):
        original.step_frame(stop_after(3))
    original.save_checkpoint(path)
    resumed = build_scene(*device, method, **timing)
    resumed.load_checkpoint(path)
    assert _core.checkpoint_info(path)[0] == resumed.frame == 2
    assert state(resumed) == state(original)

    step(untouched, 2)
    reports = [simulation.step_frame() for simulation in (untouched, original, resumed)]
    assert len({(r.frame, r.substeps, r.dt_min, r.dt_max, r.density_error_mean, r.iterations) for r in reports}) == 1
    assert reports[0].substeps > 3
    assert state(untouched) == state(original) == state(resumed)


@pytest.mark.parametrize("is_blown_up", [False, True])
@pytest.mark.parametrize("method", METHODS)
def test_what_went_on_leaves_no_trace_in_who_goes_back(device, method, is_blown_up, tmp_path):
    """Back to fewer particles: the arrays still hold the others, whose numbers may be none any more."""
    path = str(tmp_path / "state.checkpoint")
    returned, untouched = build_scene(*device, method), build_scene(*device, method)
    step(untouched, 1)
    step(returned, 1)
    returned.save_checkpoint(path)
    step(returned, 2)
    returned.set_force(np.full((returned.particle_count, 3), 3e38 if is_blown_up else 50.0, dtype=np.float32))
    if is_blown_up:
        with pytest.raises(_core.Unstable):
            returned.step_frame()
    else:
        returned.step_frame()
    assert returned.particle_count > 2 * untouched.particle_count
    returned.load_checkpoint(path)
    for _ in range(2):
        expected, found = untouched.step_frame(), returned.step_frame()
        assert (found.substeps, found.dt_min, found.dt_max) == (expected.substeps, expected.dt_min, expected.dt_max)
        assert state(returned) == state(untouched)


def test_strict_runs_resume_on_another_device(device, tmp_path):
    path = str(tmp_path / "state.checkpoint")
    original = build_scene("cpu", 1, solver__precision="strict")
    step(original, 3)
    original.save_checkpoint(path)
    resumed = build_scene(*device, solver__precision="strict")
    resumed.load_checkpoint(path)
    step(original, 2)
    step(resumed, 2)
    assert state(resumed) == state(original)


def test_a_checkpoint_tells_what_it_is(tmp_path):
    path = str(tmp_path / "state.checkpoint")
    simulation = build_scene()
    step(simulation, 2)
    for tag in (TAG, "", "x" * 100000):
        simulation.save_checkpoint(path, tag)
        assert _core.checkpoint_info(path) == (2, simulation.particle_count, tag)


def test_the_previous_checkpoint_is_kept(tmp_path):
    simulation = build_scene()
    for _ in range(3):
        simulation.step_frame()
        simulation.save_checkpoint(str(checkpoint_path(tmp_path)), TAG)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.checkpoint", "run.checkpoint.previous"]
    assert _core.checkpoint_info(str(checkpoint_path(tmp_path)))[0] == 3
    assert _core.checkpoint_info(str(previous_path(tmp_path)))[0] == 2
    resumed = build_scene()
    resumed.load_checkpoint(str(previous_path(tmp_path)))
    resumed.step_frame()
    assert state(resumed) == state(simulation)


def test_a_damaged_checkpoint_changes_nothing(tmp_path):
    simulation = build_scene()
    step(simulation, 2)
    simulation.save_checkpoint(str(checkpoint_path(tmp_path)))
    content = bytearray(checkpoint_path(tmp_path).read_bytes())
    content[len(content) // 2] ^= 1
    checkpoint_path(tmp_path).write_bytes(content)
    before = state(simulation)
    with pytest.raises(_core.BadInput, match="damaged"):
        simulation.load_checkpoint(str(checkpoint_path(tmp_path)))
    assert state(simulation) == before
    simulation.step_frame()


# ---- kill -9 -------------------------------------------------------------------------------------------------------


def start_run(folder: Path) -> subprocess.Popen:
    """Returns once the run has begun to work."""
    command = [sys.executable, checkpointed_run.__file__, str(folder), str(FRAME_COUNT)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "ready\n"
    return process


def finish(process: subprocess.Popen) -> int:
    process.stdout.close()
    return process.wait()


def wait_for_files(process: subprocess.Popen, folder: Path, change_count: int) -> None:
    """Until files have come, gone or changed their names so many times: the next write is under way."""
    seen = folder.stat().st_mtime_ns
    while change_count > 0 and process.poll() is None:
        now = folder.stat().st_mtime_ns
        change_count -= now != seen
        seen = now


def published_frames(folder: Path) -> dict[str, bytes]:
    """Files with a final name; what a killed process left unfinished has another."""
    return {path.name: path.read_bytes() for path in folder.glob("*.bgeo")}


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """Folder of a run that nothing stopped, and the seconds it worked."""
    folder = tmp_path_factory.mktemp("undisturbed")
    process = start_run(folder)
    begin = time.monotonic()
    assert finish(process) == 0
    return folder, time.monotonic() - begin


def check_what_is_there(folder: Path, expected: dict[str, bytes]) -> None:
    frames = published_frames(folder)
    assert frames == {name: expected[name] for name in frames}, "a frame is torn, or another than it should be"
    simulation = build_large_scene()
    resumable = simulation.frame if load_newest(simulation, folder) else 0
    assert len(frames) - resumable in (0, 1), "a frame is written before its checkpoint, and none is missing"


def test_the_frames_are_read_by_others(undisturbed, tmp_path):
    """The bytes that killed runs are held against are good ones."""
    reader = pytest.importorskip("pysplashsurf").bgeo
    pytest.importorskip("meshio")
    folder, _ = undisturbed
    packed = tmp_path / "packed.bgeo"  # that reader takes compressed files only
    packed.write_bytes(gzip.compress(frame_path(folder, FRAME_COUNT).read_bytes()))
    simulation = build_large_scene()
    simulation.load_checkpoint(str(checkpoint_path(folder)))
    np.testing.assert_array_equal(reader.readbgeo_to_meshio(packed).points, simulation.read("position"))


@pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")
def test_a_run_killed_again_and_again_loses_nothing(undisturbed, tmp_path):
    reference, seconds = undisturbed
    expected = published_frames(reference)
    assert len(expected) == FRAME_COUNT
    instants = random.Random(9)
    folder, killed, rounds = tmp_path / "0", 0, 0
    folder.mkdir()
    while killed < KILL_COUNT:
        process = start_run(folder)
        if killed % 2:
            time.sleep(instants.uniform(0.0, 0.5 * seconds))
        else:
            wait_for_files(process, folder, instants.randint(1, 12))
            time.sleep(instants.uniform(0.0, 1e-3))
        process.kill()
        status = finish(process)
        assert status in (0, -signal.SIGKILL)
        killed += status != 0
        check_what_is_there(folder, expected)
        if status == 0:
            rounds += 1
            assert published_frames(folder) == expected
            folder = tmp_path / str(rounds)
            folder.mkdir()
    assert finish(start_run(folder)) == 0
    assert published_frames(folder) == expected
    original, resumed = build_large_scene(), build_large_scene()
    original.load_checkpoint(str(checkpoint_path(reference)))
    resumed.load_checkpoint(str(checkpoint_path(folder)))
    assert state(resumed) == state(original)
