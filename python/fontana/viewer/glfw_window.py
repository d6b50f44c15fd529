"""A window with OpenGL 3.3, or one sentence that says why there is none."""

from __future__ import annotations

import contextlib

from fontana import _core
from fontana.gl.context import REQUIRED_VERSION
from fontana.optional import OptionalPackage

_INSTEAD = "`fontana render` draws the frames of a run without a window"
_NO_OPENGL = "this display has no OpenGL 3.3 for a window"


def import_libraries() -> None:
    """Raises BadInput with the line to install them if the window's libraries are missing."""
    # imgui_bundle before glfw: both must use the one copy of GLFW that it brings.
    for name in ("imgui_bundle", "glfw", "moderngl"):
        OptionalPackage(name, "view", "the viewer").module(name)


class GlfwWindow:
    """A window of `size` pixels and its moderngl context, which is current. Raises DeviceUnavailable."""

    def __init__(self, title: str, size: tuple[int, int]):
        import_libraries()
        import glfw
        import moderngl

        self._glfw = glfw
        glfw.ERROR_REPORTING = False  # asked for with get_error
        if not glfw.init():
            raise _core.DeviceUnavailable(f"no window can be opened here: {_reason(glfw)}; {_INSTEAD}")
        glfw.window_hint(glfw.CONTEXT_VERSION_MAJOR, 3)
        glfw.window_hint(glfw.CONTEXT_VERSION_MINOR, 3)
        glfw.window_hint(glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE)
        glfw.window_hint(glfw.OPENGL_FORWARD_COMPAT, glfw.TRUE)
        self.handle = glfw.create_window(*size, title, None, None)
        if not self.handle:
            reason = _reason(glfw)
            glfw.terminate()
            raise _core.DeviceUnavailable(f"{_NO_OPENGL}: {reason}; {_INSTEAD}")
        glfw.make_context_current(self.handle)
        glfw.swap_interval(1)
        try:
            self.context = moderngl.create_context(require=REQUIRED_VERSION)
        except Exception as error:  # moderngl raises kinds of its own
            glfw.terminate()
            raise _core.DeviceUnavailable(f"{_NO_OPENGL}: {error}; {_INSTEAD}") from error

    @property
    def size(self) -> tuple[int, int]:
        """Pixels of what is drawn; without any while it is an icon."""
        if self._glfw.get_window_attrib(self.handle, self._glfw.ICONIFIED):
            return 0, 0
        return self._glfw.get_framebuffer_size(self.handle)

    @property
    def content_scale(self) -> float:
        """How large the screen wants letters to be."""
        return max(self._glfw.get_window_content_scale(self.handle))

    @property
    def is_closed(self) -> bool:
        return bool(self._glfw.window_should_close(self.handle))

    def wait(self, seconds: float) -> None:
        """Takes in events until that long from now, or until one came."""
        if seconds > 0:
            self._glfw.wait_events_timeout(seconds)
        else:
            self._glfw.poll_events()

    def show(self) -> None:
        self._glfw.swap_buffers(self.handle)

    def hide(self) -> None:
        self._glfw.hide_window(self.handle)
        self._glfw.poll_events()

    def close(self) -> None:
        with contextlib.suppress(Exception):  # nothing is lost with it
            self.context.release()
        self._glfw.destroy_window(self.handle)
        self._glfw.terminate()


def _reason(glfw: object) -> str:
    code, text = glfw.get_error()
    if not code or not text:
        return "GLFW gives no reason"
    return text.decode(errors="replace") if isinstance(text, bytes) else str(text)
