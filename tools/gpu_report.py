"""Checks and measures an installed Fontana on the GPUs of this machine, and writes a report to commit.

    tools/gpu_check                                   builds first, then runs this
    python tools/gpu_report.py --counts 10000,100000

Devices, agreement with the CPU, tests, speed beside the CPU's, a profile and what compilers say. Each part is on disk
as soon as it is done; one that fails does not stop the others.
"""

from __future__ import annotations

import datetime
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import click
import compile_table
from compile_tables.source import CompilerError
from gpu_report_text import report_text

from fontana import FontanaError, _core, bench
from fontana.cli.verify import compare_all
from fontana.launch_profile import profile_of

ROOT = Path(__file__).resolve().parents[1]
METHODS = ("mueller", "dfsph")
PROFILED_SUBSTEPS = 20
SHOWN_TEST_LINES = 15
_FASTEST, _GRAVITY = 3.0, 9.81  # m/s and m/s^2, for the time step


@dataclass(frozen=True)
class Device:
    """A device by its backend and its number there."""

    backend: str
    number: int
    name: str

    @property
    def label(self) -> str:
        return f"{self.backend} {self.number}: {self.name}"


@click.command(help=__doc__.split("\n\n")[0])
@click.option("--allow-cpu", is_flag=True, help="Take an OpenCL driver on the CPU for the GPU where there is none.")
@click.option("--counts", default="10000,100000,1000000", callback=bench.count_list, help="Particles to measure with.")
@click.option("--profile-count", default=100_000, show_default=True, help="Particles of the profile.")
@click.option("--budget", default=4.0, show_default=True, help="Seconds for each number.")
@click.option("--tests", default="tests/backends", show_default=True, help='Folder of the tests to run; "" for none.')
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), help="[default: one in benchmarks/results]")
def command(
    allow_cpu: bool, counts: list[int], profile_count: int, budget: float, tests: str, out: Path | None
) -> None:
    devices = find_devices(allow_cpu)
    folder = out or ROOT / "benchmarks" / "results" / folder_name(devices[0].name)
    report = {
        "benchmark": "gpu_check",
        **bench.describe_conditions(["tools/gpu_check", *sys.argv[1:]]),
        "checked": [device.label for device in devices],
        "parts": {},
    }
    parts: dict[str, Callable[[], dict]] = {
        "agreement": agreement,
        "tests": lambda: run_tests(tests),
        "speed": lambda: {"rows": [speed(method, n, devices, budget) for method in METHODS for n in counts]},
        "profiles": lambda: {"rows": [profile(method, d, profile_count) for method in METHODS for d in devices]},
        "compilers": compile_table.compile_all,
    }
    for name, part in parts.items():
        click.echo(f"{name} ...", err=True)
        report["parts"][name] = guarded(part)
        publish(folder, report)
    bench.note_end(report)
    publish(folder, report)
    click.echo((folder / "report.md").read_text())
    click.echo(f"written: {folder / 'report.md'}, {folder / 'report.json'}")
    failed = [name for name, part in report["parts"].items() if part["state"] == "failed"]
    if failed:
        raise click.ClickException(f"failed: {', '.join(failed)}; the report says why")


def find_devices(allow_cpu: bool) -> list[Device]:
    """The GPUs; with allow_cpu, where there is none, what other backends offer. Raises DeviceUnavailable."""
    found, reasons, numbers = [], [], {}
    for device in _core.devices():
        number = numbers[device.backend] = numbers.get(device.backend, -1) + 1
        if device.backend == "cpu":
            continue
        if device.available:
            found.append((Device(device.backend, number, device.name), device.is_gpu))
        else:
            reasons.append(f"{device.backend}: {device.reason}")
    gpus = [device for device, is_gpu in found if is_gpu]
    if gpus:
        return gpus
    others = [device for device, _ in found]
    if allow_cpu and others:
        return others
    reasons += [f"{device.label} is no GPU" for device in others]
    hint = "; --allow-cpu goes on with the CPU's" if others else ""
    raise _core.DeviceUnavailable(f"no GPU is present here ({'; '.join(reasons)}){hint}")


def folder_name(device_name: str) -> str:
    words = re.sub(r"[^a-z0-9]+", "-", device_name.lower()).strip("-")[:40].strip("-")
    return f"gpu-{words}-{datetime.date.today().isoformat()}"


def guarded(part: Callable[[], dict]) -> dict:
    """What the part found, with its state; of one that raised, why."""
    try:
        return {"state": "done"} | part()
    except (FontanaError, CompilerError, OSError, MemoryError) as error:
        return {"state": "failed", "reason": str(error) or type(error).__name__}


def publish(folder: Path, report: dict) -> None:
    bench.publish_json(folder / "report.json", report)
    _core.publish_file(str(folder / "report.md"), report_text(report).encode())


def agreement() -> dict:
    """All devices, schemes and methods against the plain CPU reference."""
    rows, missing = compare_all()
    found = {"rows": rows, "missing": missing}
    if all(row["passed"] for row in rows):
        return found
    return found | {"state": "failed", "reason": "some differ from the reference by more than allowed"}


def run_tests(folder: str) -> dict:
    if not folder:
        return {"state": "left out"}
    done = subprocess.run([sys.executable, "-m", "pytest", "-q", folder], cwd=ROOT, capture_output=True, text=True)
    found = {"folder": folder, "end": (done.stdout + done.stderr).strip().splitlines()[-SHOWN_TEST_LINES:]}
    return found if done.returncode == 0 else found | {"state": "failed", "reason": f"exit code {done.returncode}"}


def speed(method: str, particle_count: int, devices: list[Device], budget: float) -> dict:
    """Million particle-substeps a second of the CPU and of each device, or the sentence why not; and the ratios."""
    row: dict = {"method": method, "particles": particle_count}
    row["cpu"] = clocked(method, particle_count, Device("cpu", 0, "cpu"), budget)
    for device in devices:
        row[device.label] = clocked(method, particle_count, device, budget)
        if "median" in row["cpu"] and "median" in row[device.label]:
            ratio = row[device.label]["median"] / row["cpu"]["median"]
            row[f"ratio, {device.label}"] = bench.significant(ratio)
    return row


def clocked(method: str, particle_count: int, device: Device, budget: float) -> dict:
    try:
        simulation, dt = build(method, particle_count, device)
        clock = bench.clock_substeps(simulation, dt, "grid", budget)
    except FontanaError as error:
        return {"failed": str(error)}
    click.echo(f"  {method}, {particle_count:,} particles, {device.label}", err=True)
    return clock.rates(particle_count)["million_particle_substeps_per_second"]


def profile(method: str, device: Device, particle_count: int) -> dict:
    simulation, dt = build(method, particle_count, device, profile=True)
    simulation.set("time.substeps", PROFILED_SUBSTEPS)
    simulation.set("time.timestep", PROFILED_SUBSTEPS * dt)
    simulation.step_frame()
    before = simulation.profile()
    simulation.step_frame()
    facts = {"method": method, "device": device.label, "particles": particle_count, "substeps": PROFILED_SUBSTEPS}
    return facts | profile_of(simulation, before)


def build(method: str, particle_count: int, device: Device, profile: bool = False) -> tuple[_core.Simulation, float]:
    """The box of `fontana bench thesis` by a method on a device, and the longest step that its limits allow, s."""
    simulation, _ = bench.bench_scene("box", particle_count).build(device.backend, profile=profile)
    simulation.set("solver.device", device.number)
    simulation.set("fluid.method", method)
    limits = simulation.estimate_limits(_FASTEST, _GRAVITY)
    names = ("advection", "acceleration", "acoustic", "viscosity", "surface_tension", "convergence")
    return simulation, min(getattr(limits, name) for name in names)


if __name__ == "__main__":
    try:
        command()
    except FontanaError as error:
        sys.exit(f"gpu_check: {error}")
