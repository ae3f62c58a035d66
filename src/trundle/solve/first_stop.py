"""The first instant at which one of several functions of time falls through zero, to the last digit."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

_LOOKS_AT_ONCE = 100_000
_LEAST_LOOKS = 256
_DEEPEST = 4.0  # times the larger step to its neighbours: a look at a minimum is no further above it
_EPSILON = 2.0**-52


def first_stop(values: Callable[[Any], Any], duration: float, step: float) -> tuple[float, int] | None:
    """Return when and which of several functions first falls through zero, also where it rises again at once.

    Parameters
    ----------
    values : callable
        Takes times (n,), s, or one time; returns the functions (k, n), or k numbers.
    duration : float
        How far to look, s.
    step : float
        Between two looks, s: small against the pace at which the functions change.

    Returns
    -------
    (float, int) or None
        The time, s, and the index of the function; None where none does.

    Examples
    --------
    >>> found = first_stop(lambda t: np.array([np.cos(t), 1.0 + 0.0 * t]), 10.0, 0.05)
    >>> round(found[0] / (math.pi / 2), 15), found[1]
    (1.0, 0)
    """
    if duration <= 0:
        return None
    looks = max(_LEAST_LOOKS, math.ceil(duration / step)) + 1
    step = duration / (looks - 1)
    for first in range(0, looks, _LOOKS_AT_ONCE):
        index = np.arange(max(0, first - 1), min(first + _LOOKS_AT_ONCE, looks) + 1)  # one look over on either side
        t = index * step
        falls = [(_fall(_part(values, which), t, value), which) for which, value in enumerate(values(t))]
        found = [(at, which) for at, which in falls if at is not None and at <= duration]
        if found:
            return min(found)
    return None


def _part(values: Callable[[Any], Any], which: int) -> Callable[[float], float]:
    return lambda t: float(values(t)[which])


def _fall(function: Callable[[float], float], t: Any, value: Any) -> float | None:
    """Return where one function first falls through zero, given looks at it."""
    inside = value >= 0
    falls = inside[:-1] & ~inside[1:]
    dips = np.zeros_like(falls)
    before, after = value[:-2] - value[1:-1], value[2:] - value[1:-1]
    lowest = inside[1:-1] & (before > 0) & (after >= 0)
    dips[1:] = lowest & (value[1:-1] - _DEEPEST * np.maximum(before, after) < 0)
    for j in np.flatnonzero(falls | dips):
        if falls[j]:
            return _root(function, float(t[j]), float(t[j + 1]))
        low = _lowest(function, float(t[j - 1]), float(t[j + 1]))
        if function(low) < 0:
            return _root(function, float(t[j - 1]), low)
    return None


def _lowest(function: Callable[[float], float], begin: float, end: float) -> float:
    from scipy.optimize import minimize_scalar

    bounds = (begin, end)
    return float(minimize_scalar(function, bounds=bounds, method="bounded", options={"xatol": 1e-9 * (end - begin)}).x)


def _root(function: Callable[[float], float], begin: float, end: float) -> float:
    from scipy.optimize import brentq

    if not function(begin) > 0:  # it falls at once: alone and among others, rounding may differ
        return begin
    if function(end) >= 0:
        return end
    return float(brentq(function, begin, end, xtol=1e-300, rtol=4 * _EPSILON))
