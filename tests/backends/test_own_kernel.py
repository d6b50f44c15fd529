"""A kernel from outside the core through Backend::compile. Builds and runs own_kernel_test.cpp; ctest runs the same
program on the cpu backend under sanitizers.
"""

import subprocess


def test_a_kernel_from_outside_runs_on_every_backend(backend, native_build):
    result = subprocess.run([native_build("own_kernel_test"), backend], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
