"""Compiles every kernel for GPUs that are not here, and says what it needs there: registers, scratch, occupancy.

    python tools/compile_table.py --out benchmarks/results

Writes compile_table.md and compile_table.json. Needs the compilers that tools/compile_tables/ names; what is missing is
said and left out, unless --strict. Compiling says nothing about running.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from types import ModuleType

import click
from compile_tables import source

from fontana import FontanaError, bench

ROOT = Path(__file__).resolve().parents[1]
VENDORS = ("nvidia", "amd", "spirv")
LEGEND = """AMD: vector registers of a thread / scalar registers of a wave / waves that a SIMD unit holds. NVIDIA:
registers of a thread. SPIR-V has none yet. Memory of a work-group, scratch memory and spills: where there are any.
"""


@click.command(help=__doc__.split("\n\n")[0])
@click.option("--out", type=click.Path(path_type=Path, file_okay=False), default=ROOT / "benchmarks/results/local")
@click.option("--strict", is_flag=True, help="A missing compiler and a kernel with scratch memory are failures.")
def command(out: Path, strict: bool) -> None:
    results = {
        "benchmark": "compile_table",
        **bench.describe_conditions([Path(sys.executable).name, "tools/compile_table.py", *sys.argv[1:]]),
        **compile_all(),
    }
    bench.note_end(results)
    bench.publish_json(out / "compile_table.json", results)
    text = markdown(results)
    (out / "compile_table.md").write_text(text)
    click.echo(text)
    click.echo(f"written: {out / 'compile_table.json'}, {out / 'compile_table.md'}")
    troubles = complaints(results, strict)
    if troubles:
        raise click.ClickException("; ".join(troubles))


def compile_all() -> dict:
    """The results of every vendor's compiler that is here. Raises CompilerError where one refuses the kernels."""
    text = source.kernel_text()
    results: dict = {"kernels": source.kernel_names(text), "missing": {}, "rows": []}
    for name in VENDORS:
        vendor = module_of(name)
        if vendor is None:
            continue
        reason = vendor.missing()
        if reason:
            results["missing"][name] = reason
        else:
            results["rows"] += vendor.rows(text, vendor.TARGETS)
    return results


def module_of(name: str) -> ModuleType | None:
    """A vendor's module; None where this checkout has none, or what it needs cannot be imported."""
    try:
        return importlib.import_module(f"compile_tables.{name}")
    except ImportError:
        return None


def complaints(results: dict, strict: bool) -> list[str]:
    """A sentence for each kernel that a target lacks, and with `strict` for all that a release must not have."""
    found = []
    by_target: dict[str, set[str]] = {}
    for row in results["rows"]:
        by_target.setdefault(row["target"], set()).add(row["kernel"])
        if strict and (row["scratch_bytes"] or row["spill_bytes"]):
            found.append(f"{row['kernel']} on {row['target']} uses {row['scratch_bytes']} bytes of scratch memory")
    for target, kernels in by_target.items():
        absent = sorted(set(results["kernels"]) - kernels)
        if absent:
            found.append(f"{target} lacks {', '.join(absent)}")
    if strict:
        found += [f"no {name}: {reason}" for name, reason in results["missing"].items()]
    return found


def markdown(results: dict) -> str:
    """The page of a whole run of this tool."""
    commit = (results["commit"] or {}).get("hash", "unknown")
    head = [
        "# What the kernels need on GPUs that are not here",
        "",
        f"Compiled, not run. By `{results['command']}` at commit `{commit}`.",
        "",
    ]
    return "\n".join([*head, *table(results)]) + "\n"


def table(results: dict) -> list[str]:
    """Lines of Markdown: the compilers, then a row a kernel and a column a target."""
    targets = list(dict.fromkeys(row["target"] for row in results["rows"]))
    cells = {(row["kernel"], row["target"]): cell(row) for row in results["rows"]}
    compilers = {row["target"]: row["compiler"] for row in results["rows"]}
    return [
        *(f"- {target}: {compilers[target]}" for target in targets),
        *(f"- no {name}: {reason}" for name, reason in results["missing"].items()),
        "",
        *LEGEND.splitlines(),
        "",
        f"| kernel | {' | '.join(targets)} |",
        f"|---|{'---|' * len(targets)}",
        *(
            f"| {kernel} | {' | '.join(cells.get((kernel, target), 'MISSING') for target in targets)} |"
            for kernel in results["kernels"]
        ),
    ]


def cell(row: dict) -> str:
    if row["registers"] is None:
        return "compiles"
    numbers = [row["registers"], *(row[name] for name in ("scalar_registers", "occupancy") if name in row)]
    text = " / ".join(map(str, numbers))
    for name, word in (("shared_bytes", "work-group"), ("scratch_bytes", "scratch"), ("spill_bytes", "spilled")):
        if row[name]:
            text += f" + {row[name]} B {word}"
    return text


if __name__ == "__main__":
    try:
        command()
    except (FontanaError, source.CompilerError) as error:
        sys.exit(f"compile_table: {error}")
