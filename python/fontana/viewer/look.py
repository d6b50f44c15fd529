"""How the panels look: fonts, colours, distances. Dear ImGui's own style, quieter and in the colours of water."""

from __future__ import annotations

from pathlib import Path

import imgui_bundle
from imgui_bundle import ImVec2, ImVec4, imgui

FONT_SIZE = 15.0  # pixels at a content scale of 1
_COMFORTABLE_HEIGHT, _LARGEST = 860.0, 1.35  # pixels for letters of FONT_SIZE; and by how much they grow at most
ACCENT = (0.26, 0.62, 0.86, 1.0)
TEXT = (0.90, 0.92, 0.94, 1.0)
DIM = (0.58, 0.63, 0.68, 1.0)
WARNING = (0.98, 0.72, 0.30, 1.0)
ERROR = (0.97, 0.42, 0.38, 1.0)
_PANEL = (0.085, 0.10, 0.12, 0.94)
_FIELD = (0.155, 0.18, 0.21, 1.0)
_FIELD_HOVERED = (0.21, 0.245, 0.285, 1.0)


def apply(scale: float) -> None:
    """Loads the font that comes with imgui-bundle and sets the style; `scale` is the screen's."""
    fonts = Path(imgui_bundle.__file__).parent / "assets" / "fonts"
    text, icons = fonts / "Roboto" / "Roboto-Regular.ttf", fonts / "Font_Awesome_6_Free-Solid-900.otf"
    atlas = imgui.get_io().fonts
    if text.exists():  # else Dear ImGui's built-in font
        atlas.add_font_from_file_ttf(str(text), FONT_SIZE)
        if icons.exists():
            config = imgui.ImFontConfig()
            config.merge_mode = True
            atlas.add_font_from_file_ttf(str(icons), 0.86 * FONT_SIZE, config)
    style = imgui.get_style()
    imgui.style_colors_dark(style)
    style.window_rounding = style.frame_rounding = style.popup_rounding = style.grab_rounding = 4.0
    style.window_border_size = style.child_border_size = 0.0
    style.window_padding = ImVec2(12, 10)
    style.frame_padding = ImVec2(7, 4)
    style.item_spacing = ImVec2(8, 5)
    style.scrollbar_size = 11.0
    for name, color in _colors().items():
        style.set_color_(getattr(imgui.Col_, name).value, ImVec4(*color))
    style.scale_all_sizes(scale)
    style.font_scale_dpi = scale


def fit(height: float) -> None:
    """Lets the letters grow a little with the window, `height` pixels high."""
    imgui.get_style().font_scale_main = min(_LARGEST, max(1.0, height / _COMFORTABLE_HEIGHT))


def _colors() -> dict[str, tuple[float, float, float, float]]:
    def accent(alpha: float) -> tuple[float, float, float, float]:
        return (*ACCENT[:3], alpha)

    return {
        "text": TEXT,
        "text_disabled": DIM,
        "window_bg": _PANEL,
        "popup_bg": (*_PANEL[:3], 0.98),
        "menu_bar_bg": (0.07, 0.08, 0.10, 1.0),
        "frame_bg": _FIELD,
        "frame_bg_hovered": _FIELD_HOVERED,
        "frame_bg_active": accent(0.45),
        "button": _FIELD,
        "button_hovered": accent(0.55),
        "button_active": accent(0.80),
        "header": (0.125, 0.15, 0.18, 1.0),
        "header_hovered": accent(0.35),
        "header_active": accent(0.50),
        "slider_grab": accent(0.80),
        "slider_grab_active": ACCENT,
        "check_mark": ACCENT,
        "separator": (1.0, 1.0, 1.0, 0.08),
        "scrollbar_bg": (0.0, 0.0, 0.0, 0.0),
        "plot_histogram": ACCENT,
        "table_header_bg": (0.0, 0.0, 0.0, 0.0),
    }
