"""Equations of Kepler's kind, t(x) = t for an x that only grows with the time, and the functions that they are made of.

Closed forms that are simple in another variable than the time come back to the time by one of these.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial
from typing import Any

import numpy as np

_MOST_STEPS = 400
_TABLE = 64  # parts, between which two or three of Newton's steps find x
_TERMS = 12  # of the series below |z| = 1: the next would be 1e-24
_EPSILON = 2.0**-52
_CLOSE = 1e-12  # share of x within which a step of Newton's method may be nothing but rounding
_SERIES = [(-1) ** n / factorial(2 * n + 3) for n in range(_TERMS)]


def inverse_of(time: Callable[[Any], tuple[Any, Any]], t: Any, high: Any) -> Any:
    """Return the x at which an increasing function has given values: Newton's method, kept within brackets.

    Examples
    --------
    >>> x = inverse_of(lambda x: (x + x**3, 1 + 3 * x**2), np.array([0.0, 10.0]), np.array([1.0, 1.0]))
    >>> np.round(x, 12).tolist()
    [0.0, 2.0]
    """
    t, high = np.broadcast_arrays(np.asarray(t, dtype=float), np.asarray(high, dtype=float))
    shape, t, high = t.shape, t.ravel(), high.ravel().copy()
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        x, low, high = _begun(time, t, high)
        last = high - low
        left = np.arange(t.size)  # those not yet found
        for _ in range(_MOST_STEPS):
            at, before, behind = x[left], low[left], high[left]
            now, rate = time(at)
            over = ~(now < t[left])
            before, behind = np.where(over, before, at), np.where(over, at, behind)
            better = at - (now - t[left]) / rate
            inside = (better >= before) & (better <= behind)
            better = np.where(inside, better, 0.5 * (before + behind))
            step = np.abs(better - at)
            # The steps of Newton's method shrink to the rounding of t(x), and then no more.
            rounding = inside & (step <= _CLOSE * np.abs(at)) & (4 * step >= last[left])
            done = (step <= _EPSILON * np.abs(at)) | (behind - before <= 2 * _EPSILON * behind) | rounding
            x[left], low[left], high[left], last[left] = better, before, behind, step
            left = left[~done]
            if not left.size:
                break
    return x.reshape(shape)


def _begun(time: Callable[[Any], tuple[Any, Any]], t: Any, high: Any) -> tuple[Any, Any, Any]:
    """Return a first x for each t, read off a table, and bounds between which it is."""
    latest, end = t.max(initial=0.0), high.max(initial=0.0)
    for _ in range(_MOST_STEPS):
        if not time(end)[0] < latest:
            break
        end = 2 * end
    table = np.linspace(0.0, end, _TABLE + 1)
    reached = time(table)[0]
    j = np.clip(np.searchsorted(reached, t, side="right") - 1, 0, _TABLE - 1)
    x = table[j] + (t - reached[j]) / (reached[j + 1] - reached[j]) * (table[j + 1] - table[j])
    x = np.where((x >= table[j]) & (x <= table[j + 1]), x, 0.5 * (table[j] + table[j + 1]))
    # A neighbour more on both sides, since t(x) may round otherwise the next time.
    return x, table[np.maximum(j - 1, 0)], table[np.minimum(j + 2, _TABLE)]


def precisely(time: Callable[[Any], tuple[Any, Any]], t: Any, near: float) -> Any:
    """Return the same with mpmath's digits, from a root known as a float.

    Examples
    --------
    >>> import mpmath
    >>> float(precisely(lambda x: (x + x**3, 1 + 3 * x**2), mpmath.mpf(10), 2.1))
    2.0
    """
    import mpmath

    x = mpmath.mpf(near)
    for _ in range(60):
        now, rate = time(x)
        step = (now - t) / rate
        x = x - step
        if abs(step) <= mpmath.eps * abs(x):
            break
    return x


def stumpff(square: Any, x: Any) -> tuple[Any, Any, Any, Any]:
    """Return cos νx, sin νx/ν, (1 − cos νx)/ν² and (x − sin νx/ν)/ν², smooth where ν² falls through zero.

    Examples
    --------
    >>> [float(part) for part in stumpff(0.0, np.array(2.0))]
    [1.0, 2.0, 2.0, 1.3333333333333333]
    """
    if type(x).__module__.partition(".")[0] == "mpmath":
        return _precise_stumpff(square, x)
    if not square:
        return 1 + 0 * x, x, 0.5 * x * x, x * x * x / 6
    nu, z = abs(square) ** 0.5, square * x * x
    with np.errstate(over="ignore", invalid="ignore"):
        half, sine = (np.sin(0.5 * nu * x), np.sin(nu * x)) if square > 0 else (np.sinh(0.5 * nu * x), np.sinh(nu * x))
        versine, s1 = 2 * (half / nu) ** 2, sine / nu
        rest = (x - s1) / square
    small = np.abs(z) < 1
    if np.any(small):  # where the difference would lose digits
        z, series = np.where(small, z, 0.0), _SERIES[-1]
        for term in _SERIES[-2::-1]:
            series = term + z * series
        rest = np.where(small, x * x * x * series, rest)
    return 1 - square * versine, s1, versine, rest


def _precise_stumpff(square: Any, x: Any) -> tuple[Any, Any, Any, Any]:
    import mpmath

    if not square:
        return 1 + 0 * x, x, x * x / 2, x**3 / 6
    with mpmath.extradps(3 * mpmath.mp.dps):
        nu = mpmath.sqrt(square)
        cosine, s1 = mpmath.cos(nu * x).real, (mpmath.sin(nu * x) / nu).real
        parts = (cosine, s1, (1 - cosine) / square, (x - s1) / square)
    cosine, s1, c2, s3 = (+part for part in parts)
    return cosine, s1, c2, s3
