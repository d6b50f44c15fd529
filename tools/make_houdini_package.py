"""Makes the Houdini package: a folder and a zip, from houdini/package/ and the built library.

    python tools/make_houdini_package.py [--out FOLDER] [--plugin 21.0=fontana_houdini.so ...]

To install, unpack the zip into $HOUDINI_USER_PREF_DIR/packages. A version of Houdini without a --plugin gets a text
that says how to build it. The library is the one of the installed Python package. Prints what was written.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from pathlib import Path

import fontana

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "houdini" / "package"
VERSIONS = ("20.5", "21.0", "22.0")
SCENES = ("box", "fountain_rock")  # for the scripts, which in hython have no package to read them with
DEFAULT_VIEW = {"eye": [1.3, 1.0, 2.0], "target": [0.0, 0.25, 0.0], "field_of_view": 32.0}
SHARED = ("config", "help", "scripts", "toolbar")
PLUGIN_NAME = "fontana_houdini.so"
# The library of the double (houdini/double/), which a plugin that was built for tests is linked with.
DOUBLE_MARK = b"libfontana_houdini_double"


def make_package(out: Path, plugins: dict[str, Path]) -> tuple[Path, Path]:
    """Writes the folder and the zip, whose paths it returns. `plugins`: a built plugin by Houdini version.

    Raises BadInput for a plugin that cannot be shipped.
    """
    for version, plugin in plugins.items():
        check_plugin(version, plugin)
    folder = out / f"fontana-{fontana.version()}-houdini"
    shutil.rmtree(folder, ignore_errors=True)
    inside = folder / "fontana"
    for name in SHARED:
        shutil.copytree(SOURCE / name, inside / "shared" / name, ignore=shutil.ignore_patterns("__pycache__"))
    (inside / "shared" / "scenes").mkdir()
    for name in SCENES:
        text = json.dumps(plain_scene(name), indent=1) + "\n"
        (inside / "shared" / "scenes" / f"{name}.json").write_text(text, encoding="utf-8")
    shutil.copy(SOURCE / "fontana.json", folder)
    shutil.copy(ROOT / "LICENSE", inside)
    copy_library(inside / "lib")
    for version in VERSIONS:
        copy_plugin(inside / version / "dso", version, plugins.get(version))
    return folder, Path(shutil.make_archive(str(folder), "zip", folder))


def plain_scene(name: str) -> dict:
    """A scene as fontana_networks.py reads it: SI numbers alone, and what the scene itself says."""
    scene = fontana.load_scene(name)
    return {
        "name": scene.name,
        "particle_spacing": scene.build().get("fluid.particle_spacing"),
        "parameters": scene.parameters,
        "emitters": scene.emitters,
        "colliders": scene.colliders,
        "frames": scene.frame_count,
        "view": DEFAULT_VIEW | scene.view,
    }


def check_plugin(version: str, plugin: Path) -> None:
    if version not in VERSIONS:
        raise fontana.BadInput(f"--plugin {version}: expected one of {', '.join(VERSIONS)}")
    if not plugin.is_file():
        raise fontana.BadInput(f"--plugin {version}: there is no file {plugin}")
    if DOUBLE_MARK in plugin.read_bytes():
        raise fontana.BadInput(
            f"--plugin {version}: {plugin} was built against the double of the HDK, for tests; expected one that was "
            f"built against Houdini {version}"
        )


def copy_library(folder: Path) -> None:
    """The core library, as the plugin looks for it: in ../../lib, seen from its dso folder."""
    folder.mkdir(parents=True)
    for library in sorted(Path(fontana.__file__).parent.glob("libfontana.so*")):
        shutil.copy(library, folder)


def copy_plugin(folder: Path, version: str, plugin: Path | None) -> None:
    folder.mkdir(parents=True)
    if plugin is not None:
        shutil.copy(plugin, folder / PLUGIN_NAME)
        return
    text = (SOURCE / "BUILD.txt").read_text(encoding="utf-8")
    (folder / "BUILD.txt").write_text(text.replace("VERSION", version), encoding="utf-8")


def plugin_argument(text: str) -> tuple[str, Path]:
    version, separator, path = text.partition("=")
    if not separator:
        raise argparse.ArgumentTypeError(f'"{text}": expected VERSION=PATH, such as 21.0=build/dso/{PLUGIN_NAME}')
    return version, Path(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "houdini")
    parser.add_argument("--plugin", type=plugin_argument, action="append", default=[], metavar="VERSION=PATH")
    arguments = parser.parse_args()
    try:
        folder, archive = make_package(arguments.out, dict(arguments.plugin))
    except fontana.BadInput as error:
        sys.exit(f"error: {error}")
    missing = [version for version in VERSIONS if version not in dict(arguments.plugin)]
    print(f"written: {folder}, {archive}")
    if missing:
        print(f"without a plugin for Houdini {', '.join(missing)}: BUILD.txt in its dso folder says how to build one")


if __name__ == "__main__":
    main()
