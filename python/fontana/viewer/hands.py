"""What mouse and keys do, from the events that Dear ImGui has gathered."""

from __future__ import annotations

from imgui_bundle import imgui

from fontana.viewer.keys import KEYS
from fontana.viewer.layout import Box
from fontana.viewer.model import ViewerModel

_DEGREES_PER_HEIGHT = 180.0
_ZOOM_PER_NOTCH = 0.88
_LEFT = imgui.MouseButton_.left.value
_RIGHT = imgui.MouseButton_.right.value
_MIDDLE = imgui.MouseButton_.middle.value


def handle_keys(model: ViewerModel) -> None:
    """Calls the action of each key that went down; not while a number is typed."""
    if imgui.get_io().want_text_input:
        return
    for key in KEYS:
        if imgui.is_key_pressed(getattr(imgui.Key, key.name), False):
            getattr(model, key.action)()
    if imgui.is_key_pressed(imgui.Key.escape, False):
        model.shows_keys = False


def handle_mouse(model: ViewerModel, box: Box) -> None:
    """Orbit, pan, zoom and push over the picture in `box`; the panels keep what is theirs."""
    io = imgui.get_io()
    pixel = (io.mouse_pos.x - box.x, io.mouse_pos.y - box.y)
    size = (int(box.width), int(box.height))
    if min(size) < 1:
        return
    pushes = imgui.is_mouse_down(_RIGHT) or (imgui.is_mouse_down(_LEFT) and io.key_ctrl)
    if not pushes:
        model.release()
    if io.want_capture_mouse:
        return
    if pushes:
        _push(model, pixel, size)
    elif imgui.is_mouse_down(_MIDDLE) or (imgui.is_mouse_down(_LEFT) and io.key_shift):
        model.camera.pan(-io.mouse_delta.x / box.height, io.mouse_delta.y / box.height)
    elif imgui.is_mouse_down(_LEFT):
        turn = _DEGREES_PER_HEIGHT / box.height
        model.camera.orbit(-turn * io.mouse_delta.x, turn * io.mouse_delta.y)
    if io.mouse_wheel:
        model.camera.zoom(_ZOOM_PER_NOTCH**io.mouse_wheel)


def _push(model: ViewerModel, pixel: tuple[float, float], size: tuple[int, int]) -> None:
    if imgui.is_mouse_clicked(_RIGHT) or imgui.is_mouse_clicked(_LEFT):
        model.take(pixel, size)
    model.drag(pixel, size)
