"""Under what conditions a number was measured: machine, devices, versions, commit, load, command line."""

from __future__ import annotations

import datetime
import os
import platform
import shlex
import subprocess
from importlib import metadata
from pathlib import Path

from fontana import _core

_QUIET_LOAD = 0.5  # processes waiting or running, over the last minute
_DEVICE_FIELDS = ("backend", "name", "driver", "memory_bytes", "compute_units", "is_gpu", "available", "reason")


def describe_conditions(command: list[str]) -> dict:
    """A plain object with everything that a reader of a number needs to know; `command` is the command line.

    The host's name, its user and its folders stay out of it: results are published.
    """
    return {
        "started": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "command": shlex.join(command),
        "commit": _commit(Path.cwd()),
        "versions": _versions(),
        "machine": _machine(),
        "devices": [{name: getattr(device, name) for name in _DEVICE_FIELDS} for device in _core.devices()],
    }


def missing_backends() -> dict[str, str]:
    """Why a backend cannot run here, by its name; empty where all can."""
    found = _core.devices()
    here = {device.backend for device in found if device.available}
    return {device.backend: device.reason for device in reversed(found) if device.backend not in here}


def usable_cores() -> int:
    """How many cores this process may run on; `taskset` makes them fewer."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _machine() -> dict:
    cpu = next(device for device in _core.devices() if device.backend == "cpu")
    return {
        "cpu": cpu.name,
        "cores": os.cpu_count(),
        "usable_cores": usable_cores(),
        "memory_bytes": cpu.memory_bytes,
        "os": " ".join([platform.system(), platform.machine(), *platform.libc_ver()]),
        "load_average_before": _load_average(),
    }


def note_end(results: dict, state: str = "finished") -> None:
    """Adds to the results how they ended, and how busy the machine was by then."""
    results["state"] = state
    results["machine"]["load_average_after"] = _load_average()


def load_remark(results: dict) -> str | None:
    """That others were at work, or None if the machine was quiet when the measurement began."""
    load = results["machine"]["load_average_before"]
    if not load or load[0] < _QUIET_LOAD:
        return None
    return (
        f"the machine was not quiet: load average {load[0]:.1f} on {results['machine']['cores']} cores at the start; "
        "the numbers are lower than it can do"
    )


def _load_average() -> list[float] | None:
    """Of 1, 5 and 15 minutes, where the system tells."""
    return [round(value, 2) for value in os.getloadavg()] if hasattr(os, "getloadavg") else None


def _versions() -> dict[str, str]:
    versions = {"fontana": _core.version(), "python": platform.python_version()}
    for package in ("numpy", "matplotlib"):
        versions[package] = metadata.version(package)
    return versions


def _commit(folder: Path) -> dict | None:
    """The commit of the checkout that `folder` lies in and whether it has changes, results of benchmarks aside."""
    top = _git(folder, "rev-parse", "--show-toplevel")
    if top is None or not (Path(top) / "src/fontana/fontana.h").exists():
        return None
    commit = _git(folder, "rev-parse", "HEAD")
    changes = _git(Path(top), "status", "--porcelain", "--", ".", ":!benchmarks/results")
    return {"hash": commit, "dirty": bool(changes)} if commit else None


def _git(folder: Path, *arguments: str) -> str | None:
    try:
        done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, timeout=30)
    except (OSError, subprocess.TimeoutExpired):
        return None
    return done.stdout.strip() if done.returncode == 0 else None
