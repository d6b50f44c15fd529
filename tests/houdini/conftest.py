"""The double of `hou` in place of Houdini's module, for tests that ask for it."""

import importlib.util
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
