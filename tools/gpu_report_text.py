"""The report of tools/gpu_check as a page."""

from __future__ import annotations

import compile_table

from fontana.launch_profile import profile_notes, profile_table

_TITLES = {
    "agreement": "Agreement with the CPU",
    "tests": "Tests",
    "speed": "Speed, million particle-substeps a second",
    "profiles": "Where the time goes",
    "compilers": "What compilers say",
}


def report_text(report: dict) -> str:
    """Markdown of all parts that are done so far."""
    commit = report["commit"]
    lines = [
        f"# Fontana on {', '.join(report['checked'])}",
        "",
        f"- command: `{report['command']}`, started {report['started']}",
        f"- commit: {commit['hash'] + (' with changes' if commit['dirty'] else '') if commit else 'not a checkout'}",
        f"- machine: {report['machine']['cpu']}, {report['machine']['usable_cores']} cores, {report['machine']['os']}",
        f"- load before: {report['machine']['load_average_before']}",
    ]
    if not any(device["is_gpu"] and device["available"] for device in report["devices"]):
        lines.append("- **no GPU is present: what follows ran on a CPU and says nothing about GPUs**")
    lines += ["", "## Devices", ""]
    columns = ["backend", "device", "kind", "driver", "why not"]
    lines += _table(columns, [_device_cells(device) for device in report["devices"]])
    for name, part in report["parts"].items():
        lines += ["", f"## {_TITLES[name]}", ""]
        lines += [f"**Failed: {part['reason']}**", ""] if part["state"] == "failed" else []
        lines += ["Left out.", ""] if part["state"] == "left out" else []
        lines += _PARTS[name](part) if part.keys() - {"state", "reason"} else []
    return "\n".join(lines) + "\n"


def _device_cells(device: dict) -> list[str]:
    kind = "GPU" if device["is_gpu"] else "CPU"
    return [device["backend"], device["name"], kind if device["available"] else "", device["driver"], device["reason"]]


def _agreement(part: dict) -> list[str]:
    names = ("density", "acceleration", "velocity", "position")
    rows = []
    for row in part["rows"]:
        scheme = [row["method"], f"{row['backend']} {row['device']}", row["neighbors"], row["precision"]]
        bits = {None: "", True: "yes", False: "no"}[row["same_bits"]]
        rows.append([*scheme, *(f"{row[name]:.1e}" for name in names), bits, "ok" if row["passed"] else "**FAILED**"])
    columns = ["method", "device", "neighbours", "arithmetic", *names, "same bits", ""]
    notes = [f"- not compared: {name}: {reason}" for name, reason in part["missing"].items()]
    return [*_table(columns, rows), "", *notes]


def _tests(part: dict) -> list[str]:
    return [f"`pytest {part['folder']}`:", "", "```", *part["end"], "```"]


def _speed(part: dict) -> list[str]:
    columns = list(part["rows"][0])
    return _table(columns, [[_speed_cell(row.get(column, "")) for column in columns] for row in part["rows"]])


def _speed_cell(value: object) -> str:
    if isinstance(value, dict):
        return f"{value['median']:.3g}" if "median" in value else value["failed"]
    return f"{value:,}" if isinstance(value, int) else f"{value:.3g}" if isinstance(value, float) else str(value)


def _profiles(part: dict) -> list[str]:
    lines = []
    for shown in part["rows"]:
        size = f"{shown['substeps']} substeps of {shown['particles']:,} particles"
        lines += [f"### {shown['method']} on {shown['device']}: {size}", "", *_table(*profile_table(shown)), ""]
        lines += [f"- {note}" for note in profile_notes(shown)] + [""]
    return lines


def _compilers(part: dict) -> list[str]:
    return ["Compiled, not run.", "", *compile_table.table(part)]


_PARTS = {
    "agreement": _agreement,
    "tests": _tests,
    "speed": _speed,
    "profiles": _profiles,
    "compilers": _compilers,
}


def _table(columns: list[str], rows: list[list[str]]) -> list[str]:
    escaped = [[cell.replace("|", "/") for cell in row] for row in (columns, *rows)]
    head, *body = [f"| {' | '.join(row)} |" for row in escaped]
    return [head, f"|{'---|' * len(columns)}", *body]
