"""What a source shows: one frame and the facts about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from fontana.gl.frame_data import FrameData


@dataclass(frozen=True)
class Snapshot:
    """One frame.

    number   frames finished; 0 is the start
    time     s
    data     its particles and where its colliders are
    record   what run.json says of a frame: substeps, dt_min, limit, density_error_mean, ...; empty where unknown
    scheme   where it was computed, "cpu grid"; "" for a cache
    phases   seconds by name: what the frame took to simulate, to read
    """

    number: int
    time: float
    data: FrameData
    record: Mapping[str, object] = field(default_factory=dict)
    scheme: str = ""
    phases: Mapping[str, float] = field(default_factory=dict)
