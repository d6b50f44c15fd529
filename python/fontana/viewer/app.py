"""From a scene or a folder to a window that is open until the user closes it."""

from __future__ import annotations

from pathlib import Path

import click

from fontana.runs.stop import StoppedError
from fontana.scene import Scene
from fontana.viewer.glfw_window import GlfwWindow, import_libraries


def open_viewer(what: Scene | Path, size: tuple[int, int], is_playing: bool) -> None:
    """Shows a scene live, or the run in a folder. Raises DeviceUnavailable without a display, BadInput for no run,
    StoppedError after Ctrl-C and SIGTERM, when a movie that was being made is complete."""
    import_libraries()
    from fontana.viewer.live import LiveSource
    from fontana.viewer.model import ViewerModel
    from fontana.viewer.player import CachePlayer
    from fontana.viewer.window import ViewerWindow

    source = LiveSource(what, is_playing) if isinstance(what, Scene) else CachePlayer(what, is_playing)
    try:
        window = GlfwWindow(f"{source.scene.name} - Fontana", size)
        try:
            model = ViewerModel(source)
            viewer = ViewerWindow(model, window)
            try:
                stopped = viewer.run()
            finally:
                window.hide()
                said = len(model.messages.history)
                viewer.close()  # which finishes a movie
                for text in model.messages.history[said:]:
                    click.echo(text)
        finally:
            window.close()
    finally:
        source.close()
    if stopped:
        raise StoppedError(stopped, "the window was closed by a signal")
