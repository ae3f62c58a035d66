"""Orientation q(t) from a known Ω(t): q̇ = ½ Ω q (theory page, section 5).

Each stretch of time is covered by steps on which Ω is a polynomial and q its Taylor series about the middle; all
steps are worked out at once and then multiplied up. Where Ω(t) repeats, `periodic_orientation` needs one period only.
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
    pieces = _pieces(angular_velocity, np.concatenate([[start_time], times]))
    if pieces.max(initial=1) > 1:  # far between: go there by way of instants in between
        between = np.repeat(np.diff(times, prepend=start_time) / pieces, pieces)
        index = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces), pieces) + 1
        finer = np.repeat(times, pieces) + index * between
        return orientation(angular_velocity, finer, start, start_time)[np.cumsum(pieces) - 1]
    result = np.empty((4, times.size))
    q, now, done = np.asarray(start, dtype=float).reshape(4, 1), float(start_time), 0
    while done < times.size:
        edges = np.concatenate([[now], times[done : done + _STEPS_AT_ONCE // 4]])
        steps = _steps_needed(angular_velocity, edges).astype(np.int64)
        take = max(1, int(np.searchsorted(np.cumsum(steps), _STEPS_AT_ONCE)))
        edges, steps = edges[: take + 1], steps[:take]
        turned = _running_product(_turns(angular_velocity, edges, steps))[:, np.cumsum(steps) - 1]
        result[:, done : done + take] = _product(turned, q)
        done, now = done + take, float(edges[-1])
        q = result[:, done - 1 : done]
    return (result / np.sqrt((result * result).sum(axis=0))).T


def _pieces(angular_velocity: AngularVelocity, edges: Array) -> NDArray[np.int64]:
    """Return into how many parts to cut each interval so that none asks for too many steps at once."""
    steps = _steps_needed(angular_velocity, edges)
    total = float(steps.sum())
    if not total < _MOST_STEPS:
        raise SolverError(
            f"The body turns by some {total:.3g} rad in this run, more than the {_MOST_STEPS:.3g} rad that its "
            "orientation is followed over. Ask for a shorter run, or look for a load that drives it too hard."
        )
    return np.maximum(1, np.ceil(steps / (_STEPS_AT_ONCE // 4))).astype(np.int64)


def _steps_needed(angular_velocity: AngularVelocity, edges: Array) -> Array:
    """Count the steps in each interval so that none turns by more than `_LARGEST_TURN`."""
    speeds = np.sqrt((angular_velocity(edges) ** 2).sum(axis=0))
    middles = np.sqrt((angular_velocity(0.5 * (edges[1:] + edges[:-1])) ** 2).sum(axis=0))
    fastest = np.maximum(np.maximum(speeds[1:], speeds[:-1]), middles)
    return np.maximum(1.0, np.ceil(fastest * np.diff(edges) / _LARGEST_TURN))


def _turns(angular_velocity: AngularVelocity, edges: Array, steps: NDArray[np.int64]) -> Array:
    """Return the rotation (4, total) of each step; steps are halved until Ω's polynomial resolves Ω on them."""
    half = np.repeat(0.5 * np.diff(edges) / steps, steps)
    index = np.arange(steps.sum()) - np.repeat(np.cumsum(steps) - steps, steps)
    middle = np.repeat(edges[:-1], steps) + (2 * index + 1) * half
    return _resolved_turns(angular_velocity, middle, half, depth=0)


def _resolved_turns(angular_velocity: AngularVelocity, middle: Array, half: Array, depth: int) -> Array:
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


def _taylor(coefficients: Array) -> Array:
    """Sum the series of q about the middle of each step; return the rotation from its beginning to its end."""
    term = [np.zeros((4, coefficients.shape[2]))]
    term[0][0] = 1.0
    even, odd = term[0].copy(), np.zeros_like(term[0])
    for n in range(1, _terms_needed(coefficients) + 1):
        total = np.zeros_like(even)
        for j in range(min(n, _NODES)):
            total += _pure_product(coefficients[j], term[n - 1 - j])
        term.append(total * (0.5 / n))
        (odd if n % 2 else even).__iadd__(term[n])
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


def _pure_product(v: Array, q: Array) -> Array:
    """Return the product of the quaternion (0, v) with q."""
    (x, y, z), (a, b, c, d) = v, q
    return np.stack([-(x * b + y * c + z * d), x * a + y * d - z * c, y * a + z * b - x * d, z * a + x * c - y * b])


def _product(p: Array, q: Array) -> Array:
    """Return the quaternion products p q, components first."""
    return p[0] * q + _pure_product(p[1:], q)


def _conjugate(q: Array) -> Array:
    return q * np.array([[1.0], [-1.0], [-1.0], [-1.0]])


def _running_product(turns: Array) -> Array:
    """Return r_j = turn_j ... turn_1 turn_0, in √n vectorised sweeps."""
    count = turns.shape[1]
    width = max(1, int(np.ceil(np.sqrt(count))))
    rows = -(-count // width)
    padded = np.zeros((4, rows * width))
    padded[0] = 1.0
    padded[:, :count] = turns
    grid = padded.reshape(4, rows, width).copy()
    for j in range(1, width):
        grid[:, :, j] = _product(grid[:, :, j], grid[:, :, j - 1])
    before = grid[:, 0, -1].copy()
    for i in range(1, rows):
        grid[:, i] = _product(grid[:, i], before[:, None])
        before = grid[:, i, -1].copy()
    return grid.reshape(4, -1)[:, :count]


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
    within = np.empty((4, rest.size))
    within[:, order] = orientation(angular_velocity, rest[order], (1.0, 0.0, 0.0, 0.0)).T
    q0 = np.asarray(start, dtype=float).reshape(4, 1)
    result = _product(within, _product(monodromy.power(turns), q0))
    return (result / np.sqrt((result * result).sum(axis=0))).T


def _rest(elapsed: Array, turns: Array, monodromy: Monodromy) -> Array:
    """Return the time left after whole periods, to the last digit of the time itself."""
    whole, rounding = two_product(turns, monodromy.period)
    return (elapsed - whole) - rounding - turns * monodromy.period_remainder
