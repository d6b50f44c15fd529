"""The OpenCL runtime that wheels carry: found where the system has none, out of the way where it has one."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from fontana.opencl_runtime import wheel_environment

LIST_DEVICES = """
import json, fontana
print(json.dumps([[d.name, d.driver, d.available, d.reason] for d in fontana.devices() if d.backend == "opencl"]))
"""


@pytest.fixture
def wheels(tmp_path) -> Path:
    """A folder laid out like the installed wheels."""
    libraries = tmp_path / "pyopencl" / ".libs"
    libraries.mkdir(parents=True)
    for name in ("libOpenCL-5519dec5.so.1.0.0", "libpocl-21062cec.so", "pocl.icd"):
        (libraries / name).touch()
    return tmp_path / "pyopencl"


def loader_of(folder):
    return str(folder / ".libs" / "libOpenCL-5519dec5.so.1.0.0")


def driver_of(folder):
    return str(folder / ".libs" / "libpocl-21062cec.so")


def test_without_a_system_runtime_all_comes_from_the_wheels(wheels):
    expected = {
        "FONTANA_OPENCL_LIBRARY": loader_of(wheels),
        "PYOPENCL_HOME": str(wheels),
        "OCL_ICD_VENDORS": driver_of(wheels),
    }
    assert wheel_environment(wheels, {}, has_system_loader=False, has_system_driver=False) == expected
    assert wheel_environment(wheels, {}, has_system_loader=True, has_system_driver=False) == expected


def test_a_system_runtime_is_left_alone(wheels):
    assert wheel_environment(wheels, {}, has_system_loader=True, has_system_driver=True) == {}


def test_a_system_driver_without_a_loader_gets_the_loader_only(wheels):
    found = wheel_environment(wheels, {}, has_system_loader=False, has_system_driver=True)
    assert found == {"FONTANA_OPENCL_LIBRARY": loader_of(wheels), "PYOPENCL_HOME": str(wheels)}


@pytest.mark.parametrize("name", ["OCL_ICD_VENDORS", "OCL_ICD_FILENAMES", "OPENCL_VENDOR_PATH"])
def test_the_users_choice_of_driver_stays(wheels, name):
    chosen = {name: "/opt/driver.so"}
    assert wheel_environment(wheels, chosen, has_system_loader=True, has_system_driver=False) == {}
    found = wheel_environment(wheels, chosen, has_system_loader=False, has_system_driver=False)
    assert found.keys() == {"FONTANA_OPENCL_LIBRARY", "PYOPENCL_HOME"}


def test_the_users_choice_of_loader_stays(wheels):
    chosen = {"FONTANA_OPENCL_LIBRARY": "/opt/libOpenCL.so"}
    assert wheel_environment(wheels, chosen, has_system_loader=False, has_system_driver=False) == {}


def test_a_user_who_chooses_the_loader_of_the_wheel_gets_what_it_needs(wheels):
    chosen = {"FONTANA_OPENCL_LIBRARY": loader_of(wheels)}
    found = wheel_environment(wheels, chosen, has_system_loader=True, has_system_driver=False)
    assert found == {"PYOPENCL_HOME": str(wheels), "OCL_ICD_VENDORS": driver_of(wheels)}


def test_pyopencl_without_libraries_inside_changes_nothing(tmp_path):
    assert wheel_environment(tmp_path, {}, has_system_loader=False, has_system_driver=False) == {}


def list_devices(**environment):
    """The OpenCL rows of the list of devices, in a process with these variables; None takes one away."""
    variables = {name: value for name, value in (os.environ | environment).items() if value is not None}
    command = [sys.executable, "-c", LIST_DEVICES]
    result = subprocess.run(command, env=variables, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


@pytest.fixture
def installed_wheels() -> Path:
    spec = importlib.util.find_spec("pyopencl")
    folder = Path(spec.origin).parent if spec else None
    if folder is None or not list((folder / ".libs").glob("libpocl*")):
        reason = "the wheels pyopencl and pocl-binary-distribution are not installed (pip install 'fontana[opencl]')"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    return folder


def test_the_runtime_of_the_wheels_has_a_device(installed_wheels):
    """As on a machine whose system has no OpenCL."""
    found = wheel_environment(installed_wheels, {}, has_system_loader=False, has_system_driver=False)
    ((name, driver, available, reason),) = list_devices(**found)
    assert "Portable Computing Language" in driver
    assert available, reason


def test_pocl_without_a_linker_is_unavailable_and_says_why(installed_wheels):
    """It would end the process at the first kernel."""
    found = wheel_environment(installed_wheels, {}, has_system_loader=False, has_system_driver=False)
    ((name, driver, available, reason),) = list_devices(**found, PATH="/none")
    assert not available
    assert "linker 'ld'" in reason


def test_a_library_that_is_none_is_a_sentence():
    ((name, driver, available, reason),) = list_devices(FONTANA_OPENCL_LIBRARY="/none/libOpenCL.so")
    assert not available
    assert reason.startswith("FONTANA_OPENCL_LIBRARY is '/none/libOpenCL.so', which cannot be used (")


def test_a_library_without_opencl_in_it_is_a_sentence(fault_layer):
    ((name, driver, available, reason),) = list_devices(FONTANA_OPENCL_LIBRARY=str(fault_layer))
    assert not available
    assert "has no function clGetPlatformIDs" in reason


def test_the_loader_of_the_wheel_without_its_variable_is_a_sentence():
    """It would crash. This is for hosts without Python, where nothing sets the variable."""
    environment = {"FONTANA_OPENCL_LIBRARY": "/elsewhere/pyopencl/.libs/libOpenCL.so", "PYOPENCL_HOME": None}
    ((name, driver, available, reason),) = list_devices(**environment)
    assert not available
    assert "crashes unless PYOPENCL_HOME names" in reason
