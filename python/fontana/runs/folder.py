"""The folder of a run: its names, its checkpoints, and where to continue."""

from __future__ import annotations

import contextlib
import shutil
from pathlib import Path

from fontana import _core
from fontana.output_folder import make_output_folder
from fontana.runs.manifest import MANIFEST_NAME, Manifest

CHECKPOINT_BYTES_PER_PARTICLE = 64
SPARE_BYTES = 2**20  # run.json, the picture, headers


class RunFolder:
    """Paths and checkpoints of the run called `name` in `path`."""

    def __init__(self, path: Path, name: str):
        self.path = path
        self.name = name

    def create(self) -> None:
        """Makes the folder and tries a write in it. Raises IoError."""
        make_output_folder(self.path)

    def check_space(self, frame_bytes: int, particle_count: int) -> None:
        """Raises IoError unless two frames and a checkpoint of so many particles fit on the disk."""
        needed = 2 * frame_bytes + CHECKPOINT_BYTES_PER_PARTICLE * particle_count + SPARE_BYTES
        free = shutil.disk_usage(self.path).free
        if free < needed:
            raise _core.IoError(
                f'"{self.path}" has {free / 1e6:.0f} MB left; two frames and a checkpoint of this run take '
                f"{needed / 1e6:.0f} MB"
            )

    def frame_path(self, frame: int, format: str) -> Path:
        """fountain.0001.bgeo: a dot before a number of four digits is what Houdini's $F4 reads."""
        return self.path / f"{self.name}.{frame:04d}.{format}"

    @property
    def picture_path(self) -> Path:
        return self.path / f"{self.name}.png"

    @property
    def checkpoints(self) -> tuple[Path, Path]:
        """The last one and the one before it, as the library names them."""
        return self.path / f"{self.name}.checkpoint", self.path / f"{self.name}.checkpoint.previous"

    def save_checkpoint(self, simulation: _core.Simulation, digest: str) -> None:
        """Raises IoError; the library keeps the checkpoint before it, and at every instant one that is whole."""
        simulation.save_checkpoint(str(self.checkpoints[0]), digest)

    def load_checkpoint(
        self, simulation: _core.Simulation, digests: set[str], most_frames: int
    ) -> tuple[int | None, list[str]]:
        """Continues from the newest checkpoint that is whole, belongs to the scene and is not past `most_frames`.

        Returns its finished frames, or None if there is none, and sentences about those that would not do.
        """
        notes = []
        for path in self.checkpoints:
            if not path.exists():
                continue
            try:
                frame, _, tag = _core.checkpoint_info(str(path))
                if tag not in digests:
                    notes.append(f"{path.name} belongs to another scene")
                    continue
                if frame > most_frames:
                    continue
                simulation.load_checkpoint(str(path))
            except (_core.IoError, _core.BadInput) as error:
                notes.append(f"{path.name} cannot be used: {error}")
                continue
            return frame, notes
        return None, notes

    def clear(self, manifest: Manifest | None) -> None:
        """Removes what a former run left: the frames it lists, checkpoints, picture and manifest. Raises IoError."""
        names = manifest.file_names() if manifest else self.foreign_frames()
        former = RunFolder(self.path, manifest.data["scene"]["name"]) if manifest else self
        paths = [self.path / name for name in names] + [*former.checkpoints, former.picture_path]
        try:
            for path in [*paths, self.path / MANIFEST_NAME]:  # the manifest last: it names the others
                with contextlib.suppress(FileNotFoundError):
                    path.unlink()
        except OSError as error:
            raise _core.IoError(f'cannot remove "{path}": {error.strerror}') from error

    def foreign_frames(self) -> list[str]:
        """Frames of this name that no manifest speaks of."""
        return sorted(path.name for path in self.path.glob(f"{self.name}.[0-9][0-9][0-9][0-9].*"))
