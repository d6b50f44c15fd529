"""`fontana bench plot`: draws the results of `fontana bench thesis` again."""

from __future__ import annotations

from pathlib import Path

import click

from fontana.bench._results import load_results


@click.command(short_help="Draw the results of `thesis` again.")
@click.argument("results", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(path_type=Path, dir_okay=False), help="The picture. [default: beside RESULTS]")
def command(results: Path, out: Path | None) -> None:
    """Draw RESULTS, the JSON of `fontana bench thesis`: the thesis's Figs. 15 and 16 with its own numbers beside.

    \b
    Examples:
      fontana bench plot out/bench/thesis.json
      fontana bench plot thesis.json --out figure.png
    """
    from fontana.bench._thesis_figure import publish_figure

    picture = out or results.with_suffix(".png")
    publish_figure(load_results(results), picture)
    click.echo(f"written: {picture}")
