"""Integrals of smooth functions of time to the last digits, as functions of their upper end.

On each piece of time a function is interpolated at Chebyshev's points and the polynomial integrated. Floats take 24
points; where mpmath's numbers come in, so many more that all their digits are used.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import Vector
from ...mechanics.scalars import is_number

_POINTS = 24
_MOST_KNOWN = 1000
_POINTS_A_DIGIT = 1.1  # with pieces a third as long as the nearest singularity is away, 6.4⁻ⁿ is what is left


@dataclass(frozen=True)
class Rule:
    """Chebyshev's points on (−1, 1) and the matrices that belong to them; of floats or of mpmath's numbers.

    Examples
    --------
    >>> import math
    >>> abs(float(rule().total @ np.cos(rule().points)) - 2 * math.sin(1.0)) < 1e-15
    True
    """

    points: NDArray[Any]
    coefficients: NDArray[Any]  # from values at the points to a Chebyshev series
    antiderivative: NDArray[Any]  # from values to the series of the integral from −1
    running: NDArray[Any]  # from values to the integral from −1 to each point
    total: NDArray[Any]  # from values to the integral from −1 to 1


@cache
def rule(digits: int | None = None) -> Rule:
    """Return the rule for floats, or for mpmath's numbers of so many digits."""
    if digits is None:
        count, cos, pi, one = _POINTS, np.cos, np.pi, 1.0
    else:
        import mpmath

        count = int(_POINTS_A_DIGIT * digits) + 4
        cos, pi, one = np.frompyfunc(mpmath.cos, 1, 1), +mpmath.pi, mpmath.mpf(1)
    angles = (np.arange(count) * 2 + 1) * (pi / (2 * count))
    orders = np.arange(count + 1)
    table = cos(orders[:, None] * angles[None, :])  # T_k at the points
    coefficients = table[:-1] * (2 * one / count)
    coefficients[0] = coefficients[0] / 2
    # ∫T_k = T_{k+1}/(2(k+1)) − T_{k−1}/(2(k−1)), and the constant from the value 0 at −1.
    lower, upper = np.zeros_like(table), np.zeros_like(table)
    lower[1:] = coefficients
    lower[1] = 2 * lower[1]
    upper[1:-2] = coefficients[2:]
    antiderivative = (lower - upper) / np.maximum(2 * orders, 1)[:, None]
    signs = (-1) ** orders[1:]
    antiderivative[0] = -(signs[:, None] * antiderivative[1:]).sum(axis=0)
    return Rule(cos(angles), coefficients, antiderivative, table.T @ antiderivative, antiderivative.sum(axis=0))


def series_at(series: NDArray[Any], piece: Any, x: Any) -> Any:
    """Return the sums of Chebyshev series of several functions, each time in its piece, by Clenshaw's recurrence.

    Examples
    --------
    >>> float(series_at(np.array([0.0, 0.0, 1.0]).reshape(3, 1, 1), 0, 0.5)[0])  # 2x² − 1
    -0.5
    """
    twice = 2 * x
    ahead = behind = 0.0 * series[0].take(piece, axis=1) * x  # order by order: a million times are not 25 million
    for order in range(len(series) - 1, 0, -1):
        now = twice * ahead
        now -= behind
        now += series[order].take(piece, axis=1)
        ahead, behind = now, ahead
    return series[0].take(piece, axis=1) + x * ahead - behind


class Running:
    """∫₀ᵗ of several smooth functions at once, for any t between two ends.

    Parameters
    ----------
    function : callable
        Takes times (n,), returns values (functions, n).
    first, last : int
        Ends in steps; the first is at most 0.
    step : float
        Length of a piece, s: short beside the distance of the function's singularities from the real times.

    Examples
    --------
    >>> import math
    >>> sine = Running(lambda t: np.cos(t)[None], 0, 3, 1.0)
    >>> abs(float(sine.at(2.5)[0]) - math.sin(2.5)) < 1e-15
    True
    """

    def __init__(self, function: Callable[[Any], Any], first: int, last: int, step: float) -> None:
        self.first, self.step = first, step
        edges = np.arange(first, last) * step
        times = edges[:, None] + (0.5 * step) * (1 + rule().points)
        values = np.asarray(function(times.ravel())).reshape(-1, *times.shape)
        series = np.einsum("ki,fpi->kfp", rule().antiderivative, values) * (0.5 * step)
        sums = np.cumsum(series.sum(axis=0), axis=1)
        begins = np.concatenate([np.zeros_like(sums[:, :1]), sums], axis=1)
        series[0] += (begins - begins[:, -first : 1 - first or None])[:, :-1]
        self.series = series

    def at(self, t: Any) -> Any:
        """Return the integrals, (functions, ...), from 0 to t."""
        place = np.asarray(t) / self.step - self.first
        piece = np.clip(np.floor(place).astype(int), 0, self.series.shape[2] - 1)
        return series_at(self.series, piece, 2 * (place - piece) - 1)


class PreciseRunning:
    """The same with mpmath's numbers, from 0 on; pieces are worked out as they are needed.

    Parameters
    ----------
    function : callable
        Takes one time, returns a list of values.
    step : float
        Length of a piece, s.

    Examples
    --------
    >>> import mpmath
    >>> with mpmath.workdps(40):
    ...     abs(PreciseRunning(lambda t: [mpmath.cos(t)], 1.0).at(mpmath.mpf(2.5))[0] - mpmath.sin(2.5)) < 1e-39
    True
    """

    def __init__(self, function: Callable[[Any], Any], step: float) -> None:
        self.function, self.step = function, step
        self.sums: list[NDArray[Any]] = []  # up to the end of each piece
        self.known: dict[Any, NDArray[Any]] = {}  # the same time is asked for again and again
        self.digits = 0

    def at(self, t: Any) -> NDArray[Any]:
        """Return the integrals from 0 to t ≥ 0."""
        import mpmath

        if self.digits != mpmath.mp.dps or len(self.known) > _MOST_KNOWN:
            self.digits, self.sums, self.known = mpmath.mp.dps, [], {}
        if t not in self.known:
            self.known[t] = self._at(t)
        return self.known[t]

    def _at(self, t: Any) -> NDArray[Any]:
        import mpmath

        whole = max(0, int(mpmath.floor(t / self.step)))
        while len(self.sums) < whole:
            begin = len(self.sums) * mpmath.mpf(self.step)
            self.sums.append(self._sum(len(self.sums)) + self._piece(begin, mpmath.mpf(self.step)))
        begin = whole * mpmath.mpf(self.step)
        return self._sum(whole) + self._piece(begin, t - begin)

    def _sum(self, pieces: int) -> Any:
        return self.sums[pieces - 1] if pieces else 0

    def _piece(self, begin: Any, length: Any) -> NDArray[Any]:
        this = rule(self.digits)
        values = np.array([self.function(begin + length / 2 * (1 + x)) for x in this.points], dtype=object)
        return (this.total @ values) * (length / 2)


def is_one(form: Any) -> bool:
    """Tell whether every number of a closed form is a number, not an array of members."""
    return not any(np.ndim(value) for _, value in _numbers(form))


def one_by_one(form: Any, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
    """Return the motion of a closed form whose numbers are arrays of members, member after member."""
    t = np.asarray(t, dtype=float)
    shape = np.broadcast_shapes(t.shape, *(np.shape(value) for _, value in _numbers(form)))
    member_shape = np.broadcast_shapes((1,) * len(shape), *(np.shape(value) for _, value in _numbers(form)))
    times, result = np.broadcast_to(t, shape), np.empty((4, 3, *shape))
    for index in np.ndindex(member_shape):
        one = replace(
            form, **{field.name: _member(getattr(form, field.name), member_shape, index) for field in fields(form)}
        )
        here = tuple(slice(None) if size == 1 else i for size, i in zip(member_shape, index, strict=True))
        for rows, vector in zip(result, one.motion_at(times[here]), strict=True):
            for row, part in zip(rows, vector, strict=True):
                row[here] = part
    return tuple(Vector(*rows) for rows in result)  # type: ignore[return-value]


def _numbers(form: Any) -> Iterator[tuple[str, Any]]:
    for field in fields(form):
        value = getattr(form, field.name)
        for part in value if isinstance(value, tuple) else (value,):
            if is_number(part) or isinstance(part, np.ndarray):
                yield field.name, part


def _member(value: Any, shape: tuple[int, ...], index: tuple[int, ...]) -> Any:
    if isinstance(value, tuple):
        return tuple(_member(part, shape, index) for part in value)
    return float(np.broadcast_to(value, shape)[index]) if isinstance(value, np.ndarray) else value
