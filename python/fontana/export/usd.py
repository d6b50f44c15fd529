"""USD: particles as one stage with time samples, surfaces as a layer a frame that a stage plays as value clips.

Time codes are frame numbers. A stage says its frame rate, that Y is up, and how many metres a unit is.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fontana.export.staged import staged
from fontana.optional import OptionalPackage
from fontana.surface import Mesh

_USD = OptionalPackage("usd-core", "usd", "USD")
SUFFIXES = (".usd", ".usdc", ".usda")
# Values wait in memory until they are saved; binary layers take them in parts, text only as a whole.
_SAVE_EVERY_BYTES = 2**28


@dataclass(frozen=True)
class StageLayout:
    """What all stages of a cache share: the root prim's name, frames a second, metres a unit, first and last frame."""

    name: str
    frame_rate: float
    unit: float
    first: int
    last: int


def check_installed() -> None:
    """Raises BadInput with the line that installs what is missing."""
    _USD.module("pxr.Usd")


class PointsStage:
    """A stage of UsdGeomPoints at /NAME/particles that grows by frames, in a file of its own at `path`."""

    def __init__(self, path: Path, layout: StageLayout):
        self._stage = _new_stage(path, layout)
        geometry = _USD.module("pxr.UsdGeom")
        self._points = geometry.Points.Define(self._stage, f"{_root(layout)}/particles")
        self._attributes = {
            "points": self._points.CreatePointsAttr(),
            "velocities": self._points.CreateVelocitiesAttr(),
            "ids": self._points.CreateIdsAttr(),
            "widths": self._points.CreateWidthsAttr(),
            "extent": self._points.CreateExtentAttr(),
        }
        self._points.SetWidthsInterpolation(geometry.Tokens.vertex)
        self._can_save_in_parts = path.suffix != ".usda"
        self._unsaved = 0

    def add(self, frame: int, arrays: dict[str, np.ndarray]) -> None:
        """The particles of a frame, with their diameters as widths."""
        vt = _USD.module("pxr.Vt")
        widths = (2.0 * arrays["radius"]).astype(np.float32)
        values = {
            "points": vt.Vec3fArray.FromNumpy(arrays["position"]),
            "velocities": vt.Vec3fArray.FromNumpy(arrays["velocity"]),
            "ids": vt.Int64Array.FromNumpy(arrays["id"].astype(np.int64)),
            "widths": vt.FloatArray.FromNumpy(widths),
            "extent": _extent(arrays["position"], widths.max(initial=0.0) / 2),
        }
        for name, value in values.items():
            self._attributes[name].Set(value, frame)
        self._stage.SetEndTimeCode(frame)
        self._unsaved += arrays["position"].nbytes + arrays["velocity"].nbytes
        if self._can_save_in_parts and self._unsaved > _SAVE_EVERY_BYTES:
            self.save()

    def save(self) -> None:
        _save(self._stage)
        self._unsaved = 0


@contextlib.contextmanager
def points_stage(path: Path, layout: StageLayout) -> Iterator[PointsStage]:
    """A stage to add frames to; the file is there once the block ends. Raises IoError."""
    with staged(path) as temporary:
        stage = PointsStage(temporary, layout)
        yield stage
        stage.save()


def write_mesh_frame(mesh: Mesh, frame: int, path: Path, layout: StageLayout) -> None:
    """A layer with one time sample of the mesh /NAME/surface. Raises IoError."""
    vt = _USD.module("pxr.Vt")
    with staged(path) as temporary:
        stage = _new_stage(temporary, StageLayout(layout.name, layout.frame_rate, layout.unit, frame, frame))
        prim = _define_mesh(stage, layout)
        prim.GetPointsAttr().Set(vt.Vec3fArray.FromNumpy(mesh.position), frame)
        prim.GetNormalsAttr().Set(vt.Vec3fArray.FromNumpy(mesh.normal), frame)
        prim.GetVelocitiesAttr().Set(vt.Vec3fArray.FromNumpy(mesh.velocity), frame)
        counts = np.full(len(mesh.triangles), 3, dtype=np.int32)
        prim.GetFaceVertexCountsAttr().Set(vt.IntArray.FromNumpy(counts), frame)
        prim.GetFaceVertexIndicesAttr().Set(vt.IntArray.FromNumpy(mesh.triangles.ravel()), frame)
        prim.GetExtentAttr().Set(_extent(mesh.position, 0.0), frame)
        _save(stage)


def write_clips_stage(path: Path, files: Mapping[int, str], layout: StageLayout) -> None:
    """A small stage that plays the layers `files`, by frame and beside `path`, as value clips. Raises IoError."""
    usd, sdf = _USD.module("pxr.Usd"), _USD.module("pxr.Sdf")
    with staged(path) as temporary:
        stage = _new_stage(temporary, layout)
        prim = _define_mesh(stage, layout).GetPrim()
        clips = usd.ClipsAPI(prim)
        clips.SetClipPrimPath(str(prim.GetPath()))
        clips.SetClipAssetPaths([sdf.AssetPath(f"./{file}") for file in files.values()])
        clips.SetClipActive([(frame, index) for index, frame in enumerate(files)])
        clips.SetClipTimes([(frame, frame) for frame in files])
        first = sdf.Layer.FindOrOpen(str(path.parent / next(iter(files.values()))))
        manifest = usd.ClipsAPI.GenerateClipManifestFromLayers([first], prim.GetPath())
        manifest_name = f"{path.stem}.clips.usda"
        with staged(path.parent / manifest_name) as temporary_manifest:
            manifest.Export(str(temporary_manifest))
        clips.SetClipManifestAssetPath(sdf.AssetPath(f"./{manifest_name}"))
        _save(stage)


def _new_stage(path: Path, layout: StageLayout):
    usd, geometry = _USD.module("pxr.Usd"), _USD.module("pxr.UsdGeom")
    stage = usd.Stage.CreateNew(str(path))
    geometry.SetStageUpAxis(stage, geometry.Tokens.y)
    geometry.SetStageMetersPerUnit(stage, layout.unit)
    stage.SetTimeCodesPerSecond(layout.frame_rate)
    stage.SetFramesPerSecond(layout.frame_rate)
    stage.SetStartTimeCode(layout.first)
    stage.SetEndTimeCode(layout.last)
    stage.SetDefaultPrim(geometry.Xform.Define(stage, _root(layout)).GetPrim())
    return stage


def _root(layout: StageLayout) -> str:
    tf = _USD.module("pxr.Tf")
    return f"/{tf.MakeValidIdentifier(layout.name)}"


def _define_mesh(stage, layout: StageLayout):
    """A polygon mesh as it is, without subdivision, whose attributes have no values yet."""
    geometry = _USD.module("pxr.UsdGeom")
    mesh = geometry.Mesh.Define(stage, f"{_root(layout)}/surface")
    mesh.CreateSubdivisionSchemeAttr(geometry.Tokens.none)
    mesh.CreateOrientationAttr(geometry.Tokens.rightHanded)
    mesh.SetNormalsInterpolation(geometry.Tokens.vertex)
    for create in ("Points", "Normals", "Velocities", "FaceVertexCounts", "FaceVertexIndices", "Extent"):
        getattr(mesh, f"Create{create}Attr")()
    return mesh


def _extent(position: np.ndarray, margin: float):
    """The box of all positions, wider by a radius; a point at the origin where there are none."""
    vt = _USD.module("pxr.Vt")
    if len(position) == 0:
        return vt.Vec3fArray.FromNumpy(np.zeros((2, 3), dtype=np.float32))
    box = np.stack([position.min(axis=0) - margin, position.max(axis=0) + margin])
    return vt.Vec3fArray.FromNumpy(box.astype(np.float32))


def _save(stage) -> None:
    if not stage.GetRootLayer().Save():
        raise RuntimeError("USD could not save the layer")
