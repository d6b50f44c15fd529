"""The C++ checks of io, as they are and under the sanitizers."""

import subprocess


def assert_passes(program):
    result = subprocess.run([program], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def test_checks(io_test):
    assert_passes(io_test)


def test_checks_with_address_and_undefined_behaviour_sanitizers(io_test_sanitized):
    assert_passes(io_test_sanitized)
