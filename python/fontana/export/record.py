"""The record of a sequence of files: with what each was made, so that the same command continues."""

from __future__ import annotations

import glob
import json
from pathlib import Path

from jsonschema import Draft202012Validator

from fontana import _core
from fontana.errors import SceneError
from fontana.export.target import Target
from fontana.reader import read_json

_SCHEMA = {
    "type": "object",
    "required": ["fontana", "settings", "frames"],
    "properties": {
        "settings": {"type": "object"},
        "frames": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["frame", "source", "bytes"],
                "properties": {"frame": {"type": "integer"}, "source": {"type": "string"}},
            },
        },
    },
}


class Record:
    """`target.record`: the settings of a sequence and, by frame, the hash of its source and the size of its file.

    Opening it raises BadInput if it was made with other settings, or if files are there that no record speaks of;
    `restart` forgets what was there instead.
    """

    def __init__(self, target: Target, settings: dict, restart: bool):
        self._target = target
        self._settings = json.loads(json.dumps(settings))
        self._entries: dict[int, dict] = {}
        if restart:
            return
        former = _load(target.record)
        if former is None:
            self._refuse_foreign_files()
            return
        changed = sorted(
            name
            for name in self._settings.keys() | former["settings"].keys()
            if self._settings.get(name) != former["settings"].get(name)
        )
        if changed:
            raise _core.BadInput(
                f'"{target.pattern}" was made with another {", ".join(changed)}; use another -o, or --restart'
            )
        self._entries = {entry["frame"]: entry for entry in former["frames"]}

    def has(self, frame: int, source: str) -> bool:
        """Whether the frame's file is there, of the size it was written with, and of the source of that hash."""
        entry = self._entries.get(frame)
        if entry is None or entry["source"] != source:
            return False
        try:
            return self._target.frame(frame).stat().st_size == entry["bytes"]
        except OSError:
            return False

    def add(self, entry: dict) -> None:
        """A file is on disk: {"frame", "source", "bytes", ...}. Raises IoError."""
        self._entries[entry["frame"]] = entry
        self.publish()

    def publish(self) -> None:
        """Writes the record; before the first file too, which without it would count as another's. Raises IoError."""
        frames = [self._entries[frame] for frame in sorted(self._entries)]
        data = {"fontana": _core.version(), "settings": self._settings, "frames": frames}
        _core.publish_file(str(self._target.record), (json.dumps(data, indent=1) + "\n").encode())

    def _refuse_foreign_files(self) -> None:
        target = self._target
        foreign = sorted(target.folder.glob(glob.escape(target.pattern.name).replace("#", "[0-9]")))
        if foreign:
            raise _core.BadInput(
                f'"{foreign[0]}" is there, but no {target.record.name} that speaks of it; '
                "use another -o, or --restart to replace such files"
            )


def _load(path: Path) -> dict | None:
    if not path.exists():
        return None
    try:
        data = read_json(path)
    except SceneError as error:
        raise _core.BadInput(f"{error}; --restart begins anew") from error
    if not Draft202012Validator(_SCHEMA).is_valid(data):
        raise _core.BadInput(f'"{path}" is not the record of a sequence; --restart begins anew')
    return data
