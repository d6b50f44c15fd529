"""Shaders, from files beside this one, with #include."""

from __future__ import annotations

import re
from importlib import resources

import numpy as np

_INCLUDE = re.compile(r'^#include "([\w.]+)"$', re.MULTILINE)
_VERSION = "#version 330 core\n"


def load_program(context: object, vertex: str, fragment: str) -> object:
    """A moderngl program of two files in shaders/."""
    return context.program(vertex_shader=_VERSION + _text(vertex), fragment_shader=_VERSION + _text(fragment))


def set_uniforms(program: object, **values: object) -> None:
    """Sets those of the values that the program uses: a compiler removes what it does not need."""
    for name, value in values.items():
        if name not in program:
            continue
        uniform = program[name]
        if hasattr(value, "shape") and getattr(value, "ndim", 0) == 2:
            uniform.write(value.T.astype("f4").tobytes())  # OpenGL stores matrices by column
        elif hasattr(value, "__len__"):
            uniform.value = tuple(np.asarray(value).tolist())
        else:
            uniform.value = value


def _text(name: str) -> str:
    source = resources.files(__package__).joinpath("shaders", name).read_text(encoding="utf-8")
    return _INCLUDE.sub(lambda match: _text(match[1]), source)
