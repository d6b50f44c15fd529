"""Writes the help pages of the Houdini nodes: houdini/help/ with the parameters of the library filled in.

    python tools/make_houdini_help.py

A line %GROUP of a text becomes an entry for each parameter of that group in src/fontana/scene/parameters.def. Needs
fontana installed from this tree. tests/houdini/test_help.py fails where a page is out of date, and holds the pages
against the panels.
"""

from __future__ import annotations

import textwrap
from pathlib import Path

from fontana.tables import groups
from fontana.units import readable

ROOT = Path(__file__).parents[1]
TEXTS = ROOT / "houdini" / "help"
PAGES = ROOT / "houdini" / "package" / "help" / "nodes" / "sop"
WIDTH = 120


def page(text: str) -> str:
    """A text with its %GROUP lines filled in. Raises KeyError for a group that the table does not have."""
    parts = text.splitlines()
    return "\n".join(group_entries(line[1:]) if line.startswith("%") else line for line in parts) + "\n"


def group_entries(group: str) -> str:
    return "\n\n".join(entry(parameter) for parameter in groups()[group].values())


def entry(parameter) -> str:
    """What a panel's row says, and its range; the id is the row's name there."""
    label = f"{parameter.label} ({parameter.unit.replace('**', '^')})" if parameter.unit else parameter.label
    sentences = [parameter.doc, unit_text(parameter)]
    return "\n".join(
        [
            f"{label}:",
            f"    #id: {parameter.name.replace('.', '_')}",
            *textwrap.wrap(
                " ".join(filter(None, sentences)), WIDTH - 4, initial_indent="    ", subsequent_indent="    "
            ),
        ]
    )


def unit_text(parameter) -> str:
    """The unit and the bounds, where there are any."""
    if parameter.type not in ("float", "int"):
        return ""
    unit = f" {readable(parameter.unit)}" if parameter.unit else ""
    return f"From {parameter.minimum:g} to {parameter.maximum:g}{unit}."


def pages() -> dict[Path, str]:
    """The pages by the files they belong into."""
    return {
        PAGES / f"fontana--{text.stem}-1.0.txt": page(text.read_text(encoding="utf-8")) for text in TEXTS.glob("*.txt")
    }


if __name__ == "__main__":
    for path, text in pages().items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        print(f"wrote {path}")
