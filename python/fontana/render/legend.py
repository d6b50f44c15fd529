"""What the colours of the points mean, drawn onto a picture."""

from __future__ import annotations

import numpy as np

from fontana.gl.color_maps import color_map_table
from fontana.gl.frame_data import COLOR_UNITS, Look

_LIGHT, _DARK = (245, 248, 252), (12, 16, 22)


def add_legend(picture: np.ndarray, look: Look) -> np.ndarray:
    """The picture, (height, width, 3) bytes, with a colour bar at its lower left and the look's range at its ends."""
    from PIL import Image, ImageDraw, ImageFont

    height, width = picture.shape[:2]
    unit = height / 36.0
    bar = max(1, round(min(15.0 * unit, 0.4 * width))), max(1, round(0.7 * unit))
    left, top = round(1.2 * unit), height - round(1.3 * unit) - bar[1]
    image = Image.fromarray(picture)
    colours = (255 * color_map_table(look.color_map, bar[0])).round().astype(np.uint8)
    image.paste(Image.fromarray(np.repeat(colours[None], bar[1], axis=0)), (left, top))
    pen, font = ImageDraw.Draw(image), ImageFont.load_default(max(8.0, 0.95 * unit))
    line = {"font": font, "fill": _LIGHT, "stroke_width": max(1, round(unit / 12)), "stroke_fill": _DARK}
    low, high = (f"{value:.4g}" for value in look.color_range)
    name = look.color_by + (f" ({COLOR_UNITS[look.color_by]})" if COLOR_UNITS[look.color_by] else "")
    pen.text((left, top - 0.35 * unit), low, anchor="ls", **line)
    pen.text((left + bar[0], top - 0.35 * unit), high, anchor="rs", **line)
    pen.text((left + bar[0] / 2, top - 0.35 * unit), name, anchor="ms", **line)
    return np.asarray(image)
