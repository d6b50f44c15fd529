"""What the benchmarks of the thesis's tables do alike: describe it, measure until the end or Ctrl-C, publish."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import click

from fontana.bench._machine import describe_conditions, note_end
from fontana.bench._results import publish_json, publish_picture
from fontana.bench._scenes import SPACING
from fontana.bench._timing import SUBSTEPS_PER_FRAME


def describe_results(benchmark: str, scene_names: list[str], **settings: object) -> dict:
    """The results before the first number: conditions, settings, and a list of rows for each scene."""
    settings |= {"particle_spacing": SPACING, "substeps_per_frame": SUBSTEPS_PER_FRAME}
    conditions = describe_conditions(["fontana", *sys.argv[1:]])
    scenes: dict[str, list] = {name: [] for name in scene_names}
    return {"benchmark": benchmark, "state": "running"} | conditions | {"settings": settings, "scenes": scenes}


def measure_and_publish(
    results: dict,
    path: Path,
    measure: Callable[[Callable[[], None]], None],
    print_results: Callable[[dict], None],
) -> None:
    """Fills the results by `measure`, which is given what to call after each row, and leaves them in `path`, in print
    and, beside `path`, as a picture. Raises KeyboardInterrupt after Ctrl-C, with what was measured published."""
    picture = path.with_suffix(".png")
    try:
        measure(lambda: publish_json(path, results))
        note_end(results)
    except KeyboardInterrupt:
        note_end(results, "interrupted")
    publish_json(path, results)
    print_results(results)
    publish_picture(results, picture)
    click.echo(f"written: {path}, {picture}")
    if results["state"] == "interrupted":
        raise KeyboardInterrupt
