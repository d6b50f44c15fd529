"""What the viewer shows, without a window: a simulation that runs in its thread, and a cache that is played."""

from __future__ import annotations

import time

import numpy as np
import pytest
from small_scenes import DROP

from fontana import _core
from fontana.scene import load_scene
from fontana.viewer.live import LiveSource
from fontana.viewer.orders import Push
from fontana.viewer.player import CachePlayer

PATIENCE = 60.0  # s


def wait_for(condition):
    """Until it holds; a thread is at work."""
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, "it took too long"
        time.sleep(0.002)


@pytest.fixture
def live():
    """Makes live sources of the drop with changes, and ends them."""
    made = []

    def make(is_playing=False, **overrides):
        changes = {name.replace("__", "."): value for name, value in overrides.items()}
        made.append(LiveSource(load_scene(DROP, {"solver.backend": "cpu"} | changes), is_playing))
        wait_for(lambda: made[-1].snapshot is not None or made[-1].failure)
        return made[-1]

    yield make
    for source in made:
        source.close()


def frames_on(source, count):
    number = source.snapshot.number + count
    source.step(count)
    wait_for(lambda: source.snapshot.number == number)


# ---- live


def test_it_plays_pauses_steps_and_restarts(live):
    source = live(is_playing=True)
    wait_for(lambda: source.snapshot.number >= 3)
    source.set_playing(False)
    time.sleep(0.1)
    number = source.snapshot.number
    time.sleep(0.1)
    assert source.snapshot.number == number
    frames_on(source, 2)
    assert source.snapshot.data.particle_count == 216
    source.restart()
    wait_for(lambda: source.snapshot.number == 0)
    assert source.snapshot.data.particle_count == 0


def test_phases_are_by_kernel_where_the_profile_is_on(live):
    source = live()
    frames_on(source, 1)
    assert set(source.snapshot.phases) == {"simulate", "read"}
    source.set("solver.profile", 1)
    frames_on(source, 5)
    kernels = {name: seconds for name, seconds in source.snapshot.phases.items() if name not in ("simulate", "read")}
    assert "pressure_gradient" in kernels
    assert 0 < sum(kernels.values()) <= source.snapshot.phases["simulate"], "they are this frame's, not those of all"


def test_frames_are_those_of_a_run(live):
    source = live()
    frames_on(source, 3)
    simulation = load_scene(DROP, {"solver.backend": "cpu"}).build()
    for _ in range(3):
        report = simulation.step_frame()
    for name in ("position", "velocity", "density", "pressure", "id"):
        assert np.array_equal(getattr(source.snapshot.data, name), simulation.read(name)), name
    assert source.snapshot.record["substeps"] == report.substeps
    assert source.snapshot.scheme == "cpu grid"
    assert np.allclose(source.snapshot.data.centres[1], simulation.collider_centre(1, report.time))


def test_a_changed_parameter_acts_from_the_next_frame_on(live):
    source = live()
    frames_on(source, 1)
    source.set("forces.gravity", (0.0, 100.0, 0.0))
    frames_on(source, 3)
    assert source.snapshot.data.velocity[:, 1].mean() > 1.0
    assert source.settings.is_changed("forces.gravity")


def test_a_refused_value_changes_nothing(live):
    source = live()
    with pytest.raises(_core.BadInput, match=r"fluid\.viscosity"):
        source.set("fluid.viscosity", -1.0)
    assert not source.settings.is_changed("fluid.viscosity")
    frames_on(source, 1)


def test_a_spacing_waits_for_the_restart(live):
    source = live()
    frames_on(source, 1)
    source.set("fluid.particle_spacing", 0.1)
    frames_on(source, 1)
    assert source.snapshot.data.particle_count == 216
    source.restart()
    wait_for(lambda: source.snapshot.number == 0)
    frames_on(source, 1)
    assert source.snapshot.data.particle_count == 27


def test_schemes_are_switched_while_it_runs(live, opencl_device):
    source = live(is_playing=True)
    for backend, neighbors in (("cpu", "all-pairs"), ("opencl", "grid"), ("opencl", "all-pairs"), ("cpu", "grid")):
        source.set("solver.backend", backend)
        source.set("solver.neighbors", neighbors)
        wait_for(lambda scheme=f"{backend} {neighbors}": source.snapshot.scheme == scheme)
    rates = source.rates.by_scheme
    assert sorted(rates) == ["cpu all-pairs", "cpu grid", "opencl all-pairs", "opencl grid"]
    assert all(rate.frames_per_second > 0 and rate.particle_count == 216 for rate in rates.values())
    assert source.failure is None


def test_a_switch_in_the_middle_of_a_frame_does_not_wait_for_its_end(live):
    """A frame of 2000 substeps: the switch comes between two of them, and the frame is finished by the new scheme."""
    source = live(is_playing=True, time__substeps=2000, time__timestep=0.02)
    wait_for(lambda: source.fraction)
    source.set("solver.neighbors", "all-pairs")
    wait_for(lambda: not source._orders.values)
    assert source.snapshot.number == 0
    wait_for(lambda: source.snapshot.number == 1)
    assert source.snapshot.scheme == "cpu all-pairs"


def test_closing_does_not_wait_for_the_frame(live):
    source = live(is_playing=True, time__substeps=100000, time__timestep=1.0)
    wait_for(lambda: source.fraction)
    source.close()
    assert source.snapshot.number == 0


def test_an_unstable_simulation_says_so_and_starts_again(live):
    """A ball that comes at 3000 km/s asks for more substeps than are allowed."""
    source = live(is_playing=True, time__max_substeps=60, fluid__method="mueller")
    source.set_collider(1, "friction", 0.3)
    source.set("forces.gravity", (0.0, -1e6, 0.0))
    wait_for(lambda: source.failure)
    assert "substeps" in source.failure.sentence
    assert source.failure.is_final
    source.set("forces.gravity", (0.0, -1.0, 0.0))
    assert source.failure
    source.restart()
    wait_for(lambda: source.failure is None and source.snapshot.number >= 2)


def test_parameters_that_cannot_be_integrated_are_mended_by_another_value(live):
    source = live()
    frames_on(source, 1)
    source.set("fluid.viscosity", 50000.0)
    assert source.settings.complaint()
    source.set_playing(True)
    wait_for(lambda: source.failure)
    assert not source.failure.is_final
    source.set("fluid.viscosity", 1.0)
    wait_for(lambda: source.failure is None and source.snapshot.number >= 2)
    assert source.settings.complaint() == ""


def test_a_missing_device_is_mended_by_another(live):
    source = live()
    frames_on(source, 1)
    source.set("solver.device", 63)
    source.set("solver.backend", "opencl")
    source.step()
    wait_for(lambda: source.failure)
    assert not source.failure.is_final
    source.set("solver.backend", "cpu")
    wait_for(lambda: source.snapshot.number == 2)
    assert source.failure is None


def test_a_push_moves_the_fluid_and_ends(live):
    source = live(forces__gravity=[0, 0, 0])
    frames_on(source, 1)
    middle = source.snapshot.data.position.mean(axis=0)
    source.push(Push((50.0, 0.0, 0.0), tuple(middle.tolist()), 0.3))
    frames_on(source, 2)
    pushed = source.snapshot.data.velocity.mean(axis=0)
    assert pushed[0] > 0.5
    assert abs(pushed[1]) < 0.1 * pushed[0]
    source.push(None)
    frames_on(source, 1)
    assert source.snapshot.data.velocity.mean(axis=0)[0] == pytest.approx(pushed[0], rel=0.1)
    assert not source.settings.changes()


def test_a_push_is_in_the_unit_of_the_scene(live):
    """Centimetres: the hand is where the particles are seen."""
    source = live(forces__gravity=[0, 0, 0], time__simulation_scale=0.1)
    frames_on(source, 1)
    middle = source.snapshot.data.position.mean(axis=0)
    source.push(Push((50.0, 0.0, 0.0), tuple(middle.tolist()), 0.3))
    frames_on(source, 1)
    assert source.snapshot.data.velocity.mean(axis=0)[0] > 0.5


def test_a_moved_collider_is_seen_at_once(live):
    source = live()
    frames_on(source, 1)
    source.set_collider(0, "centre", (0.0, -0.5, 0.0))
    wait_for(lambda: source.snapshot.data.centres[0][1] == -0.5)
    assert source.snapshot.number == 1
    source.restart()
    wait_for(lambda: source.snapshot.number == 0)
    assert source.snapshot.data.centres[0][1] == -0.5


def test_the_pace_is_kept(live):
    """Ten frames at forty a second take a quarter of a second at the least."""
    source = live()
    source.frames_per_second = 40.0
    start = time.monotonic()
    source.set_playing(True)
    wait_for(lambda: source.snapshot.number >= 11)
    assert time.monotonic() - start >= 0.25


# ---- a cache


def shown(player, number):
    """The snapshot of a frame, once it is read."""
    wait_for(lambda: (snapshot := player.snapshot) is not None and snapshot.number == number)
    return player.snapshot


def test_a_cache_shows_the_frames_of_the_run(drop_cache, play):
    player = play(drop_cache)
    simulation = load_scene(DROP, {"solver.backend": "cpu"}).build()
    for number in range(1, 7):
        simulation.step_frame()
        player.seek(number)
        snapshot = shown(player, number)
        assert np.array_equal(snapshot.data.position, simulation.read("position"))
        assert snapshot.record["substeps"] > 0


def test_a_cache_plays_at_its_pace_and_begins_anew(drop_cache, play):
    player = play(drop_cache)
    player.set_playing(True)
    clock, seen = time.monotonic(), []
    for _ in range(8):
        seen.append(shown(player, player.number).number)
        clock += 1.001 / player.frames_per_second
        player.tick(clock)
    assert seen == [1, 2, 3, 4, 5, 6, 1, 2]
    player.loops = False
    player.seek(6)
    shown(player, 6)
    player.tick(clock + 1.0)
    assert (player.number, player.is_playing) == (6, False)


def test_a_cache_goes_on_and_back(drop_cache, play):
    player = play(drop_cache)
    player.step(3)
    shown(player, 4)
    player.step(-2)
    shown(player, 2)
    player.step(-9)
    shown(player, 1)


@pytest.mark.parametrize("harm", ["missing", "damaged", "cut"])
def test_frames_that_cannot_be_read_are_skipped_and_named(drop_cache, play, harm):
    path = drop_cache / "drop.0003.bgeo"
    if harm == "missing":
        path.unlink()
    else:
        data = bytearray(path.read_bytes())
        data[200] ^= 1
        path.write_bytes(data[:-50] if harm == "cut" else data)
    player = play(drop_cache)
    player.seek(3)
    shown(player, 4)
    assert list(player.skipped) == [3]
    assert "frame 3 is skipped" in player.skipped[3]
    assert "drop.0003.bgeo" in player.skipped[3]


def test_a_cache_of_which_nothing_can_be_read(drop_cache, play):
    for path in drop_cache.glob("*.bgeo"):
        path.unlink()
    player = play(drop_cache)
    wait_for(lambda: len(player.skipped) == 6)
    player.tick(time.monotonic() + 1.0)
    assert player.snapshot is None


def test_a_folder_that_is_no_run_is_refused(tmp_path):
    with pytest.raises(_core.BadInput, match="not the folder of a run"):
        CachePlayer(tmp_path)
