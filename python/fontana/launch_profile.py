"""Where the time of a run goes: every launch by name, beside what the device's memory and a named GPU could do."""

from __future__ import annotations

from collections.abc import Iterable

from fontana import _core
from fontana.roofline import Gpu

# What the bytes and flops of src/fontana/kernels/kernel_list.def are counted for; both differ in every scene.
COUNTED_NEIGHBORS = 30
COUNTED_CANDIDATES = 216
# Beyond the caches of any device here or in data/gpus.json; a small device gets a share of its memory.
_COPIED_BYTES = 256 << 20
_COPIED_SHARE = 1 / 16


def profile_of(
    simulation: _core.Simulation, before: Iterable[_core.KernelProfile] = (), gpu: Gpu | None = None
) -> dict:
    """What the launches of a simulation took, those of `before` taken off. It needs solver.profile.

    rows                          of all launches, the longest first: name, launches, milliseconds, share (of all rows)
                                  and, where the kernel's cost is stated, elements (particles, summed over launches),
                                  bytes_per_particle, flops_per_particle, gigabytes_per_second, gigaflops,
                                  share_of_copy (of the measured bandwidth); with `gpu` roofline_milliseconds
    copy_gigabytes_per_second     what this device reads and writes in copying; None where memory did not suffice
    counted_for, mean_neighbors   what the stated costs assume, and what the particles have now
    roofline                      the figures behind the estimate, or None

    All pairs visit more than the stated candidates, so costs are left out there. Raises the errors of the device.
    """
    rows = _rows(simulation.profile(), before, is_counted=simulation.get("solver.neighbors") != "all-pairs")
    copied = _copy_bandwidth(simulation)
    for row in rows:
        if "gigabytes_per_second" in row and copied:
            row["share_of_copy"] = _digits(row["gigabytes_per_second"] / copied)
        if "gigabytes_per_second" in row and gpu:
            moved, flops = (row["elements"] * row[f"{what}_per_particle"] for what in ("bytes", "flops"))
            row["roofline_milliseconds"] = _digits(1e3 * gpu.least_seconds(moved, flops))
    neighbors = simulation.count_neighbors()
    return {
        "rows": rows,
        "copy_gigabytes_per_second": copied,
        "counted_for": {"neighbors": COUNTED_NEIGHBORS, "candidates": COUNTED_CANDIDATES},
        "mean_neighbors": _digits(float(neighbors.mean())) if len(neighbors) else None,
        "roofline": _roofline(gpu) if gpu else None,
    }


def _rows(after: Iterable, before: Iterable, is_counted: bool) -> list[dict]:
    earlier = {row.name: row for row in before}
    rows = []
    for launch in after:
        taken_off = earlier.get(launch.name)
        values = [
            getattr(launch, name) - (getattr(taken_off, name) if taken_off else 0)
            for name in ("launches", "seconds", "elements", "bytes", "flops")
        ]
        if values[0]:
            rows.append(_row(launch.name, *values, is_counted=is_counted))
    total = sum(row["milliseconds"] for row in rows)
    for row in rows:
        row["share"] = _digits(row["milliseconds"] / total) if total else 0.0
    return sorted(rows, key=lambda row: -row["milliseconds"])


def _row(name: str, launches: int, seconds: float, elements: int, moved: float, flops: float, is_counted: bool) -> dict:
    row = {"name": name, "launches": launches, "milliseconds": _digits(1e3 * seconds)}
    if not (is_counted and moved and seconds > 0.0):
        return row
    return row | {
        "elements": elements,
        "bytes_per_particle": moved / elements,
        "flops_per_particle": flops / elements,
        "gigabytes_per_second": _digits(1e-9 * moved / seconds),
        "gigaflops": _digits(1e-9 * flops / seconds),
    }


def _copy_bandwidth(simulation: _core.Simulation) -> float | None:
    room = int(_COPIED_SHARE * simulation.device().memory_bytes) or _COPIED_BYTES
    try:
        return _digits(1e-9 * simulation.measure_copy(min(_COPIED_BYTES, room)))
    except _core.OutOfMemory:
        return None


def _roofline(gpu: Gpu) -> dict:
    return {
        "estimate": True,
        "gpu": gpu.name,
        "gigaflops": _digits(1e-9 * gpu.flops),
        "gigabytes_per_second": _digits(1e-9 * gpu.bandwidth),
        "source": gpu.source,
    }


def _digits(value: float) -> float:
    """Five: more than repeats agree on."""
    return float(f"{value:.5g}")


def profile_table(profile: dict) -> tuple[list[str], list[list[str]]]:
    """Columns and rows of a profile for people."""
    columns = ["launch", "launches", "ms", "share", "bytes/particle", "flops/particle", "GB/s", "GFLOP/s", "of copy"]
    gpu = profile["roofline"]
    if gpu:
        columns.append("estimate, ms")
    return columns, [_cells(row, bool(gpu)) for row in profile["rows"]]


def _cells(row: dict, has_estimate: bool) -> list[str]:
    formats = {
        "bytes_per_particle": "{:.0f}",
        "flops_per_particle": "{:.0f}",
        "gigabytes_per_second": "{:.2f}",
        "gigaflops": "{:.2f}",
        "share_of_copy": "{:.0%}",
    }
    if has_estimate:
        formats["roofline_milliseconds"] = "{:.3f}"
    cells = [row["name"], str(row["launches"]), f"{row['milliseconds']:.1f}", f"{row['share']:.1%}"]
    return cells + [text.format(row[name]) if name in row else "" for name, text in formats.items()]


def profile_notes(profile: dict) -> list[str]:
    """What a reader of the table must know, a sentence each."""
    copied, counted, gpu = profile["copy_gigabytes_per_second"], profile["counted_for"], profile["roofline"]
    notes = [f"copying reaches {copied:.1f} GB/s on this device" if copied else "copying found no memory to measure in"]
    if any(row.get("share_of_copy", 0.0) > 1.0 for row in profile["rows"]):
        notes.append("above 100% of copy: data stayed in caches, which copying goes beyond")
    if any("gigaflops" in row for row in profile["rows"]):
        mean = profile["mean_neighbors"]
        notes.append(
            f"bytes and flops are counted for {counted['neighbors']} neighbours out of {counted['candidates']} "
            f"candidates and perfect caches; the mean at the end is {mean:.1f} neighbours"
        )
    else:
        notes.append("bytes and flops are stated for the grid only")
    if gpu:
        notes.append(
            f"estimate: the least time on {gpu['gpu']} by its published peaks, {gpu['gigaflops'] / 1e3:g} TFLOP/s and "
            f"{gpu['gigabytes_per_second']:g} GB/s ({gpu['source']}); not measured"
        )
    return notes
