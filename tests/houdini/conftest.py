"""The double of `hou` in place of Houdini's module, for tests that ask for it."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent


@pytest.fixture
def hou(monkeypatch):
    """The double, fresh for each test. It is not Houdini; see hou_double.py."""
    specification = importlib.util.spec_from_file_location("hou", HERE / "hou_double.py")
    module = importlib.util.module_from_spec(specification)
    monkeypatch.setitem(sys.modules, "hou", module)
    specification.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def panels(native_build) -> dict[str, dict]:
    """Label, icon and parameters of each operator, as the plugin gives them to the double of the HDK."""
    program, plugin = native_build("fontana_houdini_panels"), native_build("fontana_houdini")
    done = subprocess.run([program, plugin], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
