"""`fontana mesh` and `fontana export`: files for other programs, out of the cache of a run."""

from __future__ import annotations

import os
from contextlib import AbstractContextManager
from pathlib import Path

import click

from fontana.cli.usage import FloatRange
from fontana.export import alembic, usd, vdb
from fontana.export.sequence import SequenceOptions, make_sequence
from fontana.export.surfaces import SUFFIXES as MESH_SUFFIXES
from fontana.export.surfaces import SurfaceMaker
from fontana.export.target import Target, parse_target
from fontana.export.whole import FrameWriter, write_whole
from fontana.runs.cache import Cache
from fontana.runs.frame_numbers import FRAMES_HELP
from fontana.runs.progress import make_progress
from fontana.surface import SurfaceSettings, check_installed

_MOST_JOBS = 8  # by default: each needs memory for a frame of its own

_folder = click.argument("folder", type=click.Path(path_type=Path))
_frames = click.option("--frames", metavar="RANGE", help=FRAMES_HELP)
_restart = click.option("--restart", is_flag=True, help="Replace what is there instead of continuing.")
_jobs = click.option(
    "--jobs",
    type=click.IntRange(1),
    default=lambda: min(_MOST_JOBS, os.cpu_count() or 1),
    metavar="N",
    help=f"Frames made at once. [default: processors, at most {_MOST_JOBS}]",
)
_json = click.option("--json", "as_json", is_flag=True, help="One JSON object a line instead of text.")
_quiet = click.option("--quiet", is_flag=True, help="Say nothing but errors.")
_SURFACE = SurfaceSettings()


def _surface_options(function):
    for option in reversed(
        (
            click.option(
                "--cell-size",
                type=FloatRange(0.1, 4.0),
                default=_SURFACE.cell_size,
                show_default=True,
                metavar="RADII",
                help="Of the grid behind the surface, in particle radii: smaller is finer and slower.",
            ),
            click.option(
                "--smoothing",
                type=click.IntRange(0, 200),
                default=_SURFACE.smoothing,
                show_default=True,
                metavar="N",
                help="Passes of smoothing; 0 leaves the bumps of the particles.",
            ),
            click.option(
                "--threshold",
                type=FloatRange(0.05, 1.5),
                default=_SURFACE.threshold,
                show_default=True,
                help="Share of the rest density at which the surface lies: smaller is fatter.",
            ),
        )
    ):
        function = option(function)
    return function


@click.command(short_help="Make the surface of the fluid of a run.")
@_folder
@_frames
@click.option(
    "-o", "--out", metavar="NAME", help="Ends in .bgeo, .ply, .obj or .usdc. [default: FOLDER/surface/NAME.bgeo]"
)
@_surface_options
@_jobs
@_restart
@_json
@_quiet
def mesh(
    folder: Path,
    frames: str | None,
    out: str | None,
    cell_size: float,
    smoothing: int,
    threshold: float,
    jobs: int,
    restart: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Make the surface of the fluid for the frames in FOLDER: a closed mesh of triangles, a file a frame.

    The particles' radius comes from the run. The same command again continues where it stopped. For .usdc, .usda and
    .usd a stage NAME.usda plays all frames.

    \b
    Examples:
      fontana mesh out/fountain
      fontana mesh out/fountain --frames 1-48 -o water/fountain.ply
      fontana mesh out/fountain -o water/fountain.####.usdc --cell-size 0.5
    """
    cache = Cache(folder)
    chosen = cache.select(frames)
    target = parse_target(out or str(folder / "surface" / f"{cache.scene.name}.bgeo"), MESH_SUFFIXES)
    check_installed()
    if target.suffix in usd.SUFFIXES:
        usd.check_installed()
    settings = SurfaceSettings(cell_size=cell_size, threshold=threshold, smoothing=smoothing)
    make = SurfaceMaker(cache.particle_radius, settings, _layout(cache, chosen))
    options = SequenceOptions(target, make.recorded(), jobs, restart)
    progress = make_progress(as_json, quiet)
    try:
        result = make_sequence(cache, chosen, make, options, progress)
        if target.suffix in usd.SUFFIXES and result.there:
            stage = target.folder / f"{target.name}.usda"
            layers = {frame: target.frame(frame).name for frame in result.there}
            usd.write_clips_stage(stage, layers, _layout(cache, result.there))
            progress.note(f"{stage} plays what is there")
        result.raise_if_incomplete()
        progress.finish([target.frame(frame) for frame in chosen])
    finally:
        progress.close()


@click.command(short_help="Write the particles of a run for other programs.")
@_folder
@_frames
@click.option("-o", "--out", metavar="NAME", required=True, help="Ends in .usdc, .usda, .usd, .abc or .vdb.")
@click.option(
    "--voxel-size",
    type=FloatRange(0.25, 8.0),
    default=vdb.VdbSettings().voxel_size,
    show_default=True,
    metavar="RADII",
    help="Of the grid surface, in particle radii; vel has voxels of twice that. Only .vdb.",
)
@_jobs
@_restart
@_json
@_quiet
def export(
    folder: Path,
    frames: str | None,
    out: str,
    voxel_size: float,
    jobs: int,
    restart: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Write the particles in FOLDER for other programs.

    \b
    .usdc, .usda, .usd  USD: one stage of points with widths, velocities and ids
    .abc                Alembic: one file of points, likewise
    .vdb                OpenVDB: a file a frame, the level set "surface" and the velocities "vel"

    \b
    Examples:
      fontana export out/fountain -o fountain.usdc
      fontana export out/fountain -o fountain.abc --frames 1-48
      fontana export out/fountain -o vdb/fountain.####.vdb
    """
    cache = Cache(folder)
    chosen = cache.select(frames)
    target = parse_target(out, [*usd.SUFFIXES, ".abc", ".vdb"])
    progress = make_progress(as_json, quiet)
    try:
        if target.suffix == ".vdb":
            check_installed()
            vdb.find_openvdb()
            make = vdb.VdbMaker(cache.particle_radius, vdb.VdbSettings(voxel_size))
            make_sequence(
                cache, chosen, make, SequenceOptions(target, make.recorded(), jobs, restart), progress
            ).raise_if_incomplete()
            progress.finish([target.frame(frame) for frame in chosen])
        else:
            write_whole(cache, chosen, _points_writer(cache, chosen, target), target, progress)
            progress.finish([target.whole])
    finally:
        progress.close()


def _points_writer(cache: Cache, frames: list[int], target: Target) -> AbstractContextManager[FrameWriter]:
    open_writer = alembic.points_archive if target.suffix == ".abc" else usd.points_stage
    return open_writer(target.whole, _layout(cache, frames))


def _layout(cache: Cache, frames: list[int]) -> usd.StageLayout:
    return usd.StageLayout(cache.scene.name, cache.frame_rate, cache.unit, frames[0], frames[-1])
