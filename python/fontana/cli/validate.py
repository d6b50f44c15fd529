"""`fontana validate`: cases with known answers, their figures and plots."""

from __future__ import annotations

import json
import shlex
import sys
from pathlib import Path

import click
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from fontana.cli.information import print_table
from fontana.cli.usage import Choice
from fontana.errors import BeyondLimit, beyond
from fontana.runs.standard_output import printing
from fontana.tables import parameters
from fontana.validate import SIZES, Session, case_names, find_case


@click.command(short_help="Compare with experiments and closed forms.")
@click.argument("cases", nargs=-1, metavar="[CASE...]")
@click.option(
    "--out", type=click.Path(path_type=Path, file_okay=False), default=Path("out/validate"), show_default=True
)
@click.option("--size", type=Choice(SIZES), default=SIZES[0], show_default=True, help="Of all cases.")
@click.option("--method", type=Choice(parameters()["fluid.method"].choices), help="Instead of each case's own.")
@click.option("--backend", type=Choice(parameters()["solver.backend"].choices), help="Where to compute.")
@click.option("--threads", type=click.IntRange(0), help="Threads of the cpu backend; 0: all cores.")
@click.option("--resume", is_flag=True, help="Keep the cases that this commit has finished in --out.")
@click.option("--list", "list_only", is_flag=True, help="Name the cases and stop.")
@click.option("--json", "as_json", is_flag=True, help="As JSON.")
def validate(
    cases: tuple[str, ...],
    out: Path,
    size: str,
    method: str | None,
    backend: str | None,
    threads: int | None,
    resume: bool,
    list_only: bool,
    as_json: bool,
) -> None:
    """Run cases whose answer is known, from experiments, closed forms and other methods, and compare.

    Without a CASE all of them. Each writes its figures, curves, machine and commit to --out as JSON, and a plot beside
    it. All at full size take a minute or two; after Ctrl-C what is finished is there, and --resume goes on.

    \b
    Examples:
      fontana validate
      fontana validate martin-moyce hydrostatic --size full --out out/truth
      fontana validate --method pcisph
    """
    names = cases or tuple(case_names())
    chosen = {name: find_case(name) for name in names}
    if list_only:
        print_table(["case", ""], [[name, case.title] for name, case in chosen.items()])
        return
    settings = {"fluid.method": method, "solver.backend": backend, "solver.threads": threads}
    overrides = {path: value for path, value in settings.items() if value is not None}
    session = Session(names, size, overrides, out, ["fontana", *sys.argv[1:]])
    results = _run(session, resume, as_json)
    if as_json:
        click.echo(json.dumps({"cases": results}, indent=1))
    findings = [
        beyond(result["case"], row["name"], row["value"], row["limit"], row["unit"])
        for result in results
        for row in result["figures"]
        if not row["kept"]
    ]
    if findings:
        raise BeyondLimit(findings)


def _run(session: Session, resume: bool, as_json: bool) -> list[dict]:
    """The results of all cases; shows a bar on a terminal, and each case's figures as it ends."""
    results: list[dict] = []
    columns = (TextColumn("{task.description}"), BarColumn(bar_width=32), TextColumn("{task.percentage:>3.0f} %"))
    console = Console(stderr=True, highlight=False)
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("", total=1.0)

        def tell(name: str, label: str, share: float) -> None:
            progress.update(task, description=f"{name}: {label}", completed=share)

        try:
            for result in session.run(tell, resume):
                results.append(result)
                if not as_json:
                    with printing():
                        _print(result)
        except KeyboardInterrupt:
            done = ", ".join(result["case"] for result in results) or "none"
            again = shlex.join([*session.command, *([] if resume else ["--resume"])])
            console.print(f"finished and kept: {done}; to go on: {again}", markup=False)
            raise
    return results


def _print(result: dict) -> None:
    click.echo(f"{result['case']}: {result['title']} ({result['wall_seconds']:.0f} s)")
    rows = []
    for row in result["figures"]:
        limit = "" if row["limit"] is None else f"{row['limit']:g}"
        verdict = "" if row["limit"] is None else "ok" if row["kept"] else "BEYOND"
        rows.append([f"  {row['name']}", f"{row['value']:.3g} {row['unit']}".strip(), limit, verdict])
    print_table(["", "measured", "limit", ""], rows)
    click.echo("")
