"""The double's own maker of *.proto.h: typed access to the parameters that a verb's dialog script describes.

    generate_proto.py SOP_Name.cpp SOP_Name.proto.h

In a build with Houdini its own generator does this, from the same text: what stands between R"THEDSFILE( and
)THEDSFILE" in the source. Only what verbs use is known here: plain parameters, in folders or not.
"""

import re
import sys
from pathlib import Path

TOKEN = re.compile(r'"(?:\\.|[^"\\])*"|[{}]|[^\s{}"]+')
CPP_TYPES = {"integer": "int64", "ordinal": "int64", "toggle": "bool", "string": "UT_StringHolder", "float": "fpreal64",
             "vector": "UT_Vector3D", "vector2": "UT_Vector2D"}  # fmt: skip
FOLDERS = ("group", "groupcollapsible", "groupsimple")


def dialog_script(source: str) -> str:
    found = re.search(r'R"THEDSFILE\((.*?)\)THEDSFILE"', source, re.DOTALL)
    if not found:
        raise SystemExit('generate_proto.py: no R"THEDSFILE( in the source')
    return re.sub(r"//[^\n]*", "", found[1])


def tree(tokens, end="}"):
    """Tokens up to `end` as a list, with a list for each pair of braces."""
    items = []
    for token in tokens:
        if token == end:
            return items
        items.append(tree(tokens) if token == "{" else token.strip('"'))
    return items


def parms(block):
    """The parms of a block and of the folders in it, each as a dictionary of its entries."""
    for word, value in zip(block, block[1:], strict=False):
        if word == "parm" and isinstance(value, list):
            yield dict(zip(value[::2], value[1::2], strict=False))
        elif word in FOLDERS and isinstance(value, list):
            yield from parms(value)


def enum_of(parm):
    return f"{parm['cppname']}"


def default_of(parm):
    values = parm.get("default", ["0"])
    kind = parm["type"]
    if kind == "ordinal":
        tokens = parm["menu"][::2]
        return str(tokens.index(values[0]) if values[0] in tokens else int(values[0]))
    if kind == "toggle":
        return "true" if values[0] in ("1", "on") else "false"
    if kind == "string":
        return f'"{values[0]}"'
    return f"{CPP_TYPES[kind]}({', '.join(values)})" if kind.startswith("vector") else values[0]


def accessor(parm):
    member = f"my{parm['cppname']}"
    if parm["type"] == "ordinal":
        enum = enum_of(parm)
        return f"    {enum} get{parm['cppname']}() const {{ return static_cast<{enum}>({member}); }}"
    return f"    const {CPP_TYPES[parm['type']]}& get{parm['cppname']}() const {{ return {member}; }}"


def header(name: str, parms) -> str:
    enums = [
        f"enum class {enum_of(parm)} {{ {', '.join(token.upper() for token in parm['menu'][::2])} }};"
        for parm in parms
        if parm["type"] == "ordinal"
    ]
    using = [
        f"    using {enum_of(parm)} = {name}Enums::{enum_of(parm)};" for parm in parms if parm["type"] == "ordinal"
    ]
    evaluate = [
        f'        graph->evalOpParm(my{parm["cppname"]}, node, "{parm["name"]}", time, dependency);' for parm in parms
    ]
    members = [f"    {CPP_TYPES[parm['type']]} my{parm['cppname']}{{{default_of(parm)}}};" for parm in parms]
    return "\n".join(
        [
            "// Made by houdini/double/generate_proto.py.",
            "#pragma once",
            '#include "SOP/SOP_NodeVerb.h"',
            f"namespace {name}Enums {{",
            *enums,
            "}",
            f"class {name}Parms : public SOP_NodeParms {{",
            " public:",
            *using,
            "    void buildFromOp(const OP_GraphProxy* graph, exint node, fpreal time,",
            "                     DEP_MicroNode* dependency) override {",
            *evaluate,
            "    }",
            *map(accessor, parms),
            " private:",
            *members,
            "};",
            "",
        ]
    )


def main():
    source, target = map(Path, sys.argv[1:])
    block = tree(iter(TOKEN.findall(dialog_script(source.read_text(encoding="utf-8")))), end="")[0]
    found = list(parms(block))
    for parm in found:
        parm.setdefault("cppname", parm["name"][0].upper() + parm["name"][1:])
    target.write_text(header(source.stem, found), encoding="utf-8")


if __name__ == "__main__":
    main()
