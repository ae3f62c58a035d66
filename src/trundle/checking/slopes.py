"""Rates of change of somebody else's samples, with the error that the samples themselves show.

Around each instant a polynomial is fitted to some samples by least squares. What the fit leaves over tells the noise
(of a camera, of digits cut off when the file was written), and what two degrees less would change tells the
truncation; degree and width are those for which the two together are least.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

Array = NDArray[np.float64]

_DEGREES = (4, 6, 8)
_WIDEST = 768  # samples
_TRIED = 24  # windows on which degree and width are chosen
SIGMAS = 6.0  # of the noise; thousands of numbers are looked at, and none of them may fail by chance
_TRUNCATION = 2.0
_UNEVEN = 10.0  # times the usual noise: numbers of so many digits are rounded at another place where they are larger


@dataclass(frozen=True)
class Estimate:
    """A derivative at some of the samples.

    Parameters
    ----------
    values : array (m, c)
        The derivative.
    error : array (m,)
        What it may be off by, as the length of a vector.
    noise : array (m,)
        Standard deviation of one sample about a smooth curve, as the length of a vector.
    reach : int
        How many samples to either side it was taken from.

    Examples
    --------
    See `derivative`.
    """

    values: Array
    error: Array
    noise: Array
    reach: int = 0


@dataclass(frozen=True)
class _Windows:
    """What a fit needs of the instants alone, so that all arrays over the same instants share it."""

    time: Array  # kept, so that no other array takes its place in memory, by which windows are found again
    index: NDArray[np.int_]
    row: Array  # (m, width), gives the derivative
    fewer: Array  # what two degrees less take off it
    basis: Array
    inverse: Array


Known = dict[tuple[int, ...], _Windows]


def derivative(
    time: Array, values: Array, centres: NDArray[np.int_], order: int = 1, known: Known | None = None
) -> Estimate:
    """Return a derivative of sampled values, with its error.

    Parameters
    ----------
    time : array (n,)
        Ascending, at any spacing, s.
    values : array (n, c)
        Samples of c quantities.
    centres : int array (m,)
        At which samples.
    order : int
        1 or 2; 0 smooths.
    known : dict, optional
        Keeps what was worked out of the instants, for other values at the same ones.

    Returns
    -------
    Estimate
        With an error that is meant never to be exceeded: six standard deviations and twice the truncation.

    Examples
    --------
    Five digits of a sine, two hundred to a turn: the slope is good to a few parts in ten thousand, and is said to be.

    >>> t = np.linspace(0.0, 6.283, 201)
    >>> slope = derivative(t, np.round(np.sin(t), 5)[:, None], np.arange(20, 180))
    >>> off = np.abs(slope.values[:, 0] - np.cos(t[20:180]))
    >>> bool(np.all(off < slope.error)), bool(slope.error.max() < 1e-3)
    (True, True)
    """
    known = {} if known is None else known
    some = centres[:: max(1, centres.size // _TRIED)]
    best, chosen = np.inf, (_DEGREES[0], min(time.size, _DEGREES[0] + 3))
    for degree in _DEGREES:
        width, rising = degree + 3, 0
        while width <= min(time.size, _WIDEST) and rising < 2:
            error = float(np.median(_fit(time, values, some, order, degree, width, known).error))
            if error < best:
                best, chosen, rising = error, (degree, width), 0
            else:
                rising += 1
            width = max(width + 2, int(width * 1.6))
    return _fit(time, values, centres, order, *chosen, known)


def _fit(
    time: Array,
    values: Array,
    centres: NDArray[np.int_],
    order: int,
    degree: int,
    width: int,
    known: Known,
) -> Estimate:
    key = (id(time), centres.size, int(centres[-1]), order, degree, width)
    if key not in known:
        known[key] = _windows(time, centres, order, degree, width)
    at = known[key]
    about = values[centres]
    y = values[at.index] - about[:, None, :]
    estimate = np.einsum("mn,mnc->mc", at.row, y) + (about if order == 0 else 0.0)
    truncation = np.linalg.norm(np.einsum("mn,mnc->mc", at.fewer, y), axis=1)
    rest = y - at.basis @ (at.inverse @ y)
    noise = np.sqrt((rest * rest).sum(axis=(1, 2)) / (width - degree - 1))
    rounding = np.finfo(float).eps * float(np.abs(values).max())
    noise = np.maximum(np.maximum(noise, float(np.median(noise))), rounding)
    error = SIGMAS * noise * np.linalg.norm(at.row, axis=1) + _TRUNCATION * truncation
    # A bend that no polynomial follows is no noise of the samples themselves.
    return Estimate(estimate, error, np.minimum(noise, _UNEVEN * float(np.median(noise))), width // 2 + 1)


def _windows(time: Array, centres: NDArray[np.int_], order: int, degree: int, width: int) -> _Windows:
    first = np.clip(centres - width // 2, 0, time.size - width)
    index = first[:, None] + np.arange(width)
    half = (time[index[:, -1]] - time[index[:, 0]]) / 2
    middle = (time[index[:, -1]] + time[index[:, 0]]) / 2
    x = (time[index] - middle[:, None]) / half[:, None]
    here = (time[centres] - middle) / half
    basis = chebyshev.chebvander(x, degree)
    inverse = np.linalg.pinv(basis)
    unit = half[:, None] ** order
    row = _row(here, inverse, order) / unit
    fewer = row - _row(here, np.linalg.pinv(basis[..., : degree - 1]), order) / unit
    return _Windows(time, index, row, fewer, basis, inverse)


def _row(here: Array, inverse: Array, order: int) -> Array:
    """Return the weights (m, width) that give a derivative at `here` from the samples of each window."""
    degree = inverse.shape[1] - 1
    at = chebyshev.chebvander(here, degree) @ _differentiation(degree, order)
    return np.einsum("md,mdn->mn", at, inverse)


@cache
def _differentiation(degree: int, order: int) -> Array:
    """Return the matrix that takes Chebyshev coefficients to those of the derivative."""
    matrix = np.zeros((degree + 1, degree + 1))
    if order == 0:
        return np.eye(degree + 1)
    matrix[: degree + 1 - order] = chebyshev.chebder(np.eye(degree + 1), m=order)
    return matrix
