"""The Python API over numpy arrays."""

from __future__ import annotations

import numpy as np
import pytest

import fontana


def test_frames_have_every_attribute_in_order_of_id(drop: dict) -> None:
    simulation = fontana.Simulation(drop, backend="cpu")
    frames = list(simulation.frames(2))
    frame = frames[-1]
    count = frame.particle_count
    assert count == simulation.particle_count == 216
    for name in ("position", "velocity", "acceleration", "force"):
        assert getattr(frame, name).shape == (count, 3)
        assert getattr(frame, name).dtype == np.float32
    for name in ("density", "pressure", "mass"):
        assert getattr(frame, name).shape == (count,)
    assert frame.id.dtype == np.int32
    assert np.array_equal(frame.id, np.arange(count))
    assert frame.time == pytest.approx(2 / 24)
    assert frame.position.mean(axis=0)[1] < 0.3


def test_a_frame_keeps_what_was_read_and_refuses_what_was_not(drop: dict) -> None:
    simulation = fontana.Simulation(drop)
    frame = simulation.step()
    before = frame.position.copy()
    simulation.step()
    assert np.array_equal(frame.position, before)
    with pytest.raises(fontana.StaleFrameError, match="frame 1 was not asked for its velocity"):
        _ = frame.velocity


def test_particles_are_added_at_any_time(drop: dict) -> None:
    simulation = fontana.Simulation(drop)
    simulation.step()
    simulation.add_particles([[0, 2, 0], [0.2, 2, 0]], velocity=[[0, 1, 0], [0, 1, 0]], mass=[0.1, 0.2])
    frame = simulation.step()
    assert frame.particle_count == 218
    assert frame.mass[-2:] == pytest.approx([0.1, 0.2])
    assert frame.position[-1, 1] == pytest.approx(2 + 1 / 24, abs=0.02)


@pytest.mark.parametrize(
    ("position", "velocity", "mass", "complaint"),
    [
        ([[0, 0]], None, None, "position: expected shape (N, 3), got (1, 2)"),
        ([0, 0, 0], None, None, "position: expected shape (N, 3), got (3,)"),
        ("abc", None, None, "position: expected numbers of shape (N, 3)"),
        ([[0, 0, 0]], [[0, 0, 0]] * 2, None, "velocity: expected shape (1, 3), got (2, 3)"),
        ([[0, 0, 0]], None, [1, 1], "mass: expected shape (1,), got (2,)"),
        ([[0, 0, np.nan]], None, None, ""),
        ([[0, 0, 0]], None, [-1], ""),
    ],
)
def test_bad_particles_are_refused(position, velocity, mass, complaint: str) -> None:
    simulation = fontana.Simulation()
    with pytest.raises(fontana.BadInput) as error:
        simulation.add_particles(position, velocity, mass)
    assert complaint in str(error.value)
    assert simulation.particle_count == 0


def test_a_force_acts_until_it_is_cleared() -> None:
    simulation = fontana.Simulation({"forces": {"gravity": [0, 0, 0]}})
    simulation.add_particles([[0, 0, 0], [5, 0, 0]], mass=[1, 2])
    simulation.set_force([[1, 0, 0], [0, 0, 0]])
    frame = simulation.step()
    assert frame.velocity[0, 0] == pytest.approx(1 / 24, rel=1e-4)
    assert not frame.velocity[1].any()
    simulation.set_force(None)
    assert simulation.step().velocity[0, 0] == pytest.approx(1 / 24, rel=1e-4)
    with pytest.raises(fontana.BadInput, match="force: expected shape"):
        simulation.set_force([[1, 0, 0]])


def test_parameters_by_path_or_last_part_with_units() -> None:
    simulation = fontana.Simulation(viscosity="300 cP", **{"fluid.rest_density": "1 g/cm3"})
    assert simulation.get("fluid.viscosity") == pytest.approx(0.3)
    assert simulation.get("rest_density") == pytest.approx(1000)
    simulation.set("viscosity", "1e-3 m2/s")
    assert simulation.get("viscosity") == pytest.approx(1.0)
    simulation.set("forces.gravity", [0, "-1 m/s2", 0])
    assert simulation.get("gravity") == pytest.approx((0, -1, 0))
    with pytest.raises(fontana.BadInput, match=r"did you mean fluid\.viscosity\?"):
        simulation.set("viscocity", 1)
    with pytest.raises(fontana.BadInput):
        simulation.set("fluid.viscosity", -1)


def test_the_scheme_switches_in_mid_run(drop: dict) -> None:
    plain = fontana.Simulation(drop, **{"solver.neighbors": "all-pairs"})
    switched = fontana.Simulation(drop, **{"solver.neighbors": "all-pairs"})
    for frame in range(3):
        expected = plain.step().position
        if frame == 1:
            switched.set("solver.neighbors", "grid")
            switched.set("solver.threads", 1)
        got = switched.step().position
    assert np.abs(got - expected).max() < 1e-4


def test_every_backend_here_runs_and_agrees(drop: dict) -> None:
    names = sorted({device.backend for device in fontana.devices() if device.available})
    assert "cpu" in names
    results = []
    for name in names:
        simulation = fontana.Simulation(drop, backend=name)
        assert simulation.device.backend == name == simulation.backend
        results.append(simulation.step().position)
    for result in results[1:]:
        assert np.abs(result - results[0]).max() < 1e-4


def test_a_stopped_frame_goes_on(drop: dict) -> None:
    whole, parted = fontana.Simulation(drop), fontana.Simulation(drop)
    with pytest.raises(fontana.Interrupted):
        parted.step(progress=lambda fraction: fraction > 0.3)
    assert parted.frame == 0
    assert np.array_equal(parted.step().position, whole.step().position)


def test_a_progress_function_need_not_answer(drop: dict) -> None:
    shares = []
    fontana.Simulation(drop).step(progress=shares.append)
    assert shares[-1] == pytest.approx(1.0)


def test_frames_without_a_count_are_those_of_the_scene(drop: dict) -> None:
    simulation = fontana.Simulation(drop)
    simulation.step()
    assert sum(1 for _ in simulation.frames()) == 5


def test_a_count_of_frames_below_nothing_is_refused(drop: dict) -> None:
    with pytest.raises(fontana.BadInput, match="expected a count of 0 or more, got -1"):
        list(fontana.Simulation(drop).frames(-1))


@pytest.mark.parametrize(
    ("field", "expected"),
    [
        ({"flip": "yes"}, "flip: expected true or false"),
        ({"enabled": None}, "enabled: expected true or false"),
        ({"radius": "wide"}, "radius: expected a number"),
        ({"centre": 3}, "centre: expected three numbers"),
    ],
)
def test_fields_of_the_wrong_type_are_refused(field: dict, expected: str) -> None:
    with pytest.raises(fontana.BadInput, match=expected):
        fontana.Simulation().core.add_collider("plane_y", **field)


def test_a_frame_number_that_is_not_whole_is_refused() -> None:
    with pytest.raises(fontana.BadInput, match="first_frame: expected a whole number"):
        fontana.Simulation().core.add_emitter("sphere", radius=1.0, first_frame=2.5)


def test_errors_of_the_progress_function_come_through(drop: dict) -> None:
    def fail(fraction: float) -> bool:
        raise ZeroDivisionError("on purpose")

    with pytest.raises(ZeroDivisionError, match="on purpose"):
        fontana.Simulation(drop).step(fail)
