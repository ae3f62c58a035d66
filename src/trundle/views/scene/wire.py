"""A scene, and the bytes that carry it to a viewer: a header in JSON, then the columns, one behind the other.

Little-endian: ``TRUNDLE1``, the length of the header and 0 as uint32, the header, the columns. Offsets count from the
end of the header. A column's numbers count as unsigned integers of their own width, whatever they are. Each row gives
way to its second difference from the two before it, those before the first being 0; where it overflows it wraps, so
that nothing is lost. Of these differences stand first the first bytes of all rows, then their second bytes, and so on.
A motion is smooth, so what stands side by side is much alike, and is sent compressed to half of what rows would be.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import TrundleError
from .mesh import Mesh, columns_of_mesh

MAGIC = b"TRUNDLE1"
FORMAT = 3
_START = struct.Struct("<8sII")
_TYPES = ("float32", "float64", "uint32", "uint8")


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything that a viewer needs to draw a run.

    Examples
    --------
    >>> scene = Scene({"title": "Still"}, {"time": np.array([0.0, 1.0])}, {"time": "s"})
    >>> unpack(pack(scene)).columns["time"]
    array([0., 1.])
    """

    header: dict[str, Any]  # title, scenario, body, support, events, findings, formula: plain values, as JSON has them
    # samples over `time`, and the two meshes, each as float32, float64, uint32 or uint8
    columns: dict[str, NDArray[Any]]
    units: dict[str, str] = field(default_factory=dict)  # the unit of each column that has one
    meshes: Mapping[str, Mesh] = field(default_factory=dict)  # that are among the columns: "body" and "support"


def pack(scene: Scene, known: Collection[str] | None = None) -> bytes:
    """Return a scene as bytes.

    `known`: the names of meshes that whoever reads it has from before. Then the header names the scene's own under
    `meshes`, with their size, and those that are known, be it in another size, are left out.

    Examples
    --------
    >>> blob = pack(Scene({"title": "Still"}, {"phase": np.zeros(3, dtype=np.uint8)}))
    >>> blob[:8], len(blob)
    (b'TRUNDLE1', 107)
    """
    described, parts, offset = {}, [], 0
    named = {} if known is None else scene.meshes
    left_out = {
        column for whose, mesh in named.items() if mesh.name in (known or ()) for column in columns_of_mesh(whose)
    }
    for name, column in scene.columns.items():
        if name in left_out:
            continue
        kind = _name(column.dtype)
        if kind not in _TYPES:
            raise TypeError(f"the column {name!r} must be one of {', '.join(_TYPES)}; got {kind}")
        described[name] = {
            "dtype": kind,
            "shape": list(column.shape),
            "offset": offset,
            "unit": scene.units.get(name, ""),
        }
        parts.append(_differences(column) if column.size else b"")
        offset += len(parts[-1])
    meshes = {whose: {"name": mesh.name, "size": mesh.size} for whose, mesh in named.items()}
    header = plain({**scene.header, "columns": described, **({"meshes": meshes} if meshes else {})})
    text = json.dumps(header, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()
    return b"".join([_START.pack(MAGIC, len(text), 0), text, *parts])


def unpack(blob: bytes) -> Scene:
    """Return the scene that `pack` wrote.

    Examples
    --------
    >>> unpack(b"something else")
    Traceback (most recent call last):
    ...
    trundle.errors.TrundleError: These bytes are no scene of trundle's: they do not begin with TRUNDLE1.
    """
    if len(blob) < _START.size or not blob.startswith(MAGIC):
        raise TrundleError(f"These bytes are no scene of trundle's: they do not begin with {MAGIC.decode()}.")
    _, length, _ = _START.unpack_from(blob)
    begin = _START.size + length
    try:
        header = json.loads(blob[_START.size : begin])
        described: Mapping[str, Any] = header.pop("columns")
        columns = {name: _column(blob, begin, facts) for name, facts in described.items()}
    except (ValueError, KeyError, TypeError) as error:
        raise TrundleError(f"This scene is damaged or cut short ({error}).") from None
    return Scene(header, columns, {name: facts["unit"] for name, facts in described.items() if facts["unit"]})


@cache  # NumPy puts it together each time
def _name(kind: np.dtype[Any]) -> str:
    return kind.name


def _differences(column: NDArray[Any]) -> bytes:
    rows = np.ascontiguousarray(column, dtype=column.dtype.newbyteorder("<")).reshape(len(column), -1)
    words = rows.view(f"<u{rows.itemsize}")
    for _ in range(2):
        words, before = words.copy(), words
        words[1:] -= before[:-1]
    return words.view(np.uint8).T.tobytes()


def _column(blob: bytes, begin: int, facts: Mapping[str, Any]) -> NDArray[Any]:
    if facts["dtype"] not in _TYPES:
        raise ValueError(f"a column of {facts['dtype']!r}")
    kind, shape = np.dtype(facts["dtype"]).newbyteorder("<"), tuple(facts["shape"])
    count = math.prod(shape)
    if count == 0:
        return np.zeros(shape, kind)
    planes = np.frombuffer(blob, np.uint8, count * kind.itemsize, begin + facts["offset"]).reshape(-1, shape[0])
    words = np.ascontiguousarray(planes.T).view(f"<u{kind.itemsize}")
    for _ in range(2):
        words = np.cumsum(words, axis=0, dtype=words.dtype)
    return words.view(kind).reshape(shape)


def plain(value: Any) -> Any:
    """Return a value as JSON has it: NumPy's numbers as Python's, and null for what is not finite.

    Examples
    --------
    >>> plain({"rate": np.float64(1.5), "ratio": float("inf"), "pair": (1, True)})
    {'rate': 1.5, 'ratio': None, 'pair': [1, True]}
    """
    kind = type(value)
    if kind is float:  # nearly all are of Python's own kinds
        return value if math.isfinite(value) else None
    if kind is str or kind is int or kind is bool or value is None:
        return value
    if isinstance(value, Mapping):
        return {str(key): plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [plain(part) for part in value]
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
