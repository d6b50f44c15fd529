"""The suffix of a file decides what it holds: it has to be a known one."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from fontana import _core
from fontana.tables import nearest


def check_suffix(path: Path, known: Iterable[str]) -> str:
    """The suffix of the file that -o names, in small letters. Raises BadInput with the nearest if it is not `known`."""
    suffix, names = path.suffix.lower(), list(known)
    if suffix in names:
        return suffix
    near = nearest(suffix, names)
    wrong = f"not in {path.suffix}" if suffix else "it has no suffix"
    hint = f"; did you mean {near}?" if near else ""
    raise _core.BadInput(
        f'-o "{path}": expected a name that ends in {", ".join(names[:-1])} or {names[-1]}, {wrong}{hint}'
    )
