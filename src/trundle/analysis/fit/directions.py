"""Which directions in the space of what is free the data fix: by the singular values of the weighted Jacobian.

The columns are first made as long as one another, so that units and sizes of the numbers do not matter. What is left is
how alike their traces in the data are (Brun, Reichert and Künsch 2001): a singular value of 0 is a direction along
which nothing that was measured changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...solve.samples import Array

_SHOWS, _MOVED = 1e-5, 0.1
EXACT = 1e-7  # of the largest: below it the data do not change at all along a direction


@dataclass(frozen=True)
class Directions:
    """The directions of a Jacobian."""

    basis: Array  # (p, r): what the data fix: columns in the numbers' own units, each one standard deviation long
    free: Array  # (p, f): along which nothing measured changes
    weak: Array  # (p, w): along which it changes by less than the noise, however far one goes
    values: Array  # (p,): the singular values, the largest first

    @property
    def covariance(self) -> Array:
        """Of the numbers, (p, p), along what is fixed."""
        return np.asarray(self.basis @ self.basis.T)


def directions(jacobian: Array, signal: float) -> Directions:
    """Return the directions that a Jacobian in units of the noise fixes, and those that it does not.

    Parameters
    ----------
    jacobian : array (m, p)
        Weighted.
    signal : float
        The size of the motion in units of the noise: a number that moves the data by less over one such size is weak.

    Examples
    --------
    Two numbers that enter by their sum alone:

    >>> found = directions(np.array([[1.0, 1.0], [2.0, 2.0]]), 100.0)
    >>> found.free[:, 0].round(3).tolist(), found.basis.shape
    ([-0.707, 0.707], (2, 1))
    >>> directions(np.empty((3, 0)), 0.0).basis.shape
    (0, 0)
    """
    norms = np.linalg.norm(jacobian, axis=0)
    silent = norms <= EXACT**2 * max(norms.max(initial=0.0), 1e-300)
    scale = np.where(silent, 1.0, 1.0 / np.where(silent, 1.0, norms))
    scaled = jacobian * np.where(silent, 0.0, scale)
    if scaled.shape[0] < scaled.shape[1]:
        scaled = np.vstack([scaled, np.zeros((scaled.shape[1] - scaled.shape[0], scaled.shape[1]))])
    _, s, Vt = np.linalg.svd(scaled, full_matrices=False)
    free = s <= EXACT * s.max(initial=1e-300)
    weak = ~free & (s * max(signal, 0.0) <= 1.0)
    good = ~(free | weak)
    apart = (scale[:, None] * Vt.T) if Vt.size else np.empty((norms.size, 0))
    basis = apart[:, good] / s[good]
    return Directions(basis, _unit(apart[:, free]), _unit(apart[:, weak]), s)


def _unit(columns: Array) -> Array:
    """Return columns of length 1, the largest part positive."""
    lengths = np.linalg.norm(columns, axis=0)
    columns = columns / np.where(lengths > 0, lengths, 1.0)
    return np.asarray(columns * np.where(columns[-1:] < 0, -1.0, 1.0)) if columns.size else columns


def taken(found: Directions, scale: Array, signal: float) -> Any:
    """Return which numbers take part in a direction that is not fixed, (p,).

    In a weak direction, those that a step as large as all of the motion would move by more than they are known.
    """
    free = np.abs(found.free / scale[:, None])
    part = (free > _SHOWS * free.max(axis=0, initial=1e-300)).any(axis=1)
    weak = np.abs(found.weak / scale[:, None])
    weak /= np.linalg.norm(weak, axis=0, keepdims=True)
    known = np.linalg.norm(found.basis, axis=1) / scale
    return np.asarray(part | (weak * signal > _MOVED * known[:, None]).any(axis=1))


def echelon(null: Array, scale: Array, preferred: Array) -> tuple[Array, list[int]]:
    """Return a basis of null vectors, each with as few numbers as can be, and the pivot of each.

    Parameters
    ----------
    null : array (p, f)
        Spanning the space.
    scale : array (p,)
        Of the numbers: the standard deviation that each would have alone.
    preferred : array (p,)
        Larger for numbers that make a better pivot.

    Examples
    --------
    >>> rows, pivots = echelon(np.array([[1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]), np.ones(3), np.array([0, 1, 1]))
    >>> pivots, rows.T.round(9).tolist()
    ([2, 1], [[1.0, 0.0, 1.0], [1.0, 1.0, 0.0]])
    """
    left = np.array(null / scale[:, None], dtype=float)
    pivots: list[int] = []
    for k in range(left.shape[1]):
        size = np.abs(left[:, k:]).max(axis=1)
        size[pivots] = 0.0
        usable = size > 1e-3 * size.max()
        row = int(np.lexsort((size, np.where(usable, preferred, -1.0)))[-1])
        column = k + int(np.argmax(np.abs(left[row, k:])))
        left[:, [k, column]] = left[:, [column, k]]
        left[:, k] /= left[row, k]
        for other in range(left.shape[1]):
            if other != k:
                left[:, other] -= left[row, other] * left[:, k]
        pivots.append(row)
    left[np.abs(left) < 1e-5 * np.abs(left).max(axis=0, keepdims=True)] = 0.0
    rows = left * scale[:, None]
    for k, row in enumerate(pivots):
        rows[:, k] /= rows[row, k]
    return rows, pivots
