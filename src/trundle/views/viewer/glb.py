"""A scene as a GLB file, the form in which other programs take an animated model: glTF 2.0, y up, metres, seconds."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pygltflib as gltf
from numpy.typing import NDArray

from ...mechanics.algebra import Quaternion
from ..plots.scales import round_step
from ..scene import Scene

Array = NDArray[Any]

_UP = Quaternion(math.sqrt(0.5), -math.sqrt(0.5), 0.0, 0.0)  # about x: z, which is up in the world frame, becomes y
_KINDS = {1: gltf.SCALAR, 3: gltf.VEC3, 4: gltf.VEC4}
_CODES = {"float32": gltf.FLOAT, "uint32": gltf.UNSIGNED_INT, "uint8": gltf.UNSIGNED_BYTE}
# Okabe and Ito's blue and yellow on ivory; a support in warm greys.
_BLUE, _YELLOW, _IVORY, _INK = "#0072b2", "#f0e442", "#fdfcf8", "#1a1c1f"
_BASE, _OTHER, _MARK = "#d9d6cc", "#c2beb2", "#e69f00"
_STRIPE = 0.16  # half the width of a meridian stripe, as a share of the body
_POLE = 0.95
_SECTORS = 12
_SQUARES = 14  # of a board, along its longer side, at most


def glb_of(scene: Scene) -> bytes:
    """Return a scene as an animated model.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.views.scene import scene_of
    >>> glb_of(scene_of(tr.Scenario.load("level-turntable-nudged").run()))[:4]
    b'glTF'
    """
    return Writer(scene).written()


class Writer:
    """The file while it is being written."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.columns = scene, scene.columns
        self.blob = bytearray()
        self.file = gltf.GLTF2(
            asset=gltf.Asset(generator="trundle", version="2.0"),
            scene=0,
            scenes=[gltf.Scene(name=str(scene.header["title"]) or None, nodes=[0])],
        )

    def written(self) -> bytes:
        """Return the whole file."""
        turn = _UP * Quaternion(*self.scene.header["to_world"])
        self.file.nodes = [gltf.Node(name="world", rotation=_xyzw(np.array([tuple(turn)]))[0].tolist(), children=[])]
        body = self._mesh("body", *self._parts("body"), _body_colours(self.columns["body_pattern"]))
        support = self._support()
        self._path()
        self._animate([(body, "position", "orientation"), (support, "support_position", "support_orientation")])
        self.file.buffers = [gltf.Buffer(byteLength=len(self.blob))]
        self.file.set_binary_blob(bytes(self.blob))
        return b"".join(self.file.save_to_bytes())

    def _support(self) -> int:
        told = self.scene.header["support"]
        polar = told.get("marks", "polar") == "polar"
        if told["flat"] and not polar:  # a rectangle, which has too few corners to be painted by them
            return self._mesh("support", *board(self.columns["support_vertices"]))
        return self._mesh("support", *self._parts("support"), _support_colours(self.columns["support_marks"], polar))

    def _parts(self, name: str) -> tuple[Array, Array, Array]:
        vertices, normals, triangles = (self.columns[f"{name}_{part}"] for part in ("vertices", "normals", "triangles"))
        return vertices, normals, triangles

    def _mesh(self, name: str, vertices: Array, normals: Array, triangles: Array, colours: Array) -> int:
        """Add a mesh as a node below the world; returns the node."""
        attributes = gltf.Attributes(
            POSITION=self._put(vertices, gltf.ARRAY_BUFFER, bounds=True),
            NORMAL=self._put(_unit(normals), gltf.ARRAY_BUFFER),
            COLOR_0=self._put(colours, gltf.ARRAY_BUFFER),
        )
        corners = triangles.astype(np.uint32).ravel()
        indices = self._put(corners, gltf.ELEMENT_ARRAY_BUFFER)
        material = self._material(name, 0.35 if name == "body" else 0.8, both_sides=name == "support")
        return self._node(name, gltf.Primitive(attributes=attributes, indices=indices, material=material))

    def _path(self) -> None:
        points = gltf.Attributes(POSITION=self._put(self.columns["position"], gltf.ARRAY_BUFFER, bounds=True))
        colour = [*_linear(_BLUE), 1.0]
        material = self._material("path", 1.0, colour=colour)
        self._node("path", gltf.Primitive(attributes=points, mode=gltf.LINE_STRIP, material=material))

    def _material(self, name: str, rough: float, *, colour: Any = None, both_sides: bool = False) -> int:
        shine = gltf.PbrMetallicRoughness(
            baseColorFactor=colour or [1.0, 1.0, 1.0, 1.0], metallicFactor=0.0, roughnessFactor=rough
        )
        self.file.materials.append(gltf.Material(name=name, pbrMetallicRoughness=shine, doubleSided=both_sides))
        return len(self.file.materials) - 1

    def _node(self, name: str, primitive: Any) -> int:
        self.file.meshes.append(gltf.Mesh(name=name, primitives=[primitive]))
        self.file.nodes.append(gltf.Node(name=name, mesh=len(self.file.meshes) - 1))
        node = len(self.file.nodes) - 1
        self.file.nodes[0].children.append(node)
        return node

    def _animate(self, moving: list[tuple[int, str, str]]) -> None:
        """Let nodes follow the columns of their poses; those without columns stay."""
        kept = rising(self.columns["time"])
        time = None
        motion = gltf.Animation(name="motion", samplers=[], channels=[])
        for node, position, orientation in moving:
            for column, path in ((position, "translation"), (orientation, "rotation")):
                if column not in self.columns:
                    continue
                values = self.columns[column][kept]
                values = _xyzw(values) if path == "rotation" else values
                if time is None:
                    seconds = self.columns["time"][kept] - self.columns["time"][0]
                    time = self._put(seconds.astype(np.float32), bounds=True)
                motion.samplers.append(gltf.AnimationSampler(input=time, output=self._put(values)))
                target = gltf.AnimationChannelTarget(node=node, path=path)
                motion.channels.append(gltf.AnimationChannel(sampler=len(motion.samplers) - 1, target=target))
                setattr(self.file.nodes[node], path, values[0].tolist())  # where programs do not play it
        self.file.animations = [motion]

    def _put(self, values: Array, target: int | None = None, *, bounds: bool = False) -> int:
        """Add numbers to the file; returns their accessor."""
        flat = values.ndim == 1
        content = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<")).tobytes()
        self.file.bufferViews.append(
            gltf.BufferView(buffer=0, byteOffset=len(self.blob), byteLength=len(content), target=target)
        )
        self.blob += content + b"\0" * (-len(content) % 4)
        rows = values.reshape(-1, 1) if flat else values
        accessor = gltf.Accessor(
            bufferView=len(self.file.bufferViews) - 1,
            componentType=_CODES[values.dtype.name],
            normalized=values.dtype == np.uint8,
            count=len(values),
            type=_KINDS[rows.shape[1]],
            min=rows.min(axis=0).tolist() if bounds else None,
            max=rows.max(axis=0).tolist() if bounds else None,
        )
        self.file.accessors.append(accessor)
        return len(self.file.accessors) - 1


def rising(time: Array) -> NDArray[np.bool_]:
    """Return which instants are later than all before them in float32 too, as glTF asks.

    Examples
    --------
    >>> rising(np.array([0.0, 20.0, 20.0000001]))
    array([ True,  True, False])
    """
    seconds = (np.asarray(time) - time[0]).astype(np.float32)
    return np.concatenate([[True], np.diff(np.maximum.accumulate(seconds)) > 0])


def board(sheet: Array) -> tuple[Array, Array, Array, Array]:
    """Return a sheet of a plane as a board whose squares have a round length and meet at the origin.

    Examples
    --------
    >>> vertices, _, triangles, _ = board(np.array([[-1.0, -0.2, 0.0], [1.0, 0.2, 0.0]]))
    >>> len(vertices), len(triangles)
    (80, 40)
    """
    low, high = np.min(sheet, axis=0).astype(float), np.max(sheet, axis=0).astype(float)
    side = round_step(float(np.max(high - low)), _SQUARES)
    x, y = (_cuts(low[i], high[i], side) for i in (0, 1))
    left, front = (part.ravel() for part in np.meshgrid(x[:-1], y[:-1]))
    right, back = (part.ravel() for part in np.meshgrid(x[1:], y[1:]))
    corners = [np.stack(part, axis=1).ravel() for part in ([left, right, right, left], [front, front, back, back])]
    vertices = np.column_stack([*corners, np.full(4 * left.size, low[2])]).astype(np.float32)
    triangles = (4 * np.arange(left.size)[:, None] + np.array([0, 1, 2, 0, 2, 3])).reshape(-1, 3)
    odd = (np.floor((left + right) / (2 * side)) + np.floor((front + back) / (2 * side))) % 2 == 1
    colours = _painted([(np.repeat(odd, 4), _OTHER)], _BASE, len(vertices))
    return vertices, np.broadcast_to([0.0, 0.0, 1.0], vertices.shape), triangles, colours


def _cuts(low: float, high: float, side: float) -> Array:
    """Return where a board is cut along an axis: at its ends, and at whole numbers of squares between them."""
    whole = side * np.arange(math.ceil(low / side), math.floor(high / side) + 1)
    inside = whole[(whole > low + 1e-6 * side) & (whole < high - 1e-6 * side)]
    return np.concatenate([[low], inside, [high]])


def _xyzw(quaternions: Array) -> Array:
    """Return quaternions in glTF's order, of unit length to float32."""
    turned = np.roll(np.asarray(quaternions, dtype=np.float64), -1, axis=1)
    return (turned / np.linalg.norm(turned, axis=1, keepdims=True)).astype(np.float32)


def _unit(vectors: Array) -> Array:
    return (vectors / np.linalg.norm(vectors.astype(np.float64), axis=1, keepdims=True)).astype(np.float32)


def _body_colours(pattern: Array) -> Array:
    """Return a body's paint: two meridian stripes and its poles, by the direction of its outward normal."""
    x, y, z = np.asarray(pattern, dtype=float).T
    striped = (np.abs(x) < _STRIPE) | (np.abs(y) < _STRIPE)
    return _painted([(z > _POLE, _YELLOW), (z < -_POLE, _INK), (striped, _BLUE)], _IVORY, len(z))


def _support_colours(marks: Array, polar: bool) -> Array:
    """Return a support's paint: sectors round its axis, or the squares of a board."""
    across, along = np.asarray(marks, dtype=float).T
    if polar:
        other = np.floor(across * _SECTORS) % 2 == 1
        first = (across % 1.0) < 0.5 / _SECTORS
        return _painted([(first, _MARK), (other, _OTHER)], _BASE, len(across))
    other = (np.floor(across * 4) + np.floor(along * 4)) % 2 == 1
    return _painted([(other, _OTHER)], _BASE, len(across))


def _painted(rules: list[tuple[Array, str]], rest: str, count: int) -> Array:
    """Return vertex colours as glTF has them, linear; the first rule that holds counts."""
    colours = [np.array([*_linear(name), 1.0], dtype=np.float32) for _, name in rules]
    default = np.array([*_linear(rest), 1.0], dtype=np.float32)
    held = [np.broadcast_to(rule[:, None], (count, 4)) for rule, _ in rules]
    return np.select(held, [np.broadcast_to(colour, (count, 4)) for colour in colours], default).astype(np.float32)


def _linear(colour: str) -> list[float]:
    shares = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    return [share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4 for share in shares]
