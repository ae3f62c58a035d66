"""What chance alone does: how far the longest of many vectors of noise reaches."""

from __future__ import annotations

import math
from functools import lru_cache

CHANCE = 1e-4  # that noise alone exceeds the bound of one figure of a card
LEAST_FREEDOM = 1.0


@lru_cache
def longest(count: int, freedom: float, parts: int = 3, chance: float = CHANCE) -> float:
    """Return how long the longest of many vectors of noise becomes, in standard deviations of one component.

    Examples
    --------
    >>> round(longest(1, 1e9, parts=1, chance=0.05), 3), round(longest(240, 1e9), 2)
    (1.96, 5.7)
    """
    from scipy import special

    share = chance / max(count, 1)
    denominator = max(freedom, LEAST_FREEDOM)
    # F exceeds x with the chance I_y(ν/2, c/2), y = ν/(ν + c x): by its own tail, which keeps its digits.
    y = float(special.betaincinv(0.5 * denominator, 0.5 * parts, share))
    if denominator > 1e6:  # y is one to rounding: the limit is χ²
        return math.sqrt(2 * float(special.gammainccinv(0.5 * parts, share)))
    return math.sqrt(denominator * (1 - y) / y)
