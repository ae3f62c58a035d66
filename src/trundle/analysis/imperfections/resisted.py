"""A circle against resistance to rolling: what a force of steady size does to it, averaged over a round."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

_ROUNDS = 1e6  # integrated ahead: as long as anybody waits, twice over
_SMALL = 1e-4  # of two speeds: below it the mean is its first term, to 1e-9


@dataclass(frozen=True)
class ResistedCircle:
    """The distance c of a circle's centre from the axis and its radius A, under a force of steady size against rolling.

    The ball rolls over the table at w = −i(ωc + (ω − κ)A e^{iφ}), φ the angle from the centre's direction, and the
    force f changes the centre at i f/κ and the arm of the circle at −i f e^{−iκt}/κ. With the speeds P = ωc and
    Q = (ω − κ)A and the mean D of |P + Q e^{iφ}| over a round that is dc/dt = −η ∂D/∂P and dA/dt = η ∂D/∂Q: the centre
    comes in to the axis and the circle grows, by η where the centre is there.

    Parameters
    ----------
    rate, kappa : float
        Of the table and of the circle, rad/s.
    pace : float
        η = δg/(a k ω), m/s.
    offset, radius : float
        c and A at the start, m.

    Examples
    --------
    About the axis the circle grows steadily:

    >>> ResistedCircle(3.5, 1.0, 1e-3, 0.0, 0.1).at(100.0)
    (0.0, 0.2)
    """

    rate: float
    kappa: float
    max_rate: float
    offset: float
    radius: float

    def at(self, time: float) -> tuple[float, float]:
        """Return c and A at a time since the start, m.

        Examples
        --------
        >>> ResistedCircle(3.5, 1.0, 0.0, 0.2, 0.1).at(50.0)
        (0.2, 0.1)
        """
        if self.offset == 0:
            return 0.0, self.radius + (self.max_rate * time if self.radius else 0.0)
        if self.max_rate == 0:
            return self.offset, self.radius
        c, A = self._solution(time)
        return max(0.0, float(c)), float(A)

    @cached_property
    def _solution(self) -> Any:
        from scipy.integrate import solve_ivp

        over, past = abs(self.rate), abs(self.rate - self.kappa)

        def rates(_: float, state: Any) -> list[float]:
            P, Q = over * max(0.0, float(state[0])), past * max(0.0, float(state[1]))
            return [-self.max_rate * _slope(P, Q), self.max_rate * _slope(Q, P)]

        until = _ROUNDS * 2 * math.pi / abs(self.kappa)
        size = self.offset + self.radius
        first = [self.offset, self.radius]
        solved = solve_ivp(rates, (0.0, until), first, rtol=1e-10, atol=1e-12 * size, dense_output=True)
        return solved.sol


def _slope(P: float, Q: float) -> float:
    """Return ∂/∂P of the mean of |P + Q e^{iφ}| over φ, by complete elliptic integrals of m = 4PQ/(P + Q)²."""
    from scipy.special import ellipe, ellipkm1

    if P <= _SMALL * Q:
        return 0.5 * P / Q if Q > 0 else 0.0
    rest = ((P - Q) / (P + Q)) ** 2
    other = (P - Q) * ellipkm1(rest) if P != Q else 0.0
    return float(((P + Q) * ellipe(1 - rest) + other) / (np.pi * P))
