"""The direction in which slip begins: the one that it keeps to when friction acts against it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

_TRIED = 90  # directions in which a change of sign is looked for


def onset(growth: Callable[[Any, Any], tuple[Any, Any, Any]]) -> list[tuple[float, tuple[float, float]]]:
    """Return how slip can begin: the directions ŝ with dŝ = 0 along which it grows, and how fast.

    Parameters
    ----------
    growth : callable
        The rate of change of s, two components, for friction against (cos β, sin β), given by cos β and sin β, numbers
        or arrays. Both are multiplied by a third number, which it returns with them, and which may vanish where
        friction jams the contact.

    Returns
    -------
    list of (float, (float, float))
        The rates at which slip grows, in the unit of `growth`, each with cos β and sin β, fastest first. None where
        friction jams the contact in all of them (Painlevé's paradox).

    Examples
    --------
    Where the body answers alike in all directions, slip begins the way it is driven, if friction is too weak:

    >>> onset(lambda c, s: (3.0 - 2.0 * c, -2.0 * s, 1.0))
    [(1.0, (1.0, 0.0))]
    >>> onset(lambda c, s: (-3.0 - 2.0 * c, -2.0 * s, 1.0))[0][1][0]
    -1.0
    >>> onset(lambda c, s: (3.0 - 4.0 * c, -4.0 * s, 1.0))
    []

    Where friction jams it in some directions, slip goes another way. Between the two no rate is finite, and none is
    taken for a root:

    >>> onset(lambda c, s: (3.0, 0.0, 0.5 - s))
    [(6.0, (1.0, 0.0))]
    """
    from scipy.optimize import brentq

    def across(angle: float) -> float:
        c, s = math.cos(angle), math.sin(angle)
        along_first, along_second, _ = growth(c, s)
        return float(c * along_second - s * along_first)

    angles = np.linspace(-math.pi, math.pi, _TRIED + 1)
    c, s = np.cos(angles), np.sin(angles)
    along_first, along_second, _ = growth(c, s)
    left = np.signbit(c * along_second - s * along_first)
    left[-1] = left[0]  # one direction: rounding leaves ŝ = (−1, 0) between the two
    found = []
    for i in np.flatnonzero(left[1:] != left[:-1]):
        ends = sorted((float(angles[i]), float(angles[i + 1])), key=lambda angle: abs(across(angle)))
        # An end that is the root itself: a number may have been rounded to the other side than the array.
        meets = across(ends[0]) * across(ends[1]) <= 0
        angle = brentq(across, *ends, xtol=1e-15) if meets else ends[0]
        way = math.cos(angle), math.sin(angle)
        along_first, along_second, share = growth(*way)
        if share:
            found.append((float((way[0] * along_first + way[1] * along_second) / share), way))
    return sorted((pair for pair in found if pair[0] > 0), reverse=True)
