"""`fontana run` and `fontana resume`."""

from __future__ import annotations

import json
import shlex
import sys
from pathlib import Path

import click

from fontana.cli.usage import Choice
from fontana.formats import FORMATS
from fontana.overrides import parse_assignments
from fontana.roofline import gpus
from fontana.runs.estimate import estimate, print_estimate
from fontana.runs.manifest import Manifest
from fontana.runs.reporters import make_reporter
from fontana.runs.runner import DEFAULT_CHECKPOINT_EVERY, RunOptions, run_scene
from fontana.scene import Scene, load_scene, resolve
from fontana.tables import parameters

_OUTPUT_OPTIONS = (
    click.option("--json", "as_json", is_flag=True, help="One JSON object a line instead of text."),
    click.option("--quiet", is_flag=True, help="Say nothing but errors."),
)
_WHERE_OPTIONS = (
    click.option("--backend", type=Choice(parameters()["solver.backend"].choices), help="Where to compute."),
    click.option("--threads", type=click.IntRange(0), help="Threads of the cpu backend; 0: all cores."),
    click.option("--frames", type=click.IntRange(1), help="Frames to have in the end. [default: the scene's]"),
)


def _with(options):
    def decorate(function):
        for option in reversed(options):
            function = option(function)
        return function

    return decorate


def _kept_settings(assignments: tuple[str, ...]) -> list[str]:
    """The settings of this command that belong in the next one, which has a particle spacing of its own."""
    kept = [text for text in assignments if not text.startswith("fluid.particle_spacing")]
    return [word for text in kept for word in ("--set", text)]


@click.command(short_help="Simulate a scene into a folder.")
@click.argument("scene")
@_with(_WHERE_OPTIONS)
@click.option("--neighbors", type=Choice(parameters()["solver.neighbors"].choices), help="How neighbours are found.")
@click.option("--out", type=click.Path(path_type=Path), help="Folder of the frames. [default: out/NAME]")
@click.option(
    "--set", "assignments", multiple=True, metavar="PATH=VALUE", help="Change a value of the scene; repeatable."
)
@click.option(
    "--format", "formats", multiple=True, type=Choice(FORMATS), help="Of the frames; repeatable. [default: bgeo]"
)
@click.option(
    "--checkpoint-every",
    type=click.IntRange(1),
    default=DEFAULT_CHECKPOINT_EVERY,
    show_default=True,
    metavar="N",
    help="Frames between checkpoints: the most that a crash can cost.",
)
@click.option("--dry-run", is_flag=True, help="Say what the run will cost, and simulate nothing but a calibration.")
@click.option("--profile", is_flag=True, help="Time every launch by name, and show what limits it.")
@click.option(
    "--roofline",
    type=Choice(list(gpus()), case_sensitive=False),
    help="Estimate beside the profile the least time of each launch on this GPU.",
)
@click.option("--restart", is_flag=True, help="Replace what is in the folder instead of continuing.")
@click.option("--accept-changed", is_flag=True, help="Continue although the scene is not the one of the frames so far.")
@click.option("--picture/--no-picture", default=True, help="Draw a contact sheet at the end.")
@_with(_OUTPUT_OPTIONS)
def run(
    scene: str,
    backend: str | None,
    threads: int | None,
    frames: int | None,
    neighbors: str | None,
    out: Path | None,
    assignments: tuple[str, ...],
    formats: tuple[str, ...],
    checkpoint_every: int,
    dry_run: bool,
    profile: bool,
    roofline: str | None,
    restart: bool,
    accept_changed: bool,
    picture: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Simulate SCENE, a file or the name of a bundled scene, and write a file a frame.

    The same command again continues where it stopped. Values carry units, or are SI.

    \b
    Examples:
      fontana run fountain --frames 240 --out out/fountain
      fontana run box --set fluid=honey --set fluid.particle_spacing=15mm
      fontana run box --backend opencl --format bgeo --format ply
      fontana run box --set forces.gravity=0,-1.62,0 --out out/moon
      fontana run fountain_rock --dry-run
      fontana run box --profile --roofline H100
    """
    overrides = parse_assignments(assignments)
    overrides |= _settings(backend, threads, frames)
    if neighbors:
        overrides["solver.neighbors"] = neighbors
    if profile or roofline:
        overrides["solver.profile"] = True
    loaded = load_scene(scene, overrides)
    options = RunOptions(
        out=out or Path("out") / loaded.name,
        formats=tuple(dict.fromkeys(formats)) or ("bgeo",),
        checkpoint_every=checkpoint_every,
        restart=restart,
        accept_changed=accept_changed,
        picture=picture,
        gpu=gpus()[roofline] if roofline else None,
        variation=["fontana", "run", scene, *_kept_settings(assignments)],
        command=["fontana", *sys.argv[1:]],
    )
    if dry_run:
        _show_estimate(loaded, options, as_json)
    else:
        _execute(loaded, options, as_json, quiet)


@click.command(short_help="Continue a run after Ctrl-C, a crash, or for more.")
@click.argument("folder", type=click.Path(path_type=Path))
@_with(_WHERE_OPTIONS)
@_with(_OUTPUT_OPTIONS)
def resume(
    folder: Path, backend: str | None, threads: int | None, frames: int | None, as_json: bool, quiet: bool
) -> None:
    """Continue the run in FOLDER after Ctrl-C, a crash, or for more frames.

    \b
    Examples:
      fontana resume out/fountain
      fontana resume out/fountain --frames 480
      fontana resume out/fountain --backend opencl
    """
    data = Manifest.of_run(folder).data
    scene = resolve(data["scene"], data["scene"]["name"], _settings(backend, threads, frames))
    options = RunOptions(
        out=folder,
        formats=tuple(data["formats"]),
        checkpoint_every=data["checkpoint_every"],
        picture=data.get("picture", True),
        command=["fontana", *sys.argv[1:]],
    )
    _execute(scene, options, as_json, quiet)


def _settings(backend: str | None, threads: int | None, frames: int | None) -> dict[str, object]:
    """Options that are values of the scene too."""
    values = {"solver.backend": backend, "solver.threads": threads, "output.frames": frames}
    return {path: value for path, value in values.items() if value is not None}


def _execute(scene: Scene, options: RunOptions, as_json: bool, quiet: bool) -> None:
    reporter = make_reporter(as_json, quiet)
    try:
        run_scene(scene, options, reporter)
    finally:
        reporter.close()


def _show_estimate(scene: Scene, options: RunOptions, as_json: bool) -> None:
    result = estimate(scene, options.formats)
    if as_json:
        click.echo(json.dumps({"event": "estimate"} | result))
    else:
        print_estimate(result)
        click.echo(f"run it: {shlex.join([word for word in options.command if word != '--dry-run'])}")
