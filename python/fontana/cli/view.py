"""`fontana view`."""

from __future__ import annotations

from pathlib import Path

import click

from fontana import _core
from fontana.overrides import parse_assignment
from fontana.scene import load_scene
from fontana.tables import parameters


class _Size(click.ParamType):
    name = "WIDTHxHEIGHT"

    def convert(self, value: object, parameter: object, context: object) -> tuple[int, int]:
        width, _, height = str(value).partition("x")
        if not (width.isdecimal() and height.isdecimal() and 1 <= int(width) <= 16384 and 1 <= int(height) <= 16384):
            self.fail(f'"{value}": expected pixels such as 1280x720', parameter, context)
        return int(width), int(height)


@click.command()
@click.argument("source")
@click.option("--backend", type=click.Choice(parameters()["solver.backend"].choices), help="Where to compute.")
@click.option(
    "--neighbors", type=click.Choice(parameters()["solver.neighbors"].choices), help="How neighbours are found."
)
@click.option(
    "--set", "assignments", multiple=True, metavar="PATH=VALUE", help="Change a value of the scene; repeatable."
)
@click.option("--paused", is_flag=True, help="Begin without playing.")
@click.option("--size", type=_Size(), default="1280x720", show_default=True, help="Of the window, in pixels.")
def view(
    source: str,
    backend: str | None,
    neighbors: str | None,
    assignments: tuple[str, ...],
    paused: bool,
    size: tuple[int, int],
) -> None:
    """Look at SOURCE in a window: a scene is simulated live, the folder of a run is played.

    Every parameter can be turned, and the backend switched, while it runs. The key ? lists the others.

    \b
    Examples:
      fontana view fountain
      fontana view my_scene.json --set fluid=honey --backend opencl
      fontana view out/fountain
    """
    overrides = dict(parse_assignment(text) for text in assignments)
    overrides |= {"solver.backend": backend} if backend else {}
    overrides |= {"solver.neighbors": neighbors} if neighbors else {}
    from fontana.viewer.app import open_viewer  # libraries that only the window needs

    if Path(source).is_dir():
        if overrides:
            raise _core.BadInput(f'"{source}" is a run, which is played as it is; to change something view its scene')
        open_viewer(Path(source), size, not paused)
    else:
        open_viewer(load_scene(source, overrides), size, not paused)
