"""Units, round numbers and thinning for figures: labels stay short, and no visible point is lost."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Lines longer than this are thinned before they are drawn.
LONG_LINE = 100_000


@dataclass(frozen=True)
class Unit:
    """A unit that an axis is labelled in: its size in SI and its symbol."""

    scale: float
    symbol: str


# Size in SI, symbol, and the least count of it for which it is taken; from large to small.
_Units = tuple[tuple[float, str, float], ...]
_LENGTHS: _Units = (
    (1e3, "km", 1.5),
    (1, "m", 2),
    (1e-2, "cm", 2),
    (1e-3, "mm", 1),
    (1e-6, "µm", 1),
    (1e-9, "nm", 1),
)
_TIMES: _Units = (
    (86400, "d", 3),
    (3600, "h", 3),
    (60, "min", 5),
    (1, "s", 0.1),
    (1e-3, "ms", 1),
    (1e-6, "µs", 1),
)
_UNITS: dict[str, _Units] = {
    "length": _LENGTHS,
    "speed": tuple((scale, f"{symbol}/s", least) for scale, symbol, least in _LENGTHS),
    "force": ((1e6, "MN", 2), (1e3, "kN", 2), (1, "N", 1), (1e-3, "mN", 1), (1e-6, "µN", 1), (1e-9, "nN", 1)),
    "time": _TIMES,
    "angular velocity": ((1, "rad/s", 0.01),),
    "torque": ((1, "N m", 1), (1e-3, "mN m", 1), (1e-6, "µN m", 1)),
    "damping": ((1, "kg/s", 0.5), (1e-3, "g/s", 0.5), (1e-6, "mg/s", 0.5)),
    "number": ((1, "", 5e-3),),
    "angle": ((math.pi / 180, "°", 1e-2),),
}
_SI = {
    "length": "m",
    "speed": "m/s",
    "force": "N",
    "time": "s",
    "angular velocity": "rad/s",
    "torque": "N m",
    "damping": "kg/s",
    "number": "",
    "angle": "rad",
}
_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def unit_for(size: float, kind: str) -> Unit:
    """Choose the unit in which a quantity of a given size reads shortest.

    Parameters
    ----------
    size : float
        The largest magnitude on the axis (SI).
    kind : str
        "length", "speed", "force", "time", "angular velocity", "torque", "damping", "angle" or "number".

    Returns
    -------
    Unit
        A named unit, or a power of ten of the SI unit where the named ones would need long labels.

    Examples
    --------
    >>> unit_for(0.5, "length").symbol, unit_for(3.0, "length").symbol, unit_for(1e-15, "length").symbol
    ('cm', 'm', '10⁻¹⁵ m')
    """
    if not math.isfinite(size) or size <= 0.0:
        size = 1.0
    scale, symbol, _ = _UNITS[kind][0]
    if size < 2e4 * scale:
        for scale, symbol, least in _UNITS[kind]:
            if size >= least * scale * (1.0 - 1e-9):
                return Unit(scale, symbol)
    power = math.floor(math.log10(size) + 1e-9)
    return Unit(10.0**power, f"10{str(power).translate(_SUPERSCRIPT)} {_SI[kind]}".strip())


def with_unit(value: float, kind: str, digits: int = 3) -> str:
    """Write a value with the unit that suits it.

    Parameters
    ----------
    value : float
        The value (SI).
    kind : str
        As in `unit_for`.
    digits : int
        Significant digits.

    Returns
    -------
    str
        Such as ``"36.8 cm/s"``.

    Examples
    --------
    >>> with_unit(0.36804, "speed"), with_unit(0.025, "length")
    ('36.8 cm/s', '2.5 cm')
    """
    unit = unit_for(abs(value), kind)
    return f"{short(value / unit.scale, digits)} {unit.symbol}".strip()


def as_ratio(value: float) -> str:
    """Write a number as a simple fraction where it is one, else with four digits.

    Parameters
    ----------
    value : float
        The number.

    Returns
    -------
    str
        Such as ``"2/5"``.

    Examples
    --------
    >>> as_ratio(0.4), as_ratio(2 / 3), as_ratio(0.37)
    ('2/5', '2/3', '0.37')
    """
    near = Fraction(value).limit_denominator(12)
    return str(near) if abs(float(near) - value) <= 1e-12 * abs(value) else short(value, 4)


def round_step(span: float, most: int) -> float:
    """Return the least of 1, 2, 5 times a power of ten that divides a span into few enough parts.

    Parameters
    ----------
    span : float
        What is divided, positive.
    most : int
        The largest number of parts allowed.

    Returns
    -------
    float
        The step, in the span's unit.

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

    Parameters
    ----------
    time : (n,) array
        s.
    points, velocity : (n, d) array
        m and m/s, in one frame.
    parts : int
        Pieces for each step; every sample stays a vertex.

    Returns
    -------
    ((n - 1) * parts + 1, d) array
        The vertices (m).

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

    Parameters
    ----------
    points : (n, 2) array
        The path (m).
    tolerance : float
        The largest distance by which the drawn line may differ (m).
    longest : int
        Paths up to this length are returned as they are.

    Returns
    -------
    (k, 2) array
        The points to draw; first and last are kept.

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

    Parameters
    ----------
    time, values : (n,) array
        The series.
    longest : int
        Series up to this length are returned as they are.
    buckets : int
        How many slices.

    Returns
    -------
    time, values : (k,) array
        The samples to draw, in order; first and last are kept.

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


def short(value: float, digits: int) -> str:
    """Write a number with so many significant digits, in typographer's signs.

    Parameters
    ----------
    value : float
        The number.
    digits : int
        Significant digits.

    Returns
    -------
    str
        Such as ``"−1.5·10⁻⁹"``.

    Examples
    --------
    >>> short(-1.5e-9, 3), short(1283.4, 3), short(33.3, 4)
    ('−1.5·10⁻⁹', '1283', '33.3')
    """
    text = f"{value:.{digits}g}"
    if "e" in text:
        mantissa, power = text.split("e")
        if 0 <= int(power) <= 4:
            text = f"{value:.0f}"
        else:
            exponent = f"10{str(int(power)).translate(_SUPERSCRIPT)}"
            text = exponent if mantissa == "1" else f"{mantissa}·{exponent}"
    return text.replace("-", "−")
