"""Writes docs/validation-results.md and its pictures from what `fontana validate` has measured.

fontana validate --size full --out benchmarks/results/validate
python tools/make_validation_docs.py
"""

import importlib
import json
import sys
from pathlib import Path

from fontana.validate import find_case, publish_picture

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "benchmarks" / "results" / "validate"
PAGE = ROOT / "docs" / "validation-results.md"
PICTURES = ROOT / "docs" / "images"

HEAD = """# What the validation measured

Written by `python tools/make_validation_docs.py` from `benchmarks/results/validate/`, which
`fontana validate --size full --out benchmarks/results/validate` made. What each case asks and what the tests hold it to
at small size: [validation.md](validation.md#held-against-nature). A figure without a limit is reported only.

"""


def main() -> None:
    results = load()
    PAGE.write_text(page(results), encoding="utf-8")
    for result in results:
        publish_picture(find_case(result["case"]), result, PICTURES / picture_name(result))
    print(f"written: {PAGE.relative_to(ROOT)} and {len(results)} pictures in {PICTURES.relative_to(ROOT)}")


def load() -> list[dict]:
    """The results of every case, by name."""
    return [json.loads(path.read_text(encoding="utf-8")) for path in sorted(RESULTS.glob("*.json"))]


def page(results: list[dict]) -> str:
    return HEAD + conditions(results) + "".join(section(result) for result in results)


def conditions(results: list[dict]) -> str:
    machines = {f"{result['machine']['cpu']}, {result['machine']['usable_cores']} cores" for result in results}
    commits = {describe_commit(result) for result in results}
    return f"Machine: {'; '.join(sorted(machines))}. Commit: {', '.join(sorted(commits))}.\n"


def describe_commit(result: dict) -> str:
    commit = result["commit"]
    return "unknown" if commit is None else f"`{commit['hash'][:10]}`{' with changes' if commit['dirty'] else ''}"


def section(result: dict) -> str:
    module = importlib.import_module(f"fontana.validate.{result['case'].replace('-', '_')}")
    about = module.__doc__.strip().split("\n\n")[0].replace("\n", " ")
    lines = [f"\n## {result['title']}\n", about, ""]
    lines += [f"![{result['title']}](images/{picture_name(result)})", "", *run_lines(result), ""]
    lines += ["| Figure | Measured | Limit |", "|---|---|---|"]
    for figure in result["figures"]:
        limit = "" if figure["limit"] is None else f"{figure['limit']:g} {figure['unit']}".strip()
        beyond = "" if figure["kept"] else " **beyond**"
        lines.append(f"| {figure['name']} | {figure['value']:.3g} {figure['unit']}".rstrip() + f"{beyond} | {limit} |")
    return "\n".join(lines) + "\n"


def run_lines(result: dict) -> list[str]:
    """What ran, and how hard the solves worked."""
    particles = max(run["particles"] for run in result["runs"])
    substeps = sum(run["substeps"] for run in result["runs"])
    unconverged = sum(run["unconverged"] for run in result["runs"])
    settings = result["settings"]
    command = f"`fontana validate {result['case']} --size {settings['size']}`"
    work = f"up to {particles:,} particles, {substeps:,} substeps, {unconverged} of them not converged"
    return [f"{command}: {settings['resolution']} spacings to the length, {work}."]


def picture_name(result: dict) -> str:
    return f"validation_{result['case'].replace('-', '_')}.png"


if __name__ == "__main__":
    sys.exit(main())
