"""Where a function changes sign, to the last digit."""

from __future__ import annotations

from collections.abc import Callable

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
