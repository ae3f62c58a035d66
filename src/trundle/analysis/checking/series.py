"""One residual over time beside what it may be."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .slopes import Array

_TELLS = 0.2  # a bound, as a share, beyond which the data say nothing of a check


@dataclass(frozen=True)
class Series:
    """One residual over time beside its bound.

    Examples
    --------
    >>> one = Series("no slip", np.arange(2.0), np.array([[0.0], [0.5]]), 1.0, np.array([0.25, 0.25]), 0.1, "")
    >>> float(one.worst), one.share, one.first_failure
    (2.0, 0.5, 1.0)
    """

    name: str  # of the check
    time: Array  # (m,): s
    residual: Array  # (m, c): as vectors
    size: float  # beside which a residual is small or not: the shares are shares of it
    bound: Array  # (m,): the longest vector allowed
    asked: float  # the part of the bound that the tolerance makes; the rest is what the data themselves leave open
    note: str  # how it was measured
    # what it would be a share of if the size were no more than what moves; absent: the size
    motion: float | None = None

    @cached_property
    def length(self) -> Array:
        """The residual's length at each instant."""
        return np.asarray(np.linalg.norm(self.residual, axis=1), dtype=float)

    @cached_property
    def ratio(self) -> Array:
        """The residual over its bound."""
        return self.length / self.bound

    @property
    def worst(self) -> float:
        """The largest residual over its bound."""
        return float(self.ratio.max())

    @property
    def share(self) -> float:
        """The residual as a share of the size, where it is worst against its bound."""
        return float(self.length[np.argmax(self.ratio)] / self.size)

    @property
    def allowed(self) -> float:
        """The bound as a share of the size, at the same instant."""
        return float(self.bound[np.argmax(self.ratio)] / self.size)

    @cached_property
    def typical(self) -> float:
        """The root mean square residual as a share of what moves."""
        return float(np.sqrt((self.length**2).mean()) / (self.motion or self.size))

    @cached_property
    def room(self) -> float:
        """What is usually allowed, as a share of the size."""
        return float(np.median(self.bound) / self.size)

    @property
    def tells(self) -> bool:
        """Whether its bound is so small that to be within it means anything."""
        return self.room <= _TELLS

    @property
    def first_failure(self) -> float | None:
        """The first instant at which the bound is exceeded, s."""
        over = np.flatnonzero(self.ratio > 1)
        return float(self.time[over[0]]) if over.size else None
