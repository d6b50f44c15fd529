"""symbols.py PLUGIN: what the plugin shows to Houdini and takes from others; says what is wrong and exits with 1."""

import subprocess
import sys

SHOWN = {"newSopOperator", "HoudiniDSOVersion", "HoudiniGetTagInfo"}
LINKER = {"_init", "_fini", "_edata", "_end", "__bss_start"}
SANITIZERS = ("__asan", "__odr_asan", "__tsan")


def names(plugin: str, *options: str) -> set[str]:
    listing = subprocess.run(["nm", "-D", *options, plugin], capture_output=True, text=True, check=True).stdout
    return {line.split()[-1].split("@")[0] for line in listing.splitlines()}


def main() -> int:
    plugin = sys.argv[1]
    shown = {name for name in names(plugin, "--defined-only") if not name.startswith(SANITIZERS)}
    taken = names(plugin, "--undefined-only")
    wrong = [f"shows {name}" for name in sorted(shown - SHOWN - LINKER)]
    wrong += [f"lacks {name}" for name in sorted(SHOWN - shown)]
    wrong += [f"takes {name}" for name in sorted(taken) if "tbb" in name or "7fontana" in name or name.startswith("cl")]
    if "fontana_create" not in taken:
        wrong.append("does not take fontana_create from the shared library: the solver was linked into it")
    print("\n".join(wrong))
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
