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


# ---- nodes and parameters ------------------------------------------------------------------------------------------

# Parameters of Houdini's own nodes that the scripts set: name and number of components. `tube` names its radii
# rad1 and rad2; other tuples end in x, y, z, and colours in r, g, b.
NODE_TYPES: dict[str, dict[str, dict[str, int]]] = {
    "Object": {
        "geo": {"t": 3, "r": 3},
        "cam": {"t": 3, "r": 3, "res": 2, "focal": 1, "aperture": 1},
        "hlight": {"t": 3, "r": 3, "light_type": 1, "light_intensity": 1},
        "envlight": {"light_intensity": 1},
    },
    "Sop": {
        "box": {"size": 3, "t": 3},
        "sphere": {"type": 1, "rad": 3, "t": 3},
        "tube": {"type": 1, "rad": 2, "height": 1, "t": 3},
        "merge": {},
        "xform": {"t": 3, "r": 3},
        "material": {"shop_materialpath1": 1},
        "particlefluidsurface": {"particlesep": 1},
    },
    "Vop": {"principledshader": {"basecolor": 3, "rough": 1, "ior": 1, "transparency": 1}},
}
MOST_INPUTS = {"box": 0, "sphere": 0, "tube": 0, "merge": 9999, "geo": 0, "fontana::solver::1.0": 2}
SUFFIXES = {"basecolor": "rgb", "rad": "xyz", "res": "xy"}

exprLanguage = types.SimpleNamespace(Hscript="exprLanguage.Hscript")  # noqa: N816
nodeFlag = types.SimpleNamespace(DisplayComment="nodeFlag.DisplayComment")  # noqa: N816


class Keyframe:
    def setFrame(self, value: float) -> None:  # noqa: N802
        self.frame = value

    def setValue(self, value: float) -> None:  # noqa: N802
        self.value = value

    def setExpression(self, expression: str, language: str) -> None:  # noqa: N802
        self.expression = expression


class Parm:
    def __init__(self, node: Node, name: str, menu: tuple[str, ...] = (), is_list: bool = False):
        self._node, self._name, self._menu, self._is_list = node, name, menu, is_list
        self.value: object = 0
        self.keys: list[Keyframe] = []

    def name(self) -> str:
        return self._name

    def set(self, value: object) -> None:
        if self._menu and isinstance(value, str) and value not in self._menu:
            raise TypeError(f"{self._name} has no {value}")
        if not isinstance(value, (bool, int, float, str)):
            raise TypeError(f"{self._name}: {value!r}")
        self.value = value
        if self._is_list:
            self._node.make_instances(int(value))

    def eval(self) -> object:
        return self.value

    def setKeyframe(self, keyframe: Keyframe) -> None:  # noqa: N802
        self.keys.append(keyframe)


class ParmTuple(tuple):
    """Of Parm."""

    def set(self, values: object) -> None:
        if len(values) != len(self):
            raise InvalidSize(f"{len(values)} values for {[parm.name() for parm in self]}")
        for parm, value in zip(self, values, strict=True):
            parm.set(value)

    def eval(self) -> tuple:
        return tuple(parm.eval() for parm in self)


class InvalidSize(Error):  # noqa: N818
    pass


class NodeType:
    def __init__(self, name: str):
        self._name = name

    def name(self) -> str:
        return self._name


class InfoTree:
    def __init__(self, rows: tuple = (), branches: dict[str, InfoTree] | None = None):
        self._rows, self._branches = rows, branches or {}

    def rows(self) -> tuple:
        return self._rows

    def branches(self) -> dict[str, InfoTree]:
        return self._branches


class Node:
    def __init__(self, parent: Node | None, type_name: str, name: str, child_category: str | None):
        self._parent, self._type, self._name, self._child_category = parent, type_name, name, child_category
        self._children: list[Node] = []
        self._inputs: list[Node | None] = []
        self._parms: dict[str, Parm] = {}
        self._tuples: dict[str, ParmTuple] = {}
        self._instance_rows: list[dict] = []  # of the one list of instances that a panel has
        self.comment, self.flags = "", set()

    # Making nodes.
    def createNode(self, type_name: str, name: str | None = None) -> Node:  # noqa: N802
        known = NODE_TYPES[self._child_category] if self._child_category else {}
        if type_name not in known and type_name not in panels:
            raise OperationFailed(f"Invalid node type name: {type_name}")
        taken = {child._name for child in self._children}
        stem = name or type_name
        unique = next(text for text in [stem, *(f"{stem}{k}" for k in range(1, 1000))] if text not in taken)
        child = Node(self, type_name, unique, {"geo": "Sop"}.get(type_name))
        for parm, size in known.get(type_name, {}).items():
            child._add_parm(parm, size)
        rows = panels[type_name]["parameters"] if type_name in panels else []
        child._instance_rows = [row for row in rows if "#" in row["name"]]
        for row in rows:
            if "#" not in row["name"]:
                child._add_parm(row["name"], row["size"], tuple(row["menu"]), row["type"] == "multiparm")
        self._children.append(child)
        return child

    def _add_parm(self, name: str, size: int, menu: tuple[str, ...] = (), is_list: bool = False) -> None:
        suffixes = "12" if self._type == "tube" and name == "rad" else SUFFIXES.get(name, "xyz")
        names = [name] if size == 1 else [name + suffix for suffix in suffixes[:size]]
        parms = [Parm(self, each, menu, is_list) for each in names]
        self._tuples[name] = ParmTuple(parms)
        self._parms |= {parm.name(): parm for parm in parms}

    def make_instances(self, count: int) -> None:
        for row in self._instance_rows:
            for number in range(1, count + 1):
                self._add_parm(row["name"].replace("#", str(number)), row["size"], tuple(row["menu"]))

    def destroy(self) -> None:
        self._parent._children.remove(self)

    # Asking nodes.
    def name(self) -> str:
        return self._name

    def path(self) -> str:
        return "/".join([self._parent.path().rstrip("/") if self._parent else "", self._name])

    def parent(self) -> Node:
        return self._parent

    def type(self) -> NodeType:
        return NodeType(self._type)

    def node(self, path: str) -> Node | None:
        found = self
        for part in filter(None, path.split("/")):
            found = next((child for child in found._children if child._name == part), None)
            if found is None:
                return None
        return found

    def children(self) -> tuple[Node, ...]:
        return tuple(self._children)

    def inputs(self) -> tuple[Node | None, ...]:
        return tuple(self._inputs)

    def outputs(self) -> tuple[Node, ...]:
        return tuple(node for node in self._parent._children if self in node._inputs)

    def parm(self, name: str) -> Parm | None:
        return self._parms.get(name)

    def parmTuple(self, name: str) -> ParmTuple | None:  # noqa: N802
        return self._tuples.get(name)

    # Changing nodes.
    def setInput(self, index: int, node: Node | None) -> None:  # noqa: N802
        if index >= MOST_INPUTS.get(self._type, 1):
            raise InvalidInput(f"{self._type} has no input {index}")
        self._inputs += [None] * (index + 1 - len(self._inputs))
        self._inputs[index] = node

    def setComment(self, text: str) -> None:  # noqa: N802
        self.comment = text

    def setGenericFlag(self, flag: str, value: bool) -> None:  # noqa: N802
        self.flags.add(flag)

    def setDisplayFlag(self, value: bool) -> None:  # noqa: N802
        self.flags.add("display")

    def setRenderFlag(self, value: bool) -> None:  # noqa: N802
        self.flags.add("render")

    def layoutChildren(self) -> None:  # noqa: N802
        pass

    # Cooking nodes: what `cooks` says of the type, for tests that need geometry.
    def geometryAtFrame(self, frame: float) -> Geometry | None:  # noqa: N802
        return cooks[self._type](self, frame)

    def errors(self) -> tuple[str, ...]:
        return ()

    def infoTree(self) -> InfoTree:  # noqa: N802
        own = InfoTree((("Device", "the double"),))
        return InfoTree(branches={"SOP Info": InfoTree(branches={"Fontana": own})})


class InvalidInput(Error):  # noqa: N818
    pass


class _Group:
    """What `with hou.undos.group(...)` and its like enter."""

    def __init__(self, name: str = ""):
        pass

    def __enter__(self) -> None:
        pass

    def __exit__(self, *exception: object) -> None:
        pass


class _Playbar:
    def setFrameRange(self, first: float, last: float) -> None:  # noqa: N802
        self.frame_range = (first, last)

    def setPlaybackRange(self, first: float, last: float) -> None:  # noqa: N802
        self.playback_range = (first, last)


panels: dict[str, dict] = {}  # of the plugin's nodes; empty: the plugin is not loaded
cooks: dict[str, object] = {}  # geometry by type: cook(node, frame)
undos = types.SimpleNamespace(group=_Group, disabler=_Group)
playbar = _Playbar()

_root = Node(None, "root", "", None)
_root._children = [Node(_root, "obj", "obj", "Object"), Node(_root, "mat", "mat", "Vop")]


def node(path: str) -> Node | None:
    return _root.node(path)


def sopNodeTypeCategory() -> str:  # noqa: N802
    return "Sop"


def nodeType(category: str, name: str) -> NodeType | None:  # noqa: N802
    return NodeType(name) if name in panels or name in NODE_TYPES[category] else None


def applicationVersionString() -> str:  # noqa: N802
    return "a double"


def applicationPlatformInfo() -> str:  # noqa: N802
    return "no platform"
