"""The part of Houdini's package files that ours uses, for tests: which folders join HOUDINI_PATH in which Houdini.

After https://www.sidefx.com/docs/houdini/ref/plugins.html: comparisons of keywords with quoted text, joined by `and`
and `or`; `and` binds tighter. Versions compare number by number.
"""

from __future__ import annotations

import operator
import re

PACKAGE_SCHEMA = {
    "type": "object",
    "required": ["enable", "env", "hpath"],
    "additionalProperties": False,
    "properties": {
        "enable": {"type": ["boolean", "string"]},
        "load_package_once": {"type": "boolean"},
        "show": {"type": "boolean"},
        "env": {
            "type": "array",
            "items": {"type": "object", "minProperties": 1, "additionalProperties": {"type": "string"}},
        },
        "hpath": {
            "type": "array",
            "minItems": 1,
            "items": {
                "oneOf": [
                    {"type": "string"},
                    {
                        "type": "object",
                        "minProperties": 1,
                        "maxProperties": 1,
                        "additionalProperties": {"type": "string"},
                    },
                ]
            },
        },
    },
}
_COMPARISON = re.compile(r"(houdini_version|houdini_os|houdini_python)\s*(<=|>=|==|!=|<|>)\s*'([^']*)'")
_OPERATORS = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


def holds(rule: str, facts: dict[str, str]) -> bool:
    """Whether a rule is true where the keywords have these values. Raises ValueError for a rule it cannot read."""
    return any(all(_compare(part, facts) for part in side.split(" and ")) for side in rule.split(" or "))


def _compare(text: str, facts: dict[str, str]) -> bool:
    match = _COMPARISON.fullmatch(text.strip())
    if not match:
        raise ValueError(f"cannot read {text!r}")
    name, sign, wanted = match.groups()
    if name == "houdini_version":
        found = tuple(int(part) for part in facts[name].split("."))
        return _OPERATORS[sign](found, tuple(int(part) for part in wanted.split(".")))
    return _OPERATORS[sign](facts[name], wanted)


def houdini_path(package: dict, package_folder: str, facts: dict[str, str]) -> list[str]:
    """The folders that the package adds to HOUDINI_PATH; none where it is not enabled."""
    variables = {"HOUDINI_PACKAGE_PATH": package_folder}
    if not holds(package["enable"], facts):
        return []
    for entry in package["env"]:
        variables |= {name: _expand(value, variables) for name, value in entry.items()}
    folders = []
    for entry in package["hpath"]:
        rules = {"": entry} if isinstance(entry, str) else entry
        folders += [_expand(folder, variables) for rule, folder in rules.items() if not rule or holds(rule, facts)]
    return folders


def _expand(text: str, variables: dict[str, str]) -> str:
    return re.sub(r"\$(\w+)", lambda match: variables[match[1]], text)
