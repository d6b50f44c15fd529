"""What click finds wrong with a command line, in one sentence as every other error, with the nearest valid word."""

from __future__ import annotations

import math

import click

from fontana.errors import clean
from fontana.tables import suggestion


class Choice(click.Choice):
    """click's, which names the choices but not the nearest."""

    def get_invalid_choice_message(self, value: object, ctx: click.Context | None) -> str:
        words = list(map(str, self.choices))
        near = suggestion(str(value), words)
        hint = near if near.startswith("; did") else ""
        return f'"{clean(str(value))}" is not one of {", ".join(words)}{hint}'


class FloatRange(click.FloatRange):
    """click's, which lets NaN through, and infinity where there is no bound."""

    def convert(self, value: object, param: click.Parameter | None, ctx: click.Context | None) -> float:
        number = super().convert(value, param, ctx)
        if not math.isfinite(number):
            self.fail(f"{number} is not a finite number", param, ctx)
        return number


def usage_sentence(error: click.ClickException) -> str:
    """Where, what is wrong, and the nearest word, or else which help says more."""
    parameter, context = getattr(error, "param", None), getattr(error, "ctx", None)
    if isinstance(error, click.BadParameter) and isinstance(parameter, click.Option) and error.message:
        return f"{parameter.opts[-1]}: {error.message.rstrip('.')}"
    text = error.format_message().strip().rstrip(".")
    text = text[:1].lower() + text[1:].replace(". Did you mean", "; did you mean")
    return text if text.endswith("?") or not context else f"{text}; {context.command_path} --help says more"
