"""The direction in which slip begins: the one that it keeps to when friction acts against it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

_TRIED = 90  # directions in which a change of sign is looked for


def onset(growth: Callable[[float, float], tuple[float, float]]) -> tuple[float, tuple[float, float]] | None:
    """Return how slip begins: its direction ŝ, with dŝ = 0, and how fast it grows along it.

    Parameters
    ----------
    growth : callable
        The rate of change of s, two components, for friction against (cos β, sin β), given by cos β and sin β.

    Returns
    -------
    (float, (float, float)) or None
        The rate at which slip grows, in the unit of `growth`, and cos β and sin β: the fastest where there are several.
        None where none grows: friction jams the contact (Painlevé's paradox).

    Examples
    --------
    Where the body answers alike in all directions, slip begins the way it is driven, if friction is too weak:

    >>> onset(lambda c, s: (3.0 - 2.0 * c, -2.0 * s))
    (1.0, (1.0, 0.0))
    >>> onset(lambda c, s: (3.0 - 4.0 * c, -4.0 * s)) is None
    True
    """
    from scipy.optimize import brentq

    def across(angle: float) -> float:
        c, s = math.cos(angle), math.sin(angle)
        along_first, along_second = growth(c, s)
        return float(c * along_second - s * along_first)

    angles = np.linspace(-math.pi, math.pi, _TRIED + 1)
    values = [across(angle) for angle in angles]
    found = []
    for i in range(_TRIED):
        if values[i] * values[i + 1] <= 0:
            angle = brentq(across, angles[i], angles[i + 1], xtol=1e-15)
            c, s = math.cos(angle), math.sin(angle)
            along_first, along_second = growth(c, s)
            found.append((float(c * along_first + s * along_second), (c, s)))
    growing = [pair for pair in found if pair[0] > 0]
    return max(growing) if growing else None
