"""The command `fontana`."""

from fontana.cli.main import main

__all__ = ["main"]
