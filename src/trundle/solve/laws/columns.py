"""The columns of many states, as records take them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...mechanics.algebra import Vector
from ..samples import Array


def columns_of(states: Array, size: int) -> tuple[Array, Array, Array, Array]:
    """Return p, unit q, Ω and the support's own coordinates."""
    return states[:, :3].copy(), unit_rows(states[:, 3:7]), states[:, 7:10].copy(), states[:, size:].copy()


def unit_rows(q: Array) -> Array:
    """Return quaternions of norm 1."""
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def arrays(like: Array, *vectors: Vector) -> list[Array]:
    """Return vectors as arrays of the shape of another."""
    return [np.broadcast_to(vector.array(), like.shape).copy() for vector in vectors]


def phase_of(time: Array, code: int) -> Any:
    """Return the code of one phase for each time."""
    return np.full(time.size, code, dtype=np.int8)
