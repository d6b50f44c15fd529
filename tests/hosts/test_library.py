"""The shared library as a plugin sees it: its symbols, its header, the C example."""

import re
import subprocess
from pathlib import Path

import pytest

import fontana

ROOT = Path(__file__).parents[2]
PACKAGE = Path(fontana.__file__).parent


def library():
    found = sorted(PACKAGE.glob("libfontana.so.*")) or sorted(PACKAGE.glob("libfontana*.dylib"))
    assert found, f"no library beside the package in {PACKAGE}"
    return found[0]


def test_only_fontana_symbols_are_exported():
    listing = subprocess.run(["nm", "-D", "--defined-only", library()], capture_output=True, text=True, check=True)
    names = {line.split()[-1] for line in listing.stdout.splitlines()}
    foreign = {name for name in names if not name.startswith("fontana_")}
    assert names and not foreign, sorted(foreign)[:10]


def test_the_file_is_named_by_the_number_of_its_interface():
    """So that a plugin built against another one is refused as it is loaded, and does not read structs that differ."""
    header = (PACKAGE / "include" / "fontana.h").read_text(encoding="utf-8")
    number = re.search(r"^#define FONTANA_ABI_VERSION (\d+)$", header, re.MULTILINE)[1]
    dynamic = subprocess.run(["readelf", "-d", library()], capture_output=True, text=True, check=True).stdout
    assert f"[libfontana.so.{number}]" in dynamic
    assert library().name == f"libfontana.so.{number}"


def test_no_vendor_library_is_linked():
    needed = subprocess.run(["readelf", "-d", library()], capture_output=True, text=True, check=True).stdout
    assert "OpenCL" not in needed and "cuda" not in needed and "tbb" not in needed


@pytest.mark.parametrize("compiler", [["gcc", "-std=c11"], ["g++", "-std=c++17"]], ids=["C11", "C++17"])
def test_the_header_stands_alone(tmp_path, compiler):
    source = tmp_path / ("only_header.c" if compiler[0] == "gcc" else "only_header.cpp")
    source.write_text('#include "fontana.h"\nint main(void) { return fontana_abi_version() != FONTANA_ABI_VERSION; }\n')
    program = tmp_path / "only_header"
    warnings = ["-Wall", "-Wextra", "-pedantic", "-Werror"]
    folder = library().parent
    subprocess.run(
        [*compiler, *warnings, f"-I{PACKAGE / 'include'}", source, library(), f"-Wl,-rpath,{folder}", "-o", program],
        check=True,
    )
    subprocess.run([program], check=True)


def test_the_c_example_runs(tmp_path):
    program = tmp_path / "dam_break"
    subprocess.run(
        ["gcc", "-std=c11", "-Wall", "-Wextra", "-pedantic", "-Werror", f"-I{PACKAGE / 'include'}",
         ROOT / "examples" / "c" / "dam_break.c", library(), f"-Wl,-rpath,{library().parent}", "-lm", "-o", program],
        check=True,
    )  # fmt: skip
    result = subprocess.run([program], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    assert list(tmp_path.rglob("*.bgeo")), "the example writes a .bgeo"


def test_the_c_example_is_built_as_its_readme_says(tmp_path, native_build):
    """Its lines, with another folder in place of out/."""
    native_build("dam_break")
    lines = (ROOT / "examples" / "c" / "README.md").read_text(encoding="utf-8").split("```")[1]
    script = lines.replace("$PWD/out/c", str(tmp_path / "installed")).replace("out/dam_break", f"{tmp_path}/dam_break")
    script = script.replace("dam_break out\n", f"dam_break {tmp_path}\n")
    done = subprocess.run(["sh", "-e", "-c", script], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr
    assert len(list(tmp_path.glob("dam_break.*.bgeo"))) == 12
    assert (tmp_path / "installed" / "include" / "fontana.h").exists()
