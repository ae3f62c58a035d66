"""Orientation q(t) from a known Ω(t): q̇ = ½ Ω q (theory page, section 5).

Each stretch of time is covered by steps on which Ω is a polynomial and q its Taylor series about the middle; all
steps are worked out at once and then multiplied up. Where Ω(t) repeats, `periodic_orientation` needs one period only.

In here a quaternion w + xi + yj + zk is a pair of complex numbers, (w + xi) + (y + zi)j: a product takes four
multiplications of arrays for sixteen.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import SolverError
from .exact.phi import two_product
from .monodromy import Monodromy

Array = NDArray[np.float64]
Pairs = NDArray[np.complex128]  # (2, n)
AngularVelocity = Callable[[Array], Array]  # times (n,) -> Ω (3, n) in the support frame, rad/s

_NODES = 8  # of the polynomial for Ω on a step
_LARGEST_TURN = 1.0  # rad a step
_MOST_TERMS = 40  # of q's series on a step
_STEPS_AT_ONCE = 100_000
_MOST_STEPS = 3e8  # some twenty minutes
_EPSILON = 2.0**-53
# The last coefficient of Ω's polynomial on a step, rad: rounding alone makes it some 1e-14; what comes after it is a
# hundredth of it at most, divided by nine when integrated.
_TAIL = 1e-13


def orientation(angular_velocity: AngularVelocity, times: Array, start: Any, start_time: float = 0.0) -> Array:
    """Return the orientation at given times from a known angular velocity.

    Parameters
    ----------
    angular_velocity : callable
        Takes times (n,) in s, returns Ω (3, n) in the support frame, rad/s.
    times : array (n,)
        Ascending, s.
    start : sequence of 4 floats
        Quaternion (w, x, y, z) at `start_time`.
    start_time : float
        s, at most the first of `times`.

    Returns
    -------
    array (n, 4)
        Unit quaternions, body frame to support frame; exact up to the rounding of Ω·t.

    Raises
    ------
    SolverError
        If Ω is not smooth enough to be followed, or the body turns too often.

    Examples
    --------
    Half a turn about the third axis:

    >>> q = orientation(lambda t: np.outer([0.0, 0.0, 1.0], np.ones_like(t)), np.array([np.pi]), (1, 0, 0, 0))
    >>> [round(c, 12) + 0.0 for c in q[0].tolist()]
    [0.0, 0.0, 0.0, 1.0]
    """
    times = np.asarray(times, dtype=float)
    edges = np.concatenate([[start_time], times])
    steps = _steps_needed(angular_velocity, edges)
    pieces = np.ceil(steps / (_STEPS_AT_ONCE // 4)).astype(np.int64)
    if pieces.max(initial=1) > 1:  # far between: go there by way of instants in between
        between = np.repeat(np.diff(edges) / pieces, pieces)
        index = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces), pieces) + 1
        finer = np.repeat(times, pieces) + index * between
        return orientation(angular_velocity, finer, start, start_time)[np.cumsum(pieces) - 1]
    result = np.empty((2, times.size), dtype=complex)
    q, done = _paired(start), 0
    while done < times.size:
        ahead = steps[done : done + _STEPS_AT_ONCE // 4]
        take = max(1, int(np.searchsorted(np.cumsum(ahead), _STEPS_AT_ONCE)))
        ahead = ahead[:take]
        turned = _running_product(_turns(angular_velocity, edges[done : done + take + 1], ahead))
        result[:, done : done + take] = _product(turned[:, np.cumsum(ahead) - 1], q)
        done += take
        q = result[:, done - 1 : done]
    return _unit(result)


def _paired(quaternion: Any) -> Pairs:
    """Return one quaternion (w, x, y, z) as a pair."""
    w, x, y, z = (float(part) for part in quaternion)
    return np.array([[complex(w, x)], [complex(y, z)]])


def _unit(pairs: Pairs) -> Array:
    """Return the quaternions (n, 4) of pairs, scaled to length 1."""
    q = np.ascontiguousarray(pairs.T).view(float)
    return q / np.sqrt((q * q).sum(axis=1, keepdims=True))


def _steps_needed(angular_velocity: AngularVelocity, edges: Array) -> NDArray[np.int64]:
    """Count the steps in each interval so that none turns by more than `_LARGEST_TURN`."""
    instants = np.concatenate([edges, 0.5 * (edges[1:] + edges[:-1])])
    speeds = np.sqrt((angular_velocity(instants) ** 2).sum(axis=0))
    speeds, middles = speeds[: edges.size], speeds[edges.size :]
    fastest = np.maximum(np.maximum(speeds[1:], speeds[:-1]), middles)
    steps = np.maximum(1.0, np.ceil(fastest * np.diff(edges) / _LARGEST_TURN))
    total = float(steps.sum())
    if not total < _MOST_STEPS:
        raise SolverError(
            f"The body turns by some {total:.3g} rad in this run, more than the {_MOST_STEPS:.3g} rad that its "
            "orientation is followed over. Ask for a shorter run, or look for a load that drives it too hard."
        )
    return steps.astype(np.int64)


def _turns(angular_velocity: AngularVelocity, edges: Array, steps: NDArray[np.int64]) -> Pairs:
    """Return the rotation (2, total) of each step; steps are halved until Ω's polynomial resolves Ω on them."""
    half = np.repeat(0.5 * np.diff(edges) / steps, steps)
    index = np.arange(steps.sum()) - np.repeat(np.cumsum(steps) - steps, steps)
    middle = np.repeat(edges[:-1], steps) + (2 * index + 1) * half
    return _resolved_turns(angular_velocity, middle, half, depth=0)


def _resolved_turns(angular_velocity: AngularVelocity, middle: Array, half: Array, depth: int) -> Pairs:
    coefficients = _polynomials(angular_velocity, middle, half)
    size = np.abs(coefficients).max(axis=1)  # (nodes, total), each already times the half step
    rough = size[-2:].max(axis=0) > _TAIL * np.maximum(size[0], 1.0)
    result = _taylor(coefficients)
    if rough.any():
        if depth > 30:
            raise SolverError("Ω(t) is not smooth: its orientation cannot be followed; look for a jump in the loads.")
        quarter, m = 0.5 * half[rough], middle[rough]
        first, second = (
            _resolved_turns(angular_velocity, m + side * quarter, quarter, depth + 1) for side in (-1.0, 1.0)
        )
        result[:, rough] = _product(second, first)
    return result


@cache
def _fit() -> tuple[Any, Any]:
    """Nodes on [−1, 1] and the matrix that takes values there to coefficients of 1, x, x², ..."""
    nodes, _ = np.polynomial.legendre.leggauss(_NODES)
    return nodes, np.linalg.inv(np.vander(nodes, increasing=True))


def _polynomials(angular_velocity: AngularVelocity, middle: Array, half: Array) -> Array:
    """Return the coefficients (nodes, 3, total) of Ω·(half step) in x ∈ [−1, 1]."""
    nodes, to_coefficients = _fit()
    values = angular_velocity((middle + nodes[:, None] * half).ravel()).reshape(3, _NODES, -1)
    mean = values.mean(axis=1, keepdims=True)
    coefficients = np.einsum("jn,cnt->jct", to_coefficients, values - mean)  # of the small rest: rounding stays small
    coefficients[0] += mean[:, 0]
    return coefficients * half


def _taylor(coefficients: Array) -> Pairs:
    """Sum the series of q about the middle of each step; return the rotation from its beginning to its end."""
    x, y, z = np.moveaxis(coefficients, 1, 0)
    spin, across = 1j * x, y + 1j * z  # Ω as a pair, for each power of the time
    most, total = _terms_needed(coefficients), x.shape[1]
    a, b = (np.zeros((most + 1, total), dtype=complex) for _ in range(2))  # q's terms, as pairs
    a[0] = 1.0
    for n in range(1, most + 1):
        used = min(n, _NODES)
        u, v, c, d = spin[:used], across[:used], a[n - used : n][::-1], b[n - used : n][::-1]
        a[n] = (u * c - v * d.conj()).sum(axis=0) * (0.5 / n)
        b[n] = (u * d + v * c.conj()).sum(axis=0) * (0.5 / n)
    even, odd = (np.stack([a[first::2].sum(axis=0), b[first::2].sum(axis=0)]) for first in (0, 1))
    return _product(even + odd, _conjugate(even - odd))


def _terms_needed(coefficients: Array) -> int:
    """Count the terms of q's series that show, by its own recursion for the sizes of the coefficients.

    Where Ω is small but turns fast, a late coefficient outweighs all products of early ones.
    """
    sizes = np.abs(coefficients).sum(axis=1).max(axis=1, initial=0.0).tolist()
    most = [1.0]
    for n in range(1, _MOST_TERMS + 1):
        most.append(sum(sizes[j] * most[n - 1 - j] for j in range(min(n, _NODES))) * 0.5 / n)
    return max(n for n, bound in enumerate(most) if bound > _EPSILON / 8)


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


def periodic_orientation(
    angular_velocity: AngularVelocity, monodromy: Monodromy, times: Array, start: Any, start_time: float = 0.0
) -> Array:
    """Return the orientation at given times where Ω(t) repeats: any time costs what one period costs.

    Parameters
    ----------
    angular_velocity : callable
        As for `orientation`, with time counted from `start_time`.
    monodromy : Monodromy
        The rotation of one period.
    times : array (n,)
        s, at least `start_time`; any order.
    start : sequence of 4 floats
        Quaternion (w, x, y, z) at `start_time`.
    start_time : float
        s.

    Returns
    -------
    array (n, 4)
        Unit quaternions, body frame to support frame.

    Examples
    --------
    See `trundle.solve.monodromy.Monodromy`.
    """
    elapsed = np.asarray(times, dtype=float) - start_time
    turns = np.floor(elapsed / monodromy.period)
    turns -= _rest(elapsed, turns, monodromy) < 0  # the quotient was rounded up to a whole turn
    rest = np.clip(_rest(elapsed, turns, monodromy), 0.0, None)
    order = np.argsort(rest, kind="stable")
    within = np.empty((2, rest.size), dtype=complex)
    within[:, order] = orientation(angular_velocity, rest[order], (1.0, 0.0, 0.0, 0.0)).view(complex).T
    w, x, y, z = monodromy.power(turns)
    return _unit(_product(within, _product(np.stack([w + 1j * x, y + 1j * z]), _paired(start))))


def _rest(elapsed: Array, turns: Array, monodromy: Monodromy) -> Array:
    """Return the time left after whole periods, to the last digit of the time itself."""
    whole, rounding = two_product(turns, monodromy.period)
    return (elapsed - whole) - rounding - turns * monodromy.period_remainder
