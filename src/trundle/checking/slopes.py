"""Values and rates of change of somebody else's samples, with what noise and spacing leave open.

Around each instant a polynomial is fitted to some samples by least squares. What the fit leaves over tells the noise
(of a camera, of digits cut off when the file was written). What the last two degrees add, beyond what noise makes of
that, and how much less it is than what the two before them did, tells the truncation. Degree and width are those for
which noise and truncation together are least.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int_]

SIGMAS = 5.5  # of the noise, against which truncation is weighed; about what the longest of some hundred reaches
_DEGREES = (4, 6, 8)
_WIDEST = 768  # samples
_TRIED = 24  # windows on which degree and width are chosen
_TRUNCATION = 2.0  # times what the next two degrees would add
_ROUNDED = 4.0  # units in the last place: there is no noise to smooth
_ALIKE = 1e-12  # of half a window: instants that are even to rounding
_AT_ONCE = 2_000_000  # numbers of a stack of windows
_NEIGHBOURS = 15  # windows among which the noise is taken to be the same
_PLAINLY = 9.0  # times another variance: the noise is not the same all along
_DOUBT = 2.0  # standard deviations by which a truncation must stand out of the noise
_MEDIAN = 0.6  # degrees of freedom that a median keeps
_FARTHEST = 32  # samples over which noise is looked at for what it has in common


@dataclass(frozen=True)
class Estimate:
    """Values, or a derivative, at some of the samples.

    Parameters
    ----------
    values : array (m, c)
        What was estimated.
    spread : array (m,)
        Standard deviation of the worst of its components.
    bias : array (m,)
        What too few samples for so much bending may add, as the length of a vector.
    noise : array (m,)
        Standard deviation of one sample about a smooth curve, the worst component.
    freedom : float
        Degrees of freedom from which the noise was estimated.
    alike : float
        Times the variance of a mean over many samples that noise makes which is not independent from one to the next.
    index : int array (m, w), optional
        The samples that each was taken from.
    row : array (m, w), optional
        Their weights.

    Examples
    --------
    See `derivative`.
    """

    values: Array
    spread: Array
    bias: Array
    noise: Array
    freedom: float = np.inf
    alike: float = 1.0
    index: Any = field(default=None, repr=False)
    row: Any = field(default=None, repr=False)

    @property
    def error(self) -> Array:
        """What the values may be off by, as the length of a vector."""
        return SIGMAS * self.spread + self.bias

    @property
    def reach(self) -> int:
        """How many samples to either side it was taken from."""
        return int(self.index.shape[1]) // 2 + 1

    def scaled(self, factor: float, values: Array, bias: Array) -> Estimate:
        """Return what follows from it by a map that lengthens no vector by more than a factor."""
        return replace(self, values=values, spread=factor * self.spread, bias=bias, row=factor * self.row)


@dataclass(frozen=True)
class _Windows:
    """What a fit needs of the instants alone, so that all arrays over the same instants share it."""

    time: Array  # kept, so that no other array takes its place in memory, by which windows are found again
    index: Index
    row: Array  # (m, width), gives the derivative
    changes: tuple[Array, Array]  # what the last two degrees add to it, and what the two before them did
    basis: Array  # (m, width, degree + 1), or (1, ...) where the samples are even
    inverse: Array

    def correlations(self, lags: int) -> Array:
        """Return what independent noise of variance 1 gives for Σᵢ eᵢ eᵢ₊ₗ of what a fit leaves over, l = 1, 2, ..."""
        B, P = self.basis[0], self.inverse[0].T
        width = B.shape[0]
        return np.array([-(B[: width - lag] * P[lag:]).sum() for lag in range(1, lags + 1)])


Known = dict[tuple[Any, ...], _Windows]


@dataclass(frozen=True)
class Fit:
    """A degree and a width in samples; a width of one takes the samples as they are."""

    degree: int
    width: int


def derivative(
    time: Array, values: Array, centres: Index, order: int = 1, known: Known | None = None, fit: Fit | None = None
) -> Estimate:
    """Return a derivative of sampled values, with what noise and spacing leave open.

    Parameters
    ----------
    time : array (n,)
        Ascending, at any spacing, s.
    values : array (n, c)
        Samples of c quantities.
    centres : int array (m,)
        At which samples, ascending.
    order : int
        1 or 2; 0 smooths, where that is better than the samples as they are.
    known : dict, optional
        Keeps what was worked out of the instants, for other values at the same ones.
    fit : Fit, optional
        As `best_fit` returns it, where it was asked already.

    Returns
    -------
    Estimate
        With its spread and bias.

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
    fit = best_fit(time, values, order, known) if fit is None else fit
    if fit.width > 1:
        return _fit(time, values, centres, order, fit, known)
    few = _some(time.size)
    noise = _fit(time, values, few, 0, Fit(fit.degree, fit.degree + 3), known)
    size = np.interp(centres, few, noise.noise)
    one = np.ones((centres.size, 1))
    return Estimate(values[centres], size, 0 * size, size, noise.freedom, noise.alike, centres[:, None], one)


def best_fit(time: Array, values: Array, order: int, known: Known, kept: float = 1.0) -> Fit:
    """Return the degree and the width for which noise and truncation together are least.

    Parameters
    ----------
    time, values, order, known
        As of `derivative`.
    kept : float
        Share of the noise that counts against the truncation: less than 1 where means are taken of many estimates.

    Returns
    -------
    Fit
        Found at some instants all along the samples.
    """
    some = _some(time.size)
    best, chosen, noise = np.inf, Fit(_DEGREES[0], min(time.size, _DEGREES[0] + 3)), 0.0
    for degree in _DEGREES:
        width, rising = degree + 3, 0
        while width <= min(time.size, _WIDEST) and rising < 2:
            found = _fit(time, values, some, order, Fit(degree, width), known)
            error = float(np.median(kept * SIGMAS * found.spread + found.bias))
            if error < best:
                best, chosen, rising = error, Fit(degree, width), 0
                noise = float(np.median(found.noise))
            else:
                rising += 1
            width = max(width + 2, int(width * 1.6))
    rounded = noise <= _ROUNDED * np.finfo(float).eps * float(np.abs(values).max())  # which is not independent
    raw = order == 0 and (rounded or best >= kept * SIGMAS * noise)
    return Fit(chosen.degree, 1) if raw else chosen


def _some(samples: int) -> Index:
    return np.unique(np.linspace(0, samples - 1, min(samples, _TRIED)).round().astype(int))


def _fit(time: Array, values: Array, centres: Index, order: int, fit: Fit, known: Known) -> Estimate:
    degree, width = fit.degree, fit.width
    key = (id(time), centres.tobytes(), order, degree, width)
    if key not in known:
        known[key] = _windows(time, centres, order, degree, width)
    at = known[key]
    about = values[centres]
    y = values[at.index] - about[:, None, :]
    estimate = np.einsum("mn,mnc->mc", at.row, y) + (about if order == 0 else 0.0)
    rest = y - at.basis @ (at.inverse @ y)
    rounding = np.finfo(float).eps * float(np.abs(values).max())
    noise, freedom = _noise(rest, at.index, degree, rounding)
    alike = _alike(rest, at, degree)
    gain = np.sqrt(alike) * np.linalg.norm(at.row, axis=1)
    last, before = (
        _beyond(np.einsum("mn,mnc->mc", row, y), alike * (noise * np.linalg.norm(row, axis=1)) ** 2, at.index)
        for row in at.changes
    )
    truncation = _TRUNCATION * last * np.minimum(last / np.where(before > 0, before, np.inf), 1.0)
    return Estimate(estimate, noise * gain, truncation, noise, freedom, alike, at.index, at.row)


def _noise(rest: Array, index: Index, degree: int, rounding: float) -> tuple[Array, float]:
    """Return the standard deviation of one sample at each window, the worst component's, and its degrees of freedom."""
    width = rest.shape[1]
    free = width - degree - 1
    median = (1 - 2 / (9 * free)) ** 3  # of χ² over its mean [Wilson and Hilferty]
    each = (rest * rest).sum(axis=1) / (free * median)
    level = np.median(each, axis=0).max()
    local = _running_median(each).max(axis=1)
    samples = np.unique(index).size if index.size < _AT_ONCE else int(np.ptp(index)) + 1
    if local.max() > _PLAINLY * max(local.min(), rounding**2):
        step = float(np.median(np.diff(index[:, 0]))) if len(index) > 1 else 0.0
        samples = min(samples, round(width + step * _NEIGHBOURS))
        variance = local
    else:
        variance = np.full(len(each), level)
    return np.maximum(np.sqrt(variance), rounding), _MEDIAN * samples * free / width


def _running_median(values: Array) -> Array:
    """Return the medians over some neighbours, at the ends over the first and the last of them."""
    if len(values) <= _NEIGHBOURS:
        return np.broadcast_to(np.median(values, axis=0), values.shape)
    windows = np.lib.stride_tricks.sliding_window_view(values, _NEIGHBOURS, axis=0)
    middle, half = np.median(windows, axis=-1), _NEIGHBOURS // 2
    return np.concatenate([np.repeat(middle[:1], half, axis=0), middle, np.repeat(middle[-1:], half, axis=0)])


def _beyond(change: Array, by_chance: Array, index: Index) -> Array:
    """Return the root mean square length of changes among neighbours, beyond what noise of a known variance makes."""
    size, parts = min(_NEIGHBOURS, len(change)), change.shape[1]
    pad = (size // 2, size - 1 - size // 2)

    def mean(squares: Array) -> Array:
        return np.convolve(np.pad(squares, pad, mode="edge"), np.full(size, 1 / size), "valid")

    step = float(np.median(np.diff(index[:, 0]))) if len(index) > 1 else 0.0
    apart = min(size, 1 + step * (size - 1) / index.shape[1])  # windows that share no sample
    doubt = _DOUBT * np.sqrt(2 / (parts * apart))
    noise = mean(by_chance) * parts
    return np.asarray(np.sqrt(np.maximum(mean((change**2).sum(axis=1)) - noise * (1 + doubt), 0.0)))


def _alike(rest: Array, at: _Windows, degree: int) -> float:
    """Return how much more the noise of a mean is than that of independent samples: 1 + 2 Σ of its correlations."""
    width = rest.shape[1]
    lags = min(width // 4, _FARTHEST)
    power = float((rest * rest).sum())
    if lags == 0 or power == 0:
        return 1.0
    scale = power / (width - degree - 1)  # a sum over the windows and components, of the variance
    sums = np.array([float((rest[:, :-lag] * rest[:, lag:]).sum()) for lag in range(1, lags + 1)])
    share = (sums / scale - at.correlations(lags)) / width
    samples = min(rest.shape[0] * width, int(np.ptp(at.index)) + 1)
    small = np.flatnonzero(share < 4 / np.sqrt(samples))
    return float(1 + 2 * share[: small[0] if small.size else lags].sum())


def _windows(time: Array, centres: Index, order: int, degree: int, width: int) -> _Windows:
    first = np.clip(centres - width // 2, 0, time.size - width)
    index = first[:, None] + np.arange(width)
    half = (time[index[:, -1]] - time[index[:, 0]]) / 2
    middle = (time[index[:, -1]] + time[index[:, 0]]) / 2
    x = (time[index] - middle[:, None]) / half[:, None]
    here = (time[centres] - middle) / half
    even = x[:1] if float(np.abs(x - x[:1]).max()) < _ALIKE else x
    basis = chebyshev.chebvander(even, degree)
    inverses = [_pseudoinverse(basis[..., : degree + 1 - less]) for less in (0, 2, 4)]
    row, fewer, fewest = (_row(here, inverse, order) / half[:, None] ** order for inverse in inverses)
    return _Windows(time, index, row, (row - fewer, fewer - fewest), basis, inverses[0])


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
