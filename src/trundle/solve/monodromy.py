"""The rotation of a body over one period of its angular velocity, and its powers (theory page, section 5)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from operator import mul
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .exact.phi import two_product

Array = NDArray[np.float64]

_DIGITS = 40  # a million turns lose six of them
_BITS = 140
_TERMS = 60
_KEPT = 16  # motions: a run's card asks again
_HALF_TURN_A_STEP = 6.0  # rad of half the angle: the series of order 60 leaves 6^60/60! < 1e-35 of it


@dataclass(frozen=True)
class Monodromy:
    """The rotation over one period, kept to about 30 digits so that its millionth power has lost none that shows.

    Examples
    --------
    A ball whose Ω = (0, 0, 1) never changes has turned by 2π after 2π seconds, as after a million times that:

    >>> steady = Monodromy.of_turning_vector(constant=0, turning=0, along=1.0, rate=1.0)
    >>> [round(abs(c), 9) for c in steady.power(np.array([1e6])).ravel().tolist()]
    [1.0, 0.0, 0.0, 0.0]
    """

    period: float  # s
    period_remainder: float  # s; the period is the sum of the two
    axis: Array  # (3,): unit axis of the rotation, support frame
    half_turns: float  # the rotation's half angle, in full turns (half angle / 2π)
    half_turns_remainder: float  # to be added to it

    def power(self, n: Array) -> Array:
        """Return the rotation of n periods, shape (4, len(n)): the angle is reduced with 32 digits first."""
        whole, rounding = two_product(n, self.half_turns)
        part = (whole - np.round(whole)) + rounding + n * self.half_turns_remainder
        angle = 2 * math.pi * part
        return np.concatenate([np.cos(angle)[None], self.axis[:, None] * np.sin(angle)])

    @staticmethod
    @lru_cache(_KEPT)
    def of_turning_vector(constant: Any, turning: Any, along: Any, rate: Any) -> Monodromy:
        """Work out the rotation over one period of Ω_x + iΩ_y = C + D e^{iκt}, Ω_z constant.

        With a = w + iz and c = x − iy the quaternion obeys ȧ = ½(iΩ_z a − W c), ċ = ½(W̄ a − iΩ_z c), W = C + D e^{iκt};
        its power series is summed in multiple precision.

        Examples
        --------
        >>> Monodromy.of_turning_vector(2.0, 0.0, 0.0, 1.0).axis
        array([1., 0., 0.])
        """
        import mpmath

        with mpmath.workdps(_DIGITS):
            C, D, along, rate = mpmath.mpc(constant), mpmath.mpc(turning), mpmath.mpf(along), mpmath.mpf(rate)
            period = 2 * mpmath.pi / abs(rate)
            half_angle = (abs(C) + abs(D) + abs(along) + abs(rate)) * period / 2
            steps = 16 + int(mpmath.ceil(half_angle / _HALF_TURN_A_STEP))  # 16: e^{iκt} has a short series too
            unit, h = mpmath.mpf(2) ** _BITS, period / steps
            growth = [(mpmath.mpc(0, rate * h)) ** n / mpmath.factorial(n) for n in range(_TERMS)]
            # In a step of a fast spinner e^{iκt} hardly changes: of what is less than a unit nothing is left.
            growth = [growth[0], *(factor for factor in growth[1:] if abs(D * factor * h) * unit >= 1)]
            a, c = (int(unit), 0), (0, 0)
            for j in range(steps):
                turning = D * mpmath.expj(2 * mpmath.pi * mpmath.sign(rate) * j / steps)
                W = [turning * factor * h for factor in growth]
                W[0] += C * h
                fixed = [(int(w.real * unit), int(w.imag * unit)) for w in W]
                a, c = _step(fixed, int(along * h * unit), a, c)
            a, c = (mpmath.mpc(*part) / unit for part in (a, c))
            size = mpmath.sqrt(abs(a) ** 2 + abs(c) ** 2)
            w, z, x, y = a.real / size, a.imag / size, c.real / size, -c.imag / size
            sine = mpmath.sqrt(x * x + y * y + z * z)
            half = mpmath.atan2(sine, w) / (2 * mpmath.pi)
            axis = [float(part / sine) for part in (x, y, z)] if sine else [0.0, 0.0, 1.0]
            return Monodromy(*_two_floats(period), np.array(axis), *_two_floats(half))


def _two_floats(value: Any) -> tuple[float, float]:
    high = float(value)
    return high, float(value - high)


def _step(W: list[tuple[int, int]], spin: int, a: tuple[int, int], c: tuple[int, int]) -> tuple[tuple[int, int], ...]:
    """Advance (a, c) by one step: their power series, in integers that count units of 2^-_BITS.

    Sums of products of integers are exact and, in Python, ten times faster than mpmath's complex numbers.
    """
    W_re, W_im = [w[0] for w in W], [w[1] for w in W]
    a_re, a_im, c_re, c_im = [a[0]], [a[1]], [c[0]], [c[1]]
    for n in range(_TERMS):
        back = slice(n, n - len(W) if n >= len(W) else None, -1)
        aw = [(sumprod(W_re, p), sumprod(W_im, p)) for p in (a_re[back], a_im[back])]
        cw = [(sumprod(W_re, p), sumprod(W_im, p)) for p in (c_re[back], c_im[back])]
        scale = 2 * (n + 1) << _BITS
        new = (
            -spin * a_im[n] - (cw[0][0] - cw[1][1]),  # ȧ = ½(iΩ_z a − W c)
            spin * a_re[n] - (cw[1][0] + cw[0][1]),
            spin * c_im[n] + (aw[0][0] + aw[1][1]),  # ċ = ½(W̄ a − iΩ_z c)
            -spin * c_re[n] + (aw[1][0] - aw[0][1]),
        )
        for series, value in zip((a_re, a_im, c_re, c_im), new, strict=True):
            series.append(value // scale)
    return (sum(a_re), sum(a_im)), (sum(c_re), sum(c_im))


def sumprod(p: list[int], q: list[int]) -> int:
    """Return the sum of p_i q_i over the shorter of the two lists (math.sumprod needs Python 3.12 and equal lengths).

    Examples
    --------
    >>> sumprod([1, 2, 3], [10, 10])
    30
    """
    return sum(map(mul, p, q))
