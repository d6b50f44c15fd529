"""Finds the cases by looking, so that a file is all a new one needs."""

from __future__ import annotations

import importlib
import pkgutil

from fontana import _core, validate
from fontana.tables import suggestion
from fontana.validate._case import Case


def case_names() -> list[str]:
    """The modules of this package that are cases, as the command line spells them."""
    return sorted(
        module.name.replace("_", "-") for module in pkgutil.iter_modules(validate.__path__) if module.name[0] != "_"
    )


def find_case(name: str) -> Case:
    """The case of that name. Raises BadInput with the nearest one."""
    names = case_names()
    if name not in names:
        raise _core.BadInput(f'unknown case "{name}"{suggestion(name, names)}')
    return importlib.import_module(f"fontana.validate.{name.replace('-', '_')}").CASE
