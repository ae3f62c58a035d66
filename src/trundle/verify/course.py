"""The course of slip in a landing, worked out a second time: what `mechanics.impact` found is compared with it.

The law is the same (theory page, T4b, and Stronge's restitution), the way is not. Slip that turns is followed in a
variable in which nothing is singular: with dτ = dP_n/|s_t| Keller's equations are ds/dτ = |s_t| M n − μ M s_t, slip
falls off exponentially where friction ends it, and the impulse follows from M P = Δs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .bounds import Array

_ENDED = 1e-12  # of the slip at first: what is left of slip that has ended
_STRAIGHT = 1e-14  # of M, by which slip along one line seems to turn
_MOST_PIECES = 20
_MOST_STEPS = 1000
_TERMS = 24  # of a Taylor series
_PRECISION = 1e-17


@dataclass
class Course:
    """A landing from the slip with which it begins, along two tangents and n.

    Parameters
    ----------
    M : array (3, 3)
        By how much an impulse at the contact changes s, 1/kg.
    mu : float or None
        Coefficient of friction; None: no limit.
    restitution : float
        e.
    slip : array (3,)
        s just before, m/s, its third component negative.

    Examples
    --------
    A ball of 1 kg that comes down at 2 m/s, slips at 1 m/s, and grips on the way:

    >>> course = Course(np.diag([3.5, 3.5, 1.0]), 0.3, 0.5, np.array([1.0, 0.0, -2.0]))
    >>> course.impulse().round(12).tolist(), course.turned
    ([-0.285714285714, 0.0, 3.0], False)
    """

    M: Array
    mu: float | None
    restitution: float
    slip: Array
    turned: bool = False  # whether the slip changed its direction on the way
    work: float = 0.0  # of the normal impulse, J
    aim: float | None = None  # the work at which it ends, known once compression is over

    def impulse(self) -> Array:
        """Return P along two tangents and n, N s; not a number where no impulse ends the landing."""
        begin, size = self.slip.copy(), float(np.linalg.norm(self.slip))
        if self.mu is None:  # no slip outlasts the first of the impulse
            ending = np.append(np.linalg.solve(self.M[:2, :2], -self.slip[:2]), 0.0)
            self.slip = self.slip + self.M @ ending
            self.slip[:2] = 0.0
        for _ in range(_MOST_PIECES):
            if self.aim is None and self.slip[2] >= 0:
                self.aim = (1 - self.restitution**2) * self.work
            if self.aim is not None and self.work >= self.aim:
                return np.asarray(np.linalg.solve(self.M, self.slip - begin))
            if not self._go_on(size):
                break
        return np.full(3, np.nan)

    def _go_on(self, size: float) -> bool:
        """Go on by one piece: slip along a line, slip that turns, or no slip; tell whether there is a way on."""
        sigma = float(np.hypot(*self.slip[:2]))
        if self.mu == 0:
            return self._line(np.array([0.0, 0.0, 1.0]))
        if self.mu is None or sigma <= 2 * _ENDED * size:
            return self._from_no_slip()
        hat = self.slip[:2] / sigma
        rate = self.M @ np.append(-self.mu * hat, 1.0)
        if abs(hat[0] * rate[1] - hat[1] * rate[0]) > _STRAIGHT * np.abs(self.M).max():
            self.turned = True
            return self._curve()
        along = float(hat @ rate[:2])
        return self._line(np.append(-self.mu * hat, 1.0), -sigma / along if along < 0 else np.inf)

    def _from_no_slip(self) -> bool:
        """Go on from where slip has ended: it stays so where the friction cone allows it, and else begins again."""
        stays = np.linalg.solve(self.M, [0.0, 0.0, 1.0])
        stays = stays / stays[2]
        if self.mu is None or np.hypot(*stays[:2]) <= self.mu:
            goes_on = self._line(stays)
            self.slip[:2] = 0.0
            return goes_on
        begins = _begins(self.M, self.mu)
        return begins is not None and self._line(begins)

    def _line(self, way: Array, ends: float = np.inf) -> bool:
        """Go on along one direction of the impulse to the first of: slip ends, compression ends, the landing ends."""
        rate, up, left = self.M @ way, float(self.slip[2]), 0.0 if self.aim is None else self.aim - self.work
        if self.aim is None:
            upto = -up / rate[2] if rate[2] > 0 else np.inf
        else:  # up P + ½ rate P² = left
            root = up * up + 2 * rate[2] * left
            upto = 2 * left / (up + np.sqrt(root)) if root >= 0 and up + np.sqrt(root) > 0 else np.inf
        amount = min(upto, ends)
        if not np.isfinite(amount):
            return False
        self.work += up * amount + 0.5 * float(rate[2]) * amount**2
        self.slip = self.slip + amount * rate
        if ends <= upto:
            self.slip[:2] = 0.0
        elif self.aim is None:
            self.slip[2] = 0.0
        else:
            self.work = max(self.work, self.aim)
        return True

    def _curve(self) -> bool:
        """Follow slip that turns to the first of the same three ends, by its Taylor series in τ."""
        speed, aim = float(np.linalg.norm(self.slip)), self.aim
        series = _Series.of(self.M, float(self.mu or 0.0), self.slip / speed, self.work / speed**2)
        least = _ENDED * series.length
        for _ in range(_MOST_STEPS):
            step = series.step()
            over = (lambda t: series.at(t)[2]) if aim is None else (lambda t: series.at(t)[3] - aim / speed**2)
            stops = over(step) >= 0
            if stops:
                step = _root(over, step)
            series = series.after(step)
            ended = series.length <= least
            if stops or ended:
                self.slip, self.work = np.array(series.slip) * speed, series.work * speed**2
                if stops:
                    self.work, self.slip[2] = (self.work, 0.0) if aim is None else (aim, self.slip[2])
                else:
                    self.slip[:2] = 0.0
                return True
        return False


@dataclass(frozen=True)
class _Series:
    """Taylor series of s, for a speed of 1, and of the work of P_n at one instant of τ."""

    push: Array  # M n
    drag: Array  # μ M, its first two columns
    slip: tuple[float, float, float]
    work: float

    @staticmethod
    def of(M: Array, mu: float, slip: Array, work: float) -> _Series:
        x, y, z = slip.tolist()
        return _Series(M[:, 2], mu * M[:, :2], (x, y, z), work)

    @property
    def length(self) -> float:
        """|s_t|."""
        return float(np.hypot(*self.slip[:2]))

    @cached_property
    def terms(self) -> Array:
        """The coefficients of s and of the work, (4, terms)."""
        s, length, w = np.zeros((3, _TERMS)), np.zeros(_TERMS), np.zeros(_TERMS)
        s[:, 0], length[0], w[0] = self.slip, self.length, self.work
        for k in range(_TERMS - 1):
            if k:
                square = (s[:2, : k + 1] * s[:2, k::-1]).sum()
                length[k] = (square - length[1:k] @ length[k - 1 : 0 : -1]) / (2 * length[0])
            s[:, k + 1] = (length[k] * self.push - self.drag @ s[:2, k]) / (k + 1)
            w[k + 1] = s[2, : k + 1] @ length[k::-1] / (k + 1)
        return np.vstack([s, w])

    def step(self) -> float:
        """Return how far the series holds to the last digit."""
        last = np.abs(self.terms[:, -2:]).max(axis=0) / self.length
        reach = [(_PRECISION / max(c, 1e-300)) ** (1 / n) for n, c in zip((_TERMS - 2, _TERMS - 1), last, strict=True)]
        return min(reach)

    def at(self, t: float) -> Array:
        """Return s and the work at a τ."""
        return self.terms @ t ** np.arange(_TERMS)

    def after(self, t: float) -> _Series:
        """Return the series about a τ."""
        x, y, z, w = self.at(t).tolist()
        return _Series(self.push, self.drag, (x, y, z), w)


def _root(over: Callable[[float], float], step: float) -> float:
    """Return where a function that ends above zero passes through it."""
    from scipy.optimize import brentq

    return 0.0 if over(0.0) >= 0 else float(brentq(over, 0.0, step, xtol=1e-300, rtol=1e-15))


def _begins(M: Array, mu: float) -> Array | None:
    """Return the impulse for each unit of P_n of slip that begins from nothing: along ŝ, which it keeps to.

    Of ŝ = (1 − x², 2x)/(1 + x²) the part of ds/dP_n across ŝ is a polynomial of degree 4 in x.
    """
    a, B = M[:2, 2], mu * M[:2, :2]
    c, s, one = np.array([-1.0, 0.0, 1.0]), np.array([0.0, 2.0, 0.0]), np.array([1.0, 0.0, 1.0])
    first, second = (a[i] * one - B[i, 0] * c - B[i, 1] * s for i in range(2))
    roots = np.append(np.roots(np.convolve(c, second) - np.convolve(s, first)), 1e300)  # the last: ŝ = (−1, 0)
    best, found = 0.0, None
    for x in roots[np.abs(roots.imag) <= 1e-7 * (1 + np.abs(roots))].real:
        angle = 2 * np.arctan(x)
        hat = np.array([np.cos(angle), np.sin(angle)])
        rate = a - B @ hat
        across = abs(hat[0] * rate[1] - hat[1] * rate[0])
        if across <= 1e-6 * np.abs(M).max() and hat @ rate > best:
            best, found = float(hat @ rate), np.append(-mu * hat, 1.0)
    return found
