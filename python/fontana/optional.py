"""Packages that only some commands need, each in an extra of pyproject.toml."""

from __future__ import annotations

import importlib
from types import ModuleType

from fontana import _core


def require(module: str, package: str, purpose: str) -> ModuleType:
    """The module, imported. Raises BadInput with the line that installs its package."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise _core.BadInput(f"{purpose} needs {package}, which is not here: pip install {package}") from error
