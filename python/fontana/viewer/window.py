"""The viewer's window: one turn of its loop takes in events, draws the picture and the panels over it."""

from __future__ import annotations

import ctypes
import time

import numpy as np
from imgui_bundle import ImVec2, imgui

from fontana.runs.stop import StopSignals
from fontana.viewer import bars, hands, look, overlay, panel
from fontana.viewer.capture import Capture
from fontana.viewer.glfw_window import GlfwWindow
from fontana.viewer.layout import Box, Layout
from fontana.viewer.model import ViewerModel
from fontana.viewer.picture import Picture

_TURN = 1 / 60  # s
_TURN_WITHOUT_PIXELS = 0.1
_BACKGROUND = (0.03, 0.035, 0.045)


class ViewerWindow:
    """Shows `model` in `window` until the user closes it: `run`, or `turn` by `turn`."""

    def __init__(self, model: ViewerModel, window: GlfwWindow):
        self.model = model
        self.window = window
        self.picture = Picture(window.context)
        self.capture = Capture(model, self.picture)
        self._next_turn = 0.0
        imgui.create_context()
        imgui.get_io().set_ini_filename("")  # panels stand where the layout says
        look.apply(window.content_scale)
        imgui.backends.glfw_init_for_opengl(ctypes.cast(window.handle, ctypes.c_void_p).value, True)
        imgui.backends.opengl3_init("#version 330")

    def run(self) -> int | None:
        """Until the user closes it, or Ctrl-C or SIGTERM comes: the number of that signal."""
        with StopSignals("closing the window") as stop:
            while self.model.is_open and not stop.requested:
                self.turn()
        return stop.requested

    def turn(self) -> None:
        """Takes in events until it is time, and draws once."""
        while (wait := self._next_turn - time.monotonic()) > 0:
            self.window.wait(wait)
        self._next_turn = time.monotonic() + _TURN
        self.window.wait(0.0)
        if self.window.is_closed:
            self.model.quit()
            return
        self.model.update()
        if min(self.window.size) < 1:
            self._next_turn = time.monotonic() + _TURN_WITHOUT_PIXELS
            return
        self._draw()
        self.capture.update_window(self._image)
        self.window.show()

    def close(self) -> None:
        """Ends what is being written and lets go of the window."""
        self.capture.close()
        imgui.backends.opengl3_shutdown()
        imgui.backends.glfw_shutdown()
        imgui.destroy_context()

    def _draw(self) -> None:
        self._draw_panels()
        screen = self.window.context.screen
        screen.use()
        screen.viewport = (0, 0, *self.window.size)
        self.window.context.clear(*_BACKGROUND)
        imgui.backends.opengl3_render_draw_data(imgui.get_draw_data())

    def _image(self) -> np.ndarray:
        """What was drawn last, as (height, width, 3) bytes, upper row first."""
        width, height = self.window.size
        rows = self.window.context.screen.read(viewport=(0, 0, width, height), components=3, alignment=1)
        return np.frombuffer(rows, np.uint8).reshape(height, width, 3)[::-1]

    def _draw_panels(self) -> None:
        imgui.backends.opengl3_new_frame()
        imgui.backends.glfw_new_frame()
        imgui.new_frame()
        model, display = self.model, imgui.get_io().display_size
        look.fit(display.y)
        hands.handle_keys(model)
        layout = Layout(display.x, display.y, imgui.get_font_size(), model.shows_panel)
        self._draw_picture(layout.view)
        bars.draw_menu(model)
        if layout.panel_width:
            _window("panel", layout.panel, lambda: panel.draw_panel(model))
        _window("transport", layout.transport, lambda: bars.draw_transport(model))
        overlay.draw_statistics(model, layout.view, self.picture.seconds)
        overlay.draw_legend(model, layout.view)
        overlay.draw_messages(model, layout.view)
        overlay.draw_keys(model, layout.view)
        imgui.render()

    def _draw_picture(self, box: Box) -> None:
        """The scene, in what the panels leave; taken as screenshot or into the movie where that was asked for."""
        scale = imgui.get_io().display_framebuffer_scale
        size = (int(box.width * scale.x), int(box.height * scale.y))
        if min(size) < 1:
            return
        self.model.aspect = size[0] / size[1]
        hands.handle_mouse(self.model, box)
        texture = self.picture.update(self.model, size)
        if texture is None:
            return
        self.capture.update(size)
        corner = ImVec2(box.x + box.width, box.y + box.height)
        draws = imgui.get_background_draw_list()
        # OpenGL counts rows from below.
        draws.add_image(imgui.ImTextureRef(texture.glo), ImVec2(box.x, box.y), corner, ImVec2(0, 1), ImVec2(1, 0))
        overlay.draw_hand(self.model, box)


def _window(name: str, box: Box, draw: object) -> None:
    panel.place(box)
    imgui.begin(name, None, panel.panel_flags())
    draw()
    imgui.end()
