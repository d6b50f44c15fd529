"""Packages that only some commands need, each in an extra of pyproject.toml."""

from __future__ import annotations

import importlib
import shlex
import sys
from dataclasses import dataclass
from types import ModuleType

from fontana import _core


@dataclass(frozen=True)
class OptionalPackage:
    """A `package`, the `extra` that brings it, and what it is for: "USD"."""

    package: str
    extra: str
    purpose: str

    def module(self, name: str) -> ModuleType:
        """One of its modules, imported. Raises BadInput with the line that installs the package."""
        try:
            return importlib.import_module(name)
        except ImportError as error:
            raise self.missing() from error

    def missing(self) -> _core.BadInput:
        """The error where it is not installed. Its line is for the Python that runs: `pip` may be another's."""
        line = f"{shlex.quote(sys.executable)} -m pip install 'fontana[{self.extra}]'"
        return _core.BadInput(f"{self.purpose} needs {self.package}, which is not here: {line}")
