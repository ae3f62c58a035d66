"""Orientation q(t) from a known Ω(t): q̇ = ½ Ω q (theory page, section 5).

The time is covered by panels on which Ω is a polynomial, and each of them by steps on which the body turns little
and q is its Taylor series about the middle; many steps are worked out at once and then multiplied up, and q at an
instant is read off its step's series. Where Ω(t) repeats, `periodic_orientation` needs one period only.

In here a quaternion w + xi + yj + zk is a pair of complex numbers, (w + xi) + (y + zi)j: a product takes four
multiplications of arrays for sixteen.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from operator import mul
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import SolverError
from .exact.phi import two_product
from .monodromy import Monodromy

Array = NDArray[np.float64]
Pairs = NDArray[np.complex128]  # (2, n)
AngularVelocity = Callable[[Array], Array]  # times (n,) -> Ω (3, n) in the support frame, rad/s

_NODES = 12  # of the polynomial for Ω on a panel
_LARGEST_TURN = 8.0  # rad a step
_PANEL = 8  # steps
_SMOOTH = 0.4  # rad by which Ω itself turns on a panel
_LOOKS = 16  # at how fast the body turns, at least, before the steps are chosen
_MOST_TERMS = 40  # of q's series on a step
_AT_ONCE = 20_000  # steps, or instants
_TOGETHER = 500  # steps whose series have the same number of terms
_MOST_STEPS = 3e6  # twenty seconds
_MORE, _MOST_TRIED = 16, 20_000  # times as many panels as seemed needed, and more, at once: a second
_EPSILON = 2.0**-53
# The last two Legendre coefficients of Ω on a panel, for each rad that it turns by: rounding alone makes them some
# 1e-16, and what comes after them is a tenth of them at most, divided by as many as there are nodes when integrated.
_TAIL = 1e-14


def orientation(
    angular_velocity: AngularVelocity, times: Array, start: Any, start_time: float = 0.0, kinks: Any = ()
) -> Array:
    """Return the orientation at given times from a known angular velocity.

    Examples
    --------
    Half a turn about the third axis:

    >>> q = orientation(lambda t: np.outer([0.0, 0.0, 1.0], np.ones_like(t)), np.array([np.pi]), (1, 0, 0, 0))
    >>> [round(c, 12) + 0.0 for c in q[0].tolist()]
    [0.0, 0.0, 0.0, 1.0]
    """
    times = np.asarray(times, dtype=float)
    if not times.size:
        return np.empty((0, 4))
    edges = _edges(start_time, float(times[-1]), np.asarray(kinks, dtype=float))
    panels = _panels_needed(angular_velocity, edges)
    upto = np.cumsum(panels)
    result = np.empty((times.size, 4))
    q, done = _paired(start), 0
    for first in range(0, int(upto[-1]), _AT_ONCE // _PANEL):
        index = np.arange(first, min(first + _AT_ONCE // _PANEL, int(upto[-1])))
        which = np.searchsorted(upto, index, side="right")
        half = 0.5 * np.diff(edges)[which] / panels[which]
        middle = edges[which] + (2 * (index - upto[which] + panels[which]) + 1) * half
        course = _Course.over(angular_velocity, middle, half, q)
        end = times.size if index[-1] == upto[-1] - 1 else int(np.searchsorted(times, course.end, side="right"))
        for begin in range(done, end, _AT_ONCE):
            part = slice(begin, min(begin + _AT_ONCE, end))
            result[part] = _unit(course.at(times[part]))
        q, done = course.last, max(done, end)
    return result


def _edges(begin: float, end: float, kinks: Array) -> Array:
    """Return where to look how fast the body turns: at both ends, at the kinks between them, and evenly in between."""
    fixed = np.concatenate([[begin], kinks[(kinks > begin) & (kinks < end)], [end]])
    parts = -(-_LOOKS // (fixed.size - 1))
    share = np.arange(parts) / parts
    return np.append((fixed[:-1, None] + share * np.diff(fixed)[:, None]).ravel(), end)


def _paired(quaternion: Any) -> Pairs:
    """Return one quaternion (w, x, y, z) as a pair."""
    w, x, y, z = (float(part) for part in quaternion)
    return np.array([[complex(w, x)], [complex(y, z)]])


def _unit(pairs: Pairs) -> Array:
    """Return the quaternions (n, 4) of pairs, scaled to length 1."""
    q = np.ascontiguousarray(pairs.T).view(float)
    return q / np.sqrt((q * q).sum(axis=1, keepdims=True))


def _panels_needed(angular_velocity: AngularVelocity, edges: Array) -> NDArray[np.int64]:
    """Count the panels in each interval, as far as one sees, so that none turns by too much and Ω is smooth on it."""
    instants = np.concatenate([edges, 0.5 * (edges[1:] + edges[:-1])])
    Omega = angular_velocity(instants)
    begin, end, middle = Omega[:, : edges.size - 1], Omega[:, 1 : edges.size], Omega[:, edges.size :]
    speeds = np.linalg.norm([begin, middle, end], axis=1)
    steps = np.maximum(1.0, np.ceil(speeds.max(axis=0) * np.diff(edges) / _LARGEST_TURN))
    total = float(steps.sum())
    if not total < _MOST_STEPS:
        raise SolverError(
            f"The body turns by some {total * _LARGEST_TURN:.3g} rad in this run, more than the "
            f"{_MOST_STEPS * _LARGEST_TURN:.3g} rad that its orientation is followed over. Ask for a shorter run, or "
            "look for a load that drives it too hard."
        )
    # What goes round on a circle is this far from its chord in the middle.
    reach = max(float(np.linalg.norm(Omega - Omega.mean(axis=1, keepdims=True), axis=0).max()), 1e-300)
    off = np.linalg.norm(middle - 0.5 * (begin + end), axis=0)
    arc = 2 * np.arccos(np.clip(1 - off / reach, -1.0, 1.0))
    return np.maximum(np.ceil(steps / _PANEL), np.ceil(arc / _SMOOTH)).clip(1).astype(np.int64)


class _Course:
    """The orientation over adjoining steps, each with its series about the middle."""

    def __init__(self, middle: Array, half: Array, series: Pairs, start: Pairs) -> None:
        self.middle, self.half, self.series = middle, half, series  # series: (2, terms, steps)
        even, odd = series[:, ::2].sum(axis=1), series[:, 1::2].sum(axis=1)
        self._back = _conjugate(even - odd)  # from a step's beginning to its middle
        turned = _product(_running_product(_product(even + odd, self._back)), start)
        self._before = np.concatenate([start, turned[:, :-1]], axis=1)
        self.last = turned[:, -1:]
        self.end = float(middle[-1] + half[-1])

    @staticmethod
    def over(angular_velocity: AngularVelocity, middle: Array, half: Array, start: Pairs) -> _Course:
        """Follow Ω over these panels, halved until its polynomial resolves it on them and the body turns little."""
        middle, half, mean, legendre = _parted(*_resolved(angular_velocity, middle, half))
        return _Course(middle, half, _series(mean, legendre), start)

    def at(self, times: Array) -> Pairs:
        """Return q at instants on these steps."""
        which = np.minimum(np.searchsorted(self.middle + self.half, times), self.middle.size - 1)
        half = self.half[which]
        x = np.clip(np.divide(times - self.middle[which], half, out=np.zeros_like(times), where=half > 0), -1.0, 1.0)
        # A step's numbers for one power of x stand side by side: they are fetched together.
        rows = np.ascontiguousarray(self.series.transpose(1, 2, 0)).view(float)
        x4, now = np.repeat(x, 4).reshape(-1, 4), rows[-1].take(which, axis=0)
        for row in rows[-2::-1]:
            now *= x4
            now += row.take(which, axis=0)
        return _product(_product(now.view(complex).T, self._back[:, which]), self._before[:, which])


def _resolved(angular_velocity: AngularVelocity, middle: Array, half: Array) -> tuple[Array, Array, Array, Array]:
    """Return panels and Ω on each as `_polynomials` does; those on which it is not resolved are halved."""
    done: list[tuple[Array, ...]] = []
    left = _MORE * middle.size + _MOST_TRIED
    for _ in range(31):
        left -= middle.size
        if left < 0:
            raise SolverError("Ω(t) changes too fast, or is known too roughly, for the orientation to be followed.")
        mean, legendre = _polynomials(angular_velocity, middle, half)
        size = np.linalg.norm(mean, axis=0)
        tail = np.abs(legendre[:, -2:]).max(axis=(0, 1))
        # A panel may turn by more than one saw when it was chosen, but hardly.
        rough = (tail > _TAIL * np.maximum(size, 1.0)) | (size > _PANEL * _LARGEST_TURN)
        done.append(tuple(part[..., ~rough] for part in (middle, half, mean, legendre)))
        if not rough.any():
            break
        quarter = 0.5 * half[rough]
        middle, half = np.concatenate([middle[rough] - quarter, middle[rough] + quarter]), np.tile(quarter, 2)
    else:
        raise SolverError("Ω(t) is not smooth: its orientation cannot be followed; look for a jump in the loads.")
    return _together(done)


def _together(parts: Sequence[tuple[Array, ...]]) -> tuple[Array, Array, Array, Array]:
    middle, half, mean, legendre = (np.concatenate(part, axis=-1) for part in zip(*parts, strict=True))
    return middle, half, mean, legendre


def _parted(middle: Array, half: Array, mean: Array, legendre: Array) -> tuple[Array, Array, Array, Array]:
    """Return steps, ascending, and Ω on each: panels in so many equal parts that the body turns little on each."""
    legendre = legendre[:, : _above_rounding(legendre)]
    size = legendre.shape[1]
    counts = np.maximum(np.ceil(np.linalg.norm(mean, axis=0) / (0.5 * _LARGEST_TURN)), 1).astype(int)
    done = []
    for count in np.unique(counts).tolist():
        which = counts == count
        begun = middle[which, None] + half[which, None] * _shares(count)
        parts = _parting(count)[:, :size, :size].reshape(-1, size) @ legendre[..., which]
        parts = parts.reshape(3, count, size, -1).transpose(0, 2, 3, 1).reshape(3, size, -1)
        length = np.repeat(half[which] / count, count)
        done.append((begun.ravel(), length, np.repeat(mean[:, which] / count, count, axis=1), parts))
    middle, half, mean, legendre = _together(done)
    order = np.argsort(middle, kind="stable")
    return middle[order], half[order], mean[:, order], legendre[..., order]


def _shares(count: int) -> Array:
    """Return where the middles of equal parts of [−1, 1] are."""
    return (2 * np.arange(count) + 1) / count - 1


@cache
def _parting(count: int) -> Any:
    """Return what takes Legendre's coefficients of Ω·(half length) to those on each of so many equal parts."""
    nodes, to_legendre, _ = _fit()
    places = _shares(count)[:, None] + nodes / count
    return to_legendre @ np.polynomial.legendre.legvander(places, _NODES - 1) / count


@cache
def _fit() -> tuple[Any, Any, Any]:
    """Nodes on [−1, 1], what takes values there to Legendre's coefficients, and these to those of 1, x, x², ..."""
    nodes, _ = np.polynomial.legendre.leggauss(_NODES)
    to_legendre = np.linalg.inv(np.polynomial.legendre.legvander(nodes, _NODES - 1))
    powers = [np.polynomial.legendre.leg2poly(np.eye(_NODES)[j]) for j in range(_NODES)]
    return nodes, to_legendre, np.array([np.pad(row, (0, _NODES - row.size)) for row in powers]).T


def _polynomials(angular_velocity: AngularVelocity, middle: Array, half: Array) -> tuple[Array, Array]:
    """Return Ω·(half length) on each panel: mean (3, total), and Legendre's coefficients of the rest (3, nodes, total).

    The rest is small, and so is its rounding.
    """
    nodes, to_legendre, _ = _fit()
    values = angular_velocity((middle + nodes[:, None] * half).ravel()).reshape(3, _NODES, -1)
    mean = values.mean(axis=1)
    rest = values - mean[:, None]
    rest *= half
    return mean * half, to_legendre @ rest


def _series(mean: Array, legendre: Array) -> Pairs:
    """Return the series (2, terms, total) of q about the middle of each step, where it is 1."""
    blocks = [slice(first, first + _TOGETHER) for first in range(0, mean.shape[1], _TOGETHER)]
    parts = [_taylor(_powers(mean[:, at], legendre[..., at])) for at in blocks]
    if len(parts) == 1:
        return parts[0]
    series = np.zeros((2, max(part.shape[1] for part in parts), mean.shape[1]), dtype=complex)
    for at, part in zip(blocks, parts, strict=True):
        series[:, : part.shape[1], at] = part
    return series


def _powers(mean: Array, legendre: Array) -> Array:
    """Return Ω's coefficients (3, powers, total) of 1, x, x², ..., without those that turn by nothing."""
    count = _count_above(_EPSILON / 8, _sizes(legendre))
    coefficients = _fit()[2][:count, :count] @ legendre[:, :count]
    coefficients[:, 0] += mean
    return coefficients


def _above_rounding(legendre: Array) -> int:
    """Count Legendre's coefficients without those at the end that are as small as what ends them.

    Where Ω changes slowly, half of them are rounding of Ω's values, as the last two are; where it changes fast, what is
    larger than their bound is no rounding.
    """
    sizes = _sizes(legendre)
    return _count_above(min(2 * sizes[-2:].max(), _TAIL), sizes)


def _sizes(coefficients: Array) -> Array:
    return np.abs(coefficients).max(axis=(0, 2), initial=0.0)


def _count_above(bound: float, sizes: Array) -> int:
    above = np.flatnonzero(sizes > bound)
    return int(above[-1]) + 1 if above.size else 1


def _taylor(coefficients: Array) -> Pairs:
    """Return the series (2, terms, total) of q for Ω's coefficients (3, powers, total)."""
    most, (_, powers, total) = _terms_needed(coefficients), coefficients.shape
    # Ω q = (turning) q for each power of x, so that one sum makes a term.
    turning: Any = np.zeros((4, powers, 4, total))
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        turning[1 + a, :, 0] = turning[1 + c, :, 1 + b] = coefficients[a]
        turning[0, :, 1 + a] = turning[1 + b, :, 1 + c] = -coefficients[a]
    turning = turning.reshape(4, -1, total)
    q = np.zeros((4 * (most + 1), total))  # the last term first, so that those to be summed stand side by side
    q[-4] = 1.0
    for n in range(1, most + 1):
        first, used = 4 * (most + 1 - n), 4 * min(n, powers)
        np.einsum("act,ct->at", turning[:, :used], q[first : first + used], out=q[first - 4 : first])
        q[first - 4 : first] *= 0.5 / n
    w, x, y, z = q.reshape(-1, 4, total)[::-1].swapaxes(0, 1)
    return np.stack([w + 1j * x, y + 1j * z])


def _terms_needed(coefficients: Array) -> int:
    """Count the terms of q's series that show, by its own recursion for the sizes of the coefficients.

    Where Ω is small but turns fast, a late coefficient outweighs all products of early ones.
    """
    sizes = np.abs(coefficients).sum(axis=0).max(axis=1, initial=0.0).tolist()
    most = [1.0]  # the last first
    for n in range(1, _MOST_TERMS + 1):
        most.insert(0, sum(map(mul, sizes, most)) * 0.5 / n)
    return max(1, *(_MOST_TERMS - n for n, bound in enumerate(most) if bound > _EPSILON / 8))


def _product(p: Pairs, q: Pairs) -> Pairs:
    """Return the quaternion products p q."""
    return np.stack([p[0] * q[0] - p[1] * q[1].conj(), p[0] * q[1] + p[1] * q[0].conj()])


def _conjugate(q: Pairs) -> Pairs:
    return np.stack([q[0].conj(), -q[1]])


def _running_product(turns: Pairs) -> Pairs:
    """Return r_j = turn_j ... turn_1 turn_0, in √n vectorised sweeps."""
    count = turns.shape[1]
    width = max(1, int(np.ceil(np.sqrt(count))))
    rows = -(-count // width)
    padded = np.zeros((2, rows * width), dtype=complex)
    padded[0] = 1.0
    padded[:, :count] = turns
    grid = padded.reshape(2, rows, width)
    for j in range(1, width):
        grid[:, :, j] = _product(grid[:, :, j], grid[:, :, j - 1])
    before = grid[:, 0, -1].copy()
    for i in range(1, rows):
        grid[:, i] = _product(grid[:, i], before[:, None])
        before = grid[:, i, -1].copy()
    return grid.reshape(2, -1)[:, :count]


def periodic_orientation(angular_velocity: AngularVelocity, monodromy: Monodromy, elapsed: Array, start: Any) -> Array:
    """Return the orientation at times since the start where Ω(t) repeats: any time costs what one period costs.

    Examples
    --------
    See `trundle.solve.monodromy.Monodromy`.
    """
    turns = np.floor(elapsed / monodromy.period)
    turns -= _rest(elapsed, turns, monodromy) < 0  # the quotient was rounded up to a whole turn
    rest = np.clip(_rest(elapsed, turns, monodromy), 0.0, None)
    order = np.argsort(rest, kind="stable")
    result = np.empty((rest.size, 4))
    result[order] = orientation(angular_velocity, rest[order], (1.0, 0.0, 0.0, 0.0))  # within a period
    for first in range(0, rest.size, _AT_ONCE):
        part = slice(first, first + _AT_ONCE)
        w, x, y, z = monodromy.power(turns[part])
        before = _product(np.stack([w + 1j * x, y + 1j * z]), _paired(start))
        result[part] = _unit(_product(result[part].view(complex).T, before))
    return result


def _rest(elapsed: Array, turns: Array, monodromy: Monodromy) -> Array:
    """Return the time left after whole periods, to the last digit of the time itself."""
    whole, rounding = two_product(turns, monodromy.period)
    return (elapsed - whole) - rounding - turns * monodromy.period_remainder
