"""Values and rates of change of somebody else's samples, with what noise and spacing leave open.

Around each instant a polynomial is fitted to some samples by least squares. Noise of a known size makes its spread.
What the last two degrees add, beyond what noise makes of that, and how much less it is than what the two before them
did, tells the truncation. Degree and width are those for which noise and truncation together are least.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from .noise import Noise, noise_of
from .polynomials import Array, Index, Known, polynomials

SIGMAS = 5.5  # of the noise, against which truncation is weighed; about what the longest of some hundred reaches
_DEGREES = (4, 6, 8, 12)
_WIDEST = 768  # samples
_WIDER = 1.6  # times, from one width to the next
_TRIED = 24  # windows on which degree and width are chosen
_TRUNCATION = 2.0  # times what the next two degrees would add
_ROUNDED = 4.0  # units in the last place: there is no noise to smooth
_NEIGHBOURS = 15  # windows among which a truncation is taken to be the same
_DOUBT = 2.0  # standard deviations by which a truncation must stand out of the noise


@dataclass(frozen=True)
class Estimate:
    """Values, or a derivative, at some of the samples.

    Examples
    --------
    See `derivative`.
    """

    values: Array  # (m, c): what was estimated
    spread: Array  # (m,): standard deviation of the worst of its components
    bias: Array  # (m,): what too few samples for so much bending may add, as the length of a vector
    noise: Array  # (m,): standard deviation of one sample about a smooth curve, the worst component
    freedom: float = np.inf  # degrees of freedom from which the noise was estimated
    # times the variance of a mean over many samples that noise makes which is not independent from one to the next
    alike: float = 1.0
    index: Any = field(default=None, repr=False)  # (m, w): the samples that each was taken from
    row: Any = field(default=None, repr=False)  # (m, w): their weights

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
class Fit:
    """A degree and a width in samples; a width of one takes the samples as they are."""

    degree: int
    width: int


def derivative(
    time: Array,
    values: Array,
    centres: Index,
    order: int = 1,
    known: Known | None = None,
    fit: Fit | None = None,
    noise: Noise | None = None,
) -> Estimate:
    """Return a derivative of sampled values, with what noise and spacing leave open.

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
    noise = noise_of(time, values, known) if noise is None else noise
    fit = best_fit(time, values, order, known, noise) if fit is None else fit
    if fit.width > 1:
        found = _fit(time, values, centres, order, fit, known, noise)
    else:
        one, spread = np.ones((centres.size, 1)), noise.at(centres)
        found = Estimate(values[centres], spread, 0 * spread, spread, noise.freedom, noise.alike, centres[:, None], one)
    return found if order else replace(found, bias=found.bias + 0.5 * noise.step)


def best_fit(time: Array, values: Array, order: int, known: Known, noise: Noise, kept: float = 1.0) -> Fit:
    """Return the degree and the width for which noise and truncation together are least."""
    some = np.unique(np.linspace(0, time.size - 1, min(time.size, _TRIED)).round().astype(int))
    best, chosen = np.inf, Fit(_DEGREES[0], min(time.size, _DEGREES[0] + 3))
    for degree in _DEGREES:
        width, rising = degree + 3, 0
        while width <= min(time.size, _WIDEST) and rising < 2:
            found = _fit(time, values, some, order, Fit(degree, width), known, noise)
            error = float(np.median(kept * SIGMAS * found.spread + found.bias))
            if error < best:
                best, chosen, rising = error, Fit(degree, width), 0
            else:
                rising += 1
            width = max(width + 2, int(width * _WIDER))
    usual = float(np.median(noise.spread))
    rounded = usual <= _ROUNDED * noise.rounding  # which is not independent
    raw = order == 0 and (rounded or best >= kept * SIGMAS * usual)
    return Fit(chosen.degree, 1) if raw else chosen


def _fit(time: Array, values: Array, centres: Index, order: int, fit: Fit, known: Known, noise: Noise) -> Estimate:
    at = polynomials(time, centres, order, fit.degree, fit.width, known)
    about = values[centres]
    y = values[at.index] - about[:, None, :]
    estimate = np.einsum("mn,mnc->mc", at.row, y) + (about if order == 0 else 0.0)
    spread = noise.at(centres)
    one = np.sqrt(noise.alike) * spread  # of a mean over many samples
    last, before = (
        _beyond(np.einsum("mn,mnc->mc", row, y), (one * np.linalg.norm(row, axis=1)) ** 2, at.index)
        for row in at.changes
    )
    truncation = _TRUNCATION * last * np.minimum(last / np.where(before > 0, before, np.inf), 1.0)
    gain = np.linalg.norm(at.row, axis=1)
    return Estimate(estimate, one * gain, truncation, spread, noise.freedom, noise.alike, at.index, at.row)


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
