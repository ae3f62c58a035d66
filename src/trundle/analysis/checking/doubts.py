"""What an orientation that was added up from somebody's Ω may be off by, and with it what was turned by it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .chance import longest
from .noise import Noise, noise_of
from .polynomials import Known
from .slopes import Array, Index

_WALKS = 4  # values of a random walk that are not much the same, in which Ω is moved across itself
_SLOPE = np.sqrt(1.2)  # standard deviation of the slope of a line fitted to a random walk, times the root of its span


@dataclass(frozen=True)
class Doubt:
    """The angle by which an orientation may be off, in two parts, rad.

    Examples
    --------
    See `trundle.analysis.checking.motion.added_up`.
    """

    turning: Array  # (n,): what changes about as fast as the body turns: nobody told Ω between the samples
    walking: Array  # (n,): what noise has added up to, a random walk
    drift: float  # how fast it walks: over a span its mean rate is this over the root of the span

    @property
    def angle(self) -> Array:
        """By what the orientation may be off at each sample."""
        return self.turning + self.walking

    def fitted(self, time: Array, unsure: float) -> Doubt:
        """Return the doubt of a walk about its mean, where all of the run told the start."""
        share = (time - time[0]) / (time[-1] - time[0])
        return replace(self, walking=unsure + self.walking.max() * np.sqrt(1 / 3 - share + share**2))

    def of_rate(self, index: Index, fastest: float, length: Array, rate: Array, span: Array) -> Array:
        """Return what it leaves open of the mean rate of a vector that was turned by the orientation."""
        swinging = (self.turning[index] * fastest * length).mean(axis=1)
        before, within = (self.walking[index] * rate).mean(axis=1), self.drift * length.mean(axis=1) / np.sqrt(span)
        return np.asarray(swinging + np.hypot(before, within))


def doubt_of(time: Array, angular_velocity: Array, gain: Array, known: Known) -> Doubt:
    """Return the doubt of an orientation that was added up.

    Examples
    --------
    >>> t = np.linspace(0.0, 4.0, 401)
    >>> rolling = 5.0 + np.random.default_rng(0).normal(scale=0.02, size=(401, 3))
    >>> doubt = doubt_of(t, rolling, np.full(401, 0.1), {})
    >>> doubt.walking[::100].round(3).tolist(), doubt.turning[::100].round(3).tolist()
    ([0.0, 0.009, 0.013, 0.016, 0.018], [0.1, 0.091, 0.087, 0.084, 0.082])
    """
    length = np.linalg.norm(angular_velocity, axis=1)[:, None]
    # Either may take for noise what it cannot follow of the motion.
    variance = min(_variance(noise_of(time, values, known)) for values in (angular_velocity, length))
    one = longest(_WALKS, time.size, parts=2) * np.sqrt(variance * float(np.median(np.diff(time))))
    walking = one * np.sqrt(time - time[0])
    return Doubt(np.maximum(gain - walking, 0.0), walking, one * _SLOPE)


def _variance(noise: Noise) -> float:
    return float(np.median(noise.spread)) ** 2 * noise.alike


__all__ = ["Doubt", "doubt_of"]
