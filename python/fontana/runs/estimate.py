"""What a run will cost, before it starts: particles, memory, disk, substeps by limit, minutes on this device."""

from __future__ import annotations

import math
import time

import click

from fontana import _core
from fontana.formats import BYTES_PER_PARTICLE
from fontana.runs.folder import CHECKPOINT_BYTES_PER_PARTICLE
from fontana.runs.text import clock, data_size, describe_device, describe_fluid, length
from fontana.scene import Scene

CALIBRATION_SECONDS = 3.0
LIMITS = ("advection", "acceleration", "acoustic", "viscosity", "surface_tension")
_SUM_SAMPLES = 1000


def estimate(scene: Scene, formats: tuple[str, ...]) -> dict:
    """A plain object with the costs: SI units, bytes, seconds. Simulates a few seconds on a copy.

    Raises SceneError and BadInput as a run would, and Unstable if the first frames already are.
    """
    simulation = scene.build()
    simulation.check()
    frames = scene.frame_count
    particles = simulation.emitted_by(frames)
    particle_frames = _sum_over_frames(simulation, frames)
    limits = _substeps_by_limit(scene, simulation)
    calibration = _calibrate(scene)
    substeps = max(1.0, calibration["substeps_per_frame"], *limits.values())
    if simulation.get("time.substeps"):
        substeps = simulation.get("time.substeps")
    per_particle = sum(BYTES_PER_PARTICLE[format] for format in formats)
    return {
        "scene": scene.name,
        "frames": frames,
        "particles": particles,
        "spacing": simulation.get("fluid.particle_spacing"),
        "fluid": describe_fluid(simulation),
        "device": describe_device(simulation),
        "device_bytes": simulation.estimate_memory(particles),
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


def _calibrate(scene: Scene) -> dict:
    """Simulates the first frames of a copy for a few seconds; a frame that takes longer is cut between substeps."""
    simulation = scene.build()
    simulation.device()  # building its programs is not part of a substep
    begin = time.perf_counter()
    work = substeps = frames = 0

    def count(fraction: float) -> bool:
        nonlocal work, substeps
        substeps += 1
        work += simulation.particle_count
        return time.perf_counter() - begin > CALIBRATION_SECONDS

    progress = 0.0
    try:
        while frames < scene.frame_count and time.perf_counter() - begin < CALIBRATION_SECONDS:
            simulation.step_frame(count)
            frames += 1
    except _core.Interrupted:
        pass
    seconds = time.perf_counter() - begin
    progress = max(frames, 1)
    return {"frames": frames, "substeps_per_frame": substeps / progress, "rate": work / seconds, "seconds": seconds}


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
