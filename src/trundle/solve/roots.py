"""Where a function changes sign, to the last digit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

_MOST_STEPS = 10_000  # beside a root of high order it halves, and halves may be many: as many as there are floats
_EPSILON = 2.0**-52


def root(function: Callable[[float], float], begin: float, end: float, nearest: float = 1e-300) -> float:
    """Return where a function changes sign between two places.

    Examples
    --------
    >>> root(lambda x: (x - 0.5) ** 3, 0.0, 2.0)
    0.5
    >>> root(lambda x: x**21, -1.0, 3.0) < 1e-14
    True
    """
    from scipy.optimize import brentq

    return float(brentq(function, begin, end, xtol=nearest, rtol=4 * _EPSILON, maxiter=_MOST_STEPS))


def until_one_falls(before: NDArray[np.float64], now: NDArray[np.float64], gone: float) -> float:
    """Return after which time one of some positive numbers comes to zero if they go on falling as they fell; else ∞.

    Examples
    --------
    >>> until_one_falls(np.array([3.0, 1.0]), np.array([2.0, 4.0]), 0.5)
    1.0
    """
    falling = (now > 0) & (before > now)
    return float(np.min(now[falling] * gone / (before - now)[falling], initial=np.inf))
