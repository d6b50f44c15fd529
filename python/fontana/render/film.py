"""A film, written by ffmpeg out of imageio-ffmpeg's wheel.

ffmpeg is run directly: in a process group of its own, so that Ctrl-C ends the film well instead of killing its writer.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.optional import OptionalPackage

_COLOURS = (
    "split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle"
)
_ENCODERS = {
    ".mp4": ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", "-preset", "slow", "-movflags", "+faststart"],
    ".gif": ["-filter_complex", _COLOURS, "-loop", "0"],
    ".webp": ["-c:v", "libwebp_anim", "-quality", "70", "-compression_level", "5", "-loop", "0"],
}
_MUXERS = {".mp4": "mp4", ".gif": "gif", ".webp": "webp"}
FILM_SUFFIXES = tuple(_ENCODERS)


class Film:
    """Feeds pictures of `size` pixels to ffmpeg. The file gets its name when it is complete."""

    def __init__(self, path: Path, size: tuple[int, int], fps: float):
        self.path, self.size = path, size
        if path.suffix.lower() == ".mp4" and (size[0] % 2 or size[1] % 2):
            raise _core.BadInput(f"--size: an .mp4 needs an even width and height, got {size[0]}x{size[1]}")
        self._part = path.with_name(f".{path.name}.{os.getpid()}.part")
        self._log = tempfile.TemporaryFile()  # noqa: SIM115  (closed with the film)
        self._count = 0
        self._encoder = self._start(fps)

    def has(self, frame: int, stamp: str) -> bool:
        return False  # a film cannot be continued

    def write(self, frame: int, picture: np.ndarray, stamp: str) -> None:
        try:
            self._encoder.stdin.write(picture.tobytes())
        except OSError as error:
            raise self._failure() from error
        self._count += 1

    def finish(self) -> list[Path]:
        if not self._count:
            self.abandon()
            return []
        with contextlib.suppress(OSError):  # it may be gone already; its exit code says so
            self._encoder.stdin.close()
        if self._encoder.wait() != 0:
            raise self._failure()
        try:
            os.replace(self._part, self.path)
        except OSError as error:
            raise _core.IoError(f'cannot write "{self.path}": {error.strerror}') from error
        return [self.path]

    def abandon(self) -> None:
        if self._encoder.poll() is None:
            self._encoder.kill()
            self._encoder.wait()
        with contextlib.suppress(OSError):
            self._encoder.stdin.close()
        self._log.close()
        with contextlib.suppress(OSError):
            self._part.unlink()

    def _start(self, fps: float) -> subprocess.Popen:
        suffix = self.path.suffix.lower()
        source = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{self.size[0]}x{self.size[1]}", "-r", f"{fps:.6g}"]
        target = [*_ENCODERS[suffix], "-f", _MUXERS[suffix], str(self._part)]
        command = [_ffmpeg(), "-y", "-loglevel", "error", *source, "-i", "-", *target]
        try:
            return subprocess.Popen(command, stdin=subprocess.PIPE, stderr=self._log, start_new_session=True)
        except OSError as error:
            raise _core.IoError(f"cannot start ffmpeg: {error.strerror}") from error

    def _failure(self) -> _core.IoError:
        """Why ffmpeg ended: the last line it said."""
        self._encoder.wait()
        self._log.seek(0)
        lines = self._log.read().decode(errors="replace").strip().splitlines()
        self.abandon()
        full = next((line for line in lines if "No space left" in line), None)
        reason = "no space left on the disk" if full else (lines[-1] if lines else "ffmpeg ended early")
        return _core.IoError(f'cannot write "{self.path}": {reason}')


def _ffmpeg() -> str:
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        return get_ffmpeg_exe()
    except (ImportError, RuntimeError) as error:
        raise OptionalPackage("ffmpeg", "view", "a film").missing() from error
