"""The walk through docs/template.md as a new user would take it, on the double of the HDK."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TEMPLATE = ROOT / "houdini" / "template"
PAGE = (ROOT / "docs" / "template.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A folder after the commands of the page: a checkout, and beside it the renamed copy, built and tested."""
    folder = tmp_path_factory.mktemp("walk")
    (folder / "fontana").symlink_to(ROOT)
    commands = re.search(r"^```bash\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)[1]
    done = subprocess.run(["bash", "-euc", commands], cwd=folder, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    assert "100% tests passed" in done.stdout
    return folder / "twist"


def test_the_commands_of_the_page_work(copy):
    assert (copy / "build" / "SOP_Twist.so").exists()


def test_nothing_of_the_old_name_is_left(copy):
    files = [path for path in copy.rglob("*") if path.is_file() and "build" not in path.relative_to(copy).parts]
    assert len(files) == len([path for path in TEMPLATE.rglob("*") if path.is_file()])
    assert not [path for path in files if "swirl" in str(path.relative_to(copy)).lower()]
    assert not [path for path in files if "swirl" in path.read_text(encoding="utf-8").lower()]


def test_the_copy_runs_on_every_backend(copy, backend):
    program, plugin = copy / "build" / "twist_test", copy / "build" / "SOP_Twist.so"
    done = subprocess.run([program, plugin, backend], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_plugin_shows_houdini_its_entry_point_alone(copy):
    listed = subprocess.run(
        ["nm", "-D", "--defined-only", copy / "build" / "SOP_Twist.so"], capture_output=True, text=True
    )
    names = {line.split()[-1] for line in listed.stdout.splitlines()}
    # What UT_DSOVersion.h defines is Houdini's affair.
    assert {name for name in names if not name.startswith("Houdini")} == {"newSopOperator"}


def test_every_parameter_of_the_panel_is_in_the_help():
    panel = re.findall(r'^ +name +"(\w+)"$', (TEMPLATE / "SOP_Swirl.cpp").read_text(encoding="utf-8"), re.MULTILINE)
    page = (TEMPLATE / "help/nodes/sop/template--swirl-1.0.txt").read_text(encoding="utf-8")
    assert len(panel) == 5
    assert re.findall(r"^    #id: (\w+)$", page, re.MULTILINE) == panel


def test_every_file_of_the_template_is_on_the_page():
    for file in TEMPLATE.iterdir():
        assert f"`{file.name}" in PAGE or f"`{file.with_suffix('.cpp').name}`" in PAGE, file.name
