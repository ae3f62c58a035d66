"""Equations of Kepler's kind, t(x) = t for an x that only grows with the time, and the functions that they are made of.

Closed forms that are simple in another variable than the time come back to the time by one of these.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial
from typing import Any

import numpy as np
from numpy.polynomial.polynomial import polyval

_MOST_STEPS = 400
_TERMS = 12  # of the series below |z| = 1: the next would be 1e-24
_EPSILON = 2.0**-52
_CLOSE = 1e-12  # share of x within which a step of Newton's method may be nothing but rounding
_SERIES = [[(-1) ** n / factorial(2 * n + k) for n in range(_TERMS)] for k in (2, 3)]


def inverse_of(time: Callable[[Any], tuple[Any, Any]], t: Any, high: Any) -> Any:
    """Return the x at which an increasing function has given values: Newton's method, kept within brackets.

    Parameters
    ----------
    time : callable
        Takes x (n,), returns t(x), which is 0 at 0, and dt/dx > 0.
    t : array (n,)
        At least 0.
    high : array (n,)
        A first guess; where it is too small, it is doubled.

    Returns
    -------
    array (n,)
        x ≥ 0.

    Examples
    --------
    >>> x = inverse_of(lambda x: (x + x**3, 1 + 3 * x**2), np.array([0.0, 10.0]), np.array([1.0, 1.0]))
    >>> np.round(x, 12).tolist()
    [0.0, 2.0]
    """
    t, high = np.broadcast_arrays(np.asarray(t, dtype=float), np.asarray(high, dtype=float))
    shape, t, high = t.shape, t.ravel(), high.ravel().copy()
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        low, high = _brackets(time, t, high)
        x, last = 0.5 * (low + high), high - low
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


def _brackets(time: Callable[[Any], tuple[Any, Any]], t: Any, high: Any) -> tuple[Any, Any]:
    """Return bounds between which each x is, from a first guess of the upper ones."""
    low = np.zeros_like(t)
    for _ in range(_MOST_STEPS):
        short = time(high)[0] < t
        if not short.any():
            break
        low, high = np.where(short, high, low), np.where(short, 2 * high, high)
    return low, high


def precisely(time: Callable[[Any], tuple[Any, Any]], t: Any, near: float) -> Any:
    """Return the same with mpmath's digits, from a root known as a float.

    Parameters
    ----------
    time : callable
        As for `inverse_of`, of mpmath's numbers.
    t : mpmath number
        At least 0.
    near : float
        x to some digits.

    Returns
    -------
    mpmath number
        x.

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

    Parameters
    ----------
    square : float or mpmath number
        ν², 1/s²; where it is negative, these are hyperbolic functions.
    x : array or mpmath number
        s.

    Returns
    -------
    tuple of 4
        As x.

    Examples
    --------
    >>> [float(part) for part in stumpff(0.0, np.array(2.0))]
    [1.0, 2.0, 2.0, 1.3333333333333333]
    """
    if type(x).__module__.partition(".")[0] == "mpmath":
        return _precise_stumpff(square, x)
    z = square * x * x
    small = np.abs(z) < 1
    near = np.where(small, z, 0.0)
    c2, s3 = (polyval(near, series) for series in _SERIES)
    nu = abs(square) ** 0.5
    with np.errstate(over="ignore", invalid="ignore"):
        y = np.where(small, 0.0, nu * x)
        half, sine = (np.sin(0.5 * y), np.sin(y)) if square > 0 else (np.sinh(0.5 * y), np.sinh(y))
    over = 1 / nu if nu else 0.0
    versine = np.where(small, x * x * c2, 2 * (half * over) ** 2)
    s1 = np.where(small, x * (1 - near * s3), sine * over)
    rest = np.where(small, x * x * x * s3, (x - s1) / (square or 1.0))
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
