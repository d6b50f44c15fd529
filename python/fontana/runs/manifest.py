"""run.json: what a run was asked for, on what it ran, and every frame with its size and hash."""

from __future__ import annotations

import json
from pathlib import Path

from jsonschema import Draft202012Validator

from fontana import _core
from fontana.errors import SceneError, clean
from fontana.reader import read_json

MANIFEST_NAME = "run.json"
_ANEW = "fontana run --restart begins anew"
HASHED_ON_RESUME = 3  # how many of the last frames are read in full; of the others the size is checked

_NAME = {"type": "string", "pattern": r"^[^/\\\x00]+$"}  # a file in the folder, never a path out of it
_FILE = {
    "type": "object",
    "required": ["file", "bytes", "hash"],
    "properties": {"file": _NAME, "bytes": {"type": "integer"}, "hash": {"type": "string"}},
}
_FRAME = {
    "type": "object",
    "required": ["frame", "time", "particles", "files"],
    "properties": {
        "frame": {"type": "integer", "minimum": 1},
        "time": {"type": "number"},
        "particles": {"type": "integer"},
        "substeps": {"type": "integer"},
        "seconds": {"type": "number"},
        "files": {"type": "array", "items": _FILE, "minItems": 1},
    },
}
_SCHEMA = {
    "type": "object",
    "required": ["fontana", "state", "scene", "digest", "formats", "checkpoint_every", "frames"],
    "properties": {
        "state": {"enum": ["running", "finished", "interrupted", "failed"]},
        "scene": {"type": "object", "required": ["name", "output"]},
        "digest": {"type": "string"},
        "formats": {"type": "array", "items": {"enum": ["bgeo", "npz", "ply"]}, "minItems": 1},
        "checkpoint_every": {"type": "integer", "minimum": 1},
        "picture": {"type": "boolean"},
        "frames": {"type": "array", "items": _FRAME},
    },
}


class Manifest:
    """The content of `folder`/run.json. `data` is a plain JSON object; `publish` replaces the file in one step."""

    def __init__(self, folder: Path, data: dict):
        self.folder = folder
        self.data = data

    @classmethod
    def of_run(cls, folder: Path) -> Manifest:
        """The manifest of a folder, which must be that of a run. Raises BadInput if it is not."""
        manifest = cls.load(folder)
        if manifest is None:
            raise _core.BadInput(f'"{folder}" has no {MANIFEST_NAME}: it is not the folder of a run')
        return manifest

    @classmethod
    def load(cls, folder: Path) -> Manifest | None:
        """The manifest of a folder, or None if it has none. Raises BadInput if it cannot be used."""
        path = folder / MANIFEST_NAME
        if not path.exists():
            return None
        try:
            data = read_json(path)
        except SceneError as error:
            raise _core.BadInput(f"{error}; {_ANEW}") from error
        errors = Draft202012Validator(_SCHEMA).iter_errors(data)
        error = next(errors, None)
        if error:
            raise _core.BadInput(f"{path}: {clean(error.message, 120)}; {_ANEW}")
        numbers = [frame["frame"] for frame in data["frames"]]
        if numbers != list(range(1, len(numbers) + 1)):
            raise _core.BadInput(f"{path}: its frames are not 1, 2, 3, ...; {_ANEW}")
        return cls(folder, data)

    def publish(self) -> None:
        """Writes run.json. Raises IoError."""
        text = json.dumps(self.data, indent=1, allow_nan=False) + "\n"
        _core.publish_file(str(self.folder / MANIFEST_NAME), text.encode())

    @property
    def frames(self) -> list[dict]:
        return self.data["frames"]

    def count_sound_frames(self) -> int:
        """How many frames, from the first on, are on disk as they were written."""
        for index, frame in enumerate(self.frames):
            in_full = index >= len(self.frames) - HASHED_ON_RESUME
            if not all(self._is_sound(file, in_full) for file in frame["files"]):
                return index
        return len(self.frames)

    def _is_sound(self, file: dict, in_full: bool) -> bool:
        path = self.folder / file["file"]
        try:
            if path.stat().st_size != file["bytes"]:
                return False
            return not in_full or hash_text(_core.hash(path.read_bytes())) == file["hash"]
        except OSError:
            return False

    def file_names(self) -> list[str]:
        return [file["file"] for frame in self.frames for file in frame["files"]]


def hash_text(value: int) -> str:
    """A 64-bit hash as run.json has it: JSON readers lose the last digits of such an integer."""
    return f"{value:016x}"
