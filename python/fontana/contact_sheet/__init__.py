"""The contact sheet of a run: a grid of frames, drawn with numpy and matplotlib alone.

It is what every `fontana run` leaves, on a farm too, where there is no OpenGL; `fontana.gl` draws everything else.
"""

from fontana.contact_sheet.sheet import contact_sheet

__all__ = ["contact_sheet"]
