"""Polynomials fitted to some samples about each of some instants: the weights that make a derivative of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int_]

_EVEN = 1e-12  # of half a window: instants that are even to rounding
_AT_ONCE = 2_000_000  # numbers of a stack of windows
_FARTHEST = 32  # samples over which noise is looked at for what it has in common


@dataclass(frozen=True)
class Polynomials:
    """What a fit needs of the instants alone, so that all arrays over the same instants share it."""

    time: Array  # kept, so that no other array takes its place in memory, by which windows are found again
    index: Index
    order: int  # of the derivative
    here: Array  # (m,): where it is wanted, in half-widths from the middle
    half: Array  # (m,): half-widths
    basis: Array  # (m, width, degree + 1), or (1, ...) where the samples are even
    inverse: Array

    @cached_property
    def row(self) -> Array:
        """The weights that give the derivative, (m, width)."""
        return self._row(self.inverse)

    @cached_property
    def changes(self) -> tuple[Array, Array]:
        """What the last two degrees add to the weights, and what the two before them did."""
        degree = self.basis.shape[2] - 1
        fewer, fewest = (self._row(_pseudoinverse(self.basis[..., : degree + 1 - less])) for less in (2, 4))
        return self.row - fewer, fewer - fewest

    def _row(self, inverse: Array) -> Array:
        return _row(self.here, inverse, self.order) / self.half[:, None] ** self.order

    @cached_property
    def correlations(self) -> Array:
        """What independent noise of variance 1 gives for Σᵢ eᵢ eᵢ₊ₗ of what a fit leaves over, l = 1, 2, ..."""
        B, P = self.basis[0], self.inverse[0].T
        width = B.shape[0]
        lags = min(width // 4, _FARTHEST)
        return np.array([-(B[: width - lag] * P[lag:]).sum() for lag in range(1, lags + 1)])


Known = dict[tuple[Any, ...], Polynomials]


def polynomials(time: Array, centres: Index, order: int, degree: int, width: int, known: Known) -> Polynomials:
    """Return the weights of fits about some of the samples; they are worked out once."""
    key = (id(time), centres.tobytes(), order, degree, width)
    if key not in known:
        known[key] = _windows(time, centres, order, degree, width)
    return known[key]


def _windows(time: Array, centres: Index, order: int, degree: int, width: int) -> Polynomials:
    first = np.clip(centres - width // 2, 0, time.size - width)
    index = first[:, None] + np.arange(width)
    half = (time[index[:, -1]] - time[index[:, 0]]) / 2
    middle = (time[index[:, -1]] + time[index[:, 0]]) / 2
    x = (time[index] - middle[:, None]) / half[:, None]
    here = (time[centres] - middle) / half
    even = x[:1] if float(np.abs(x - x[:1]).max()) < _EVEN else x
    basis = chebyshev.chebvander(even, degree)
    return Polynomials(time, index, order, here, half, basis, _pseudoinverse(basis))


def _pseudoinverse(basis: Array) -> Array:
    """Return the matrices (m, degree + 1, width) that fit coefficients, a few windows at a time."""
    step = max(1, _AT_ONCE // (basis.shape[1] * basis.shape[2]))
    found = []
    for i in range(0, len(basis), step):
        Q, R = np.linalg.qr(basis[i : i + step])
        found.append(np.linalg.solve(R, Q.transpose(0, 2, 1)))
    return np.concatenate(found)


def _row(here: Array, inverse: Array, order: int) -> Array:
    """Return the weights (m, width) that give a derivative at `here` from the samples of each window."""
    degree = inverse.shape[1] - 1
    if degree < order:
        return np.zeros((here.size, inverse.shape[2]))
    at = chebyshev.chebvander(here, degree) @ _differentiation(degree, order)
    if len(inverse) == 1:
        return at @ inverse[0]
    return np.einsum("md,mdn->mn", at, inverse)


@cache
def _differentiation(degree: int, order: int) -> Array:
    """Return the matrix that takes Chebyshev coefficients to those of the derivative."""
    matrix = np.zeros((degree + 1, degree + 1))
    if order == 0:
        return np.eye(degree + 1)
    matrix[: degree + 1 - order] = chebyshev.chebder(np.eye(degree + 1), m=order)
    return matrix
