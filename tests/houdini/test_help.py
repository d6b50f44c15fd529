"""The help pages of the nodes against their panels, as the plugin itself describes them on the double of the HDK."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "houdini" / "package" / "help" / "nodes" / "sop"
OPERATORS = {"fontana::solver::1.0": "fontana--solver-1.0.txt", "fontana::source::1.0": "fontana--source-1.0.txt"}
ENTRY = re.compile(r"^(\S[^\n]*):\n    #id: (\S+)\n(.*?)(?=^\S|\Z)", re.MULTILINE | re.DOTALL)


def entries(operator: str) -> dict[str, tuple[str, str]]:
    """Label and text by the name of the parameter."""
    text = (PAGES / OPERATORS[operator]).read_text(encoding="utf-8")
    return {name: (label, body.strip()) for label, name, body in ENTRY.findall(text)}


def test_the_pages_are_up_to_date():
    place = ROOT / "tools" / "make_houdini_help.py"
    specification = importlib.util.spec_from_file_location("make_houdini_help", place)
    tool = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(tool)
    for path, text in tool.pages().items():
        assert path.read_text(encoding="utf-8") == text, "run: python tools/make_houdini_help.py"


def test_every_node_has_a_page_and_every_page_a_node(panels):
    assert sorted(panels) == sorted(OPERATORS)
    assert {path.name for path in PAGES.iterdir()} == set(OPERATORS.values())


@pytest.mark.parametrize("operator", OPERATORS)
def test_every_parameter_has_its_entry_and_every_entry_a_parameter(panels, operator):
    listed = [row["name"] for row in panels[operator]["parameters"]]
    assert list(entries(operator)) == listed


@pytest.mark.parametrize("operator", OPERATORS)
def test_an_entry_has_the_label_of_the_panel_and_says_something(panels, operator):
    found = entries(operator)
    for row in panels[operator]["parameters"]:
        label, body = found[row["name"]]
        assert label == row["label"], row["name"]
        assert len(body) > 10, row["name"]


@pytest.mark.parametrize("operator", OPERATORS)
def test_the_head_of_a_page_is_that_of_its_node(panels, operator):
    text = (PAGES / OPERATORS[operator]).read_text(encoding="utf-8")
    assert text.startswith(f"= {panels[operator]['label']} =\n")
    head = dict(re.findall(r"^#(\w+): (.*)$", text, re.MULTILINE))
    assert (head["type"], head["context"], head["internal"]) == ("node", "sop", operator)
    assert head["icon"] == panels[operator]["icon"]
    assert (ROOT / "houdini/package/config/Icons" / f"{head['icon']}.svg").exists()
    assert re.search(r'^"""[^"\n]+"""$', text, re.MULTILINE)
    for section in ("@parameters", "@inputs", "@related"):
        assert f"\n{section}\n" in text
    for name in re.findall(r"\[(?:[^|\]]+\|)?Node:sop/(fontana--[\w.-]+)\]", text):
        assert (PAGES / f"{name}.txt").exists()
