"""The command group, and the one place where an error becomes a sentence and an exit code."""

from __future__ import annotations

import json
import os
import sys
import traceback

import click

from fontana import _core, exit_codes
from fontana.cli.bench import bench
from fontana.cli.files import export, mesh
from fontana.cli.information import devices, explain, fluids, scenes, schema
from fontana.cli.render import render
from fontana.cli.run import resume, run
from fontana.cli.usage import usage_sentence
from fontana.cli.validate import validate
from fontana.cli.verify import verify
from fontana.cli.view import view
from fontana.errors import BeyondLimit

_HELP = f"""Fontana simulates fluids for visual effects with particles (SPH), on the CPU and on the GPU.

\b
Examples:
  fontana run fountain_rock                      simulate a bundled scene into out/fountain_rock
  fontana run my_scene.json --set fluid.viscosity="300 cP" --frames 48
  fontana run my_scene.json --dry-run            what it will cost, before it starts
  fontana resume out/fountain_rock               go on after Ctrl-C or a crash
  fontana render out/fountain_rock -o rock.mp4   water, without a window
  fontana explain fluid.viscosity                what a parameter means

{exit_codes.HELP}"""


@click.group(help=_HELP, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.version_option(_core.version(), prog_name="fontana")
def cli() -> None:
    pass


for command in (
    run, resume, view, render, mesh, export, devices, verify, validate, bench, scenes, schema, explain, fluids
):  # fmt: skip
    cli.add_command(command)


def main() -> None:
    """Runs the command line and leaves with the exit code."""
    _open_closed_streams()
    if sys.stdout.errors == "strict":  # a name that cannot be shown ends no run
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        code = cli.main(prog_name="fontana", standalone_mode=False) or exit_codes.OK
    except click.exceptions.NoArgsIsHelpError as error:
        error.show()
        code = exit_codes.BAD_INPUT
    except click.ClickException as error:
        code = _say(exit_codes.BAD_INPUT, usage_sentence(error))
    except click.exceptions.Exit as error:
        code = error.exit_code
    except SystemExit:  # so click leaves when nobody reads on: `fontana schema | head`
        code = exit_codes.OK
    except (Exception, KeyboardInterrupt) as error:
        code = _report(error)
    sys.exit(code)


def _open_closed_streams() -> None:
    """`fontana run box >&-`: without it a frame's file might get the number of standard output."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115  (as long as the process)


def _report(error: BaseException) -> int:
    if isinstance(error, click.Abort):
        error = KeyboardInterrupt()
    if os.environ.get("FONTANA_DEBUG"):
        traceback.print_exception(error)
    is_printed = isinstance(error, BeyondLimit)  # with the results, which are one document
    return _say(exit_codes.exit_code(error), exit_codes.sentence(error), as_json=not is_printed)


def _say(code: int, text: str, as_json: bool = True) -> int:
    if as_json and "--json" in sys.argv:
        print(json.dumps({"event": "error", "code": code, "message": text}), flush=True)
    print(f"fontana: {text}", file=sys.stderr)
    return code
