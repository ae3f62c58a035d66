"""The first instant at which one of several functions of time falls through zero, to the last digit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..errors import SolverError
from .roots import root

_LOOKS_AT_ONCE = 100_000
_LEAST_LOOKS, _MOST_LOOKS = 256, 3e8  # these take minutes
_DEEPEST = 4.0  # times the larger step to its neighbours: a look at a minimum is no further above it


def first_stop(values: Callable[[Any], Any], looks: Sequence[tuple[float, float]]) -> tuple[float, int] | None:
    """Return when and which of several functions first falls through zero, also where it rises again at once.

    Parameters
    ----------
    values : callable
        Takes times (n,), s, or one time; returns the functions (k, n), or k numbers.
    looks : sequence of (float, float)
        How far to look, and the step between two looks as far as that, s: small against the pace at which the functions
        change there.

    Returns
    -------
    (float, int) or None
        The time, s, and the index of the function; None where none does.

    Raises
    ------
    SolverError
        If there are too many looks for a computer.

    Examples
    --------
    >>> found = first_stop(lambda t: np.array([np.cos(t), 1.0 + 0.0 * t]), [(1.0, 0.1), (10.0, 0.05)])
    >>> round(found[0] / (np.pi / 2), 15), found[1]
    (1.0, 0)
    """
    edges, steps = np.array([0.0, *(upto for upto, _ in looks)]), np.array([step for _, step in looks])
    duration = float(edges[-1])
    if duration <= 0:
        return None
    parts = np.ceil(np.diff(edges) / np.minimum(steps, duration / _LEAST_LOOKS))
    if not parts.sum() < _MOST_LOOKS:
        raise SolverError(
            f"What ends the motion within {duration:g} s would be looked for {parts.sum():.2g} times, since it changes "
            "so fast. Ask for a shorter run, or for another method."
        )
    upto = np.concatenate([[0], np.cumsum(parts.astype(np.int64))])
    for first in range(0, int(upto[-1]) + 1, _LOOKS_AT_ONCE):
        # One look over on either side.
        index = np.arange(max(0, first - 1), min(first + _LOOKS_AT_ONCE, int(upto[-1]) + 1) + 1)
        t = np.interp(index, upto, edges)
        t[index > upto[-1]] = duration + (duration - edges[-2]) / parts[-1]
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
    if not function(begin) > 0:  # it falls at once: alone and among others, rounding may differ
        return begin
    if function(end) >= 0:
        return end
    return root(function, begin, end)
