"""Draws tests/view/reference/pool.png anew: python tests/view/make_reference.py. Look at it before it is committed."""

import numpy as np
from PIL import Image
from test_fluid import REFERENCE, draw_reference

from fontana.gl.context import create_headless_context
from fontana.gl.renderer import Renderer

if __name__ == "__main__":
    REFERENCE.parent.mkdir(exist_ok=True)
    Image.fromarray(draw_reference(Renderer(create_headless_context())).astype(np.uint8)).save(REFERENCE)
