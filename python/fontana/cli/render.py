"""`fontana render`."""

from __future__ import annotations

from pathlib import Path

import click

from fontana.cli.usage import Choice, FloatRange
from fontana.gl.camera import Camera
from fontana.gl.footage import Footage
from fontana.gl.frame_data import COLOR_MAPS, COLOR_UNITS, STYLES, Look
from fontana.render.job import render as render_frames
from fontana.render.options import RenderOptions, parse_camera, parse_color_range, parse_size
from fontana.render.outputs import open_output
from fontana.runs.cache import Cache
from fontana.runs.frame_numbers import FRAMES_HELP
from fontana.runs.progress import make_progress

_LOOK = Look()


@click.command(short_help="Draw the frames of a run as pictures or a film.")
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "-o", "--out", "out", type=click.Path(path_type=Path), required=True, help="x.mp4, .gif, .webp, x.####.png"
)
@click.option("--style", type=Choice(STYLES), default=_LOOK.style, show_default=True, help="How it is drawn.")
@click.option("--frames", "frame_text", metavar="RANGE", help=FRAMES_HELP)
@click.option("--size", "size_text", default="1280x720", show_default=True, metavar="WxH", help="In pixels.")
@click.option(
    "--samples",
    type=click.IntRange(1, 4096),
    default=8,
    show_default=True,
    help="Pictures averaged into one: smooth edges, soft shadows.",
)
@click.option(
    "--shutter",
    type=FloatRange(0.0, 1.0),
    default=0.25,
    show_default=True,
    help="Share of a frame that water is exposed for; points are sharp.",
)
@click.option("--camera", "camera_text", default="", metavar="TEXT", help="Where it is. [default: the scene's view]")
@click.option("--color-by", type=Choice(tuple(COLOR_UNITS)), default=_LOOK.color_by, show_default=True)
@click.option("--color-range", "range_text", metavar="LOW,HIGH", help="Values at the ends. [default: those of the run]")
@click.option("--color-map", type=Choice(COLOR_MAPS), default=_LOOK.color_map, show_default=True)
@click.option("--legend/--no-legend", default=True, help="Say what the colours of points mean.")
@click.option("--fps", type=FloatRange(0.1, 1000), help="Of a film. [default: the run's]")
@click.option("--restart", is_flag=True, help="Draw pictures again that are there, and replace foreign ones.")
@click.option("--json", "as_json", is_flag=True, help="One JSON object a line instead of text.")
@click.option("--quiet", is_flag=True, help="Say nothing but errors.")
def render(
    folder: Path,
    out: Path,
    style: str,
    frame_text: str | None,
    size_text: str,
    samples: int,
    shutter: float,
    camera_text: str,
    color_by: str,
    range_text: str | None,
    color_map: str,
    legend: bool,
    fps: float | None,
    restart: bool,
    as_json: bool,
    quiet: bool,
) -> None:
    """Draw the frames of the run in FOLDER as pictures or a film, without a window.

    The same command again goes on with the pictures that are missing; a film begins anew.

    \b
    Camera: words with = between spaces, in metres and degrees
      eye=x,y,z target=x,y,z fov=a     or     azimuth=a elevation=a distance=d target=x,y,z
      turn=a                                  goes around the target from the first frame to the last

    \b
    Examples:
      fontana render out/fountain -o fountain.mp4
      fontana render out/fountain -o pictures/fountain.####.png --size 1920x1080 --samples 32
      fontana render out/fountain -o speed.gif --style points --color-by speed --frames 1-48 --size 640x360
      fontana render out/fountain -o still.png --frames 40 --camera "azimuth=30 elevation=12 distance=3"
    """
    cache = Cache(folder)
    footage = Footage(cache)
    camera, turn = parse_camera(camera_text, Camera.of_scene(cache.scene.view, footage.bounds()))
    exposure = shutter * cache.frame_duration if style == "fluid" else 0.0
    options = RenderOptions(
        frames=cache.select(frame_text),
        size=parse_size(size_text),
        camera=camera,
        turn=turn,
        look=Look(style, color_by, parse_color_range(range_text), color_map, samples, exposure),
        legend=legend,
        fps=fps or cache.frame_rate,
        restart=restart,
    )
    output = open_output(out, options.size, options.fps, len(options.frames), restart)
    progress = make_progress(as_json, quiet)
    try:
        progress.finish(render_frames(footage, options, output, progress))
    finally:
        progress.close()
