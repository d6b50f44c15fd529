"""What a run will cost, before it starts: particles, memory, disk, substeps by limit, minutes on this device."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import click

from fontana import _core
from fontana.formats import BYTES_PER_PARTICLE
from fontana.runs.folder import CHECKPOINT_BYTES_PER_PARTICLE
from fontana.runs.text import clock, data_size, describe_device, describe_fluid, length
from fontana.scene import Scene

CALIBRATION_SECONDS = 3.0
LIMITS = ("advection", "acceleration", "acoustic", "viscosity", "surface_tension", "convergence")
CALIBRATION_PARTICLES = 300_000
# The share of a device's memory that particles may take: sorting, emission and files need some for a while, and the
# system of a CPU the rest.
USABLE_MEMORY = {"gpu": 0.9, "cpu": 0.6}
_SUM_SAMPLES = 50


def check_memory(simulation: _core.Simulation, particle_count: int) -> int:
    """The bytes that so many particles take on the device. Raises OutOfMemory if they will not fit."""
    device = simulation.device()
    needed = simulation.estimate_memory(particle_count)
    usable = device.memory_bytes * USABLE_MEMORY["gpu" if device.is_gpu else "cpu"]
    if 0 < usable < needed:
        raise _core.OutOfMemory(
            f"{particle_count:,} particles take {data_size(needed)}, and {device.name} has {data_size(usable)} for "
            "them; use a larger fluid.particle_spacing"
        )
    return needed


def estimate(scene: Scene, formats: tuple[str, ...]) -> dict:
    """A plain object with the costs: SI units, bytes, seconds. Simulates a few seconds on a copy.

    Raises SceneError and BadInput as a run would, OutOfMemory if it cannot fit, Unstable if it already is.
    """
    simulation = scene.build()
    simulation.check()
    frames = scene.frame_count
    particles = simulation.emitted_by(frames)
    memory = check_memory(simulation, particles)
    particle_frames = _sum_over_frames(simulation, frames)
    limits = _substeps_by_limit(scene, simulation)
    calibration = _calibrate(scene, particles)
    fixed = simulation.get("time.substeps")
    substeps = fixed or max(1.0, calibration["substeps_per_frame"] or 0.0, *limits.values())
    per_particle = sum(BYTES_PER_PARTICLE[format] for format in formats)
    return {
        "scene": scene.name,
        "frames": frames,
        "particles": particles,
        "spacing": simulation.get("fluid.particle_spacing"),
        "fluid": describe_fluid(simulation),
        "device": describe_device(simulation),
        "device_bytes": memory,
        "disk_bytes": particle_frames * per_particle + 2 * particles * CHECKPOINT_BYTES_PER_PARTICLE,
        "substeps_by_limit": limits,
        "substeps_per_frame": substeps,
        "particle_substeps_per_second": calibration["rate"],
        "calibration": calibration,
        "seconds": particle_frames * substeps / calibration["rate"],
        "notes": scene.notes,
    }


def _sum_over_frames(simulation: _core.Simulation, frames: int) -> int:
    """The sum of the particle count over all frames; long runs are sampled evenly."""
    step = max(1, frames // _SUM_SAMPLES)
    return sum(simulation.emitted_by(frame) * min(step, frames - frame + 1) for frame in range(1, frames + 1, step))


def _substeps_by_limit(scene: Scene, simulation: _core.Simulation) -> dict[str, float]:
    """Substeps that a frame needs by each limit, at the speed the fluid will reach by falling and by its jets."""
    gravity = math.hypot(*simulation.get("forces.gravity"))
    speed = math.hypot(_source_speed(scene), math.sqrt(2 * gravity * _drop_height(scene)))
    limits = simulation.estimate_limits(speed, gravity)
    duration = simulation.derived().frame_duration
    steps = {name: getattr(limits, name) for name in LIMITS}
    return {name: duration / step for name, step in steps.items() if math.isfinite(step)}


def _source_speed(scene: Scene) -> float:
    speeds = [math.hypot(*emitter.get("velocity", (0.0,))) for emitter in scene.emitters]
    return max([*speeds, *(emitter.get("speed", 0.0) for emitter in scene.emitters)], default=0.0)


def _drop_height(scene: Scene) -> float:
    """From the top of the highest source to the lowest floor; the height of the sources themselves without one."""
    tops = [_centre(emitter)[1] + _half_height(emitter) for emitter in scene.emitters]
    floors = [_centre(collider)[1] for collider in scene.colliders if collider["type"] == "plane_y"]
    bottoms = [_centre(emitter)[1] - _half_height(emitter) for emitter in scene.emitters]
    return max(0.0, max(tops, default=0.0) - min(floors or bottoms or [0.0]))


def _centre(shape: dict) -> list[float]:
    return shape.get("centre", [0.0, 0.0, 0.0])


def _half_height(emitter: dict) -> float:
    return 0.5 * emitter["size"][1] if "size" in emitter else emitter["radius"]


def _calibrate(scene: Scene, particle_count: int) -> dict:
    """Simulates the first frames of a copy for a few seconds; a frame that takes longer is cut between substeps.

    A large scene is measured with coarser particles: the time of a particle-substep hardly depends on their number, but
    the substeps do, so substeps_per_frame is None then.
    """
    is_coarse = particle_count > CALIBRATION_PARTICLES
    simulation = _coarser(scene, particle_count).build() if is_coarse else scene.build()
    simulation.device()  # building its programs is not part of a substep
    begin = time.perf_counter()
    work = substeps = 0
    finished = 0.0  # frames, and the share done of the present one

    def count(fraction: float) -> bool:
        nonlocal work, substeps, finished
        substeps += 1
        work += simulation.particle_count
        finished = simulation.frame + fraction
        return time.perf_counter() - begin > CALIBRATION_SECONDS

    try:
        while simulation.frame < scene.frame_count and time.perf_counter() - begin < CALIBRATION_SECONDS:
            simulation.step_frame(count)
    except _core.Interrupted:
        pass
    seconds = time.perf_counter() - begin
    per_frame = None if is_coarse else substeps / max(finished, 1e-9)
    return {"substeps_per_frame": per_frame, "rate": max(work, 1) / seconds, "seconds": seconds}


def _coarser(scene: Scene, particle_count: int) -> Scene:
    """The same scene with about CALIBRATION_PARTICLES particles."""
    spacing = scene.build().get("fluid.particle_spacing") * (particle_count / CALIBRATION_PARTICLES) ** (1 / 3)
    return replace(scene, parameters=scene.parameters | {"fluid.particle_spacing": spacing})


def print_estimate(result: dict) -> None:
    """The estimate as lines for people."""
    click.echo(
        f"{result['scene']}: {result['frames']} frames, {result['particles']:,} particles at the last, "
        f"{length(result['spacing'])} apart"
    )
    click.echo(f"  fluid     {result['fluid']}")
    click.echo(f"  device    {result['device']}")
    click.echo(f"  memory    {data_size(result['device_bytes'])}")
    click.echo(f"  disk      {data_size(result['disk_bytes'])}")
    click.echo(f"  substeps  {result['substeps_per_frame']:.0f} a frame; by limit: {_limits_text(result)}")
    click.echo(
        f"  time      {clock(result['seconds'])} at {result['particle_substeps_per_second'] / 1e6:.2f} M "
        f"particle-substeps/s (measured for {result['calibration']['seconds']:.1f} s)"
    )
    for note in result["notes"]:
        click.echo(f"  note      {note}")


def _limits_text(result: dict) -> str:
    limits = sorted(result["substeps_by_limit"].items(), key=lambda item: -item[1])
    return ", ".join(f"{name.replace('_', ' ')} {count:.1f}" for name, count in limits)
