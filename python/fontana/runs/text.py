"""Lines for people: one place for how a fluid, a device, a frame and a duration read."""

from __future__ import annotations

from fontana import _core
from fontana.units import show


def clock(seconds: float) -> str:
    """A duration: "8.2 s", "3:07", "2:05:00"."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{seconds:02d}" if hours else f"{minutes}:{seconds:02d}"


def length(metres: float) -> str:
    """A length in the unit people would use: "20 mm", "1.5 m"."""
    return show(metres * 1e3, "mm") if metres < 1 else show(metres, "m")


def data_size(count: float) -> str:
    """Bytes: "48 MB"."""
    for unit in ("B", "kB", "MB", "GB"):
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.3g} TB"


def describe_fluid(simulation: _core.Simulation) -> str:
    """The method, density, both viscosities and, where there is one, the speed of sound, with units."""
    derived = simulation.derived()
    parts = [
        simulation.get("fluid.method"),
        show(simulation.get("fluid.rest_density"), "kg/m**3"),
        f"viscosity {show(simulation.get('fluid.viscosity'), 'Pa*s')}"
        f" (kinematic {show(derived.kinematic_viscosity, 'm**2/s')})",
    ]
    if simulation.get("fluid.surface_tension"):
        parts.append(f"surface tension {show(simulation.get('fluid.surface_tension'), 'N/m')}")
    if derived.speed_of_sound:
        parts.append(f"speed of sound {show(derived.speed_of_sound, 'm/s')}")
    return ", ".join(parts)


def describe_device(simulation: _core.Simulation) -> str:
    """ "cpu (AMD EPYC, 8 threads)"; starts the device if none runs."""
    device = simulation.device()
    threads = simulation.get("solver.threads") or device.compute_units
    units = f"{threads} thread{'s' * (threads != 1)}" if device.backend == "cpu" else f"{device.compute_units} units"
    return f"{device.backend} ({device.name}, {units})"


def frame_details(record: dict) -> str:
    """What was done in a frame, what held the step, and how good it is."""
    # Methods with a solve know their error to a hundredth of a percent; the others are off by percents.
    solve, digits = "", 1
    if record["iterations"]:
        solve, digits = f" in {record['iterations'] / record['substeps']:.1f} iterations", 3
    if record["unconverged"]:
        solve += f", {record['unconverged']} NOT CONVERGED"
    return (
        f"{record['particles']:,} particles  {record['substeps']} substeps  "
        f"dt {record['dt_min'] * 1e3:.3g} ms ({record['limit']})  "
        f"density +{record['density_error_mean']:.{digits}%} (max {record['density_error_max']:.1%}){solve}"
    )


def pace_text(rate: float, remaining: float) -> str:
    """How fast it goes (particle-substeps a second) and how long the rest takes (s)."""
    return f"{rate / 1e6:.2f} M/s  ETA {clock(remaining)}"
