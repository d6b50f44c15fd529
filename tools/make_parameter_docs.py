"""Writes docs/parameters.md from the library's table of parameters (src/fontana/scene/parameters.def).

    python tools/make_parameter_docs.py

Needs fontana installed from this tree. tests/docs/test_docs.py fails where the file is out of date.
"""

from __future__ import annotations

import itertools
from pathlib import Path

from fontana import _core
from fontana.units import readable

PAGE = Path(__file__).parents[1] / "docs" / "parameters.md"

HEAD = """\
# Parameters

Made by `tools/make_parameter_docs.py` from `src/fontana/scene/parameters.def`; edit that.

In a scene a parameter stands in its group, `{"fluid": {"viscosity": "300 cP"}}`; on the command line it is
`--set fluid.viscosity="300 cP"`; in C `fontana_set_number(simulation, "fluid.viscosity", &value, 1)`. A number without
a unit is in the unit given here. `fontana explain fluid.viscosity` prints a row of this page.
"""


def default_text(parameter) -> str:
    if parameter.type == "vector":
        return f"[{', '.join(f'{part:g}' for part in parameter.default)}]"
    if parameter.type == "bool":
        return str(parameter.default).lower()
    return parameter.default if parameter.type == "choice" else f"{parameter.default:g}"


def range_text(parameter) -> str:
    """What may stand there; any number where the table sets no bounds."""
    if parameter.type == "choice":
        return ", ".join(f"`{word}`" for word in parameter.choices)
    if parameter.type == "bool":
        return "true, false"
    if parameter.type == "vector":
        return "three numbers"
    whole = "whole, " if parameter.type == "int" else ""
    return f"{whole}{parameter.minimum:g} to {parameter.maximum:g}"


def row(parameter) -> str:
    meaning = f"**{parameter.label}.** {parameter.doc}".replace("|", "\\|")
    cells = (f"`{parameter.name}`", default_text(parameter), readable(parameter.unit), range_text(parameter), meaning)
    return f"| {' | '.join(cells)} |"


def page() -> str:
    """The whole text of docs/parameters.md."""
    parts = [HEAD]
    for group, parameters in itertools.groupby(_core.parameters(), key=lambda parameter: parameter.group):
        table = ["| Parameter | Default | Unit | Range | Meaning |", "|---|---|---|---|---|", *map(row, parameters)]
        parts.append("\n".join([f"## {group}", "", *table]) + "\n")
    return "\n".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE}")
