"""The double of the HDK against the table of where its declarations come from."""

import re
from pathlib import Path

DOUBLE = Path(__file__).parents[2] / "houdini" / "double"
INCLUDE = DOUBLE / "include"
PAGE = (DOUBLE / "PROVENANCE.md").read_text(encoding="utf-8")
ROWS = [line for line in PAGE.splitlines() if re.match(r"\| (?!What |Header )", line)]
ADDRESS = re.compile(
    r"https://www\.sidefx\.com/docs/(?:hdk|houdini)/[\w/-]+\.html"
    r"|https://github\.com/[\w.-]+/[\w.-]+/blob/[0-9a-f]{40}/[\w./-]+#L\d+"
)
# What tests call in place of Houdini is nothing of the HDK's.
HEADERS = sorted(str(path.relative_to(INCLUDE)) for path in INCLUDE.glob("*/*.h") if path.parent.name != "hdk_double")


def declared_in(header: str) -> set[str]:
    """Types and functions that bear HDK names; those of the double's own are in snake_case."""
    code = re.sub(r"//.*", "", (INCLUDE / header).read_text(encoding="utf-8"))
    types = re.findall(r"^ *(?:class|enum|using) ([A-Z]{2,3}_\w+)", code, re.MULTILINE)
    return {*types, *re.findall(r"\b([a-z]+[A-Z]\w*)\(", code)}


def test_every_header_has_rows_and_every_row_a_header():
    named = {found[1] for row in ROWS if (found := re.match(r"\| `([A-Z]+/\w+\.h)` \|", row))}
    assert sorted(named) == HEADERS
    assert "`hdk_double/hdk_double.h`" in PAGE


def test_everything_declared_is_in_the_table():
    known = set(re.findall(r"\w+", "\n".join(ROWS)))
    missing = {header: sorted(declared_in(header) - known) for header in HEADERS}
    assert {header: names for header, names in missing.items() if names} == {}


def test_every_row_has_addresses_of_pages_or_of_lines():
    assert len(ROWS) > 100
    for row in ROWS:
        links = re.findall(r"\[[^\]]+\]\(([^)\s]+)\)", row.split(" | ")[-1])
        assert links and all(ADDRESS.fullmatch(link) for link in links), row
