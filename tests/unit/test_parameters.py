"""The table of parameters: defaults, ranges, names and the thesis's preset."""

import math

import pytest

from fontana import _core


def test_every_default_is_accepted_and_read_back():
    simulation = _core.Simulation()
    for parameter in _core.parameters():
        simulation.set(parameter.name, parameter.default)
        assert simulation.get(parameter.name) == parameter.default
        assert parameter.doc.endswith(".") and parameter.label and parameter.group in parameter.name


@pytest.mark.parametrize(
    ("name", "value", "sentence"),
    [
        ("fluid.viscocity", 1.0, "did you mean 'fluid.viscosity'"),
        ("fluid.viscosity", -1.0, "out of range; expected 0 to 100000 Pa"),
        ("fluid.viscosity", math.nan, "finite"),
        ("fluid.viscosity", "thick", "expected a number"),
        ("forces.gravity", 9.81, "three numbers"),
        ("time.substeps", 2.5, "whole number"),
        ("solver.backend", "metal", "expected one of auto|cpu|cuda|opencl"),
        ("solver.neighbors", 3, "expected one of grid|tiles|all-pairs"),
        ("fluid.viscosity", (1.0, 2.0, 3.0), "expected one number"),
    ],
)
def test_bad_values_are_refused_in_one_sentence(name, value, sentence):
    with pytest.raises(_core.BadInput, match=sentence.replace("|", r"\|")) as error:
        _core.Simulation().set(name, value)
    assert "\n" not in str(error.value)


def test_thesis_preset_has_the_defaults_of_its_node():
    simulation = _core.Simulation()
    simulation.apply_preset("thesis")
    expected = {
        "fluid.method": "mueller",
        "fluid.rest_density": 1000,
        "fluid.pressure_constant": 10,
        "fluid.viscosity": 0.15,
        "fluid.surface_tension": 0,
        "fluid.particle_mass": 0.00020543,
        "fluid.support_radius": 0.006,
        "time.simulation_scale": 1,
        "time.timestep": 0.002,
        "time.substeps": 10,
        "forces.drag": 0.999,
        "forces.gravity": (0, -93, 0),
    }
    assert {name: simulation.get(name) for name in expected} == expected


def test_thesis_preset_is_a_gas():
    """One particle alone already reads more than the rest density: 315 m / (64 pi H^3) = 1490."""
    simulation = _core.Simulation()
    simulation.apply_preset("thesis")
    assert simulation.derived().self_density == pytest.approx(1490, abs=1)


def test_derived_mass_fills_a_lattice_at_rest_density(make_simulation):
    """The mean of eq. 2.8 in the middle of a lattice at the spacing is the rest density."""
    simulation = make_simulation(fluid__rest_density=850.0, forces__gravity=(0, 0, 0), time__timestep=1e-6)
    simulation.add_emitter("block", size=(0.2, 0.2, 0.2))
    simulation.step_frame()
    assert simulation.read("density").max() == pytest.approx(850.0, rel=1e-3)
