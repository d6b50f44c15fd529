"""Estimates for a GPU that is not here: the least time a launch can take there, by its public peak figures.

Williams, Waterman and Patterson 2009: a kernel is bound by its bytes over the bandwidth or by its operations over the
rate of arithmetic, whichever takes longer.
"""

from __future__ import annotations

import functools
import json
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Gpu:
    """Peak figures as its maker publishes them; the vector units alone."""

    key: str
    name: str
    flops: float  # float32 operations a second
    bandwidth: float  # bytes a second
    source: str  # where the figures are published

    def least_seconds(self, moved: float, flops: float) -> float:
        """For so many bytes and operations: perfect caches, every unit busy, nothing lost to launching."""
        return max(moved / self.bandwidth, flops / self.flops)


@functools.cache
def gpus() -> dict[str, Gpu]:
    """The GPUs of data/gpus.json by their short names."""
    listed = json.loads((Path(__file__).parent / "data" / "gpus.json").read_text(encoding="utf-8"))["gpus"]
    return {
        key: Gpu(
            key,
            facts["name"],
            1e12 * facts["float32_teraflops"],
            1e9 * facts["memory_gigabytes_per_second"],
            facts["source"],
        )
        for key, facts in listed.items()
    }
