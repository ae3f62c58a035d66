"""The steps of DOP853 many at a time, on a law compiled by numba."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from typing import Any

import numpy as np

from . import machine_code
from .samples import Array
from .tracing import CompiledLaw

LOOKS = 8  # at the event functions in each step
LOW = 0.5  # share of how much its looks differ: where all are higher, an event function is nowhere near 0 between them
FULL, ENDED, LOOK, STUCK = range(4)  # why the loop comes back
_AT_ONCE = 500  # steps: some milliseconds, after which somebody may have lost patience


def available() -> bool:
    """Tell whether there is what compiles the loop, numba of the extra `numba`, and what makes machine code of a law.

    Examples
    --------
    >>> available()
    True
    """
    return find_spec("numba") is not None and machine_code.available()


@cache
def places() -> Array:
    """Return where a step is looked at, as shares of it: Chebyshev's points.

    Examples
    --------
    >>> places()[[0, -1]].tolist()
    [0.0, 1.0]
    """
    found = 0.5 - 0.5 * np.cos(np.pi * np.arange(LOOKS) / (LOOKS - 1))
    found[[0, -1]] = 0.0, 1.0
    return found


class StuckError(Exception):
    """No step leads on: at t, s, from y, for a reason."""

    def __init__(self, t: float, y: Array, why: str) -> None:
        super().__init__(why)
        self.t, self.y, self.why = t, y, why


@dataclass(frozen=True)
class Steps:
    """Steps one after the other, and the polynomials through them."""

    times: Array  # (n + 1,), at which they begin, and the last ends, s
    starts: Array  # (n, size), the states there
    terms: Array  # (n, 7, size), as SciPy's dense output has them
    plain: bool  # whether no event function comes near zero in them

    @property
    def t_old(self) -> float:
        """When the first begins."""
        return float(self.times[0])

    @property
    def t(self) -> float:
        """When the last ends."""
        return float(self.times[-1])

    @property
    def count(self) -> int:
        """How many they are."""
        return len(self.starts)

    def __call__(self, times: Any) -> Array:
        """Return the states at an instant, (size,), or at some, (size, n)."""
        times = np.asarray(times, dtype=float)
        which = np.clip(np.searchsorted(self.times, times, side="right") - 1, 0, self.count - 1)
        begin = self.times[which]
        share = ((times - begin) / (self.times[which + 1] - begin))[..., None]
        terms = self.terms[which]
        found = np.zeros_like(terms[..., 0, :])
        for i in range(7):
            found = (found + terms[..., 6 - i, :]) * (share if i % 2 == 0 else 1 - share)
        return (found + self.starts[which]).T


class CompiledDOP853:
    """Goes on with a run that SciPy's DOP853 has begun, many steps at a time, each until one may hold an event.

    Parameters
    ----------
    law : CompiledLaw
        Its rates and event functions.
    begun : scipy.integrate.DOP853
        How far it has come.
    begin : float
        From when its times count, s.
    tolerance : float
        Relative.
    least : array
        Absolute.
    longest : float
        Step, s.
    """

    def __init__(
        self, law: CompiledLaw, begun: Any, begin: float, tolerance: float, least: Array, longest: float = np.inf
    ) -> None:
        self.law, self.begin, self.end = law, begin, float(begun.t_bound)
        self.t, self.y, self.f = float(begun.t), np.array(begun.y), np.array(begun.f)
        self.step_size, self.tolerance = float(begun.h_abs), tolerance
        self.least, self.carry, self.longest = least, np.zeros_like(self.y), longest

    def __iter__(self) -> Iterator[Steps]:
        """Go on to the end, or to where no step is possible: then `t` is short of it."""
        size = self.y.size
        x, values = np.array([0.0, *self.y, *self.law.values]), np.empty((LOOKS, self.law.count))
        while self.t < self.end:
            times, starts, terms = np.empty(_AT_ONCE + 1), np.empty((_AT_ONCE, size)), np.empty((_AT_ONCE, 7, size))
            numbers = np.array([self.begin, self.t, self.end, self.step_size, self.tolerance, self.longest])
            state, found = (x, self.y, self.f, self.carry, self.least), (times, starts, terms, values)
            count, why = _loop()(self.law.rates, self.law.event_functions, numbers, state, tables(), found)
            self.t, self.step_size = float(numbers[1]), float(numbers[3])
            plain = count - (why == LOOK)
            for first, last in ((0, plain), (plain, count)):
                if last > first:
                    part = times[first : last + 1].copy(), starts[first:last].copy(), terms[first:last].copy()
                    yield Steps(*part, plain=first < plain)
            if why == STUCK:
                raise StuckError(self.t, self.y.copy(), "Required step size is less than spacing between numbers.")


@cache
def tables() -> tuple[Array, ...]:
    """Return the coefficients: A and C of all sixteen stages, the twelfth B, those of the two errors, D, and the looks.

    Examples
    --------
    >>> [table.shape for table in tables()]
    [(16, 16), (16,), (13,), (13,), (4, 16), (8,)]
    """
    from scipy.integrate import DOP853

    a = np.zeros((16, 16))
    a[:12, :12], a[12, :12], a[13:] = DOP853.A, DOP853.B, DOP853.A_EXTRA
    c = np.array([*DOP853.C, 1.0, *DOP853.C_EXTRA])
    return a, c, np.array(DOP853.E3), np.array(DOP853.E5), np.array(DOP853.D), places()


@cache
def _loop() -> Any:
    from . import compiled_loop

    return compiled_loop.advance()
