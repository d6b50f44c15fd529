"""Which backends this machine has, and which neighbour schemes on them."""

from __future__ import annotations

import functools
from collections.abc import Sequence

from fontana import _core
from fontana.tables import parameters


def absent_backends(devices: Sequence[_core.Device]) -> dict[str, str]:
    """The backends that have no device among these, each with the reason, and what to do about it."""
    present = {device.backend for device in devices if device.available}
    return {device.backend: device.reason for device in devices if device.backend not in present}


def absent_neighbors(device: _core.Device, method: str) -> dict[str, str]:
    """The words of solver.neighbors that fluid.method=`method` cannot have on a device, each with the reason."""
    reasons = {}
    for word in parameters()["solver.neighbors"].choices:
        if word not in device.neighbors:
            reasons[word] = f"{device.backend} has {' and '.join(device.neighbors)}"
        elif complaint := _complaint(word, method):
            reasons[word] = complaint
    return reasons


@functools.cache
def _complaint(neighbors: str, method: str) -> str:
    """The library's about this scheme with this method, everything else as it is by default; "" if there is none."""
    simulation = _core.Simulation()
    simulation.set("solver.neighbors", neighbors)
    simulation.set("fluid.method", method)
    try:
        simulation.check()
    except _core.BadInput as error:
        return str(error)
    return ""
