"""Smooth splines through tables of numbers, with their derivatives, evaluated on floats and arrays."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

from ...errors import InvalidValueError, OutOfDomainError
from ...units import to_si
from ..duals import has_duals, value_of
from ..scalars import Scalar, is_number, namespace

_LEAST = 4  # points along an axis: a cubic
_QUINTIC = 6


@dataclass(frozen=True, eq=False)
class Pieces:
    """A function that is a polynomial between any two of its knots, on a line or a grid.

    Examples
    --------
    >>> square = Pieces((0.0, 1.0), (0.0,), ((((1.0,), (0.0,), (0.0,)),), (((1.0,), (2.0,), (1.0,)),)))
    >>> square(3.0), square(-1.0)
    (9.0, 1.0)
    """

    x: tuple[float, ...]  # where its pieces begin along this axis
    y: tuple[float, ...]  # and along this; on a line (0,)
    # terms[i][j][a][b] for each piece: the coefficients, counted from where it begins, the highest powers first
    terms: tuple[Any, ...]

    @staticmethod
    def of(axes: Sequence[Sequence[float]], values: Any, orders: tuple[int, ...]) -> Pieces:
        """Return a derivative of the spline through values."""
        import numpy as np
        from scipy.interpolate import make_interp_spline

        found, starts = np.asarray(values, dtype=float), list[tuple[float, ...]]()
        for axis, order in zip(axes, orders, strict=True):
            degree = 5 if len(axis) >= _QUINTIC else 3
            line = make_interp_spline(np.asarray(axis), found, k=degree)
            begins = line.t[degree : -degree - 1]
            powers = range(max(degree - order, 0), -1, -1)
            found = np.stack([line(begins, nu=order + power) / math.factorial(power) for power in powers])
            found = np.moveaxis(found, (0, 1), (-2, -1))  # the next axis comes first
            starts.append(tuple(begins.tolist()))
        if len(starts) == 1:
            found, starts = found[..., None, None], [*starts, (0.0,)]
        x, y = starts
        return Pieces(x, y, _tuples(found.transpose(1, 3, 0, 2).tolist()))

    def __call__(self, x: Scalar, y: Scalar = 0.0) -> Scalar:
        """Return its value at a number, or at the places of arrays."""
        if is_number(x) and is_number(y):
            return evaluated(self.x, self.y, self.terms, float(x), float(y))
        import numpy as np

        x, y = np.broadcast_arrays(x, y)
        (i, u), (j, v) = _counted(np.asarray(self.x), x), _counted(np.asarray(self.y), y)
        terms, value = self._table[i, j], 0.0
        for a in range(terms.shape[-2]):
            part = 0.0
            for b in range(terms.shape[-1]):
                part = part * v + terms[..., a, b]
            value = value * u + part
        return value

    @cached_property
    def _table(self) -> Any:
        import numpy as np

        return np.asarray(self.terms)


def evaluated(starts: Any, others: Any, terms: Any, x: float, y: float = 0.0) -> float:
    """Return the value of pieces at a number; machine code has it, too, in the same order.

    Examples
    --------
    >>> evaluated((0.0,), (0.0,), ((((2.0,), (1.0,)),),), 3.0)
    7.0
    """
    i, j, last, end = 0, 0, len(starts) - 1, len(others) - 1
    while i < last:
        middle = (i + last + 1) // 2
        if x < starts[middle]:
            last = middle - 1
        else:
            i = middle
    while j < end:
        middle = (j + end + 1) // 2
        if y < others[middle]:
            end = middle - 1
        else:
            j = middle
    u, v, value = x - starts[i], y - others[j], 0.0
    for row in terms[i][j]:
        part = 0.0
        for term in row:
            part = part * v + term
        value = value * u + part
    return value


def _counted(starts: Any, places: Any) -> tuple[Any, Any]:
    """Return in which pieces places are, and how far from where those begin."""
    import numpy as np

    which = np.searchsorted(starts[1:], places.real, side="right")
    return which, places - starts[which]


def _tuples(nested: Any) -> Any:
    return tuple(map(_tuples, nested)) if isinstance(nested, list) else nested


class Spline:
    """The spline through a table of numbers on a line or a grid: quintic, C⁴, or cubic, C², through fewer than six.

    The numbers belong to the structure of a system, not to its parameters: a tape records no more than that a spline is
    evaluated, and no symbol is traced through it.

    Parameters
    ----------
    axes : sequence of 1 or 2 sequences of float
        Where the values are given, each ascending.
    values : (nested) sequence of float
        values[i] or values[i][j].

    Examples
    --------
    >>> square = Spline(((0.0, 1.0, 2.0, 3.0),), (0.0, 1.0, 4.0, 9.0))
    >>> round(square((1.5,)), 12), round(square((1.5,), (1,)), 12)
    (2.25, 3.0)
    """

    def __init__(self, axes: Sequence[Sequence[float]], values: Any) -> None:
        self.axes = tuple(tuple(axis) for axis in axes)
        self.values = values

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Spline) and (self.axes, self.values) == (other.axes, other.values)

    def __hash__(self) -> int:
        return hash((self.axes, self.values))

    def __repr__(self) -> str:
        return f"<spline through {' × '.join(str(len(axis)) for axis in self.axes)} points>"

    @cached_property
    def _known(self) -> dict[tuple[int, ...], Pieces]:
        """The spline and those of its derivatives that were asked for."""
        return {}

    def __call__(self, at: tuple[Scalar, ...], orders: tuple[int, ...] | None = None) -> Scalar:
        """Return the spline or a derivative of it."""
        orders = orders or (0,) * len(at)
        if has_duals(at):
            return self._in_duals(at, orders)
        if orders not in self._known:
            self._known[orders] = Pieces.of(self.axes, self.values, orders)
        pieces, functions = self._known[orders], namespace(*at)
        if hasattr(functions, "spline"):  # a tape's
            return functions.spline(pieces, *at)
        _check_evaluable(at)
        return pieces(*at)

    def _in_duals(self, at: tuple[Scalar, ...], orders: tuple[int, ...]) -> Scalar:
        """Return a derivative with its slopes, which are those of the place."""
        places = tuple(map(value_of, at))
        found: Scalar = self(places, orders)
        for i, place in enumerate(at):
            further = self(places, tuple(order + (i == j) for j, order in enumerate(orders)))
            found = found + (place - places[i]) * further
        return found


def _check_evaluable(at: tuple[Scalar, ...]) -> None:
    for value in at:
        if not is_number(value) and type(value).__module__ != "numpy":
            raise OutOfDomainError(
                "A surface given by a table of numbers has no formula to trace. "
                "Use method 'runge-kutta', or give the surface by a formula."
            )


def ascending(values: Any, key: str) -> tuple[float, ...]:
    """Return the places of a table along one axis.

    Examples
    --------
    >>> ascending(["0 cm", "1 cm", "2 cm", "3 cm"], "r")
    (0.0, 0.01, 0.02, 0.03)
    """
    places = lengths(values, key)
    if len(places) < _LEAST:
        raise InvalidValueError(key, f"must be {_LEAST} values at least", list(places), "Six or more make it smoother.")
    for before, after in pairwise(places):
        if not after > before:
            raise InvalidValueError(key, "must ascend", [before, after], "Sort the table, and give each place once.")
    return places


def lengths(values: Any, key: str) -> tuple[float, ...]:
    """Return a list of lengths in m.

    Examples
    --------
    >>> lengths([0, "5 mm"], "z")
    (0.0, 0.005)
    """
    if isinstance(values, str) or not hasattr(values, "__len__"):
        raise InvalidValueError(key, "must be a list of lengths", values, "Write for instance [0, 0.01, 0.04, 0.09].")
    return tuple(float(to_si(value, "length", f"{key}[{i}]")) for i, value in enumerate(values))
