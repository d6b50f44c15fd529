"""Quantities with units: "0.3 Pa.s", "300 cP", "5 mm", "7e-3 m2/s".

pint knows the units. A unit's text is checked against a small grammar first, because pint evaluates what it is given:
an exponent such as 9**9**9 would keep it busy for ever.
"""

from __future__ import annotations

import functools
import math
import re

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(.*?)\s*", re.DOTALL)
_FACTOR = re.compile(r"\s*(?P<join>[*·./ ]?)\s*(?P<name>%|1|[A-Za-zµμ°]{1,24})(?:(?:\^|\*\*)?(?P<power>[+-]?\d))?")
_MAXIMUM_FACTORS = 8

KINEMATIC_VISCOSITY = "m**2/s"


class UnitError(ValueError):
    """A quantity that cannot be read; the message says what was expected, without the place."""


@functools.cache
def _registry():
    import pint  # slow to import, and many scenes hold plain numbers only

    registry = pint.UnitRegistry(on_redefinition="ignore")
    registry.define("frame_per_second = 1 / second = fps")  # pint's own fps is a foot per second
    return registry


@functools.lru_cache(maxsize=256)
def _parse_unit(text: str):
    """A pint unit from "Pa.s", "kg/m3", "m s^-2"."""
    spelled, position = "dimensionless", 0
    for _ in range(_MAXIMUM_FACTORS):
        factor = _FACTOR.match(text, position)
        if not factor:
            break
        position = factor.end()
        name = {"%": "percent", "1": "dimensionless"}.get(factor["name"], factor["name"])
        spelled += f"{'/' if factor['join'] == '/' else '*'}{name}**{factor['power'] or 1}"
    if position < len(text):
        raise UnitError(f'"{text}" is not a unit')
    try:
        return _registry().parse_units(spelled)
    except Exception as error:  # pint raises many kinds, tokenizer errors among them
        raise UnitError(f'"{text}" is not a unit') from error


def readable(unit: str) -> str:
    """A unit as people write it: "kg/m**3" becomes "kg/m^3", "Pa*s" becomes "Pa.s"."""
    return unit.replace("**", "^").replace("*", ".")


def parse_quantity(text: str, unit: str) -> tuple[float, str]:
    """Reads a number with or without a unit.

    Returns the value and the unit it is in: `unit` (SI; "" is a plain number), or KINEMATIC_VISCOSITY where a dynamic
    viscosity (Pa*s) was given as a kinematic one. A text without a unit is in SI. Raises UnitError.
    """
    match = _QUANTITY.fullmatch(text) if len(text) <= 200 else None
    if not match:
        raise UnitError(f"expected {expectation(unit)}")
    value = float(match[1])
    if not math.isfinite(value):
        raise UnitError("the number is too large")
    if not match[2]:
        return value, unit
    try:
        given = _parse_unit(match[2])
    except UnitError as error:
        raise UnitError(f"{error}: expected {expectation(unit)}") from error
    for target in (unit, KINEMATIC_VISCOSITY) if unit == "Pa*s" else (unit,):
        if _registry().get_dimensionality(given) == _registry().parse_units(target).dimensionality:
            return _convert(value, given, target), target
    raise UnitError(f'"{match[2]}" is not a unit of this value: expected {expectation(unit)}')


def has_unit(text: str) -> bool:
    """Whether a quantity names its unit."""
    match = _QUANTITY.fullmatch(text)
    return bool(match and match[2])


def _convert(value: float, given, target: str) -> float:
    try:
        converted = float(_registry().Quantity(value, given).to(target or "dimensionless").magnitude)
    except Exception as error:  # offset units such as degC in a product
        raise UnitError(f'"{given:~}" cannot be converted to {readable(target) or "a plain number"}') from error
    if not math.isfinite(converted):
        raise UnitError("the number is too large")
    return converted


def expectation(unit: str) -> str:
    """What a value in `unit` may look like, for the end of a sentence."""
    if not unit:
        return "a plain number"
    examples = {"m": "5 mm", "Pa*s": "300 cP", "kg": "0.2 g", "s": "20 ms", "1/s": "24 fps", "m/s": "3 m/s"}
    example = examples.get(unit, f"1 {readable(unit)}")
    return f'a number in {readable(unit)}, or text with a unit such as "{example}"'


def show(value: float, unit: str = "") -> str:
    """A value with its unit, short: 6 significant digits are more than an artist sets."""
    return f"{value:.6g} {readable(unit)}".strip()
