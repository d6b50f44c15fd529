"""What emitters make: how many, where, when, at which density."""

import numpy as np
import pytest

from fontana import _core

SPACING = 0.02


def test_a_block_is_filled_on_the_lattice_once(make_simulation):
    simulation = make_simulation(forces__gravity=(0, 0, 0))
    simulation.add_emitter("block", centre=(1.0, 2.0, 3.0), size=(0.2, 0.1, 0.06), first_frame=2)
    counts = [simulation.step_frame().particle_count for _ in range(3)]
    assert counts == [0, 150, 150]
    assert [simulation.emitted_by(frame) for frame in (0, 1, 2, 3)] == [0, 0, 150, 150]
    assert simulation.read("position").mean(axis=0) == pytest.approx([1.0, 2.0, 3.0], abs=1e-4)


def test_a_sphere_has_the_volume_of_a_sphere(make_simulation):
    simulation = make_simulation(forces__gravity=(0, 0, 0))
    simulation.add_emitter("sphere", radius=0.2)
    report = simulation.step_frame()
    assert report.particle_count == pytest.approx(4.0 / 3.0 * np.pi * 0.2**3 / SPACING**3, rel=0.03)


def test_a_jet_keeps_the_rest_density_and_its_frame_range(make_simulation):
    """Layers a spacing apart: the flow is area times speed, and the jet is neither thin nor packed."""
    simulation = make_simulation(forces__gravity=(0, 0, 0), fluid__viscosity=0.1)
    simulation.add_emitter("disc", radius=0.1, direction=(0, 2, 0), speed=1.5, first_frame=2, last_frame=6)
    counts = [simulation.step_frame().particle_count for _ in range(8)]
    assert counts[0] == 0 and counts[5] == counts[7]
    assert counts == [simulation.emitted_by(frame) for frame in range(1, 9)]
    seconds = 5 / 24.0
    assert counts[-1] == pytest.approx(np.pi * 0.1**2 * 1.5 * seconds / SPACING**3, rel=0.06)
    assert np.median(simulation.read("density")) == pytest.approx(1000.0, rel=0.05)
    speed = simulation.read("velocity")[:, 1]
    assert speed.mean() == pytest.approx(1.5, rel=0.05)


def test_a_rate_thins_the_jet(make_simulation):
    simulation = make_simulation(forces__gravity=(0, 0, 0))
    simulation.add_emitter("disc", radius=0.1, speed=2.0, rate=2400.0)
    for _ in range(24):
        report = simulation.step_frame()
    assert report.particle_count == pytest.approx(2400, rel=0.05)
    packed = make_simulation()
    packed.add_emitter("disc", radius=0.1, speed=2.0, rate=1e6)
    with pytest.raises(_core.BadInput, match="packs the jet; at this speed and spacing at most"):
        packed.check()


def test_jitter_is_the_same_every_time(make_simulation):
    runs = []
    for _ in range(2):
        simulation = make_simulation()
        simulation.add_emitter("block", size=(0.1, 0.1, 0.1), jitter=0.3)
        simulation.step_frame()
        runs.append(simulation.read("position").tobytes())
    assert runs[0] == runs[1]


def test_the_simulation_scale_scales_the_scene(make_simulation):
    """A scene in centimetres with scale 0.01 is the scene in metres."""
    runs = []
    for unit in (1.0, 0.01):
        simulation = make_simulation(time__simulation_scale=unit)
        simulation.add_emitter("block", centre=(0, 0.3 / unit, 0), size=np.full(3, 0.2) / unit)
        simulation.add_collider("sphere_inside", radius=0.35 / unit, centre=(0, 0.3 / unit, 0))
        for _ in range(4):
            report = simulation.step_frame()
        runs.append((simulation.read("position") * unit, simulation.read("velocity") * unit, report.max_speed * unit))
    assert np.abs(runs[0][0] - runs[1][0]).max() < 1e-3
    assert runs[0][2] == pytest.approx(runs[1][2], rel=1e-3)


@pytest.mark.parametrize(
    ("kind", "fields", "sentence"),
    [
        ("block", {"size": (0.1, -0.1, 0.1)}, "size must be above 0"),
        ("sphere", {"radius": 0.0}, "radius must be above 0"),
        ("disc", {"speed": 0.0}, "speed must be above 0"),
        ("disc", {"direction": (0, 0, 0)}, "direction must not be zero"),
        ("block", {"jitter": 0.9}, "jitter must be 0 to 0.5"),
        ("block", {"first_frame": 0}, "frames start at 1"),
        ("disc", {"first_frame": 9, "last_frame": 3}, "last frame must not come before"),
        ("cone", {}, "expected one of block, sphere, disc"),
    ],
)
def test_bad_emitters_are_refused(make_simulation, kind, fields, sentence):
    with pytest.raises(_core.BadInput, match=sentence):
        make_simulation().add_emitter(kind, **fields)


def test_a_slip_of_units_is_refused_and_not_allocated(make_simulation):
    simulation = make_simulation()
    simulation.add_emitter("block", size=(1e5, 1e5, 1e5))
    with pytest.raises(_core.BadInput, match="more than 2e9 particles"):
        simulation.step_frame()
