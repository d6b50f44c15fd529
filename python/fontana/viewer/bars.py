"""The menu above and the transport below."""

from __future__ import annotations

import math

from imgui_bundle import ImVec2, imgui

from fontana.gl.frame_data import COLOR_UNITS
from fontana.viewer.keys import shown_key
from fontana.viewer.model import SPEEDS, ViewerModel

# Font Awesome 6, which comes with imgui-bundle.
_PLAY, _PAUSE, _STEP, _BACK, _RESTART = "\uf04b", "\uf04c", "\uf051", "\uf048", "\uf2f9"
_RECORD = "\uf111"


def draw_menu(model: ViewerModel) -> None:
    """The bar across the top."""
    if not imgui.begin_main_menu_bar():
        return
    if imgui.begin_menu("File"):
        _item(model, "Screenshot", "ask_for_screenshot")
        _item(model, "Screenshot with the panels", "ask_for_window_shot")
        _item(model, "End the movie" if model.is_recording else "Begin a movie", "toggle_movie")
        imgui.separator()
        _item(model, "Quit", "quit")
        imgui.end_menu()
    if imgui.begin_menu("Play"):
        _item(model, "Pause" if model.source.is_playing else "Play", "toggle_playing")
        for text, action in (("One frame on", "step_forward"), ("One frame back", "step_back"), ("Restart", "restart")):
            _item(model, text, action)
        imgui.end_menu()
    if imgui.begin_menu("View"):
        _view_items(model)
        imgui.end_menu()
    if imgui.begin_menu("Help"):
        _item(model, "Keys", "toggle_keys", model.shows_keys)
        imgui.end_menu()
    imgui.end_main_menu_bar()


def _view_items(model: ViewerModel) -> None:
    _item(model, "Frame all", "frame_all")
    _item(model, "The scene's view", "scene_view")
    imgui.separator()
    _item(model, "Points", "draw_points", model.look.style == "points")
    _item(model, "Fluid", "draw_fluid", model.look.style == "fluid")
    if imgui.begin_menu("Coloured by"):
        for name in COLOR_UNITS:
            if imgui.menu_item(name, "", name == model.look.color_by)[0]:
                model.look.color_by = name
                model.draw_points()
        imgui.end_menu()
    imgui.separator()
    _item(model, "Colliders", "toggle_colliders", model.shows_colliders)
    _item(model, "Panel", "toggle_panel", model.shows_panel)
    _item(model, "Statistics", "toggle_statistics", model.shows_statistics)


def _item(model: ViewerModel, text: str, action: str, is_checked: bool = False) -> None:
    if imgui.menu_item(text, shown_key(action), is_checked)[0]:
        getattr(model, action)()


def draw_transport(model: ViewerModel) -> None:
    """The content of the transport's window: buttons, where one is in time, speed."""
    _buttons(model)
    imgui.same_line()
    em = imgui.get_font_size()
    speed_width = 5.5 * em
    width = imgui.get_content_region_avail().x - speed_width - imgui.get_style().item_spacing.x
    if model.source.is_live:
        _live_progress(model, width)
    else:
        _timeline(model, width)
    imgui.same_line()
    imgui.set_next_item_width(speed_width)
    changed, index = imgui.combo("##speed", SPEEDS.index(model.speed), [_speed_text(speed) for speed in SPEEDS])
    if changed:
        model.set_speed(SPEEDS[index])
    imgui.set_item_tooltip("Speed: 1 x is the pace of nature, as far as the machine keeps up.")


def _buttons(model: ViewerModel) -> None:
    size = ImVec2(2.2 * imgui.get_font_size(), 0)
    buttons = [
        (_RESTART, "restart", "Restart" if model.source.is_live else "First frame"),
        (_PAUSE if model.source.is_playing else _PLAY, "toggle_playing", "Play or pause"),
        (_STEP, "step_forward", "One frame on"),
    ]
    if not model.source.is_live:
        buttons.insert(1, (_BACK, "step_back", "One frame back"))
    for icon, action, what in buttons:
        if imgui.button(f"{icon}##{action}", size):
            getattr(model, action)()
        imgui.set_item_tooltip(f"{what} ({shown_key(action)})")
        imgui.same_line()
    if model.is_recording:
        imgui.push_style_color(imgui.Col_.text.value, imgui.ImVec4(0.97, 0.36, 0.32, 1.0))
        if imgui.button(f"{_RECORD}##toggle_movie", size):
            model.toggle_movie()
        imgui.pop_style_color()
        imgui.set_item_tooltip("The movie is being made; a click ends it")
        imgui.same_line()


def _live_progress(model: ViewerModel, width: float) -> None:
    """The frame that is shown; the bar fills while a slow one is made."""
    snapshot, fraction = model.snapshot, model.source.fraction
    text = f"frame {snapshot.number}    {snapshot.time:.3f} s" if snapshot else "starting"
    imgui.progress_bar(fraction or 0.0, ImVec2(width, 0), "")
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    size = imgui.calc_text_size(text)
    place = ImVec2(0.5 * (low.x + high.x - size.x), 0.5 * (low.y + high.y - size.y))
    imgui.get_window_draw_list().add_text(place, imgui.get_color_u32(imgui.Col_.text.value), text)


def _timeline(model: ViewerModel, width: float) -> None:
    """A slider over the frames; those that cannot be read are marked."""
    source, snapshot = model.source, model.snapshot
    time = f"    {snapshot.time:.3f} s" if snapshot else ""
    imgui.set_next_item_width(width)
    last = source.numbers[-1]
    changed, number = imgui.slider_int("##frame", source.number, source.numbers[0], last, f"frame %d of {last}{time}")
    if changed:
        source.seek(number)
    _mark_skipped(source)


def _mark_skipped(source: object) -> None:
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    first, last = source.numbers[0], source.numbers[-1]
    color = imgui.get_color_u32(imgui.ImVec4(0.97, 0.42, 0.38, 1.0))
    for number in source.skipped:
        x = low.x + (high.x - low.x) * (number - first + 0.5) / (last - first + 1)
        imgui.get_window_draw_list().add_rect_filled(ImVec2(x - 1, high.y - 4), ImVec2(x + 2, high.y), color)


def _speed_text(speed: float) -> str:
    if math.isinf(speed):
        return "fastest"
    return f"{speed:g} x" if speed >= 1 else f"1/{1 / speed:.0f} x"
