"""Named fluids with measured values and their sources (data/fluids.json)."""

from __future__ import annotations

import functools
import json
import math
from dataclasses import dataclass
from pathlib import Path

FLUID_PATHS = ("fluid.rest_density", "fluid.viscosity", "fluid.surface_tension")  # what the name of a fluid stands for
STANDARD_GRAVITY = 9.81  # m/s^2, for the capillary length


@dataclass(frozen=True)
class Fluid:
    """One fluid. Ranges are (low, high) where sources or recipes differ, else None."""

    key: str
    name: str
    temperature: float  # degrees Celsius
    density: float  # kg/m^3
    viscosity: float  # Pa s, dynamic
    viscosity_range: tuple[float, float] | None
    surface_tension: float  # N/m
    surface_tension_range: tuple[float, float] | None
    newtonian: bool
    rheology: str  # how it departs from Newton's law; "" if it does not
    confidence: str  # "high", "medium-high", "medium", "low"
    unverified: tuple[str, ...]  # values that stand on general knowledge, not on the sources named
    note: str
    sources: tuple[str, ...]

    @property
    def kinematic_viscosity(self) -> float:
        """m^2/s."""
        return self.viscosity / self.density

    @property
    def capillary_length(self) -> float:
        """Metres: sqrt(sigma / (rho g)). Drops and ripples above this size are shaped by gravity, not by tension."""
        return math.sqrt(self.surface_tension / (self.density * STANDARD_GRAVITY))


@functools.cache
def fluids() -> dict[str, Fluid]:
    """Every named fluid by its key, such as "olive_oil"."""
    text = Path(__file__).with_name("data").joinpath("fluids.json").read_text(encoding="utf-8")
    return {key: _fluid(key, entry) for key, entry in json.loads(text)["fluids"].items()}


def _fluid(key: str, entry: dict) -> Fluid:
    return Fluid(
        key=key,
        name=entry["name"],
        temperature=entry["temperature_degC"],
        density=entry["density_kg_m3"],
        viscosity=entry["viscosity_Pa_s"],
        viscosity_range=_range(entry, "viscosity_range_Pa_s"),
        surface_tension=entry["surface_tension_N_m"],
        surface_tension_range=_range(entry, "surface_tension_range_N_m"),
        newtonian=entry["newtonian"],
        rheology=entry.get("rheology", ""),
        confidence=entry["confidence"],
        unverified=tuple(entry.get("unverified", ())),
        note=entry.get("note", ""),
        sources=tuple(entry["sources"]),
    )


def _range(entry: dict, name: str) -> tuple[float, float] | None:
    return tuple(entry[name]) if name in entry else None


def fluid_parameters(fluid: Fluid, particle_spacing: float) -> tuple[dict[str, float], list[str]]:
    """The parameters a fluid's name stands for, and what an artist should know about them.

    Surface tension is left out where the particles are coarser than the capillary length: it acts on drops smaller
    than that, which such particles cannot form, and it would cost substeps without being seen.
    """
    density, viscosity, surface_tension = FLUID_PATHS
    values = {density: fluid.density, viscosity: fluid.viscosity}
    notes = []
    if particle_spacing <= fluid.capillary_length:
        values[surface_tension] = fluid.surface_tension
    else:
        notes.append(
            f"surface tension of {fluid.key} ({fluid.surface_tension:g} N/m) is left out: it shapes drops below "
            f"{fluid.capillary_length * 1e3:.2g} mm, and the particles are {particle_spacing * 1e3:.3g} mm apart"
        )
    if not fluid.newtonian:
        notes.append(f"{fluid.key} is not Newtonian ({fluid.rheology}): one viscosity stands for it")
    if fluid.confidence == "low":
        notes.append(f"the values of {fluid.key} are rough; `fontana fluids {fluid.key}` says where they come from")
    return values, notes
