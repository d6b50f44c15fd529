"""A frame's surface as a file: the maker of `fontana mesh`."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from fontana import _core
from fontana.export import usd
from fontana.export.mesh_files import ENCODERS
from fontana.surface import Mesh, SurfaceSettings, reconstruct

SUFFIXES = (*ENCODERS, *usd.SUFFIXES)


@dataclass(frozen=True)
class SurfaceMaker:
    """Makes the surface of particles of `radius` and writes it in the format of its path."""

    radius: float
    settings: SurfaceSettings
    layout: usd.StageLayout

    def recorded(self) -> dict:
        """What its files depend on, for the record of a sequence."""
        return asdict(self.settings) | {"radius": self.radius}

    def __call__(self, arrays: dict[str, np.ndarray], frame: int, path: Path) -> dict:
        mesh = reconstruct(arrays["position"], arrays["velocity"], self.radius, self.settings)
        write_mesh(mesh, frame, path, self.layout)
        return {"text": _describe(mesh), "triangles": len(mesh.triangles), "left_out": mesh.left_out}


def write_mesh(mesh: Mesh, frame: int, path: Path, layout: usd.StageLayout) -> None:
    """Raises IoError."""
    if path.suffix in ENCODERS:
        _core.publish_file(str(path), ENCODERS[path.suffix](mesh))
    else:
        usd.write_mesh_frame(mesh, frame, path, layout)


def _describe(mesh: Mesh) -> str:
    text = f"{len(mesh.triangles):,} triangles"
    if mesh.left_out:
        text += f", {mesh.left_out} particles too far away for a surface"
    return text
