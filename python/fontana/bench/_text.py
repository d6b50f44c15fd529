"""What the benchmarks print, and how their options are read."""

from __future__ import annotations

import click
from rich.console import Console
from rich.table import Table


def print_table(title: str, columns: list[str], rows: list[list[str]]) -> None:
    """A table of numbers: right-aligned, without lines; a pipe gets whole rows."""
    table = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for column in columns:
        table.add_column(column, justify="right", overflow="fold")
    for row in rows:
        table.add_row(*row)
    console = Console(highlight=False, markup=False)
    if not console.is_terminal:
        console = Console(highlight=False, markup=False, width=200)
    console.print(table)
    console.print()


def short_number(value: float) -> str:
    """Two or three digits."""
    if value >= 100:
        return f"{value:,.0f}"
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}" if value >= 0.1 else f"{value:.2g}"


def count_list(context: object, parameter: click.Parameter, text: str) -> list[int]:
    """A click callback: "100,1000" as [100, 1000], ascending."""
    words = [word.strip() for word in text.split(",") if word.strip()]
    if not words or not all(word.isdecimal() and 1 <= int(word) <= 100_000_000 for word in words):
        raise click.BadParameter(f'"{text}": expected particle counts from 1 to 100000000, such as 100,1000')
    return sorted({int(word) for word in words})


def word_list(context: object, parameter: click.Parameter, text: str) -> list[str]:
    """A click callback: "box,fountain" as a list, each word once."""
    return list(dict.fromkeys(word.strip() for word in text.split(",") if word.strip()))
