"""The panel: schemes, picture, hand, and the parameters and colliders in the panes of the thesis's node (Fig. 10)."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import ImVec2, ImVec4, imgui

from fontana.gl.frame_data import COLOR_UNITS, STYLES
from fontana.tables import COLLIDERS, groups, parameters
from fontana.units import show
from fontana.viewer import fields
from fontana.viewer.look import ERROR, WARNING
from fontana.viewer.model import ViewerModel
from fontana.viewer.settings import FROM_THE_START

# The thesis's panes by the groups of the parameter table; its fourth, "Implicit collisions", is the colliders.
_PANES = (
    ("Fluid parameters", ("fluid",), True),
    ("External forces", ("forces",), False),
    ("Fluid options", ("time", "solver"), False),
)
_SCHEME = ("solver.backend", "solver.neighbors")  # above, with their frame rates
_LOGARITHMIC = imgui.SliderFlags_.logarithmic.value


def draw_panel(model: ViewerModel) -> None:
    """The content of the panel's window."""
    _heading(model)
    _schemes_pane(model)
    _picture_pane(model)
    if model.source.is_live:
        _hand_pane(model)
    for title, names, is_open in (*_PANES, *_other_groups()):
        if _pane(title, is_open):
            _parameter_rows(model, title, names)
    if model.source.scene.colliders and _pane("Implicit collisions", False):
        _collider_rows(model)


def _heading(model: ViewerModel) -> None:
    imgui.text_unformatted(model.source.scene.name.replace("_", " "))
    imgui.same_line()
    imgui.text_disabled("live" if model.source.is_live else "cache")
    complaint = model.source.settings.complaint()
    if complaint and model.source.is_live and not model.source.failure:
        imgui.push_text_wrap_pos(0.0)
        imgui.text_colored(ImVec4(*ERROR), complaint.replace("%", "%%"))
        imgui.pop_text_wrap_pos()


def _pane(title: str, is_open: bool) -> bool:
    return imgui.collapsing_header(title, imgui.TreeNodeFlags_.default_open.value if is_open else 0)


def _other_groups() -> tuple[tuple[str, tuple[str, ...], bool], ...]:
    """A group that the thesis did not have gets a pane of its own."""
    known = {name for _, names, _ in _PANES for name in names}
    return tuple((name.replace("_", " ").capitalize(), (name,), False) for name in groups() if name not in known)


# ---- where it is computed


def _schemes_pane(model: ViewerModel) -> None:
    if not model.source.is_live or not _pane("Where it runs", True):
        return
    settings = model.source.settings
    if fields.begin_rows("scheme"):
        for path in _SCHEME:
            _parameter_row(model, path, parameters()[path], settings.get(path))
        fields.end_rows()
    _rates_table(model)
    changed, is_capped = imgui.checkbox("at most 24 frames a second, as in the thesis", model.is_capped)
    if changed:
        model.set_capped(is_capped)


def _rates_table(model: ViewerModel) -> None:
    """Frames a second of each scheme that has run: a click goes back to it."""
    rates, snapshot = model.source.rates.by_scheme, model.snapshot
    flags = imgui.TableFlags_.sizing_stretch_same.value
    if not rates or not imgui.begin_table("rates", 4, flags):
        return
    imgui.table_next_row()
    for title in ("", "frames/s", "ms/frame", "particles"):
        imgui.table_next_column()
        _right_aligned(title, imgui.text_disabled)
    for scheme, rate in sorted(rates.items()):
        imgui.table_next_row()
        imgui.table_next_column()
        spans = imgui.SelectableFlags_.span_all_columns.value
        if imgui.selectable(scheme, bool(snapshot) and scheme == snapshot.scheme, spans)[0]:
            for path, word in zip(_SCHEME, scheme.split(), strict=True):
                model.set(path, word)
        for text in (f"{rate.frames_per_second:.1f}", f"{1e3 * rate.solve_seconds:.1f}", f"{rate.particle_count:,}"):
            imgui.table_next_column()
            _right_aligned(text, imgui.text_unformatted)
    imgui.end_table()


def _right_aligned(text: str, draw: Callable[[str], None]) -> None:
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x - imgui.calc_text_size(text).x)
    draw(text)


# ---- how it is drawn


def _picture_pane(model: ViewerModel) -> None:
    if not _pane("Picture", True) or not fields.begin_rows("picture"):
        return
    fields.label("Drawn as", "points: each particle a sphere; fluid: their surface as water.")
    changed, style = fields.choice("style", STYLES, model.look.style)
    if changed:
        model.look.style = style
    if model.look.style == "points":
        fields.label("Coloured by")
        changed, name = fields.choice("color", tuple(COLOR_UNITS), model.look.color_by)
        if changed:
            model.look.color_by = name
    fields.label("Colliders")
    if imgui.checkbox("##colliders", model.shows_colliders)[0]:
        model.toggle_colliders()
    fields.end_rows()


def _hand_pane(model: ViewerModel) -> None:
    if not _pane("Hand", False) or not fields.begin_rows("hand"):
        return
    grip = model.grip
    fields.label("Strength", "Acceleration where the hand is, once it was dragged as far as its own radius.")
    _, grip.strength = imgui.slider_float("##strength", grip.strength, 1.0, 500.0, "%.0f m/s^2", _LOGARITHMIC)
    fields.label("Radius", "How far the hand reaches, in particle spacings.")
    _, grip.spacings = imgui.slider_float("##spacings", grip.spacings, 2.0, 30.0, "%.1f spacings")
    fields.end_rows()
    imgui.text_disabled("drag with the right button to push")


# ---- the tables


def _parameter_rows(model: ViewerModel, title: str, names: tuple[str, ...]) -> None:
    settings = model.source.settings
    for name in names:
        if len(names) > 1:
            imgui.text_disabled(name)
        if not fields.begin_rows(f"{title}.{name}"):
            continue
        for row in groups()[name].values():
            if row.name not in _SCHEME:
                _parameter_row(model, row.name, row, settings.get(row.name))
        fields.end_rows()
    if "fluid" in names:
        derived = settings.derived()
        facts = (show(_rounded(derived.support_radius), "m"), show(_rounded(derived.particle_mass), "kg"))
        imgui.text_disabled("support radius {}, particle mass {}".format(*facts))
    if any(settings.is_changed(path) for path in FROM_THE_START if path.split(".")[0] in names):
        imgui.text_colored(ImVec4(*WARNING), "R restarts with the changed spacing or scale")


def _parameter_row(model: ViewerModel, path: str, row: object, value: object) -> None:
    settings = model.source.settings
    fields.label(row.label, f"{path}: {row.doc}", settings.is_changed(path))
    changed, value = _field(model, row, value, path)
    if changed:
        model.set(path, value)
    if model.source.is_live and imgui.begin_popup_context_item(f"menu {path}"):
        if imgui.menu_item_simple("As in the scene"):
            model.set(path, settings.original(path))
        imgui.end_popup()


def _collider_rows(model: ViewerModel) -> None:
    for index, collider in enumerate(model.source.settings.colliders):
        title = f"{collider.get('label') or collider['type'].replace('_', ' ')}##{index}"
        if not imgui.tree_node(title):
            continue
        if fields.begin_rows(f"collider {index}"):
            for row in COLLIDERS[collider["type"]]:
                _collider_row(model, index, collider, row)
            fields.end_rows()
        imgui.tree_pop()


def _collider_row(model: ViewerModel, index: int, collider: dict, row: object) -> None:
    moves = "keys" in collider and row.name in ("centre", "velocity")
    fields.label(row.name.capitalize(), f"{row.doc} The keys of the scene move it." if moves else row.doc)
    changed, value = _field(model, row, collider[row.name], f"{index}.{row.name}", is_fixed=moves)
    if changed:
        model.set_collider(index, row.name, value)


def _field(model: ViewerModel, row: object, value: object, name: str, is_fixed: bool = False) -> tuple[bool, object]:
    """The field of a row; what a cache was simulated with is only shown."""
    imgui.begin_disabled(is_fixed or not model.source.is_live)
    result = fields.field(row, value, name, model.absent_choices(row.name))
    imgui.end_disabled()
    return result


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")


def panel_flags() -> int:
    """Of the window that holds the panel: it stays where the layout puts it."""
    flags = imgui.WindowFlags_
    return (flags.no_title_bar | flags.no_resize | flags.no_move | flags.no_collapse | flags.no_saved_settings).value


def place(box: object) -> None:
    """The next window fills `box`."""
    imgui.set_next_window_pos(ImVec2(box.x, box.y))
    imgui.set_next_window_size(ImVec2(max(1.0, box.width), max(1.0, box.height)))
