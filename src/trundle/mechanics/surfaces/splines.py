"""Smooth splines through tables of numbers, with their derivatives, evaluated on floats and arrays."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any

from ...errors import InvalidValueError, OutOfDomainError
from ...units import to_si
from ..duals import has_duals, value_of
from ..scalars import Scalar, is_number

_LEAST = 4  # points along an axis: a cubic
_QUINTIC = 6


class Spline:
    """The spline through a table of numbers on a line or a grid: quintic, C⁴, or cubic, C², through fewer than six.

    The numbers belong to the structure of a system, not to its parameters: nothing is traced through a spline.

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
    def _spline(self) -> Any:
        import numpy as np
        from scipy.interpolate import NdBSpline, make_interp_spline

        coefficients, knots = np.asarray(self.values, dtype=float), []
        degrees = tuple(5 if len(axis) >= _QUINTIC else 3 for axis in self.axes)
        for i, (axis, degree) in enumerate(zip(self.axes, degrees, strict=True)):
            line = make_interp_spline(np.asarray(axis), coefficients, k=degree, axis=i)
            knots.append(line.t)
            coefficients = np.moveaxis(line.c, 0, i)
        return NdBSpline(tuple(knots), coefficients, degrees, extrapolate=True)

    def __call__(self, at: tuple[Scalar, ...], orders: tuple[int, ...] | None = None) -> Scalar:
        """Return the spline or a derivative of it."""
        import numpy as np

        if has_duals(at):
            return self._in_duals(at, orders or (0,) * len(at))
        _check_evaluable(at)
        places = np.stack(np.broadcast_arrays(*at), axis=-1)
        orders = orders or (0,) * len(at)
        value = self._spline(places.real, nu=orders)
        if np.iscomplexobj(places):  # a step aside into the complex plane, for a derivative: to first order
            for i in range(len(at)):
                further = tuple(order + (i == j) for j, order in enumerate(orders))
                value = value + 1j * places.imag[..., i] * self._spline(places.real, nu=further)
        return float(value) if all(map(is_number, at)) else value

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
