"""How fast something they wrote changes, against how fast it should, over windows of the run.

In a window of half-length h, y is what they wrote and f the rate that it should change at: ẏ = f, or ÿ = f. The
integral of f along their own states is taken off y, and a straight line, or a parabola, is fitted to what is left: its
slope, or bend, is the mean mismatch of the rate. Of a right motion nothing is left but noise, however far the motion
bends in the window, so that windows may be as wide as the noise asks; the spread of the mismatch follows from that of
one sample.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import chebyshev

from .slopes import Array, Estimate, Index

NODES = (9, 13, 17)  # instants of a window at which the rate is worked out
_DEGREE = 8  # of the polynomial through the rate, at most
_WIDEST = 4096  # samples
_SHARE = 0.6  # of the run that a window may take
WINDOWS = 48


@dataclass(frozen=True)
class Plan:
    """Where windows lie: `start` (k,) is the first sample of each, with nodes a stride apart."""

    start: Index
    stride: int
    nodes: int
    samples: int  # of the whole run

    @property
    def width(self) -> int:
        """Samples of a window."""
        return (self.nodes - 1) * self.stride + 1

    @property
    def index(self) -> Index:
        """The samples at the nodes, (k, nodes)."""
        return self.start[:, None] + self.stride * np.arange(self.nodes)

    def thinned(self, count: int) -> Plan:
        """Return no more than some of the windows, spread over the run."""
        k = self.start.size
        some = np.unique(np.linspace(0, k - 1, min(k, count)).round().astype(int))
        return replace(self, start=self.start[some])

    def moment(self, time: Array) -> Array:
        """Return an instant that each window stands for: its own first for the first, its own last for the last."""
        last = max(self.samples - self.width, 1)
        return np.asarray(time[self.start + np.round((self.width - 1) * self.start / last).astype(int)])


def plans(samples: int) -> Iterator[Plan]:
    """Yield windows of every width that a run has room for, the narrowest first.

    Examples
    --------
    >>> [(plan.width, plan.start.size) for plan in plans(100)]
    [(9, 42), (13, 28), (17, 21), (33, 10)]
    """
    nodes, stride = list(NODES), 1
    while nodes:
        count, width = nodes[0], (nodes[0] - 1) * stride + 1
        if width > min(max(_SHARE * samples, NODES[0]), _WIDEST, samples):
            return
        room = samples - width
        windows = min(WINDOWS, 1 + -(-8 * room // (2 * width))) if room else 1
        start = np.unique(np.linspace(0, room, windows).round().astype(int))
        yield Plan(start, stride, count, samples)
        if len(nodes) > 1:
            nodes.pop(0)
        else:
            stride *= 2


@dataclass(frozen=True)
class Weights:
    """What a mismatch is made of: `row` (k, width) of y, `phi` (k, nodes) of f, `fewer` what a lower degree changes."""

    plan: Plan
    row: Array
    phi: Array
    fewer: Array

    def slope(self, y: Array) -> Array:
        """Return the mean slope, or bend, of what they wrote, (k, c)."""
        index = self.plan.start[:, None] + np.arange(self.plan.width)
        own = y[index] - y[index[:, self.plan.width // 2]][:, None]
        return np.einsum("kn,knc->kc", self.row, own)

    def mismatch(self, slope: Array, f: Array) -> tuple[Array, Array]:
        """Return the mean mismatch, and how much of it a polynomial of two degrees less through f would change."""
        changed = np.einsum("kp,kpc->kc", self.fewer, f)
        return slope - np.einsum("kp,kpc->kc", self.phi, f), np.linalg.norm(changed, axis=1)

    def mean(self, f: Array) -> Array:
        """Return the mean of a rate over each window as a mismatch of it would be seen, (k, ...)."""
        return np.einsum("kp,kp...->k...", self.phi, f)

    def gain(self, weights: Array, estimate: Estimate, place: Index) -> Array:
        """Return the standard deviation of Σ weights × estimate at the nodes, for noise of variance 1, (k,)."""
        found = np.zeros(len(weights))
        for k, (weight, at) in enumerate(zip(weights, place, strict=True)):
            index = estimate.index[at]
            along = np.bincount((index - index.min()).ravel(), (weight[:, None] * estimate.row[at]).ravel())
            found[k] = np.linalg.norm(along)
        return found


def weights_of(plan: Plan, time: Array, order: int) -> Weights:
    """Return the weights that make the mismatch of each window.

    Examples
    --------
    The bend of a parabola is found, and nothing is left where the rate has it:

    >>> t = np.linspace(0.0, 1.0, 40)
    >>> plan = next(plans(40)).thinned(1)
    >>> weights = weights_of(plan, t, 2)
    >>> slope = weights.slope(3 * t[:, None] ** 2)
    >>> [round(float(weights.mismatch(slope, np.full((1, 9, 1), f))[0][0, 0]), 9) for f in (0.0, 6.0)]
    [6.0, -0.0]
    """
    index = plan.start[:, None] + np.arange(plan.width)
    half = ((time[index[:, -1]] - time[index[:, 0]]) / 2)[:, None]
    x = (time[index] - time[index[:, 0]][:, None]) / half - 1
    row = _leading(x, order)
    nodes = x[:, :: plan.stride]
    degree = min(_DEGREE, plan.nodes - 3)
    # What the fit makes of each polynomial whose second derivative, or first, is a Chebyshev polynomial.
    acted = np.einsum("kn,knd->kd", row, _integrated(x, degree, order))
    phi = np.einsum("kd,kdp->kp", acted, np.linalg.pinv(chebyshev.chebvander(nodes, degree)))
    lower = np.linalg.pinv(chebyshev.chebvander(nodes, degree - 2))
    return Weights(plan, row / half**order, phi, phi - np.einsum("kd,kdp->kp", acted[:, : degree - 1], lower))


def _leading(x: Array, order: int) -> Array:
    """Return the weights that give the slope of a fitted line, or the bend of a fitted parabola."""
    Q, R = np.linalg.qr(x[..., None] ** np.arange(order + 1))
    last = Q[..., -1] / R[:, -1, -1][:, None]
    return np.asarray((2.0 if order == 2 else 1.0) * last)


def _integrated(x: Array, degree: int, order: int) -> Array:
    matrix = chebyshev.chebint(np.eye(degree + 1), m=order)
    return np.asarray(chebyshev.chebvander(x, degree + order) @ matrix)


def spread_of(parts: Sequence[tuple[str, Array]], noise: dict[str, Array]) -> Array:
    """Return the standard deviation of a mismatch: what comes from one array adds up, arrays go together by squares.

    Examples
    --------
    >>> parts = [("position", np.array([1.0])), ("position", np.array([2.0])), ("velocity", np.array([4.0]))]
    >>> float(spread_of(parts, {"position": np.array([1.0]), "velocity": np.array([1.0])})[0])
    5.0
    """
    gains = {name: sum(gain for other, gain in parts if other == name) for name, _ in parts}
    return np.asarray(np.sqrt(sum((gain * noise[name]) ** 2 for name, gain in gains.items())))
