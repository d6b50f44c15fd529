"""What lies over the picture: statistics, legend, messages, the hand, the keys."""

from __future__ import annotations

import numpy as np
from imgui_bundle import ImVec2, ImVec4, imgui

from fontana.gl.color_maps import color_map_table
from fontana.gl.frame_data import COLOR_UNITS
from fontana.viewer.keys import KEYS, MOUSE
from fontana.viewer.layout import Box
from fontana.viewer.look import ACCENT, ERROR, TEXT, WARNING
from fontana.viewer.model import ViewerModel

_MOST_KERNELS = 8
_LONGEST_FACT = "pressure iterations"  # of the words that come and go
_LEGEND_STEPS = 64
_LEGEND_HEIGHT = 4.0  # in heights of the font, without its padding
_STATISTICS_WIDTH = 22.0  # likewise, with its longest rows
_HAND, _HAND_EDGE = (1.0, 1.0, 1.0, 0.95), (0.0, 0.0, 0.0, 0.45)
_MARGIN = 0.7  # likewise, around what lies over the picture


def overlay_flags() -> int:
    """Of a window that shows and is not touched."""
    flags = imgui.WindowFlags_
    return (flags.no_decoration | flags.no_inputs | flags.no_saved_settings | flags.always_auto_resize).value


def _begin(name: str, box: Box, pivot: tuple[float, float], alpha: float = 0.72) -> None:
    """A box of its own size at a corner of `box`: pivot (0, 0) is the upper left, (1, 1) the lower right."""
    margin = _MARGIN * imgui.get_font_size()
    x = box.x + margin + pivot[0] * (box.width - 2 * margin)
    y = box.y + margin + pivot[1] * (box.height - 2 * margin)
    imgui.set_next_window_pos(ImVec2(x, y), 0, ImVec2(*pivot))
    imgui.set_next_window_bg_alpha(alpha)
    imgui.begin(name, None, overlay_flags())


# ---- statistics


def draw_statistics(model: ViewerModel, box: Box, draw_seconds: float) -> None:
    """Upper right: what the frame cost and how good it is."""
    snapshot = model.snapshot
    if not model.shows_statistics or snapshot is None:
        return
    rows = statistics(snapshot, model.source, draw_seconds)
    if model.source.is_live and not model.source.settings.get("solver.profile"):
        rows.append(("by kernel", "see Profile in Fluid options"))
    rows = rows[: _rows_that_fit(model, box)]
    if not rows:
        return
    _begin("statistics", box, (1.0, 0.0))
    if imgui.begin_table("facts", 2, imgui.TableFlags_.sizing_fixed_fit.value):
        # A column fits itself to its words one picture late, and would cut a longer one until then.
        for column in (0, 1):
            words = [row[column] for row in rows]
            width = max(imgui.calc_text_size(text).x for text in [*words, _LONGEST_FACT])
            imgui.table_setup_column(f"##{column}", imgui.TableColumnFlags_.width_fixed.value, width)
        for name, text in rows:
            imgui.table_next_row()
            imgui.table_next_column()
            imgui.text_disabled(name)
            imgui.table_next_column()
            imgui.text_unformatted(text)
        imgui.end_table()
    imgui.end()


def _rows_that_fit(model: ViewerModel, box: Box) -> int:
    """How many rows leave the legend its place below."""
    em, style = imgui.get_font_size(), imgui.get_style()
    taken = 2 * _MARGIN * em + 2 * style.window_padding.y
    if model.look.style == "points":
        taken += _LEGEND_HEIGHT * em + 2 * style.window_padding.y + _MARGIN * em
    return max(0, int((box.height - taken) / (imgui.get_text_line_height() + 2 * style.cell_padding.y)))


def statistics(snapshot: object, source: object, draw_seconds: float) -> list[tuple[str, str]]:
    """The rows, as name and text."""
    record = snapshot.record
    rows = [("particles", f"{snapshot.data.particle_count:,}")]
    if source.is_live and snapshot.scheme:
        rate = source.rates.by_scheme.get(snapshot.scheme)
        rows += [("scheme", snapshot.scheme)]
        rows += [("frames a second", f"{rate.frames_per_second:.1f}")] if rate else []
    if "substeps" in record:
        rows += [("substeps", f"{record['substeps']}")]
        rows += [("dt", f"{1e3 * record['dt_min']:.3g} ms"), ("dt limit", str(record["limit"]).replace("_", " "))]
        rows += [("density error", f"{100 * record['density_error_mean']:.2g} %")]
        rows += [("  largest", f"{100 * record['density_error_max']:.2g} %")]
        rows += [("fastest", f"{record['max_speed']:.3g} m/s")]
    if record.get("iterations"):
        rows += [("pressure iterations", f"{record['iterations']}")]
    if record.get("unconverged"):
        rows += [("gave up", f"{record['unconverged']} substeps")]
    phases = [(name, seconds) for name, seconds in snapshot.phases.items() if name in ("simulate", "read")]
    kernels = sorted(set(snapshot.phases.items()) - set(phases), key=lambda item: -item[1])[:_MOST_KERNELS]
    rows += [(name, _milliseconds(seconds)) for name, seconds in phases]
    rows += [(f"  {name}", _milliseconds(seconds)) for name, seconds in kernels]
    return [*rows, ("draw", _milliseconds(draw_seconds))]


def _milliseconds(seconds: float) -> str:
    return f"{1e3 * seconds:.1f} ms"


# ---- legend


def draw_legend(model: ViewerModel, box: Box) -> None:
    """Lower right: what the colours mean."""
    if model.look.style != "points":
        return
    _begin("legend", box, (1.0, 1.0))
    em = imgui.get_font_size()
    name, unit = model.look.color_by, COLOR_UNITS[model.look.color_by]
    imgui.text_unformatted(f"{name}  {unit}")
    width, height = 13 * em, 0.75 * em
    corner, draws = imgui.get_cursor_screen_pos(), imgui.get_window_draw_list()
    step = width / _LEGEND_STEPS
    for index, color in enumerate(color_map_table(model.look.color_map, _LEGEND_STEPS)):
        x = corner.x + index * step
        fill = imgui.get_color_u32(ImVec4(*color, 1.0))
        draws.add_rect_filled(ImVec2(x, corner.y), ImVec2(x + step + 0.5, corner.y + height), fill)
    imgui.dummy(ImVec2(width, height))
    low, high = model.color_range()
    left = imgui.get_cursor_pos_x()
    imgui.text_unformatted(_short(low))
    for value, share in ((0.5 * (low + high), 0.5), (high, 1.0)):
        text = _short(value)
        imgui.same_line(left + share * (width - imgui.calc_text_size(text).x))
        imgui.text_unformatted(text)
    imgui.end()


def _short(value: float) -> str:
    return f"{0.0 if abs(value) < 1e-12 else value:.4g}"


# ---- sentences


def draw_messages(model: ViewerModel, box: Box) -> None:
    """Top: what the user should know; what stops the simulation stays until it is mended."""
    rows = [(message.text, ERROR if message.is_error else TEXT) for message in model.messages.current()]
    failure = model.source.failure
    if failure:
        rows.append((failure.sentence, ERROR))
    elif not model.source.is_live and len(model.source.skipped) == len(model.source.numbers):
        rows.append(("none of the frames can be read", ERROR))
    if not rows:
        return
    em = imgui.get_font_size()
    beside = _STATISTICS_WIDTH if model.shows_statistics else 0.0
    width = max(12 * em, min(box.width - (beside + 3 * _MARGIN) * em, 42 * em))
    imgui.set_next_window_pos(ImVec2(box.x + _MARGIN * em, box.y + _MARGIN * em))
    imgui.set_next_window_size(ImVec2(width, 0))
    imgui.set_next_window_bg_alpha(0.92)
    flags = imgui.WindowFlags_
    is_still = not failure
    shape = (flags.no_decoration | flags.no_saved_settings | flags.no_move | flags.no_focus_on_appearing).value
    imgui.begin("messages", None, shape | (flags.no_inputs.value if is_still else 0))
    imgui.push_text_wrap_pos(0.0)
    for text, color in rows:
        imgui.text_colored(ImVec4(*color), text.replace("%", "%%"))
    if failure:
        if imgui.button("Restart"):
            model.restart()
        if not failure.is_final:
            imgui.same_line()
            imgui.text_colored(ImVec4(*WARNING), "or change what it names, and it goes on")
    imgui.pop_text_wrap_pos()
    imgui.end()


# ---- the hand


def draw_hand(model: ViewerModel, box: Box) -> None:
    """The ball of influence, and which way it pushes."""
    grip = model.grip
    if grip.centre is None:
        return
    size = (int(box.width), int(box.height))
    tip = grip.centre + grip.pull
    (pixels, depths) = model.camera.project(np.stack([grip.centre, tip]), size)
    if depths.min() <= 0:
        return
    half = np.tan(np.radians(model.camera.field_of_view) / 2)
    radius = grip.radius * size[1] / (2.0 * half * depths[0])
    start, end = (ImVec2(box.x + x, box.y + y) for x, y in pixels)
    draws = imgui.get_background_draw_list()
    draws.add_circle_filled(start, radius, imgui.get_color_u32(ImVec4(1.0, 1.0, 1.0, 0.10)), 64)
    for color, width in ((_HAND_EDGE, 4.0), (_HAND, 2.0)):  # seen on light ground and on dark water
        shade = imgui.get_color_u32(ImVec4(*color))
        draws.add_circle(start, radius, shade, 64, width)
        draws.add_line(start, end, shade, width + 1.0)
        draws.add_circle_filled(end, 3.0 + width, shade)


# ---- the keys


def draw_keys(model: ViewerModel, box: Box) -> None:
    """In the middle: the page behind `?`."""
    if not model.shows_keys:
        return
    _begin("keys", box, (0.5, 0.5), 0.95)
    imgui.text_unformatted("Keys and mouse")
    imgui.separator()
    half = -(-len(KEYS) // 2)
    if imgui.begin_table("keys", 4, imgui.TableFlags_.sizing_fixed_fit.value):
        for row in range(half):
            imgui.table_next_row()
            for key in KEYS[row::half]:
                _key_cell(key.shown, key.what)
        imgui.end_table()
    imgui.separator()
    if imgui.begin_table("mouse", 2, imgui.TableFlags_.sizing_fixed_fit.value):
        for gesture, what in MOUSE:
            imgui.table_next_row()
            _key_cell(gesture, what)
        imgui.end_table()
    imgui.end()


def _key_cell(key: str, what: str) -> None:
    imgui.table_next_column()
    imgui.text_colored(ImVec4(*ACCENT), key)
    imgui.table_next_column()
    imgui.text_unformatted(f"{what}    ")
