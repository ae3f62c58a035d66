"""The course of slip in a landing, worked out a second time: what `mechanics.impact` found is compared with it.

The law is the same (theory page, T4b, and Stronge's restitution), the way is not. Slip that turns is followed by its
components and their Taylor series, not by its size and angle: with dτ = dP_n/|s_t| Keller's equations are
ds/dτ = |s_t| M n − μ M s_t, slip falls off exponentially where friction ends it, and the impulse follows from M P = Δs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from operator import mul

import numpy as np

from .bounds import Array

_ENDED = 1e-13  # of the slip at first: what is left of slip that has ended
_STRAIGHT = 1e-14  # of M, by which slip along one line seems to turn
_MOST_PIECES = 20
_MOST_STEPS = 1000
_TERMS = 20  # of a Taylor series
_PRECISION = 1e-17


@dataclass
class Course:
    """A landing from the slip with which it begins, along two tangents and n.

    Examples
    --------
    A ball of 1 kg that comes down at 2 m/s, slips at 1 m/s, and grips on the way:

    >>> course = Course(np.diag([3.5, 3.5, 1.0]), 0.3, 0.5, np.array([1.0, 0.0, -2.0]))
    >>> course.impulse().round(12).tolist()
    [-0.285714285714, 0.0, 3.0]
    """

    M: Array  # (3, 3): by how much an impulse at the contact changes s, 1/kg
    mu: float | None  # coefficient of friction; None: no limit
    restitution: float  # e
    slip: Array  # (3,): s just before, m/s, its third component negative
    tangential: float = 0.0  # e_t: the share e_t² of what friction took comes back where the contact holds
    work: float = 0.0  # of the normal impulse, J
    aim: float | None = None  # the work at which it ends, known once compression is over
    taken: float = 0.0  # by friction, J: a difference of other works would lose it where it is small
    unused: float = 0.0  # what friction could have given besides while the contact held, N s

    def impulse(self) -> Array:
        """Return P along two tangents and n, N s; not a number where no impulse ends the landing."""
        begin, size = self.slip.copy(), float(np.linalg.norm(self.slip))
        if self.mu is None:  # no slip outlasts the first of the impulse
            self._end_at_once()
        for _ in range(_MOST_PIECES):
            if self.aim is None and self.slip[2] >= 0:
                self.aim = (1 - self.restitution**2) * self.work
            if self.aim is not None and self.work >= self.aim:
                self._give_back(begin)
                return np.asarray(np.linalg.solve(self.M, self.slip - begin))
            if not self._go_on(size):
                break
        return np.full(3, np.nan)

    def _give_back(self, begin: Array) -> None:
        """Add the impulse along that which ends the slip, by which a contact that holds gives back a share of its work.

        A body that comes straight down has no such impulse.
        """
        left, ending = self.tangential**2 * self.taken, np.linalg.solve(self.M[:2, :2], -begin[:2])
        along = float(np.hypot(*ending))
        if not (left > 0 and self.unused > 0 and along > 0):
            return
        way = np.append(ending / along, 0.0)
        presses = -float((self.M @ way)[2])
        free = max(0.0, float(self.slip[2])) / presses if presses > 0 else np.inf
        done, left = self._push(way, left, min(free, self.unused))
        if done < free:
            return
        # From s_n = 0 on the support holds against what presses the body onto it, which makes the cone wider.
        held = np.append(way[:2], presses / self.M[2, 2])
        wide = -np.inf if self.mu is None else 1.0 - held[2] * self.mu
        self._push(held, left, (self.unused - done) / wide if wide > 0 else np.inf)

    def _push(self, way: Array, work: float, most: float) -> tuple[float, float]:
        """Add an impulse along a direction until it has done some work; return it, and the work still left."""
        rate, first = self.M @ way, float(self.slip[:2] @ way[:2])
        gain = float(rate[:2] @ way[:2])
        amount = min(most, 2 * work / (first + np.sqrt(first * first + 2 * gain * work)) if work > 0 else 0.0)
        self.slip = self.slip + amount * rate
        return float(amount), work - amount * (first + 0.5 * gain * amount)

    def _end_at_once(self) -> None:
        """End the slip by an impulse along the support alone."""
        ending = np.append(np.linalg.solve(self.M[:2, :2], -self.slip[:2]), 0.0)
        self.taken -= 0.5 * float(self.slip @ ending)
        self.slip = self.slip + self.M @ ending
        self.slip[:2] = 0.0

    def _go_on(self, size: float) -> bool:
        """Go on by one piece: slip along a line, slip that turns, or no slip; tell whether there is a way on."""
        sigma = float(np.hypot(*self.slip[:2]))
        if self.mu == 0:
            return self._line(np.array([0.0, 0.0, 1.0]))
        if self.mu is None or sigma <= 2 * _ENDED * size:
            return self._from_no_slip()
        hat = self.slip[:2] / sigma
        way = np.append(-self.mu * hat, 1.0)
        rate = self.M @ way
        if abs(hat[0] * rate[1] - hat[1] * rate[0]) > _STRAIGHT * np.abs(self.M).max():
            return self._curve()
        along = float(hat @ rate[:2])
        return self._line(way, -sigma / along if along < 0 else np.inf)

    def _from_no_slip(self) -> bool:
        """Go on from where slip has ended: it stays so where the friction cone allows it, and else begins again."""
        stays = np.linalg.solve(self.M, [0.0, 0.0, 1.0])
        stays = stays / stays[2]
        if self.mu is None or np.hypot(*stays[:2]) <= self.mu:
            self._end_at_once()  # what is left of it, if anything
            before = self.slip
            joins = self._line(stays, holds=True)
            amount = float(np.linalg.solve(self.M, self.slip - before)[2])
            spare = np.inf if self.mu is None else self.mu - float(np.hypot(*stays[:2]))
            self.unused += spare * amount if amount > 0 else 0.0
            return joins
        begins = _begins(self.M, self.mu)
        return begins is not None and self._line(begins)

    def _line(self, way: Array, ends: float = np.inf, *, holds: bool = False) -> bool:
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
        before, self.slip = self.slip, self.slip + amount * rate
        if holds or ends <= upto:
            self.slip[:2] = 0.0
        self.taken -= 0.5 * amount * float(way[:2] @ (before + self.slip)[:2])
        if ends <= upto:
            pass
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
        row, upto = (2, 0.0) if aim is None else (3, aim / speed**2)
        for _ in range(_MOST_STEPS):
            step = series.step()
            stops = series.at(step)[row] >= upto
            if stops:
                step = series.reaches(row, upto, step)
            series = series.after(step)
            ended = series.length <= least
            if stops or ended:
                self.slip, self.work = np.array(series.slip) * speed, series.work * speed**2
                self.taken += float(self.mu or 0.0) * series.taken * speed**2
                if stops and aim is None:
                    self.slip[2] = 0.0
                elif stops:
                    self.work = float(aim or 0.0)
                return True if stops else self._rest_of_it()
        return False

    def _rest_of_it(self) -> bool:
        """Go on straight to where slip ends that has all but ended: what is left turns by no more than it is."""
        sigma = float(np.hypot(*self.slip[:2]))
        hat = self.slip[:2] / sigma
        way = np.append(-float(self.mu or 0.0) * hat, 1.0)
        along = float(hat @ (self.M @ way)[:2])
        return along < 0 and self._line(way, -sigma / along)


@dataclass(frozen=True)
class _Series:
    """Taylor series of s, for a speed of 1, of the work of P_n, and of ∫|s_t|² dτ, the μth part of friction's.

    At one instant of τ; floats are quicker here.
    """

    push: list[float]  # M n
    drag: list[list[float]]  # μ M, its first two columns
    slip: tuple[float, float, float]
    work: float
    taken: float = 0.0

    @staticmethod
    def of(M: Array, mu: float, slip: Array, work: float) -> _Series:
        x, y, z = slip.tolist()
        return _Series(M[:, 2].tolist(), (mu * M[:, :2]).tolist(), (x, y, z), work)

    @property
    def length(self) -> float:
        """|s_t|."""
        return math.hypot(*self.slip[:2])

    @cached_property
    def terms(self) -> list[list[float]]:
        """The coefficients of s and of the two works."""
        (a, b, c), ((d, e), (f, g), (h, i)) = self.push, self.drag
        (x, y, z), length, w = ([part] for part in self.slip), [self.length], [self.work]
        f_work = [self.taken]
        twice = 2 * length[0]
        for k in range(_TERMS - 1):
            if k:  # of |s_t|² = x² + y²
                square = _product(x, x) + _product(y, y) - _product(length[1:], length[1:])
                length.append(square / twice)
            x_k, y_k, l_k, n = x[k], y[k], length[k], k + 1
            w.append(_product(z, length) / n)
            f_work.append(_product(length, length) / n)
            x.append((l_k * a - d * x_k - e * y_k) / n)
            y.append((l_k * b - f * x_k - g * y_k) / n)
            z.append((l_k * c - h * x_k - i * y_k) / n)
        return [x, y, z, w, f_work]

    def step(self) -> float:
        """Return how far the series holds to the last digit."""
        n, least = _TERMS - 1, 1e-300
        last = [max(abs(row[m]) for row in self.terms) / self.length for m in (n - 1, n)]
        return min((_PRECISION / max(last[0], least)) ** (1 / (n - 1)), (_PRECISION / max(last[1], least)) ** (1 / n))

    def at(self, t: float) -> list[float]:
        """Return s and the works at a τ."""
        powers = [1.0]
        for _ in range(_TERMS - 1):
            powers.append(powers[-1] * t)
        return [sum(map(mul, row, powers)) for row in self.terms]

    def reaches(self, row: int, value: float, step: float) -> float:
        """Return the τ at which one of the numbers comes up to a value that it has passed at the end of a step."""
        from scipy.optimize import brentq

        def over(t: float) -> float:
            return self.at(t)[row] - value

        return 0.0 if over(0.0) >= 0 else float(brentq(over, 0.0, step, xtol=1e-300, rtol=1e-15))

    def after(self, t: float) -> _Series:
        """Return the series about a τ."""
        x, y, z, *works = self.at(t)
        return _Series(self.push, self.drag, (x, y, z), *works)


def _product(one: list[float], other: list[float]) -> float:
    """Return the last coefficient of the product of two series that are known so far."""
    return sum(map(mul, one, reversed(other)))


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
