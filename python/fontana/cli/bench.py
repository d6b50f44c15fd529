"""`fontana bench`: the benchmarks live in fontana/bench, each a module with a click command called `command`."""

from __future__ import annotations

import importlib
import pkgutil

import click

from fontana.errors import clean
from fontana.tables import suggestion


class _Benchmarks(click.Group):
    """Finds the commands by looking, and imports one only when it is called."""

    def list_commands(self, context: click.Context) -> list[str]:
        from fontana import bench as package

        return sorted(module.name for module in pkgutil.iter_modules(package.__path__) if module.name[0] != "_")

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        if name not in self.list_commands(context):
            return None
        return getattr(importlib.import_module(f"fontana.bench.{name}"), "command", None)

    def resolve_command(self, context: click.Context, args: list[str]) -> tuple:
        if args and args[0] not in self.list_commands(context):  # click offers only what it has imported
            context.fail(f"no such command '{clean(args[0])}'{suggestion(args[0], self.list_commands(context))}")
        return super().resolve_command(context, args)


@click.group(cls=_Benchmarks)
def bench() -> None:
    """Measure speed on this machine.

    \b
    Examples:
      fontana bench thesis                        four schemes in two scenes: the thesis's tables anew
      fontana bench houdini                       the solver node on a double of the HDK beside the library
      fontana bench plot out/bench/thesis.json    the figures of either from its numbers
    """
