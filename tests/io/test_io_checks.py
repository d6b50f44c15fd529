"""The C++ checks of io; under sanitizers ctest runs them (preset asan)."""

import subprocess


def test_checks(io_test):
    result = subprocess.run([io_test], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
