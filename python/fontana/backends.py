"""Which backends this machine has."""

from __future__ import annotations

from fontana import _core


def absent_backends() -> dict[str, str]:
    """The backends that have no device here, each with the reason, and what to do about it."""
    found = _core.devices()
    present = {device.backend for device in found if device.available}
    return {device.backend: device.reason for device in found if device.backend not in present}
