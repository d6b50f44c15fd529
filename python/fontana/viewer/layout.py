"""Where the panels stand: computed from the size of the window, so that they never overlap."""

from __future__ import annotations

from dataclasses import dataclass

PANEL_WIDTH = 23.0  # in heights of the font, as all lengths here
MENU_HEIGHT = 1.55
TRANSPORT_HEIGHT = 2.9
_LEAST_VIEW = 20.0  # the panel gives way where less than this would be left


@dataclass(frozen=True)
class Box:
    """Pixels, from the upper left corner."""

    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class Layout:
    """The places of everything for a window of `width` x `height` pixels and a font `em` pixels high."""

    width: float
    height: float
    em: float
    has_panel: bool

    @property
    def panel(self) -> Box:
        return Box(0, self._top, self.panel_width, max(0.0, self.height - self._top))

    @property
    def panel_width(self) -> float:
        wanted = self._pixels(PANEL_WIDTH)
        return wanted if self.has_panel and self.width - wanted >= _LEAST_VIEW * self.em else 0.0

    @property
    def _top(self) -> float:
        return self._pixels(MENU_HEIGHT)

    @property
    def _bottom(self) -> float:
        return self._pixels(TRANSPORT_HEIGHT)

    def _pixels(self, heights: float) -> float:
        """Whole ones: a picture between two pixels would blur."""
        return round(heights * self.em)

    @property
    def view(self) -> Box:
        """What is left for the picture."""
        height = self.height - self._top - self._bottom
        return Box(self.panel_width, self._top, self.width - self.panel_width, max(0.0, height))

    @property
    def transport(self) -> Box:
        return Box(self.panel_width, self.height - self._bottom, self.width - self.panel_width, self._bottom)
