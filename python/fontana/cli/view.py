"""`fontana view`."""

from __future__ import annotations

from pathlib import Path

import click

from fontana import _core
from fontana.cli.usage import Choice
from fontana.overrides import parse_assignments
from fontana.render.options import parse_size
from fontana.scene import load_scene
from fontana.tables import parameters


@click.command(short_help="Look at a scene or a run in a window.")
@click.argument("source")
@click.option("--backend", type=Choice(parameters()["solver.backend"].choices), help="Where to compute.")
@click.option("--neighbors", type=Choice(parameters()["solver.neighbors"].choices), help="How neighbours are found.")
@click.option(
    "--set", "assignments", multiple=True, metavar="PATH=VALUE", help="Change a value of the scene; repeatable."
)
@click.option("--paused", is_flag=True, help="Begin without playing.")
@click.option("--size", "size_text", default="1280x720", show_default=True, metavar="WxH", help="Of the window.")
def view(
    source: str,
    backend: str | None,
    neighbors: str | None,
    assignments: tuple[str, ...],
    paused: bool,
    size_text: str,
) -> None:
    """Look at SOURCE in a window: a scene is simulated live, the folder of a run is played.

    Every parameter can be turned, and the backend switched, while it runs. The key ? lists the others.

    \b
    Examples:
      fontana view fountain
      fontana view my_scene.json --set fluid=honey --backend opencl
      fontana view out/fountain
    """
    overrides = parse_assignments(assignments)
    overrides |= {"solver.backend": backend} if backend else {}
    overrides |= {"solver.neighbors": neighbors} if neighbors else {}
    from fontana.viewer.app import open_viewer  # libraries that only the window needs

    if Path(source).is_dir():
        if overrides:
            raise _core.BadInput(f'"{source}" is a folder: a run is played as it is; to change it view its scene')
        open_viewer(Path(source), parse_size(size_text), not paused)
    else:
        open_viewer(load_scene(source, overrides), parse_size(size_text), not paused)
