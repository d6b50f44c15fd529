"""The documents say what is so: links lead somewhere, files, commands and tests exist, scenes load."""

import importlib.util
import json
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

import fontana
from fontana import exit_codes
from fontana.tables import COLLIDERS, EMITTERS, KEY_FIELDS, VIEW_FIELDS
from fontana.validate import case_names

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "fontana"
OUTSIDE = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "benchmarks/README.md")
PAGES = [*sorted((ROOT / "docs").glob("*.md")), *(ROOT / name for name in OUTSIDE)]
# Where a path in a text may begin, and what exists only once something was built or run.
PATH_ROOTS = (ROOT, SOURCE, ROOT / "python" / "fontana")
MADE = ("out/", "build/", "benchmarks/results/", "results/local/", ".venv/")

PATH = re.compile(r"(?<![\w./:~$*-])(?:[\w.-]+/)+[\w-][\w.-]*\.[A-Za-z]\w*(?![\w/*])")
FOLDER = re.compile(r"`((?:[\w.-]+/)+)`")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
URL = re.compile(r"\w+://\S+")
CODE_SPAN = re.compile(r"`([^`\n]+)`")
CODE_BLOCK = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def page(name: str) -> str:
    return (ROOT / "docs" / name).read_text(encoding="utf-8")


def anchor(heading: str) -> str:
    """The name GitHub gives a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def each_page(test):
    return pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))(test)


@each_page
def test_links_lead_somewhere(path):
    for target in LINK.findall(path.read_text(encoding="utf-8")):
        if URL.match(target) or target.startswith("mailto:"):
            continue
        name, _, fragment = target.partition("#")
        file = path.parent / name if name else path
        assert file.exists(), f"{path.name}: the link {target} leads nowhere"
        if fragment:
            headings = re.findall(r"^#+ (.*)$", file.read_text(encoding="utf-8"), re.MULTILINE)
            assert fragment in map(anchor, headings), f"{path.name}: no heading for {target}"


@each_page
def test_files_that_are_named_exist(path):
    text = URL.sub("", path.read_text(encoding="utf-8"))
    named = set(PATH.findall(text)) | set(FOLDER.findall(text))
    missing = [
        name
        for name in sorted(named)
        if not name.startswith(MADE) and not any((root / name).exists() for root in (*PATH_ROOTS, path.parent))
    ]
    assert not missing, f"{path.name} names files that do not exist"


@cache
def subcommands(*command: str) -> set[str]:
    """The names listed under "Commands:" in the help of a group of commands."""
    call = [sys.executable, "-m", "fontana", *command, "--help"]
    text = subprocess.run(call, capture_output=True, text=True, check=True).stdout
    listed = re.findall(r"^  ([a-z][a-z-]*)(?:  |$)", text.partition("\nCommands:\n")[2], re.MULTILINE)
    assert listed, f"no commands in the help of fontana {' '.join(command)}"
    return set(listed)


def commands_in(text: str):
    """The words of every call of the command line in code."""
    blocks = [line for _, block in CODE_BLOCK.findall(text) for line in block.splitlines()]
    for code in [*blocks, *CODE_SPAN.findall(CODE_BLOCK.sub("", text))]:
        words = code.strip().removeprefix("$ ").split()
        if words[:1] == ["fontana"] and len(words) > 1 and re.fullmatch(r"[a-z-]+", words[1]):
            yield words


@each_page
def test_commands_that_are_named_exist(path):
    for words in commands_in(path.read_text(encoding="utf-8")):
        if words[1].startswith("-"):
            continue
        assert words[1] in subcommands(), f"{path.name}: no command {' '.join(words)}"
        if words[1] == "bench" and len(words) > 2 and not words[2].startswith("-"):
            assert words[2] in subcommands("bench"), f"{path.name}: no command {' '.join(words)}"


@each_page
def test_tests_that_are_named_exist(path):
    sources = "".join(file.read_text(encoding="utf-8") for file in (ROOT / "tests").rglob("test_*.py"))
    for name in set(re.findall(r"`(test_\w+)`", path.read_text(encoding="utf-8"))):
        assert f"def {name}(" in sources, f"{path.name}: there is no {name}"


def tool(name: str):
    """A script of tools/ as a module."""
    specification = importlib.util.spec_from_file_location(name, ROOT / "tools" / f"{name}.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def test_parameters_page_is_up_to_date():
    assert page("parameters.md") == tool("make_parameter_docs").page(), "run: python tools/make_parameter_docs.py"


def test_validation_page_is_up_to_date():
    """It says what benchmarks/results/validate holds, of every case."""
    maker = tool("make_validation_docs")
    results = maker.load()
    assert [result["case"] for result in results] == case_names()
    assert page("validation-results.md") == maker.page(results), "run: python tools/make_validation_docs.py"


def test_parameters_that_are_named_exist():
    known = {parameter.name for parameter in fontana.parameters()}
    groups = "|".join(sorted({name.split(".")[0] for name in known}))
    for path in PAGES:
        named = set(re.findall(rf"`((?:{groups})\.[a-z_]+)[`=]", path.read_text(encoding="utf-8")))
        named -= {file.name for file in SOURCE.rglob("*.*")}
        assert named <= known, f"{path.name}: {sorted(named - known)}"


def scenes_on_the_page() -> list[str]:
    blocks = [block for language, block in CODE_BLOCK.findall(page("scenes.md")) if language == "json"]
    assert len(blocks) > 3
    return blocks


@pytest.mark.parametrize("index", range(len(scenes_on_the_page())))
def test_scenes_on_the_page_load(index):
    scene = fontana.load_scene(json.loads(scenes_on_the_page()[index]))
    simulation = scene.build()
    simulation.check()
    if scene.emitters:
        assert simulation.emitted_by(scene.frame_count) > 0


def test_the_page_on_scenes_has_every_type_field_and_exit_code():
    text = page("scenes.md")
    for kind, fields in (EMITTERS | COLLIDERS).items():
        assert f"`{kind}`" in text
        assert [field.name for field in fields if f"`{field.name}`" not in text] == []
    assert [field.name for field in (*KEY_FIELDS, *VIEW_FIELDS) if f"`{field.name}`" not in text] == []
    for code in re.findall(r"^  (\d+)  ", exit_codes.HELP, re.MULTILINE):
        assert re.search(rf"^\| {code} \|", text, re.MULTILINE), f"exit code {code} is missing"


def test_the_map_of_the_thesis_is_complete():
    text = page("thesis-map.md")
    for equation in (*(f"2.{k}" for k in range(1, 18)), "3.1"):
        assert f"({equation})" in text
    for figure in range(1, 21):
        assert re.search(rf"^\|.*\bFig\. {figure}\b.*\|", text, re.MULTILINE), f"Fig. {figure}"
    for table in range(1, 6):
        assert re.search(rf"^\| Table {table}\b", text, re.MULTILINE), f"Table {table}"


def test_every_file_of_tests_is_in_the_validation():
    text = page("validation.md")
    files = (ROOT / "tests").rglob("test_*.py")
    missing = [name for name in (str(file.relative_to(ROOT)) for file in files) if name not in text]
    assert not missing, "docs/validation.md says what is tested: add a row"


def test_every_kernel_of_the_list_is_in_the_text_and_back():
    listed = re.findall(r"^KERNEL_ENTRY\((\w+),", (SOURCE / "kernels" / "kernel_list.def").read_text(), re.MULTILINE)
    texts = "".join(file.read_text() for file in (SOURCE / "kernels").glob("*.h"))
    assert sorted(listed) == sorted(re.findall(r"^KERNEL void (\w+)\(", texts, re.MULTILINE))


def test_every_method_has_its_row():
    choices = next(parameter.choices for parameter in fontana.parameters() if parameter.name == "fluid.method")
    rows = re.findall(r"^\| `(\w+)`.*`(solver/\w+\.cpp)` \|$", page("methods.md"), re.MULTILINE)
    assert sorted(name for name, _ in rows) == sorted(choices)
    assert {file for _, file in rows} == {f"solver/{file.name}" for file in (SOURCE / "solver").glob("method_*.cpp")}


def test_every_limit_of_the_time_step_has_its_row():
    fields = re.search(r"double ([\w, ]+);\s*\} fontana_time_step_limits;", (SOURCE / "fontana.h").read_text())[1]
    of_the_moment = ("frame",)  # in choose_time_step alone
    table = page("conventions.md").partition("## Time steps")[2].partition("\n## ")[0]
    assert sorted(re.findall(r"^\| `(\w+)` \|", table, re.MULTILINE)) == sorted([*fields.split(", "), *of_the_moment])


def test_the_vector_loops_are_listed():
    text = page("architecture.md").partition("The kernels that have one:")[2].partition(". ")[0]
    loops = re.findall(r"WIDE\((?!function)(\w+)\)", (SOURCE / "backends/cpu/wide_kernels.cpp").read_text())
    assert re.findall(r"`(\w+)`", text) == loops


def inclusion_rules() -> dict[str, list[str]]:
    """The table of docs/architecture.md: what a folder may include beside itself."""
    rows = re.findall(r"^\| `(\w+)` \|(.*)\|$", page("architecture.md"), re.MULTILINE)
    return {folder: re.findall(r"`([\w./]+)`", rest) for folder, rest in rows}


def test_the_arrows_point_right():
    rules = inclusion_rules()
    folders = {path.name for path in SOURCE.iterdir() if path.is_dir()}
    assert set(rules) == folders
    for folder, allowed in rules.items():
        files = [file for file in (SOURCE / folder).rglob("*") if file.suffix in (".h", ".cpp")]
        assert files
        for file in files:
            for included in re.findall(r'^#include "([^"]+)"', file.read_text(), re.MULTILINE):
                beside = (file.parent / included).exists() or included.startswith(f"{folder}/")
                fits = any(included == name or included.startswith(f"{name}/") for name in allowed)
                assert beside or fits, f"{file.relative_to(SOURCE)} includes {included}"
