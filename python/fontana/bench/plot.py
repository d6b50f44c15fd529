"""`fontana bench plot`: draws the results of `fontana bench thesis` or `fontana bench houdini` again."""

from __future__ import annotations

from pathlib import Path

import click

from fontana.bench._results import load_results, publish_picture


@click.command(short_help="Draw the results of `thesis` or `houdini` again.")
@click.argument("results", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(path_type=Path, dir_okay=False), help="The picture. [default: beside RESULTS]")
def command(results: Path, out: Path | None) -> None:
    """Draw RESULTS, with the thesis's own numbers beside: Figs. 15 and 16 from the JSON of `fontana bench thesis`,
    Figs. 17 and 18 from that of `fontana bench houdini`.

    \b
    Examples:
      fontana bench plot out/bench/thesis.json
      fontana bench plot out/bench/houdini.json
      fontana bench plot thesis.json --out figure.png
    """
    picture = out or results.with_suffix(".png")
    publish_picture(load_results(results), picture)
    click.echo(f"written: {picture}")
