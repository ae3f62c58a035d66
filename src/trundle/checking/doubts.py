"""What an orientation that was added up from somebody's Ω may be off by, and with it what was turned by it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .slopes import SIGMAS, Array, Estimate, Index

_SLOPE = np.sqrt(1.2)  # standard deviation of the slope of a line fitted to a random walk, times the root of its span


@dataclass(frozen=True)
class Doubt:
    """The angle by which an orientation may be off, in two parts, rad.

    Parameters
    ----------
    turning : array (n,)
        What changes about as fast as the body turns: nobody told Ω between the samples.
    walking : array (n,)
        What noise has added up to, a random walk.
    drift : float
        How fast it walks: over a span its mean rate is this over the root of the span.

    Examples
    --------
    See `trundle.checking.motion.added_up`.
    """

    turning: Array
    walking: Array
    drift: float

    @property
    def angle(self) -> Array:
        """By what the orientation may be off at each sample."""
        return self.turning + self.walking

    def fitted(self, time: Array) -> Doubt:
        """Return the doubt of an orientation whose start was fitted to all of the run, (n,) s: a walk about its mean."""
        share = (time - time[0]) / (time[-1] - time[0])
        return replace(self, walking=self.walking.max() * np.sqrt(1 / 3 - share + share**2))

    def of_rate(self, index: Index, fastest: float, length: Array, rate: Array, span: Array) -> Array:
        """Return what it leaves open of the mean rate of a vector that was turned by the orientation.

        Parameters
        ----------
        index : int array (k, nodes)
            Samples of some windows.
        fastest : float
            At which the body turns, rad/s.
        length, rate : array (k, nodes)
            Of the vector, and of its rate.
        span : array (k,)
            Of each window, s.

        Returns
        -------
        array (k,)
        """
        swinging = self.turning[index] * fastest * length + self.walking[index] * rate
        return np.asarray(swinging.mean(axis=1) + self.drift * length.mean(axis=1) / np.sqrt(span))


def doubt_of(time: Array, gain: Array, noise: Estimate) -> Doubt:
    """Return the doubt of an orientation that was added up.

    Parameters
    ----------
    time : array (n,)
        Ascending, s.
    gain : array (n,)
        Angle by which steps twice as long make it another, rad.
    noise : Estimate
        Of Ω at some samples, rad/s.

    Returns
    -------
    Doubt
        What noise adds up to is no matter of the steps.

    Examples
    --------
    >>> t, none = np.linspace(0.0, 4.0, 5), np.zeros(1)
    >>> doubt = doubt_of(t, np.full(5, 0.1), Estimate(none, none, none, np.array([0.01 / SIGMAS])))
    >>> doubt.walking.round(3).tolist(), doubt.turning.round(3).tolist()
    ([0.0, 0.01, 0.014, 0.017, 0.02], [0.1, 0.09, 0.086, 0.083, 0.08])
    """
    one = SIGMAS * float(np.median(noise.noise)) * np.sqrt(noise.alike * float(np.median(np.diff(time))))
    walking = one * np.sqrt(time - time[0])
    return Doubt(np.maximum(gain - walking, 0.0), walking, one * _SLOPE)


__all__ = ["Doubt", "doubt_of"]
