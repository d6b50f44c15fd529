"""The viewer in a real window on a virtual screen, worked with mouse and keys."""

from __future__ import annotations

import resource
import time

import numpy as np
import pytest
from small_scenes import DROP
from virtual_screen import virtual_screen

from fontana.scene import load_scene
from fontana.tables import parameters
from fontana.viewer.player import CachePlayer

SIZE = (680, 270)  # few pixels: the renderer on the CPU takes its time for each
TALL = (680, 640)  # for all of the panel
PATIENCE = 60.0  # s


@pytest.fixture(scope="module")
def screen():
    yield from virtual_screen()


class Desk:
    """A viewer that is open, and who sits in front of it."""

    def __init__(self, source, screen, folder, size):
        from fontana.viewer.glfw_window import GlfwWindow
        from fontana.viewer.model import ViewerModel
        from fontana.viewer.window import ViewerWindow

        self.source, self.screen = source, screen
        self.window = GlfwWindow("viewer", size)
        self.model = ViewerModel(source)
        self.viewer = ViewerWindow(self.model, self.window)
        self.viewer.capture.folder = folder
        self.wait(lambda: self.model.snapshot is not None)
        self.do("search", "--name", "^viewer$", "windowfocus", "--sync")

    def turn(self, count=1):
        for _ in range(count):
            self.viewer.turn()

    def wait(self, condition):
        """Turns until it holds."""
        end = time.monotonic() + PATIENCE
        while not condition():
            assert time.monotonic() < end, "it took too long"
            self.turn()

    def do(self, *words):
        self.screen.do(*words)
        self.turn(3)

    def press(self, key):
        self.do("key", key)

    def drag(self, button, start, end, release=True):
        """In pixels of the window."""
        self.do("mousemove", *start)
        self.do("mousedown", button)
        for share in (0.25, 0.5, 0.75, 1.0):
            self.do("mousemove", *(round(a + share * (b - a)) for a, b in zip(start, end, strict=True)))
        if release:
            self.do("mouseup", button)

    def image(self):
        """What the window shows, (height, width, 3)."""
        shots = []
        self.model.ask_for_window_shot()
        write = self.viewer.capture._write_screenshot
        self.viewer.capture._write_screenshot = lambda image: shots.append(np.array(image, dtype=np.int16))
        self.turn()
        self.viewer.capture._write_screenshot = write
        return shots[0]

    def close(self):
        self.viewer.close()
        self.window.close()
        self.source.close()


@pytest.fixture
def sit_down(screen, monkeypatch, tmp_path):
    """Opens a viewer of a scene or a cache; at the end all are closed."""
    for name, value in screen.environment.items():
        monkeypatch.setenv(name, value)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    for name in ("capture._SCREENSHOT_SAMPLES", "picture._SAMPLES"):
        monkeypatch.setattr(f"fontana.viewer.{name}", 1)
    desks = []

    def open_desk(source=None, size=SIZE, **overrides):
        from fontana.viewer.live import LiveSource

        changes = {name.replace("__", "."): value for name, value in overrides.items()}
        source = source or LiveSource(load_scene(DROP, {"solver.backend": "cpu"} | changes), is_playing=False)
        desks.append(Desk(source, screen, tmp_path, size))
        return desks[-1]

    yield open_desk
    for desk in desks:
        desk.close()


def step(desk, count=1):
    number = desk.model.snapshot.number + count
    desk.source.step(count)
    desk.wait(lambda: desk.model.snapshot.number == number)
    desk.turn(2)


def test_it_plays_and_pauses_by_key(sit_down):
    desk = sit_down()
    desk.press("space")
    desk.wait(lambda: desk.model.snapshot.number >= 3)
    desk.press("space")
    assert not desk.source.is_playing
    desk.wait(lambda: desk.source.fraction is None)
    number = desk.model.snapshot.number
    desk.press("Right")
    desk.wait(lambda: desk.model.snapshot.number == number + 1)
    desk.press("r")
    desk.wait(lambda: desk.model.snapshot.number == 0)


def test_the_mouse_orbits_pans_and_zooms(sit_down):
    desk = sit_down()
    camera = desk.model.camera
    azimuth, elevation, distance, target = camera.azimuth, camera.elevation, camera.distance, camera.target.copy()
    desk.drag(1, (450, 100), (500, 130))
    assert camera.azimuth != azimuth
    assert camera.elevation > elevation
    desk.do("click", 4)
    assert camera.distance < distance
    desk.drag(2, (450, 100), (500, 130))
    assert not np.allclose(camera.target, target)
    desk.press("v")
    assert desk.model.camera.azimuth == pytest.approx(azimuth)


def test_the_panels_keep_the_mouse_to_themselves(sit_down):
    desk = sit_down()
    azimuth, elevation = desk.model.camera.azimuth, desk.model.camera.elevation
    desk.drag(1, (60, 200), (90, 230))
    assert (desk.model.camera.azimuth, desk.model.camera.elevation) == (azimuth, elevation)


def test_a_drag_with_the_right_button_pushes_the_fluid(sit_down):
    desk = sit_down(forces__gravity=[0, 0, 0])
    step(desk)
    desk.model.grip.strength = 200.0
    pixels, _ = desk.model.camera.project(desk.model.snapshot.data.position, picture_size(desk))
    left, top = place_of_picture(desk)
    start = tuple(np.rint(pixels.mean(axis=0) + (left, top)).astype(int))
    desk.drag(3, start, (start[0] + 40, start[1]), release=False)
    assert desk.model.grip.centre is not None
    step(desk, 2)
    across = desk.model.snapshot.data.velocity @ desk.model.camera.right
    assert across.max() > 0.5
    desk.do("mouseup", 3)
    assert desk.model.grip.centre is None
    assert desk.source._orders.push is None


def place_of_picture(desk):
    from imgui_bundle import imgui

    from fontana.viewer.layout import Layout

    view = Layout(*SIZE, imgui.get_font_size(), desk.model.shows_panel).view
    return view.x, view.y


def picture_size(desk):
    return desk.viewer.picture._texture.size


def place_of_field(desk, monkeypatch, text):
    """A point in the widget beside a label of the panel."""
    from imgui_bundle import imgui

    from fontana.viewer import fields

    places = {}
    label = fields.label

    def noticing(text, *rest):
        label(text, *rest)
        places[text] = imgui.get_cursor_screen_pos()

    with monkeypatch.context() as patch:
        patch.setattr(fields, "label", noticing)
        desk.turn(2)
    return round(places[text].x + 40), round(places[text].y + 8)


def test_a_number_is_typed_into_the_panel(sit_down, monkeypatch):
    """Ctrl and a click on the field, the digits, Return."""
    desk = sit_down(size=TALL)
    for text, expected in (("12.5", 12.5), ("0.25", 0.25)):
        desk.do("mousemove", *place_of_field(desk, monkeypatch, "Rest density"))
        desk.do("keydown", "ctrl", "click", 1, "keyup", "ctrl")
        desk.do("key", "ctrl+a", "type", "--delay", 30, text)
        desk.press("Return")
        assert desk.source.settings.get("fluid.rest_density") == expected
    assert desk.source.is_playing is False, "what is typed into a field is no key of the viewer"


def test_the_panel_takes_only_backends_that_are_here(sit_down, monkeypatch):
    """The list is opened with the mouse; a click on each of its words does what it says, or nothing."""
    from imgui_bundle import imgui

    places = {}
    selectable = imgui.selectable

    def noticing(word, *rest):
        result = selectable(word, *rest)
        low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
        places[word] = (round(low.x + 12), round(0.5 * (low.y + high.y)))
        return result

    desk = sit_down(size=TALL)
    monkeypatch.setattr(imgui, "selectable", noticing)
    for word in parameters()["solver.backend"].choices:
        field = place_of_field(desk, monkeypatch, "Backend")
        desk.do("mousemove", *field, "click", 1)
        desk.turn(3)
        desk.do("mousemove", *places[word], "click", 1)
        is_here = word not in desk.model.absent_choices("solver.backend")
        assert (desk.source.settings.get("solver.backend") == word) == is_here, word
        if not is_here:  # the list is still open
            desk.do("mousemove", *field, "click", 1)


def test_backends_and_schemes_are_switched_by_key(sit_down, opencl_device):
    desk = sit_down()
    desk.press("space")
    desk.wait(lambda: desk.model.snapshot.scheme == "cpu grid")
    while desk.source.settings.get("solver.neighbors") != "all-pairs":
        desk.press("n")
    desk.wait(lambda: desk.model.snapshot.scheme == "cpu all-pairs")
    while desk.source.settings.get("solver.backend") != "opencl":
        desk.press("b")
    desk.wait(lambda: desk.model.snapshot.scheme == "opencl all-pairs")
    assert len(desk.source.rates.by_scheme) == 3


def test_the_picture_is_that_of_the_renderer_without_a_window(sit_down):
    """Particles in their colours, the collider and the light: a second context draws the same."""
    from dataclasses import replace

    from fontana.gl.context import create_headless_context
    from fontana.gl.renderer import Renderer

    desk = sit_down()
    step(desk, 2)
    size = (320, 240)
    found = desk.viewer.picture.image(desk.model, size).astype(int)
    context = create_headless_context()
    renderer = Renderer(context)
    renderer.set_stage(desk.model.colliders, desk.viewer.picture._bounds)
    renderer.set_frame(desk.model.snapshot.data)
    expected = renderer.image(desk.model.camera, size, replace(desk.model.look, color_range=desk.model.color_range()))
    context.release()
    assert np.abs(found - expected).mean() < 1.0


def test_looks_are_changed_by_key(sit_down):
    desk = sit_down()
    step(desk, 2)
    images = [desk.image()]
    for key in ("c", "k", "Tab", "i", "question", "2"):
        desk.press(key)
        desk.wait(lambda: desk.viewer.picture.is_final)
        desk.turn(2)
        images.append(desk.image())
        assert np.abs(images[-1] - images[-2]).max() > 50, key
    assert desk.model.look.style == "fluid"
    assert desk.model.look.color_by == "density"


def test_a_screenshot_is_what_one_sees(sit_down, tmp_path):
    from PIL import Image

    desk = sit_down()
    step(desk, 2)
    desk.wait(lambda: desk.viewer.picture.is_final)
    desk.press("i")  # what lies over the picture is not in its file
    desk.press("p")
    desk.press("s")
    desk.wait(lambda: len(list(tmp_path.glob("*.png"))) == 2)
    window = np.asarray(Image.open(tmp_path / "drop.view.0001.png"), dtype=int)
    picture = np.asarray(Image.open(tmp_path / "drop.view.0002.png"), dtype=int)
    assert window.shape == (SIZE[1], SIZE[0], 3)
    assert picture.shape[:2] == picture_size(desk)[::-1]
    left, top = map(int, place_of_picture(desk))
    middle = (slice(20, 115), slice(40, 200))  # above the legend
    seen = window[top : top + picture.shape[0], left : left + picture.shape[1]]
    assert np.abs(seen[middle] - picture[middle]).mean() < 1.0
    assert "drop.view.0001.png" in desk.model.messages.history[0]


def test_a_movie_has_the_frames_that_were_shown(sit_down, tmp_path):
    from imageio_ffmpeg import count_frames_and_secs

    desk = sit_down()
    step(desk)
    desk.press("m")
    step(desk)
    step(desk)
    desk.press("m")
    path = tmp_path / "drop.view.0001.mp4"
    desk.wait(path.exists)
    frames, seconds = count_frames_and_secs(str(path))
    assert frames == 3
    assert seconds == pytest.approx(3 / 24, abs=0.03)
    assert [part for part in tmp_path.iterdir() if part.suffix == ".part"] == []


@pytest.mark.parametrize("key", ["s", "m"])
def test_a_full_disk_is_a_message_and_the_show_goes_on(sit_down, tmp_path, key):
    """A limit on the size of files stands for the disk: root would fill a real one."""
    desk = sit_down()
    step(desk)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (64, limits[1]))
    try:
        desk.press(key)
        step(desk)
        if key == "m":
            desk.press(key)
        desk.wait(lambda: desk.model.messages.current())
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert desk.model.messages.current()[0].is_error
    assert "cannot write" in desk.model.messages.current()[0].text
    assert list(tmp_path.iterdir()) == []
    step(desk)
    assert not desk.model.is_recording


def test_a_window_without_pixels_and_back(sit_down):
    desk = sit_down()
    step(desk)
    for size in ((1, 1), (300, 20), (20, 300), SIZE):
        desk.do("search", "--name", "^viewer$", "windowsize", *size)
    desk.wait(lambda: desk.window.size == SIZE)
    desk.turn(2)
    assert desk.image().shape == (SIZE[1], SIZE[0], 3)


def test_what_stops_the_simulation_stands_in_the_window_until_it_is_restarted(sit_down):
    desk = sit_down(time__max_substeps=60)
    desk.press("space")
    desk.wait(lambda: desk.model.snapshot.number >= 1)
    quiet = desk.image()
    desk.model.set("forces.gravity", (0.0, -1e6, 0.0))
    desk.wait(lambda: desk.source.failure)
    desk.turn(2)
    assert np.abs(desk.image() - quiet).max() > 50
    desk.model.set("forces.gravity", (0.0, -1.0, 0.0))
    desk.press("r")
    desk.wait(lambda: desk.source.failure is None and desk.model.snapshot.number >= 1)


def test_a_cache_is_played_and_its_lost_frame_is_named(sit_down, drop_cache):
    (drop_cache / "drop.0002.bgeo").unlink()
    desk = sit_down(CachePlayer(drop_cache))
    desk.model.set_speed(0.125)
    desk.wait(lambda: any("frame 2 is skipped" in text for text in desk.model.messages.history))
    seen = set()

    def all_seen():
        seen.add(desk.model.snapshot.number)
        return seen >= {1, 3, 4, 5, 6}

    desk.wait(all_seen)
    assert 2 not in seen
    desk.press("space")
    desk.source.seek(4)
    desk.wait(lambda: desk.model.snapshot.number == 4)
    desk.press("Left")
    desk.wait(lambda: desk.model.snapshot.number == 3)


def test_the_window_is_closed_by_key(sit_down):
    desk = sit_down()
    desk.press("q")
    assert not desk.model.is_open


def test_the_window_is_closed_by_its_frame(sit_down):
    """What a window manager asks for, in the middle of a frame of 100 000 substeps."""
    desk = sit_down(time__substeps=100000, time__timestep=1.0)
    desk.press("space")
    desk.wait(lambda: desk.source.fraction)
    desk.window._glfw.set_window_should_close(desk.window.handle, True)
    desk.turn()
    assert not desk.model.is_open
