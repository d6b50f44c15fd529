"""Two readers that are not ours read the .bgeo files we write: splashsurf's in Rust and its package's in Python."""

import gzip
import importlib
import json
import os
import subprocess
import sys

import numpy as np
import pytest

COUNT = 30000  # more than the writer puts into one block


def require(module: str):
    """Where CI is set nothing may be missing; on a developer's machine the test is skipped then."""
    return importlib.import_module(module) if os.environ.get("CI") else pytest.importorskip(module)


def splashsurf(*arguments) -> None:
    require("pysplashsurf")
    program = "import pysplashsurf, sys; sys.exit(pysplashsurf.run_pysplashsurf())"
    command = [sys.executable, "-c", program, *map(str, arguments)]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def sample_particles(count: int) -> dict[str, np.ndarray]:
    """SampleParticles of checks.h."""
    number = np.arange(count, dtype=np.float32)
    axis = np.array([1.0, 2.0, 3.0], dtype=np.float32)
    return {
        "P": axis + np.float32(0.125) * number[:, None],
        "v": axis - np.float32(0.25) * number[:, None],
        "id": np.arange(count, dtype=np.int32),
        "density": np.float32(1000.0) + number,
        "pressure": np.float32(-5.0) * number,
        "pscale": np.full(count, 0.01, dtype=np.float32),
        "mass": np.float32(0.001) * (number + np.float32(1.0)),
    }


@pytest.fixture
def write_frame(io_test, tmp_path):
    def write(count: int):
        path = tmp_path / "frame.0001.bgeo"
        subprocess.run([io_test, "write-bgeo", path, str(count)], check=True)
        return path

    return write


def test_splashsurf_reads_the_positions(write_frame, tmp_path):
    splashsurf("convert", "--particles", write_frame(COUNT), "-o", tmp_path / "frame.json")
    positions = np.array(json.loads((tmp_path / "frame.json").read_text()), dtype=np.float32)
    np.testing.assert_array_equal(positions, sample_particles(COUNT)["P"])


def test_splashsurf_makes_a_surface_and_carries_attributes_to_it(write_frame, tmp_path):
    surface = tmp_path / "surface.vtk"
    attributes = ["-a", "v", "-a", "density", "-a", "pressure", "-a", "pscale", "-a", "mass"]
    shape = ["--particle-radius", "0.1", "--smoothing-length", "2", "--cube-size", "1"]
    splashsurf("reconstruct", write_frame(50), "-o", surface, *shape, *attributes)
    mesh = require("meshio").read(surface)
    assert len(mesh.points) > 100
    for name, values in sample_particles(50).items():
        if name in ("P", "id"):  # positions became the surface; splashsurf does not interpolate integers
            continue
        # Interpolation stays within what it interpolates, but for the kernel's rounding.
        slack = 1e-3 * np.abs(values).max()
        assert mesh.point_data[name].min() >= values.min() - slack
        assert mesh.point_data[name].max() <= values.max() + slack


def test_the_reader_of_pysplashsurf_reads_every_attribute(write_frame, tmp_path):
    require("meshio")
    reader = require("pysplashsurf").bgeo
    packed = tmp_path / "packed.bgeo"  # that reader takes compressed files only
    packed.write_bytes(gzip.compress(write_frame(COUNT).read_bytes(), compresslevel=1))
    mesh = reader.readbgeo_to_meshio(packed)
    expected = sample_particles(COUNT)
    np.testing.assert_array_equal(mesh.points, expected.pop("P"))
    assert set(mesh.point_data) == set(expected)
    for name, values in expected.items():
        np.testing.assert_array_equal(mesh.point_data[name], values)
        assert mesh.point_data[name].dtype.kind == values.dtype.kind


def test_we_read_what_splashsurf_writes(write_frame, io_test, tmp_path):
    frame = write_frame(COUNT)
    packed, foreign = tmp_path / "packed.bgeo", tmp_path / "foreign.bgeo"
    splashsurf("convert", "--particles", frame, "-o", packed)
    refused = subprocess.run([io_test, "verify", packed], capture_output=True, text=True)
    assert refused.returncode == 1 and "compressed with gzip" in refused.stdout
    foreign.write_bytes(gzip.decompress(packed.read_bytes()))
    result = subprocess.run([io_test, "verify", foreign], capture_output=True, text=True)
    assert result.stdout == f"good {foreign} {COUNT}\n"
