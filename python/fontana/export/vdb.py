"""OpenVDB: the level set `surface` and the velocities `vel`, the names by which Houdini's fluid tools know them."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from types import ModuleType

import numpy as np

from fontana import _core
from fontana.export.staged import staged
from fontana.optional import OptionalPackage
from fontana.surface import Mesh, SurfaceSettings, is_on_grid, reconstruct

HALF_WIDTH = 3.0  # voxels on each side of the surface that carry distances, OpenVDB's usual band
_LEAF = 8  # voxels along the side of OpenVDB's smallest block


@dataclass(frozen=True)
class VdbSettings:
    """`voxel_size` of `surface`, in particle radii; that of `vel` is twice as large, a particle spacing by default."""

    voxel_size: float = 1.0


@dataclass(frozen=True)
class VdbMaker:
    """Makes a frame's .vdb of particles of `radius`: the maker of `fontana export -o NAME.vdb`."""

    radius: float
    settings: VdbSettings

    def recorded(self) -> dict:
        """What its files depend on, for the record of a sequence."""
        return asdict(self.settings) | {"radius": self.radius}

    def __call__(self, arrays: dict[str, np.ndarray], frame: int, path: Path) -> dict:
        openvdb = find_openvdb()
        position, velocity = arrays["position"], arrays["velocity"]
        voxel_size = self.settings.voxel_size * self.radius
        mesh = reconstruct(position, velocity, self.radius, SurfaceSettings(cell_size=self.settings.voxel_size))
        surface = _level_set(openvdb, mesh, voxel_size)
        vel = _velocity_grid(openvdb, position, velocity, 2.0 * voxel_size)
        with staged(path) as temporary:
            openvdb.write(str(temporary), grids=[surface, vel], metadata={"creator": f"Fontana {_core.version()}"})
        text = f"{surface.activeVoxelCount():,} voxels"
        if mesh.left_out:
            text += f", {mesh.left_out} particles too far away for a grid"
        return {"text": text, "voxels": surface.activeVoxelCount(), "left_out": mesh.left_out}


def find_openvdb() -> ModuleType:
    """OpenVDB's Python module: installed as such, or the one inside Blender's package. Raises BadInput without one."""
    for name in ("openvdb", "pyopenvdb"):
        try:
            return importlib.import_module(name)
        except ImportError:
            continue
    bundled = _bundled_with_blender()
    if bundled is None:
        raise OptionalPackage("openvdb", "vdb", "VDB").missing()
    specification = importlib.util.spec_from_file_location("openvdb", bundled)
    module = importlib.util.module_from_spec(specification)
    sys.modules["openvdb"] = module
    specification.loader.exec_module(module)
    return module


def _bundled_with_blender() -> Path | None:
    """The module's file. Importing bpy itself would start all of Blender."""
    blender = importlib.util.find_spec("bpy")
    if blender is None or blender.origin is None:
        return None
    pattern = f"*/python/lib/python*/site-packages/openvdb*{sys.implementation.cache_tag.removeprefix('cpython-')}*"
    return next(iter(sorted(Path(blender.origin).parent.glob(pattern))), None)


def _level_set(openvdb: ModuleType, mesh: Mesh, voxel_size: float):
    """Distance to the surface, negative inside, in a band around it."""
    transform = openvdb.createLinearTransform(voxelSize=voxel_size)
    if len(mesh.triangles) == 0:
        grid = openvdb.FloatGrid(HALF_WIDTH * voxel_size)
        grid.transform = transform
    else:
        grid = openvdb.FloatGrid.createLevelSetFromPolygons(
            mesh.position, triangles=mesh.triangles.astype(np.uint32), transform=transform, halfWidth=HALF_WIDTH
        )
    grid.name = "surface"
    grid.gridClass = openvdb.GridClass.LEVEL_SET
    return grid


def _velocity_grid(openvdb: ModuleType, position: np.ndarray, velocity: np.ndarray, voxel_size: float):
    """The velocity wherever a particle is within one and a half voxels along each axis."""
    grid = openvdb.Vec3SGrid()
    grid.transform = openvdb.createLinearTransform(voxelSize=voxel_size)
    grid.name = "vel"
    # A vector that a transform turns but does not move.
    grid["vector_type"] = "contravariant relative"
    if len(position) == 0:
        return grid
    is_near = is_on_grid(position, voxel_size)
    coordinates, values = splat(position[is_near].astype(np.float64) / voxel_size, velocity[is_near])
    leaves, leaf_of = np.unique(coordinates >> 3, axis=0, return_inverse=True)
    order = np.argsort(leaf_of.ravel(), kind="stable")
    ends = np.cumsum(np.bincount(leaf_of.ravel()))
    for leaf, members in zip(leaves, np.split(order, ends[:-1]), strict=True):
        block = np.zeros((_LEAF, _LEAF, _LEAF, 3), dtype=np.float32)
        inside = coordinates[members] - _LEAF * leaf
        block[inside[:, 0], inside[:, 1], inside[:, 2]] = values[members]
        grid.copyFromArray(block, ijk=tuple(int(k) for k in _LEAF * leaf))
    return grid


def splat(places: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Averages of `values` (N, 3) on the whole numbers around `places` (N, 3), weighted by quadratic B-splines.

    Returns coordinates (M, 3) of int64 and the averages there, (M, 3).
    """
    centre = np.rint(places).astype(np.int64)
    first = centre.min(axis=0) - 1
    sides = centre.max(axis=0) + 2 - first
    strides = np.array([sides[1] * sides[2], sides[2], 1])
    offset = places - centre
    weights = np.stack([0.5 * (0.5 - offset) ** 2, 0.75 - offset**2, 0.5 * (0.5 + offset) ** 2])
    steps = [(i, j, k) for i in (0, 1, 2) for j in (0, 1, 2) for k in (0, 1, 2)]
    keys = (centre - first) @ strides
    neighbours = [keys + np.subtract(step, 1) @ strides for step in steps]
    touched = np.unique(np.concatenate([np.unique(near) for near in neighbours]))
    total = np.zeros((len(touched), 4))
    for (i, j, k), near in zip(steps, neighbours, strict=True):
        weight = weights[i, :, 0] * weights[j, :, 1] * weights[k, :, 2]
        where = np.searchsorted(touched, near)
        for axis in range(3):
            total[:, axis] += np.bincount(where, weight * values[:, axis], minlength=len(touched))
        total[:, 3] += np.bincount(where, weight, minlength=len(touched))
    coordinates = np.stack([touched // strides[0], touched // sides[2] % sides[1], touched % sides[2]], axis=1) + first
    with np.errstate(invalid="ignore"):  # a particle half-way between two voxels weighs nothing on a third
        averages = total[:, :3] / total[:, 3:]
    return coordinates, np.nan_to_num(averages)
