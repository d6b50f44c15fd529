"""The keys and the mouse: one table for what they do, the page behind `?`, and docs/viewing.md."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Key:
    """`name` is Dear ImGui's, `action` a method of the model."""

    name: str
    shown: str
    what: str
    action: str


KEYS = (
    Key("space", "Space", "play or pause", "toggle_playing"),
    Key("right_arrow", "Right", "one frame on", "step_forward"),
    Key("left_arrow", "Left", "one frame back, in a cache", "step_back"),
    Key("r", "R", "restart, or go to the first frame", "restart"),
    Key("up_arrow", "Up", "faster", "faster"),
    Key("down_arrow", "Down", "slower", "slower"),
    Key("b", "B", "compute on the next backend there is", "next_backend"),
    Key("n", "N", "find neighbours by the next scheme there is", "next_neighbors"),
    Key("f", "F", "frame all", "frame_all"),
    Key("v", "V", "the scene's own view", "scene_view"),
    Key("_1", "1", "draw points", "draw_points"),
    Key("_2", "2", "draw water", "draw_fluid"),
    Key("c", "C", "colour by the next attribute", "next_color"),
    Key("k", "K", "colliders on or off", "toggle_colliders"),
    Key("tab", "Tab", "panel on or off", "toggle_panel"),
    Key("i", "I", "statistics on or off", "toggle_statistics"),
    Key("s", "S", "screenshot of the picture", "ask_for_screenshot"),
    Key("p", "P", "screenshot with the panels", "ask_for_window_shot"),
    Key("m", "M", "begin or end a movie", "toggle_movie"),
    Key("slash", "?", "these keys", "toggle_keys"),
    Key("q", "Q", "quit", "quit"),
)

MOUSE = (
    ("Left drag", "orbit"),
    ("Middle drag, or Shift and left drag", "pan"),
    ("Wheel", "zoom"),
    ("Right drag, or Ctrl and left drag", "push the fluid, live"),
)


def shown_key(action: str) -> str:
    """The key that does it, as menus show it."""
    return next(key.shown for key in KEYS if key.action == action)
