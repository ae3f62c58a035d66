"""Slip that turns in a landing: Keller's equations for its size and direction, by their Taylor series.

The slip is σ ŝ with ŝ = (c, s), and dP = σ dτ of the normal impulse: in τ, ln σ and the angle of ŝ change alike fast,
however slow the slip is. All is in units of an impact: speeds as shares of one, M of its part along the normal.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import mul

from ..errors import SolverError
from .duals import slopes_of, value_of
from .scalars import Scalar, namespace

_TERMS = 32  # of a series
_PRECISION = 1e-18  # of what the last two of them are, as shares
_MOST_STEPS = 2000
_JAMMED = math.exp(30.0)  # times as fast as at first: what becomes so fast goes on without end
_ROUNDING = 2.0**-52
_FARTHEST = 1e9  # τ, where a series ends by itself


@dataclass(frozen=True)
class TurningSlip:
    """Slip at an instant of a landing."""

    M: Sequence[Sequence[Scalar]]  # by how much an impulse changes the slip, along two tangents and n
    mu: Scalar  # coefficient of friction
    size: Scalar  # σ
    c: Scalar  # ŝ along the first tangent
    s: Scalar  # ŝ along the second
    up: Scalar  # of the slip along n
    work: Scalar  # what the normal impulse did so far
    taken: Scalar  # what friction took so far

    def followed(self, least: float, aim: Scalar | None) -> tuple[TurningSlip, bool] | None:
        """Follow it until it is all but nothing, or the landing's part is over, and tell whether the first came.

        None where neither does, but slip grows on: friction jams the body.

        Parameters
        ----------
        least : float
            The size at which slip has all but ended.
        aim : float or None
            The work at which the landing ends; None: compression ends, at `up` = 0.

        Raises
        ------
        SolverError
            Its direction settles so fast that this takes too many steps.
        """
        now, jammed = self, _JAMMED * self.size
        row, value = (_UP, 0.0) if aim is None else (_WORK, aim)
        for _ in range(_MOST_STEPS):
            step = now.step
            if now.at(step)[row] >= value:
                return now.after(now.reaches(row, value, step)), False
            now = now.after(step)
            if now.size <= least:
                return now, True
            if not now.size < jammed:
                return None
        raise SolverError(
            "A landing is too stiff to follow: what is struck turns far too easily one way. Give a free axle more "
            "inertia, or use less friction."
        )

    @cached_property
    def terms(self) -> list[list[Scalar]]:
        """The coefficients of σ, c, s, `up`, the work and what friction took."""
        return self.series(_TERMS)

    def series(self, count: int) -> list[list[Scalar]]:
        """Return so many of them."""
        (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = self.M
        mu, n = self.mu, 1.0
        size, c, s, up, work, taken = [self.size], [self.c], [self.s], [self.up], [self.work], [self.taken]
        growth, turning, rising = (
            list[Scalar](),
            list[Scalar](),
            list[Scalar](),
        )  # of ln σ and the angle; of `up` over σ
        cc, cs, one = list[Scalar](), list[Scalar](), 1.0
        while True:
            cc.append(_product(c, c))
            cs.append(_product(c, s))
            ss = one - cc[-1]
            c_k, s_k = c[-1], s[-1]
            growth.append(xz * c_k + yz * s_k - mu * (xx * cc[-1] + (xy + yx) * cs[-1] + yy * ss))
            turning.append(yz * c_k - xz * s_k - mu * (yx * cc[-1] + (yy - xx) * cs[-1] - xy * ss))
            rising.append(zz * one - mu * (zx * c_k + zy * s_k))
            rates = (
                _product(size, growth),
                -_product(s, turning),
                _product(c, turning),
                _product(rising, size),
                _product(up, size),
                mu * _product(size, size),
            )
            for series, rate in zip((size, c, s, up, work, taken), rates, strict=True):
                series.append(rate / n)
            one, n = 0.0, n + 1.0
            if n == count:
                return [size, c, s, up, work, taken]

    @cached_property
    def step(self) -> float:
        """How far the series hold to the last digit, and where they are duals those of the slopes, too.

        Where the direction has settled it shows in the slopes alone how fast it does.
        """
        scales = [float(value_of(scale)) for scale in (self.size, 1.0, 1.0, 1.0, 1.0, 1.0)]
        several = [[value_of(part) for part in row] for row in self.terms], *self._slopes
        return min(_reach(series, scales, of_values=i == 0) for i, series in enumerate(several))

    @property
    def _slopes(self) -> Iterator[list[list[float]]]:
        """The coefficients of the slopes by each parameter."""
        count = max(len(slopes_of(row[-1], 0)) for row in self.terms)
        rows = [[slopes_of(part, count) for part in row] for row in self.terms]
        yield from ([[float(slopes[j]) for slopes in row] for row in rows] for j in range(count))

    def at(self, tau: Scalar) -> list[Scalar]:
        """Return σ, c, s, `up` and the works after some τ."""
        powers: list[Scalar] = [1.0]
        for _ in range(_TERMS - 1):
            powers.append(powers[-1] * tau)
        return [sum(map(mul, reversed(row), reversed(powers))) for row in self.terms]

    def after(self, tau: Scalar) -> TurningSlip:
        """Return the slip after some τ."""
        size, c, s, up, work, taken = self.at(tau)
        length = namespace(c, s).sqrt(c * c + s * s)
        return TurningSlip(self.M, self.mu, size, c / length, s / length, up, work, taken)

    def reaches(self, row: int, value: Scalar, end: float) -> Scalar:
        """Return the τ at which a number comes up to a value that it has passed at an end, by Newton or by halves."""
        series = [float(value_of(part)) for part in self.terms[row]]
        slopes = [k * part for k, part in enumerate(series)][1:]
        low, high, tau = 0.0, end, end
        while high - low > _ROUNDING * high:
            over = polynomial(series, tau) - value_of(value)
            low, high = (low, tau) if over >= 0 else (tau, high)
            slope = polynomial(slopes, tau)
            before, tau = tau, tau - over / slope if slope > 0 else low
            if not low < tau < high:
                tau = 0.5 * (low + high)
            if abs(tau - before) <= _ROUNDING * before:
                break
        # A step more on the terms themselves, which may be duals: so τ has their slopes.
        slope = polynomial(slopes, tau)
        return tau - (polynomial(self.terms[row], tau) - value) / slope if slope > 0 else tau


_UP, _WORK = 3, 4  # rows of the terms


def polynomial(series: Sequence[Scalar], tau: Scalar) -> Scalar:
    """Return a polynomial's value.

    Examples
    --------
    >>> polynomial([1.0, 0.0, 2.0], 3.0)
    19.0
    """
    found: Scalar = 0.0
    for part in reversed(series):
        found = found * tau + part
    return found


def _reach(series: Sequence[Sequence[float]], scales: Sequence[float], *, of_values: bool) -> float:
    """Return how far the last two terms stay as small as they must be beside the scales, or beside those before."""
    *others, before, last = (
        max(abs(number) / scale for number, scale in zip(column, scales, strict=True))
        for column in zip(*series, strict=True)
    )
    found, beside = _FARTHEST, [1.0] if of_values else others
    for share, power in ((before, _TERMS - 2), (last, _TERMS - 1)):
        if share > 0:
            found = min(found, max((_PRECISION * size / share) ** (1.0 / (power - k)) for k, size in enumerate(beside)))
    return found


def _product(one: list[Scalar], other: list[Scalar]) -> Scalar:
    """Return the last coefficient of the product of two series that are known so far."""
    return sum(map(mul, one, reversed(other)))
