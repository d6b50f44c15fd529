"""What the user can ask of the viewer, without a window: the model, the hand, the keys, the places of the panels."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from small_scenes import DROP

from fontana import _core
from fontana.gl.camera import Camera
from fontana.scene import load_scene
from fontana.tables import parameters
from fontana.viewer.bounds import worth_seeing
from fontana.viewer.grip import Grip
from fontana.viewer.keys import KEYS, MOUSE
from fontana.viewer.layout import Layout
from fontana.viewer.live import LiveSource
from fontana.viewer.model import ViewerModel
from fontana.viewer.rates import SchemeRates
from fontana.viewer.settings import Settings
from fontana.viewer.value_range import steady_range


@pytest.fixture
def model():
    """Of the drop, paused before its first frame."""
    source = LiveSource(load_scene(DROP, {"solver.backend": "cpu"}), is_playing=False)
    yield ViewerModel(source)
    source.close()


# ---- model


def test_every_key_has_its_action_and_its_own_name():
    assert len({key.name for key in KEYS}) == len(KEYS)
    assert [key.action for key in KEYS if not callable(getattr(ViewerModel, key.action, None))] == []


def test_speeds_and_the_cap_of_the_thesis(model):
    assert model.source.frames_per_second == pytest.approx(24.0)
    model.faster()
    assert model.source.frames_per_second == pytest.approx(48.0)
    model.set_capped(True)
    assert model.source.frames_per_second == 24.0
    for _ in range(9):
        model.faster()
    assert math.isinf(model.speed)
    model.set_capped(False)
    assert math.isinf(model.source.frames_per_second)
    for _ in range(9):
        model.slower()
    assert model.source.frames_per_second == pytest.approx(3.0)


def test_a_refused_value_becomes_a_message(model):
    model.set("fluid.viscosity", -1.0)
    assert "fluid.viscosity" in model.messages.current()[0].text
    assert model.messages.current()[0].is_error
    model.set_collider(1, "elasticity", 2.0)
    assert "elasticity" in model.messages.current()[1].text


def neighbors_by_key(model, backend, method):
    """The schemes that N steps through until it is back where it began."""
    for path, word in (("solver.backend", backend), ("fluid.method", method), ("solver.neighbors", "grid")):
        model.set(path, word)
    seen = []
    while not seen or seen[-1] != "grid":
        model.next_neighbors()
        seen.append(model.source.settings.get("solver.neighbors"))
    return seen


def test_a_key_goes_round_the_schemes(model, opencl_device):
    assert neighbors_by_key(model, "cpu", "mueller") == ["all-pairs", "grid"]
    assert model.absent_choices("solver.neighbors") == {"tiles": "cpu has grid and all-pairs"}
    assert neighbors_by_key(model, "opencl", "mueller") == ["tiles", "all-pairs", "grid"]
    assert model.absent_choices("solver.neighbors") == {}
    assert neighbors_by_key(model, "opencl", "dfsph") == ["all-pairs", "grid"]
    assert "choice of fluid.method=mueller" in model.absent_choices("solver.neighbors")["tiles"]
    chosen = _core.choose_device("auto")
    assert ("tiles" in neighbors_by_key(model, "auto", "mueller")) == ("tiles" in chosen.neighbors)


def test_a_key_leaves_a_scheme_that_is_not_here(model):
    model.source.settings.set("solver.neighbors", "tiles")  # as a scene may say
    model.next_neighbors()
    assert model.source.settings.get("solver.neighbors") == "all-pairs"


def test_a_key_goes_round_the_backends_that_are_here(model):
    here = {device.backend for device in _core.devices() if device.available}
    assert set(model.absent_choices("solver.backend")) == set(parameters()["solver.backend"].choices) - here - {"auto"}
    seen = []
    for _ in range(len(here) + 1):
        model.next_backend()
        seen.append(model.source.settings.get("solver.backend"))
    assert sorted(seen) == sorted(here | {"auto"})
    model.source.settings.set("solver.backend", "cuda")  # as a scene may say
    model.next_backend()
    assert model.source.settings.get("solver.backend") in here | {"auto"}


def test_colliders_that_are_hidden_are_not_drawn(model):
    version = model.stage_version
    model.toggle_colliders()
    assert model.colliders == []
    assert model.stage_version > version


def test_a_cache_is_not_pushed_or_switched(drop_cache, play):
    model = ViewerModel(play(drop_cache))
    model.take((10, 10), (100, 100))
    model.next_backend()
    assert model.grip.centre is None
    assert len(model.messages.current()) == 2


def test_the_documents_have_every_key():
    text = (Path(__file__).parents[2] / "docs" / "viewing.md").read_text(encoding="utf-8")
    assert [key for key in KEYS if f"| `{key.shown}` | {key.what} |" not in text] == []
    assert [row for row in MOUSE if "| {} | {} |".format(*row) not in text] == []


# ---- settings


def test_settings_know_what_was_changed():
    settings = Settings(load_scene(DROP))
    settings.set("fluid.viscosity", 7.0)
    settings.set_collider(1, "radius", 0.2)
    assert settings.changes() == {"fluid.viscosity": 7.0}
    assert settings.is_collider_changed(1)
    built = settings.build()
    assert built.get("fluid.viscosity") == 7.0
    assert built.collider_centre(1, 0.0) == pytest.approx((0.3, 0.1, 0.0)), "the keys of the scene are kept"
    settings.set("fluid.viscosity", settings.original("fluid.viscosity"))
    assert settings.changes() == {}


# ---- the hand


CAMERA = Camera.looking((0, 0, 5), (0, 0, 0), 40)
SIZE = (200, 100)


def dragged(*pixels, position=((0.0, 0.0, 1.0), (0.0, 0.0, -1.0)), spacing=0.1):
    """A hand that went down at the first pixel and was dragged along the others."""
    grip = Grip(strength=60.0, spacings=5.0)
    grip.take(*CAMERA.ray(pixels[0], SIZE), np.array(position), spacing)
    for pixel in pixels[1:]:
        grip.move(*CAMERA.ray(pixel, SIZE), CAMERA)
    return grip


def test_the_hand_goes_to_the_particle_in_front():
    grip = dragged((100, 50))
    assert grip.centre == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    assert grip.push().acceleration == (0.0, 0.0, 0.0)
    assert grip.push().radius == pytest.approx(0.5)


def test_it_pushes_where_it_is_dragged_with_its_whole_strength_at_most():
    right = dragged((100, 50), (130, 50)).push()
    assert right.acceleration == pytest.approx((60.0, 0.0, 0.0), abs=1e-3)
    up = dragged((100, 50), (100, 20)).push()
    assert up.acceleration == pytest.approx((0.0, 60.0, 0.0), abs=1e-3)
    little = dragged((100, 50), (103, 50)).push()
    assert 0.0 < little.acceleration[0] < 60.0


def test_a_hand_that_turns_pushes_where_it_goes_now():
    push = dragged((100, 50), (130, 50), (130, 45), (130, 40), (130, 30), (130, 20), (130, 10)).push()
    assert push.acceleration[1] > 50.0
    assert abs(push.acceleration[0]) < 20.0


def test_without_particles_there_is_nothing_to_push():
    grip = dragged((100, 50), (120, 50), position=np.zeros((0, 3)))
    assert grip.centre is None
    assert grip.push() is None


# ---- numbers and places


def test_ends_of_the_colours_are_round_and_steady():
    first = steady_range(None, (0.0, 3.3))
    assert first == (0.0, 4.0)
    assert steady_range(first, (0.0, 2.0)) == first
    assert steady_range(first, (0.0, 4.1)) == pytest.approx((0.0, 6.0))
    assert steady_range(first, (0.0, 0.5)) == pytest.approx((0.0, 0.6))
    assert steady_range(None, (999.7, 1013.0)) == pytest.approx((995.0, 1015.0))
    low, high = steady_range(None, (1000.0, 1000.0))
    assert low <= 1000.0 <= high
    assert steady_range(None, (math.nan, 1.0)) == (0.0, 1.0)


@pytest.mark.parametrize("size", [(1280, 720), (1920, 1080), (640, 400), (200, 100), (1, 1)])
@pytest.mark.parametrize("has_panel", [True, False])
def test_panels_never_overlap(size, has_panel):
    layout = Layout(*size, 15.0, has_panel)
    boxes = [layout.panel, layout.view, layout.transport]
    assert all(box.width >= 0 and box.height >= 0 for box in boxes)
    for first in boxes:
        for second in boxes:
            apart = (
                first.x + first.width <= second.x
                or second.x + second.width <= first.x
                or first.y + first.height <= second.y
                or second.y + second.height <= first.y
            )
            assert first is second or apart or min(size) < 60


def test_rates_count_the_frames_of_one_streak():
    rates = SchemeRates()
    for k in range(13):
        rates.note("cpu grid", 100.0 + 0.1 * k, 0.05, 500)
    assert rates.by_scheme["cpu grid"].frames_per_second == pytest.approx(10.0)
    rates.note("opencl grid", 105.0, 0.25, 500)
    assert rates.by_scheme["opencl grid"].frames_per_second == pytest.approx(4.0)
    rates.note("cpu grid", 109.0, 0.05, 600)
    assert rates.by_scheme["cpu grid"].frames_per_second == pytest.approx(20.0)
    assert rates.by_scheme["cpu grid"].particle_count == 600


def test_emitters_and_colliders_are_worth_seeing_before_there_is_fluid():
    low, high = worth_seeing(load_scene(DROP), np.zeros((0, 3)))
    assert (low <= [-0.14, 0.01, -0.14]).all()
    assert (high >= [0.14, 0.44, 0.14]).all()
