"""One comparison over its windows: the mismatch, and what noise and spacing leave open of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .comparisons import Comparison, Sensitivity
from .laws import Rates
from .motion import Motion
from .record import ExternalTrajectory
from .slopes import Array, Index
from .windows import Weights, spread_of

_BEYOND = 3.0  # standard deviations that a truncation must stand out of the noise


@dataclass(frozen=True)
class Open:
    """What noise, and errors of the states, leave open of a mismatch in each window.

    `spread` (k,) is its standard deviation, `by_chance` that of what a polynomial of a lower degree changes, and `bias`
    what is off besides; `freedom` are the degrees of freedom of the noise.
    """

    spread: Array
    by_chance: Array
    bias: Array
    freedom: float


def left_open(one: Comparison, weights: Weights, at: Motion, place: Index, reacts: Sensitivity) -> Open:
    """Work out what cannot be told of a comparison."""
    gains = {part: gain for part, gain in one.gains(at, reacts).items() if part in at.estimates}
    noise = {name: _noise(at, name, place) for name in {one.array, *(at.sources[part] for part in gains)}}

    def carried(phi: Array) -> list[tuple[str, Array]]:
        return [
            (at.sources[part], weights.gain(phi * g[place], at.estimates[part], place)) for part, g in gains.items()
        ]

    spread = spread_of([(one.array, np.linalg.norm(weights.row, axis=1)), *carried(weights.phi)], noise)
    by_chance = spread_of(carried(weights.fewer), noise) if gains else np.zeros_like(spread)
    bias = np.zeros_like(spread)
    for part, gain in gains.items():
        bias = bias + np.abs(weights.mean((gain * at.estimates[part].bias)[place]))
    if one.which is not None:
        bias = bias + np.abs(weights.mean(reacts.curvature_at(one.which, at.time)[place]))
    return Open(spread, by_chance, bias, min(at.estimates[name].freedom for name in noise))


def _noise(at: Motion, name: str, place: Index) -> Array:
    """Return the standard deviation of means of an array in each window, per root of their number."""
    estimate = at.estimates[name]
    return np.asarray(np.sqrt(estimate.alike * (estimate.noise[place] ** 2).mean(axis=1)))


@dataclass(frozen=True)
class Seen:
    """A comparison over its windows: mismatch and mean rate (k, 3), standard deviation and bias (k,)."""

    mismatch: Array
    rate: Array
    spread: Array
    bias: Array
    freedom: float


def seen(
    one: Comparison,
    weights: Weights,
    slope: Array,
    theirs: ExternalTrajectory,
    at: Motion,
    place: Index,
    rates: Rates,
    open_: Open,
) -> Seen:
    """Return the mismatch of a comparison, from the mean slope of what they wrote."""
    f = one.rate(at, rates)[place]
    mismatch, change = weights.mismatch(slope, f)
    bias = open_.bias + np.maximum(change - _BEYOND * np.sqrt(f.shape[-1]) * open_.by_chance, 0.0)
    if one.array in theirs.doubts:
        bias = bias + _doubtful(one.array, theirs, at.index[place], f)
    times = 2.0 if one.turning else 1.0
    mean = one.vectors(at, place, weights.mean(f))
    return Seen(one.vectors(at, place, mismatch), mean, times * open_.spread, times * bias, open_.freedom)


def _doubtful(name: str, theirs: ExternalTrajectory, index: Index, f: Array) -> Array:
    """Return what is open of the mean rate of Ω where an orientation that was added up turned it."""
    length = np.linalg.norm(getattr(theirs, name), axis=1)
    span = theirs.time[index[:, -1]] - theirs.time[index[:, 0]]
    return theirs.doubts[name].of_rate(index, float(length.max()), length[index], np.linalg.norm(f, axis=-1), span)


def share_left(one: Comparison, weights: Weights, at: Motion, place: Index, rates: Rates) -> float:
    """Return the share of a mismatch that means over windows leave, if it turns about as the motion itself does."""
    probes = [one.rate(at, rates)] + ([at.velocity] if one.which is not None and not one.turning else [])
    return min(_left(weights, probe[place]) for probe in probes)


def _left(weights: Weights, f: Array) -> float:
    length = weights.mean(np.linalg.norm(f, axis=-1))
    mean = np.linalg.norm(weights.mean(f), axis=-1)
    return float(np.median(np.where(length > 0, mean / np.where(length > 0, length, 1.0), 1.0)))
