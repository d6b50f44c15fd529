"""matplotlib's colour maps as textures, and what their colours mean as a picture."""

from __future__ import annotations

import numpy as np


def color_map_table(name: str, count: int = 256) -> np.ndarray:
    """The colours of a map from its lower to its upper end, (count, 3) in 0 to 1, as a screen gets them (sRGB)."""
    import matplotlib

    return matplotlib.colormaps[name](np.linspace(0.0, 1.0, count))[:, :3]


def color_map_texture(context: object, name: str) -> object:
    """A texture, one pixel high, of linear light: the renderer encodes for the screen at its very end."""
    encoded = color_map_table(name)
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    texture = context.texture((len(linear), 1), 3, linear.astype("f4").tobytes(), dtype="f4")
    texture.repeat_x = False
    return texture
