"""One renderer for all tests of this folder."""

import pytest

from fontana.gl.renderer import Renderer


@pytest.fixture(scope="module")
def renderer(opengl) -> Renderer:
    return Renderer(opengl)
