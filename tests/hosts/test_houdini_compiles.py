"""The plugin against the double, by the compilers of Houdini 20.5 and 21.0, with either name for the index of an input.

Syntax and warnings alone: the preset `asan` builds, loads and cooks it (tests/houdini).
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import fontana

ROOT = Path(__file__).parents[2]
HOUDINI = ROOT / "houdini"
WARNINGS = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wsign-conversion", "-Werror")


def require_compiler(name):
    if shutil.which(name):
        return
    if os.environ.get("CI") == "true":
        pytest.fail(f"there is no {name}")
    pytest.skip(f"there is no {name} here")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The folder with what CMake makes: the source's panel with its defaults, and its *.proto.h."""
    folder = tmp_path_factory.mktemp("made")
    defaults = {p.name.partition(".")[2].upper(): f"{p.default}" for p in fontana.parameters()}
    text = (HOUDINI / "sop" / "SOP_FontanaSource.cpp.in").read_text()
    panel = folder / "SOP_FontanaSource.cpp"
    panel.write_text(re.sub(r"@FONTANA_(\w+)@", lambda found: defaults[found[1]], text))
    generate = [sys.executable, HOUDINI / "double" / "generate_proto.py", panel, folder / "SOP_FontanaSource.proto.h"]
    subprocess.run(generate, check=True)
    return folder


@pytest.mark.parametrize(("compiler", "version"), [("g++-11", 20), ("g++-12", 21)])
def test_the_plugin_compiles_without_warnings(made, compiler, version):
    require_compiler(compiler)
    folders = (HOUDINI / "double" / "include", HOUDINI / "session", HOUDINI / "sop", ROOT / "src" / "fontana", made)
    sources = [*HOUDINI.glob("session/*.cpp"), *HOUDINI.glob("sop/*.cpp"), *HOUDINI.glob("double/source/*.cpp"),
               *made.glob("*.cpp")]  # fmt: skip
    assert len(sources) > 15
    options = [*WARNINGS, "-std=c++17", f"-DSYS_VERSION_MAJOR_INT={version}", *(f"-I{folder}" for folder in folders)]
    command = [compiler, "-fsyntax-only", *options, *sources]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
