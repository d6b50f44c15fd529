"""The CUDA driver and NVRTC: found where they are, a sentence where they are not. NVRTC may come in a wheel."""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
import stand_in

from fontana.cuda_runtime import wheel_environment

ROOT = Path(__file__).parents[2]

LIST_DEVICES = """
import json, fontana
print(json.dumps([[d.name, d.driver, d.available, d.reason] for d in fontana.devices() if d.backend == "cuda"]))
"""


@pytest.fixture
def wheels(tmp_path) -> Path:
    """A folder laid out like nvidia-cuda-nvrtc-cu12 and nvidia-cuda-nvrtc of CUDA 13 side by side."""
    for folder, version in (("cuda_nvrtc", "12"), ("cu13", "13")):
        libraries = tmp_path / "nvidia" / folder / "lib"
        libraries.mkdir(parents=True)
        (libraries / f"libnvrtc.so.{version}").touch()
        (libraries / f"libnvrtc-builtins.so.{version}.1").touch()
    return tmp_path / "nvidia"


def test_without_a_system_library_the_oldest_wheel_is_taken(wheels):
    expected = {"FONTANA_NVRTC_LIBRARY": str(wheels / "cuda_nvrtc/lib/libnvrtc.so.12")}
    assert wheel_environment([wheels], {}, has_system_library=False) == expected
    assert wheel_environment([wheels.parent, wheels], {"FONTANA_NVRTC_LIBRARY": ""}, False) == expected


def test_a_later_wheel_alone_is_found_too(wheels):
    (wheels / "cuda_nvrtc/lib/libnvrtc.so.12").unlink()
    found = wheel_environment([wheels], {}, has_system_library=False)
    assert found == {"FONTANA_NVRTC_LIBRARY": str(wheels / "cu13/lib/libnvrtc.so.13")}


def test_a_system_library_and_the_users_choice_are_left_alone(wheels):
    assert wheel_environment([wheels], {}, has_system_library=True) == {}
    assert wheel_environment([wheels], {"FONTANA_NVRTC_LIBRARY": "/opt/libnvrtc.so"}, has_system_library=False) == {}


def test_without_wheels_nothing_changes(tmp_path):
    assert wheel_environment([], {}, has_system_library=False) == {}
    assert wheel_environment([tmp_path], {}, has_system_library=False) == {}


def list_devices(**environment):
    """The CUDA rows of the list of devices, in a process with these variables."""
    variables = os.environ | environment
    result = subprocess.run([sys.executable, "-c", LIST_DEVICES], env=variables, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


def test_a_driver_that_is_none_is_a_sentence():
    ((name, driver, available, reason),) = list_devices(FONTANA_CUDA_LIBRARY="/none/libcuda.so.1")
    assert not available
    assert reason.startswith("FONTANA_CUDA_LIBRARY is '/none/libcuda.so.1', which cannot be used (")
    assert reason.endswith("): unset it, or give the path of a libcuda.so.1")


def test_a_driver_without_cuda_in_it_is_a_sentence():
    ((name, driver, available, reason),) = list_devices(FONTANA_CUDA_LIBRARY="libm.so.6")
    assert not available
    assert "it has no function cuInit, which CUDA 11.2 has" in reason


@pytest.mark.parametrize("library", ["/none/libnvrtc.so.12", "libm.so.6"])
def test_a_compiler_that_is_none_is_a_sentence(library):
    ((name, driver, available, reason),) = list_devices(**stand_in.environment(), FONTANA_NVRTC_LIBRARY=library)
    assert not available
    assert reason.startswith(f"FONTANA_NVRTC_LIBRARY is '{library}', which cannot be used (")


def test_a_machine_without_a_compiler_is_told_what_to_install():
    """As a host without Python sees it, where no wheel is looked for."""
    names = ("libnvrtc.so.13", "libnvrtc.so.12", "libnvrtc.so.11.2", "libnvrtc.so")
    found = subprocess.run(["ldconfig", "-p"], capture_output=True, text=True).stdout
    if any(f"{name} " in found for name in names):
        pytest.skip("the system has NVRTC")
    hidden = "import os, fontana; os.environ.pop('FONTANA_NVRTC_LIBRARY', None)\n"
    result = subprocess.run(
        [sys.executable, "-c", hidden + LIST_DEVICES],
        env=os.environ | stand_in.environment(),
        capture_output=True,
        text=True,
    )
    assert result.returncode == 0, result.stderr
    ((name, driver, available, reason),) = json.loads(result.stdout)
    assert not available
    assert reason.startswith("no NVRTC, which compiles the kernels (libnvrtc.so.13")
    assert reason.endswith("): pip install nvidia-cuda-nvrtc-cu12")


def test_the_installed_wheel_is_found():
    spec = importlib.util.find_spec("nvidia")
    folders = [Path(place) for place in spec.submodule_search_locations] if spec else []
    found = wheel_environment(folders, {}, has_system_library=False)
    if not found:
        reason = "the wheel nvidia-cuda-nvrtc-cu12 is not installed (pip install 'fontana[cuda]')"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    ((name, driver, available, reason),) = list_devices(**stand_in.environment(), **found)
    assert available, reason
    assert "compute capability 7.5, NVRTC 1" in driver


def test_the_makers_headers_declare_the_same(tmp_path):
    """Our own declarations against cuda.h and nvrtc.h, which come in the wheels nvidia-cuda-runtime-cu12 and
    nvidia-cuda-nvrtc-cu12. They are not needed to build: this is what keeps that safe."""
    spec = importlib.util.find_spec("nvidia")
    folders = [Path(place) for place in spec.submodule_search_locations] if spec else []
    places = {
        header: next((path.parent for folder in folders for path in folder.glob(f"{package}/include/{header}")), None)
        for package, header in (("cuda_runtime", "cuda.h"), ("cuda_nvrtc", "nvrtc.h"))
    }
    missing = [header for header, place in places.items() if place is None]
    if missing:
        reason = f"{' and '.join(missing)} not found (pip install 'fontana[test]')"
        if os.environ.get("CI") == "true":
            pytest.fail(reason)
        pytest.skip(reason)
    includes = [f"-I{place}" for place in places.values()] + [f"-I{ROOT / 'src' / 'fontana'}"]
    source = Path(__file__).with_name("cuda_declarations.cpp")
    command = [os.environ.get("CXX", "g++"), "-std=c++17", "-fsyntax-only", *includes, source]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
