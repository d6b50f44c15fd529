"""What the benchmarks of the thesis's tables are asked alike."""

from __future__ import annotations

from pathlib import Path

import click

from fontana import _core
from fontana.bench._scenes import BENCH_SCENES
from fontana.bench._text import count_list, word_list
from fontana.cli.usage import FloatRange
from fontana.tables import suggestion


def _scene_list(context: object, parameter: click.Parameter, text: str) -> list[str]:
    names = word_list(context, parameter, text)
    for name in names or [""]:
        if name not in BENCH_SCENES:
            raise _core.BadInput(f'--scenes: no scene "{name}" to measure{suggestion(name, BENCH_SCENES)}')
    return names


counts_option = click.option(
    "--counts",
    default="100,1000,10000,100000",
    show_default=True,
    callback=count_list,
    metavar="N,N,...",
    help="Particle counts: the rows.",
)
scenes_option = click.option(
    "--scenes",
    "scene_names",
    default="fountain,box",
    show_default=True,
    callback=_scene_list,
    metavar="NAME,NAME",
    help="Which tables.",
)
threads_option = click.option(
    "--threads", type=click.IntRange(0), default=0, help="Threads of the CPU columns; 0: all cores."
)


def budget_option(default: float, more_than: str):
    """`more_than`: when a scheme is cut off, for the help."""
    return click.option(
        "--budget",
        type=FloatRange(0, min_open=True),
        default=default,
        show_default=True,
        metavar="SECONDS",
        help=f"For each number; a scheme that would need more for {more_than} is cut off.",
    )


def out_option(name: str):
    """`name`: of the file of results in that folder."""
    return click.option(
        "--out",
        type=click.Path(path_type=Path, file_okay=False),
        default=Path("out/bench"),
        show_default=True,
        help=f"Folder of {name} and its picture, {Path(name).with_suffix('.png')}.",
    )
