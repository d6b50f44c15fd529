"""Measuring speed. Each module here is a command of `fontana bench`; those with a leading underscore are its parts.

The scripts in benchmarks/ use the same parts, so that every number in the repository comes with the same facts about
the machine and is taken in the same way.
"""

from fontana.bench._machine import describe_conditions, load_remark, missing_backends, note_end, usable_cores
from fontana.bench._results import load_results, publish_json
from fontana.bench._scenes import BENCH_SCENES, BenchScene, bench_scene
from fontana.bench._schemes import gpu_remark
from fontana.bench._text import count_list, print_table, short_number
from fontana.bench._timing import Clocked, clock_substeps, significant, statistics

__all__ = [
    "BENCH_SCENES",
    "BenchScene",
    "Clocked",
    "bench_scene",
    "clock_substeps",
    "count_list",
    "describe_conditions",
    "gpu_remark",
    "load_remark",
    "load_results",
    "missing_backends",
    "note_end",
    "print_table",
    "publish_json",
    "short_number",
    "significant",
    "statistics",
    "usable_cores",
]
