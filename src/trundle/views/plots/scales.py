"""Round numbers and thinning for figures: no visible point is lost."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Lines longer than this are thinned before they are drawn.
LONG_LINE = 100_000


def round_step(span: float, most: int) -> float:
    """Return the least of 1, 2, 5 times a power of ten that divides a span into few enough parts.

    Examples
    --------
    >>> round_step(60.0, 12), round_step(1.7, 12)
    (5.0, 0.2)
    """
    least = span / most
    power = 10.0 ** math.floor(math.log10(least))
    return next(float(f"{count * power:.3g}") for count in (1, 2, 5, 10) if count * power >= least * (1 - 1e-9))


def refined(time: Array, points: Array, velocity: Array, parts: int) -> Array:
    """Round off a coarsely sampled path with the cubics that join its samples at their velocities.

    Examples
    --------
    >>> t = np.linspace(0.0, 6.0, 13)
    >>> circle, along = np.column_stack([np.cos(t), np.sin(t)]), np.column_stack([-np.sin(t), np.cos(t)])
    >>> bool(np.max(np.abs(np.hypot(*refined(t, circle, along, 8).T) - 1.0)) < 2e-4)
    True
    """
    step = np.diff(time)[:, None, None]
    s = (np.arange(parts) / parts)[None, :, None]
    before, after = points[:-1, None, :], points[1:, None, :]
    onward = step * (velocity[:-1, None, :] * (1 - s) - velocity[1:, None, :] * s)
    pieces = before + (after - before) * s * s * (3 - 2 * s) + onward * s * (1 - s)
    return np.vstack([pieces.reshape(-1, points.shape[1]), points[-1:]])


def thin_path(points: Array, tolerance: float, longest: int = LONG_LINE) -> Array:
    """Keep every n-th point of a long path, n the largest power of two that moves the line unnoticeably.

    Examples
    --------
    >>> turn = np.linspace(0.0, 2 * np.pi, 200_001)
    >>> len(thin_path(np.column_stack([np.cos(turn), np.sin(turn)]), 1e-4)) < 2000
    True
    """
    stride = 1
    while len(points) > longest and 2 * stride < len(points) and _moves(points, 2 * stride, sure=False) <= tolerance:
        stride *= 2
    while stride > 1 and _moves(points, stride, sure=True) > tolerance:
        stride //= 2
    return points if stride == 1 else points[_kept(len(points), stride)]


def thin_series(time: Array, values: Array, longest: int = LONG_LINE, buckets: int = 8000) -> tuple[Array, Array]:
    """Keep the least and the greatest value in each slice of a long series: more slices than a page has dots.

    Examples
    --------
    >>> time, values = thin_series(np.arange(1e6), np.sin(np.arange(1e6)))
    >>> len(values) <= 16_002
    True
    """
    count = len(time)
    if count <= longest:
        return time, values
    edges = np.linspace(0, count, buckets + 1).astype(int)[:-1]
    low, high = np.minimum.reduceat(values, edges), np.maximum.reduceat(values, edges)
    bucket = np.zeros(count, dtype=int)
    bucket[edges[1:]] = 1
    bucket = np.cumsum(bucket)
    first_low = _first(values == low[bucket], bucket)
    first_high = _first(values == high[bucket], bucket)
    kept = np.unique(np.concatenate([[0, count - 1], first_low, first_high]))
    return time[kept], values[kept]


def _first(chosen: NDArray[np.bool_], bucket: NDArray[np.int_]) -> NDArray[np.int_]:
    where = np.flatnonzero(chosen)
    _, first = np.unique(bucket[where], return_index=True)
    return where[first]


def _kept(count: int, stride: int) -> NDArray[np.int_]:
    kept = np.arange(0, count, stride)
    return kept if kept[-1] == count - 1 else np.append(kept, count - 1)


def _moves(points: Array, stride: int, sure: bool) -> float:
    """Return how far the line moves: at all points that it loses, or just half-way between those that it keeps."""
    kept = _kept(len(points), stride)
    index = np.arange(len(points)) if sure else np.arange(stride // 2, len(points), stride)
    across = np.interp(index, kept, points[kept, 0]) - points[index, 0]
    up = np.interp(index, kept, points[kept, 1]) - points[index, 1]
    return float(np.max(np.hypot(across, up)))
