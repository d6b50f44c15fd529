"""The four schemes of the thesis (IV.3), in the order of its tables, and its own numbers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Scheme:
    """A column of the tables. `exponent`: how its cost grows with the particle count, at the most."""

    name: str
    backend: str
    neighbors: str
    exponent: int


SCHEMES = (
    Scheme("CPU simple", "cpu", "all-pairs", 2),
    Scheme("CPU grid", "cpu", "grid", 1),
    Scheme("GPU simple", "opencl", "all-pairs", 2),
    Scheme("GPU grid", "opencl", "grid", 1),
)
REFERENCE = SCHEMES[0].name

# Frames per second of the thesis, by scene and particle count, in the order of SCHEMES; None is its "<0.1".
THESIS_FRAME_CAP = 24.0
THESIS_FLOOR = 0.1
THESIS_HARDWARE = "2012: Core i7-860, GeForce GTX 260"
THESIS_TABLES: dict[str, dict[int, tuple[float | None, ...]]] = {
    "fountain": {  # Table 1, Fig. 15
        100: (24.0, 24.0, 24.0, 24.0),
        1_000: (2.3, 24.0, 24.0, 24.0),
        10_000: (None, 4.5, 1.7, 24.0),
        100_000: (None, 0.24, None, 5.7),
    },
    "box": {  # Table 2, Fig. 16
        100: (24.0, 24.0, 24.0, 24.0),
        1_000: (2.2, 24.0, 24.0, 24.0),
        10_000: (None, 2.7, 1.67, 24.0),
        100_000: (None, 0.17, None, 4.5),
    },
}
THESIS_PLACES = {"fountain": ("Table 1", "Fig. 15"), "box": ("Table 2", "Fig. 16")}

# Seconds of the thesis's Tables 3 and 4, by scene and particle count, in the order of SCHEMES; of how many frames it
# does not say.
THESIS_SECONDS: dict[str, dict[int, tuple[float, ...]]] = {
    "fountain": {  # Table 3, Fig. 17
        100: (3.4, 2.3, 2.1, 2.2),
        1_000: (111.3, 4.3, 5.3, 3.2),
        10_000: (1200.0, 58.7, 150.8, 10.9),
        100_000: (3000.0, 700.0, 1400.0, 116.7),
    },
    "box": {  # Table 4, Fig. 18
        100: (3.3, 2.3, 2.3, 2.3),
        1_000: (110.6, 4.9, 5.5, 3.1),
        10_000: (1300.0, 119.6, 151.6, 12.8),
        100_000: (3200.0, 800.0, 1500.0, 161.6),
    },
}
THESIS_HOUDINI_PLACES = {"fountain": ("Table 3", "Fig. 17"), "box": ("Table 4", "Fig. 18")}


def gpu_remark(results: dict) -> str | None:
    """What has to be said about the OpenCL numbers, or None where a GPU ran them."""
    devices = [device for device in results["devices"] if device["backend"] == "opencl"]
    used = next((device for device in devices if device["available"]), None)
    if used is None:
        reason = devices[0].get("reason", "") if devices else "this build has no OpenCL"
        return f"OpenCL (the GPU columns) did not run: {reason}"
    if used["is_gpu"]:
        return None
    driver = used.get("driver", "its driver").replace("Portable Computing Language", "PoCL")
    return f"there is no GPU here: OpenCL (the GPU columns) ran on the CPU through {driver}"
