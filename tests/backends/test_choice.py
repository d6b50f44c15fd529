"""Which device a word of solver.backend stands for, as it is told beforehand and as it is taken."""

import pytest

from fontana import _core
from fontana.tables import parameters


def test_the_device_that_is_told_is_the_one_that_starts(backend, make_simulation):
    for word in (backend, "auto"):
        told, started = _core.choose_device(word), make_simulation(word).device()
        assert (told.backend, told.name, told.driver) == (started.backend, started.name, started.driver)


def test_auto_is_the_first_gpu_else_the_cpu(backend):
    gpus = [device for device in _core.devices() if device.available and device.is_gpu]
    assert _core.choose_device("auto").backend == (gpus[0].backend if gpus else "cpu")
    if backend == "cuda":
        assert gpus, "the stand-in is one"


@pytest.mark.parametrize("word", [word for word in parameters()["solver.backend"].choices if word != "auto"])
def test_a_backend_without_a_device_is_told_with_the_reason(word):
    chosen = _core.choose_device(word)
    assert chosen.backend == word
    assert chosen.available == any(device.available for device in _core.devices() if device.backend == word)
    assert chosen.available or chosen.reason
