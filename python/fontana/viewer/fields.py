"""A widget for a value, made from its row in a table: a parameter, or a field of a collider."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping
from types import MappingProxyType

from imgui_bundle import imgui

from fontana.units import readable
from fontana.viewer.look import ACCENT

_HELP_WIDTH = 64  # characters
_REASON_WIDTH = 48
_NONE: Mapping[str, str] = MappingProxyType({})
_WORKED_OUT = ("derived", "automatic")  # what the table of parameters says of some zeros: "0: derived"
_MOST_FLOAT = 1e30  # a drag knows no infinity


def begin_rows(name: str) -> bool:
    """A table of labels and values; `end_rows` if it says True."""
    if not imgui.begin_table(name, 2):
        return False
    imgui.table_setup_column("label", imgui.TableColumnFlags_.width_stretch.value, 0.46)
    imgui.table_setup_column("value", imgui.TableColumnFlags_.width_stretch.value, 0.54)
    return True


def end_rows() -> None:
    imgui.end_table()


def label(text: str, help_text: str = "", is_changed: bool = False) -> None:
    """Begins a row; the value's widget comes next. A changed value has a coloured label."""
    imgui.table_next_row()
    imgui.table_next_column()
    imgui.align_text_to_frame_padding()
    if is_changed:
        imgui.push_style_color(imgui.Col_.text.value, imgui.ImVec4(*ACCENT))
    imgui.text_unformatted(text)
    if is_changed:
        imgui.pop_style_color()
    if help_text and imgui.is_item_hovered(imgui.HoveredFlags_.for_tooltip.value):
        imgui.set_tooltip(_escaped(textwrap.fill(help_text, _HELP_WIDTH)))
    imgui.table_next_column()
    imgui.set_next_item_width(-1)


def field(row: object, value: object, name: str, absent: Mapping[str, str] = _NONE) -> tuple[bool, object]:
    """Shows `value` of a row with type, unit, minimum, maximum and choices; whether it was changed, and to what.

    absent  choices that cannot be taken, each with the reason
    """
    if row.type == "bool":
        return imgui.checkbox(f"##{name}", bool(value))
    if row.type == "choice":
        return choice(name, row.choices, value, absent)
    if row.type == "int":
        speed, form = max(0.05, 0.01 * abs(value)), _meaning(row, value) or "%d"
        return imgui.drag_int(f"##{name}", int(value), speed, *_bounds(row, int), form)
    if row.type == "vector":
        speed = _speed(max((abs(x) for x in value), default=0.0))
        changed, parts = imgui.drag_float3(f"##{name}", [*value], speed, *_bounds(row, float), "%.4g")
        return changed, tuple(map(_plain, parts))
    if math.isinf(value):
        imgui.text_disabled("without end")
        return False, value
    form = _meaning(row, value) or _format(row.unit)
    changed, number = imgui.drag_float(f"##{name}", value, _speed(value), *_bounds(row, float), form)
    return changed, _plain(number)


def choice(name: str, choices: tuple[str, ...], value: str, absent: Mapping[str, str] = _NONE) -> tuple[bool, str]:
    """One word of several; the absent ones are shown with the reason and cannot be taken."""
    chosen = value
    if imgui.begin_combo(f"##{name}", value):
        for word in choices:
            if word in absent:
                _absent_choice(word, absent[word])
            elif imgui.selectable(word, word == value)[0]:
                chosen = word
        imgui.end_combo()
    return chosen != value, chosen


def _absent_choice(word: str, reason: str) -> None:
    imgui.begin_disabled()
    imgui.selectable(word, False)
    imgui.text_unformatted(textwrap.fill(reason, _REASON_WIDTH))
    imgui.end_disabled()


def _speed(value: float) -> float:
    """A pixel of dragging changes a value by a hundredth of it."""
    return max(0.01 * abs(value), 1e-4)


def _bounds(row: object, kind: type) -> tuple[float, float]:
    most = 2**30 if kind is int else _MOST_FLOAT
    return kind(max(row.minimum, -most)), kind(min(row.maximum, most))


def _format(unit: str) -> str:
    return f"%.4g {_escaped(readable(unit))}".strip()


def _meaning(row: object, value: float) -> str:
    """What a 0 stands for, where it is no quantity."""
    return next((word for word in _WORKED_OUT if value == 0 and f"0: {word}" in row.doc), "")


def _escaped(text: str) -> str:
    return text.replace("%", "%%")


def _plain(number: float) -> float:
    """The number that was typed: Dear ImGui holds it in 32 bits."""
    return float(f"{number:.7g}")
