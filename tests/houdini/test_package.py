"""The Houdini package: its rules, its files, and that nothing of the double is in it."""

import importlib.util
import json
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

import jsonschema
import package_rules
import pytest

import fontana

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "houdini" / "package"
TOOL = ROOT / "tools" / "make_houdini_package.py"
PACKAGE = json.loads((SOURCE / "fontana.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def tool():
    specification = importlib.util.spec_from_file_location("make_houdini_package", TOOL)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """What the command writes without a plugin: the folder and the zip."""
    out = tmp_path_factory.mktemp("package")
    done = subprocess.run([sys.executable, TOOL, "--out", out], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "without a plugin for Houdini 20.5, 21.0, 22.0" in done.stdout
    return next(path for path in out.iterdir() if path.is_dir()), next(out.glob("*.zip"))


def test_the_package_file_has_the_shape_of_one():
    jsonschema.validate(PACKAGE, package_rules.PACKAGE_SCHEMA)


@pytest.mark.parametrize(
    ("version", "system", "folders"),
    [
        ("20.5.278", "linux", ["shared", "20.5"]),
        ("21.0.440", "linux", ["shared", "21.0"]),
        ("22.0.454", "linux", ["shared", "22.0"]),
        ("21.0.440", "windows", ["shared"]),
        ("22.0.454", "macos", ["shared"]),
        ("20.0.896", "linux", []),
        ("19.5.303", "linux", []),
        ("22.5.100", "linux", []),
        ("100.0.1", "linux", []),
    ],
)
def test_each_houdini_gets_its_own_plugin_and_no_other(version, system, folders):
    facts = {"houdini_version": version, "houdini_os": system}
    path = package_rules.houdini_path(PACKAGE, "/packages", facts)
    assert path == [f"/packages/fontana/{folder}" for folder in folders]


def test_a_rule_that_cannot_be_read_is_no_rule():
    with pytest.raises(ValueError, match="cannot read"):
        package_rules.holds("houdini_version ~ '21.0'", {"houdini_version": "21.0"})


def test_every_folder_of_the_rules_is_there(made):
    folder, _ = made
    for version in ("20.5", "21.0", "22.0"):
        facts = {"houdini_version": f"{version}.1", "houdini_os": "linux"}
        shared, own = (Path(path) for path in package_rules.houdini_path(PACKAGE, str(folder), facts))
        for name in ("config/Icons", "help/nodes/sop", "scripts/python", "toolbar"):
            assert any((shared / name).iterdir()), name
        text = (own / "dso" / "BUILD.txt").read_text()
        assert f"The plugin for Houdini {version}" in text and "VERSION" not in text
        assert list((own / "dso").iterdir()) == [own / "dso" / "BUILD.txt"]


def test_the_zip_holds_the_folder(made):
    folder, archive = made
    with zipfile.ZipFile(archive) as file:
        assert file.testzip() is None
        names = {name for name in file.namelist() if not name.endswith("/")}
    assert names == {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}
    assert "fontana.json" in names
    assert not [name for name in names if name.endswith(".pyc")]


def test_the_library_in_the_package_is_the_installed_one(made):
    folder, _ = made
    installed = next(Path(fontana.__file__).parent.glob("libfontana.so*"))
    assert (folder / "fontana" / "lib" / installed.name).read_bytes() == installed.read_bytes()


def test_a_plugin_goes_into_its_folder(tool, tmp_path):
    plugin = tmp_path / "fontana_houdini.so"
    plugin.write_bytes(b"\x7fELF a plugin")
    folder, _ = tool.make_package(tmp_path / "out", {"21.0": plugin})
    assert (folder / "fontana/21.0/dso/fontana_houdini.so").read_bytes() == plugin.read_bytes()
    assert not (folder / "fontana/21.0/dso/BUILD.txt").exists()
    assert (folder / "fontana/22.0/dso/BUILD.txt").exists()


def test_a_plugin_that_cannot_be_shipped_is_refused(tool, native_build, tmp_path):
    plugin = native_build("fontana_houdini")
    for version, path, sentence in (
        ("21.0", plugin, "built against the double"),
        ("21.5", plugin, "expected one of 20.5, 21.0, 22.0"),
        ("22.0", tmp_path / "none.so", "there is no file"),
    ):
        with pytest.raises(fontana.BadInput, match=sentence):
            tool.make_package(tmp_path / "out", {version: path})


def test_the_shelf_names_tools_icons_and_functions_that_exist():
    document = ElementTree.parse(SOURCE / "toolbar" / "fontana.shelf").getroot()
    tools = {tool.get("name"): tool for tool in document.iter("tool")}
    assert [member.get("name") for member in document.iter("memberTool")] == list(tools)
    assert [tool.get("label") for tool in tools.values()] == ["Fontana box", "Fontana fountain"]
    networks = (SOURCE / "scripts" / "python" / "fontana_networks.py").read_text(encoding="utf-8")
    for tool in tools.values():
        assert (SOURCE / "config" / "Icons" / f"{tool.get('icon')}.svg").exists()
        script = tool.findtext("script")
        compile(script, tool.get("name"), "exec")
        function = script.partition("fontana_networks.")[2].partition("(")[0]
        assert f"\ndef {function}(" in networks


@pytest.mark.parametrize("icon", sorted((SOURCE / "config" / "Icons").iterdir()), ids=lambda path: path.stem)
def test_icons_are_square_drawings(icon):
    drawing = ElementTree.parse(icon).getroot()
    assert drawing.tag.endswith("svg") and drawing.get("viewBox") == "0 0 64 64"
    assert drawing.findtext("{http://www.w3.org/2000/svg}title")
