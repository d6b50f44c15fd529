"""Quantities with units."""

from __future__ import annotations

import pytest

from fontana.units import KINEMATIC_VISCOSITY, UnitError, parse_quantity


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("0.3 Pa.s", "Pa*s", 0.3),
        ("300 cP", "Pa*s", 0.3),
        ("300cP", "Pa*s", 0.3),
        ("1 N s / m2", "Pa*s", 1.0),
        ("5 mm", "m", 0.005),
        ("2 in", "m", 0.0508),
        ("-981 cm s^-2", "m/s**2", -9.81),
        ("1 g/cm**3", "kg/m**3", 1000.0),
        ("72.8 mN/m", "N/m", 0.0728),
        ("24 fps", "1/s", 24.0),
        ("25 %", "", 0.25),
        ("4e2", "m", 400.0),
        (" .5 µm ", "m", 5e-7),
    ],
)
def test_converts_to_si(text: str, unit: str, value: float) -> None:
    assert parse_quantity(text, unit) == (pytest.approx(value), unit)


@pytest.mark.parametrize("text", ["7e-3 m2/s", "7000 cSt", "70 St"])
def test_kinematic_viscosity_is_told_apart(text: str) -> None:
    assert parse_quantity(text, "Pa*s") == (pytest.approx(7e-3), KINEMATIC_VISCOSITY)


def test_kinematic_viscosity_is_for_viscosity_only() -> None:
    with pytest.raises(UnitError, match="not a unit of this value"):
        parse_quantity("7e-3 m2/s", "m")


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("5 kg", '"kg" is not a unit of this value: expected a number in m'),
        ("five mm", "expected a number in m"),
        ("nan mm", "expected a number in m"),
        ("inf", "expected a number in m"),
        ("1e999 m", "too large"),
        ("1e300 Ym", "too large"),
        ("20 degC", "not a unit of this value"),
        ("", "expected a number in m"),
    ],
)
def test_refuses_with_a_sentence(text: str, complaint: str) -> None:
    with pytest.raises(UnitError) as error:
        parse_quantity(text, "m")
    assert complaint in str(error.value)


@pytest.mark.parametrize("unit", ["furlogs", "m**9**9**9", "m m m m m m m m m", "__import__('os')", "m)", "m //s"])
def test_what_is_not_a_unit_is_not_evaluated(unit: str) -> None:
    """pint itself would compute 9**9**9 for ever."""
    with pytest.raises(UnitError) as error:
        parse_quantity(f"5 {unit}", "m")
    assert str(error.value).startswith(f'"{unit}" is not a unit: expected a number in m, or text with a unit such as')
