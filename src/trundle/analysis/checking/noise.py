"""The noise of somebody else's samples: of a camera, of digits cut off, of a filter, as the samples themselves show it.

Polynomials are fitted to windows, and what they leave over is noise as long as four degrees more leave about as much.
Of such windows those are taken that have most samples to a degree: they see what one sample has in common with the
next. A motion that repeats itself in a window looks like noise, too; it is told by how much more is left than before.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from .polynomials import Array, Index, Known, Polynomials, polynomials

_DEGREES = (4, 8, 12, 16)
_MORE = 4  # degrees, that leave about as much if nothing but noise is left
_ABOUT = 0.7  # of a variance
# Times a variance: noise with much in common seems so much larger in wider windows, and all in all, but not more.
_RISE, _FAR = 12.0, 1000.0
_NARROWEST, _WIDEST, _WIDER = 11, 768, 1.6  # samples, and times from one width to the next
_TRIED = 24  # windows
_LOCAL = 96  # windows in which it is seen whether the noise is the same all along
_NEIGHBOURS = 15  # of these that are taken to have the same
_FREE = 7  # more samples in each than degrees
_PLAINLY = 9.0  # times another variance: the noise is not the same all along
_MEDIAN = 0.6  # degrees of freedom that a median keeps
_TOGETHER = 4.0  # standard deviations by which that must stand out
_STEPS = 1e-6  # of a step, that samples which are cut off may be off a multiple of it
_FEWEST_STEPS = 4  # different values, to tell that they are multiples of one
_CUT = 0.45  # of a step: noise above it hides that digits were cut off


@dataclass(frozen=True)
class Noise:
    """What samples scatter by about a smooth curve.

    Examples
    --------
    See `noise_of`.
    """

    index: Index  # (m,): some of the samples
    spread: Array  # (m,): standard deviation of one sample there, the worst component
    freedom: float  # degrees of freedom that this is known with
    alike: float  # times the variance of a mean that noise makes which is not independent from one sample to the next
    step: float  # what all samples are multiples of, where no noise hides it; else 0
    rounding: float  # of the largest of the samples, as they are kept

    def at(self, index: Index) -> Array:
        """Return the standard deviation of one sample at other samples."""
        return np.interp(index, self.index, self.spread)


def noise_of(time: Array, values: Array, known: Known) -> Noise:
    """Return the noise of samples.

    Examples
    --------
    >>> t, draw = np.linspace(0.0, 6.0, 400), np.random.default_rng(0)
    >>> seen = noise_of(t, np.sin(t)[:, None] + draw.normal(scale=1e-3, size=(400, 1)), {})
    >>> round(float(seen.spread[0]), 4), seen.step
    (0.001, 0.0)
    """
    rounding = float(np.finfo(float).eps * np.abs(values).max())
    levels = _Levels(time, values, known, rounding)
    degree, width = levels.choice()
    level, alike = levels.at(degree, width)
    free = _MEDIAN * time.size * (width - degree - 1) / width / alike
    index, shape = _shape(time, values, known)
    spread = np.maximum(np.sqrt(level) * shape, rounding)
    freedom = free if np.ptp(shape) == 0 else free * _NEIGHBOURS / _LOCAL
    step = _step(values)
    return Noise(index, spread, freedom, alike, step if np.median(spread) < _CUT * step else 0.0, rounding)


@lru_cache
def _spread(samples: int, count: int) -> Index:
    return np.unique(np.linspace(0, samples - 1, min(samples, count)).round().astype(int))


def _rest(at: Polynomials, values: Array) -> Array:
    y = values[at.index] - values[at.index[:, at.index.shape[1] // 2]][:, None]
    return np.asarray(y - at.basis @ (at.inverse @ y))


def _variances(rest: Array, degree: int) -> Array:
    """Return the variance of each window and component, (m, c), so that the median over windows is that of a sample."""
    free = rest.shape[1] - degree - 1
    median = (1 - 2 / (9 * free)) ** 3  # of χ² over its mean [Wilson and Hilferty 1931]
    return np.asarray((rest * rest).sum(axis=1) / (free * median))


@dataclass
class _Levels:
    """What polynomials leave over of samples: the variance of a sample, and times that of a mean over many."""

    time: Array
    values: Array
    known: Known
    rounding: float
    found: dict[tuple[int, int], tuple[float, float]] = field(default_factory=dict)

    def at(self, degree: int, width: int) -> tuple[float, float]:
        """Return both for one degree and width."""
        if (degree, width) not in self.found:
            some = _spread(self.time.size, min(_TRIED, 2 + 4 * self.time.size // width))
            fit = polynomials(self.time, some, 0, degree, width, self.known)
            rest = _rest(fit, self.values)
            level = max(float(np.median(_variances(rest, degree), axis=0).max()), self.rounding**2)
            self.found[degree, width] = level, _alike(rest, fit, degree)
        return self.found[degree, width]

    def choice(self) -> tuple[int, int]:
        """Return the degree and the width whose rest is noise; where there is none, those that leave least."""
        widths = [_NARROWEST]
        while widths[-1] * _WIDER <= min(_WIDEST, self.time.size):
            widths.append(int(widths[-1] * _WIDER))
        pairs = [(d, w) for d in _DEGREES for w in widths if w >= d + _MORE + 3]
        chosen, level, least = None, np.inf, np.inf
        for degree, width in sorted(pairs, key=lambda pair: pair[1] / pair[0]):
            variance, alike = self.at(degree, width)
            least = min(least, variance * alike)
            if variance * alike > _FAR * least:
                break  # the motion itself is left over from here on
            if variance * alike <= _RISE * level and self.at(degree + _MORE, width)[0] >= _ABOUT * variance:
                chosen, level = (degree, width), variance * alike
        return min(self.found, key=lambda pair: self.found[pair][0]) if chosen is None else chosen


def _alike(rest: Array, at: Polynomials, degree: int) -> float:
    """Return how much more the noise of a mean is than that of independent samples: 1 + 2 Σ of its correlations."""
    width = rest.shape[1]
    power = float((rest * rest).sum())
    if power == 0:
        return 1.0
    scale = power / (width - degree - 1)  # a sum over the windows and components, of the variance
    samples = min(rest.shape[0] * width, int(np.ptp(at.index)) + 1)
    total = 0.0
    for lag, independent in enumerate(at.correlations, 1):
        share = (float((rest[:, :-lag] * rest[:, lag:]).sum()) / scale - independent) / width
        if share < _TOGETHER / np.sqrt(samples):
            break
        total += share
    return float(1 + 2 * total)


def _shape(time: Array, values: Array, known: Known) -> tuple[Index, Array]:
    """Return how the noise varies along the samples, beside its usual size: 1 all along, unless it plainly does not."""
    index, width = _spread(time.size, _LOCAL), min(_DEGREES[-1] + _FREE, time.size)
    degree = width - _FREE
    each = _variances(_rest(polynomials(time, index, 0, degree, width, known), values), degree).max(axis=1)
    usual = float(np.median(each))
    if len(each) <= _NEIGHBOURS or usual == 0:
        return index, np.ones(index.size)
    middle = np.median(np.lib.stride_tricks.sliding_window_view(each, _NEIGHBOURS), axis=-1)
    if middle.max() <= _PLAINLY * middle.min():
        return index, np.ones(index.size)
    half = _NEIGHBOURS // 2
    local = np.concatenate([np.repeat(middle[:1], half), middle, np.repeat(middle[-1:], half)])
    return index, np.sqrt(local / usual)


def _step(values: Array) -> float:
    """Return what all samples are multiples of, as they are where digits were cut off; 0 where there is no such."""
    different = np.unique(values)
    if different.size < _FEWEST_STEPS:
        return 0.0
    gaps = np.diff(different)
    step = float(gaps.min())
    return step if float(np.abs(gaps / step - np.round(gaps / step)).max()) < _STEPS * different.size else 0.0
