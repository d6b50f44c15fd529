"""A double of the small part of Houdini's Python module `hou` that Fontana uses. It is not Houdini: what passes here is
known to call functions of these names with arguments of these kinds, and no more.

Names and signatures are from https://www.sidefx.com/docs/houdini/hom/hou/ (Geometry, Attrib, Node, OpNode, SopNode,
Parm, ParmTuple, InterruptableOperation). Like Houdini it refuses: an attribute that is there already, bytes that do not
fit, changes to a node's geometry from outside its cook, a node type or a parameter that does not exist, an input that
the type does not have.
"""

from __future__ import annotations

import types

import numpy as np


class Error(Exception):
    pass


class OperationFailed(Error):  # noqa: N818 - Houdini's name
    pass


class OperationInterrupted(Error):  # noqa: N818
    pass


class GeometryPermissionError(Error):
    pass


class PermissionError(Error):  # noqa: A001
    pass


attribType = types.SimpleNamespace(Point="attribType.Point")  # noqa: N816
attribData = types.SimpleNamespace(Float="attribData.Float", Int="attribData.Int")  # noqa: N816
numericData = types.SimpleNamespace(Float32=np.float32, Float64=np.float64, Int32=np.int32, Int64=np.int64)  # noqa: N816


class Attrib:
    def __init__(self, name: str, values: np.ndarray, default: np.ndarray):
        self._name, self.values, self.default = name, values, default

    def name(self) -> str:
        return self._name

    def size(self) -> int:
        return self.values.shape[1]

    def dataType(self) -> str:  # noqa: N802
        return attribData.Int if self.values.dtype.kind == "i" else attribData.Float


class Geometry:
    """Points and their attributes; P is always there, with three components."""

    def __init__(self, is_modifiable: bool = True):
        self.is_modifiable = is_modifiable
        self._attributes = {"P": Attrib("P", np.zeros((0, 3), np.float32), np.zeros(3))}

    def intrinsicValue(self, name: str) -> int:  # noqa: N802
        if name != "pointcount":
            raise OperationFailed(name)
        return len(self._attributes["P"].values)

    def findPointAttrib(self, name: str) -> Attrib | None:  # noqa: N802
        return self._attributes.get(name)

    def addAttrib(self, kind: str, name: str, default_value: object) -> Attrib:  # noqa: N802
        self._require_modifiable()
        if kind != attribType.Point or name in self._attributes:
            raise OperationFailed(f"cannot add {name}")
        default = np.atleast_1d(default_value)
        dtype = np.int32 if default.dtype.kind == "i" else np.float32
        values = np.tile(default.astype(dtype), (self.intrinsicValue("pointcount"), 1))
        self._attributes[name] = Attrib(name, values, default)
        return self._attributes[name]

    def createPoints(self, positions: object) -> tuple:  # noqa: N802
        self._require_modifiable()
        added = np.asarray(positions, np.float32).reshape(-1, 3)
        for name, attribute in self._attributes.items():
            rows = added if name == "P" else np.tile(attribute.default, (len(added), 1))
            attribute.values = np.concatenate([attribute.values, rows.astype(attribute.values.dtype)])
        return ()

    def clear(self) -> None:
        self._require_modifiable()
        self.__init__()

    def pointFloatAttribValuesAsString(self, name: str, float_type: type = np.float32) -> bytes:  # noqa: N802
        return self._checked(name, attribData.Float).values.astype(float_type).tobytes()

    def pointIntAttribValuesAsString(self, name: str, int_type: type = np.int32) -> bytes:  # noqa: N802
        return self._checked(name, attribData.Int).values.astype(int_type).tobytes()

    def setPointFloatAttribValuesFromString(self, name: str, values: bytes, float_type: type = np.float32) -> None:  # noqa: N802
        self._set(self._checked(name, attribData.Float), values, float_type)

    def setPointIntAttribValuesFromString(self, name: str, values: bytes, int_type: type = np.int32) -> None:  # noqa: N802
        self._set(self._checked(name, attribData.Int), values, int_type)

    def _set(self, attribute: Attrib, data: bytes, kind: type) -> None:
        self._require_modifiable()
        values = np.frombuffer(data, kind)
        if values.size != attribute.values.size:
            raise OperationFailed(f"{attribute.name()}: {values.size} values for {attribute.values.size}")
        attribute.values = values.reshape(attribute.values.shape).astype(attribute.values.dtype)

    def _checked(self, name: str, kind: str) -> Attrib:
        attribute = self._attributes.get(name)
        if attribute is None or attribute.dataType() != kind:
            raise OperationFailed(f"no such attribute: {name}")
        return attribute

    def _require_modifiable(self) -> None:
        if not self.is_modifiable:
            raise GeometryPermissionError()


class InterruptableOperation:
    """Esc is pressed at the update with this number, if any."""

    esc_at_update: int | None = None

    def __init__(
        self, operation_name: str, long_operation_name: str | None = None, open_interrupt_dialog: bool = False
    ):
        self.updates: list[float] = []

    def __enter__(self) -> InterruptableOperation:
        return self

    def __exit__(self, *exception: object) -> None:
        pass

    def updateProgress(self, percentage: float) -> None:  # noqa: N802
        assert 0.0 <= percentage <= 1.0
        self.updates.append(percentage)
        if len(self.updates) == InterruptableOperation.esc_at_update:
            raise OperationInterrupted()


_frame = 1.0


def frame() -> float:
    return _frame


def setFrame(value: float) -> None:  # noqa: N802
    global _frame
    _frame = value
