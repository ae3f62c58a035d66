"""The symmetries of a rolling system, found by asking the rolling law and not by names.

A candidate moves everything rigidly: three shifts and three turns of space, three turns of the body within its own
shape. Each is an infinitesimal move that is linear in (p, q, Ω). Those that carry motions into motions are the ones
that commute with the law: [ξ, f] = Df ξ − Dξ f = 0, a set of linear equations for the nine shares of a candidate.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.contact import normal_at

if TYPE_CHECKING:
    from .flow import Flow

Array = NDArray[np.float64]

COUNT = 9  # shares: shift x, y, z (m/s); turn of space x, y, z; turn of the body about its own axes x, y, z (rad/s)
TURN = np.array([0.0, 0, 0, 0, 0, 1, 0, 0, 0])  # about the support's axis
_SAMPLES = 7
_SPREAD = 0.35  # of the states at which the law is asked, in units of the scale
_COMMUTES = 1e-8  # share below which a commutator is nothing


def moved_by(shares: Array, y: Any) -> Any:
    """Return the rates of (p, q, Ω) under a rigid move with given shares.

    Examples
    --------
    >>> moved_by(TURN, np.array([2.0, 0, 0, 1, 0, 0, 0, 0, 0, 0]))[:7].tolist()
    [0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.5]
    """
    return linear_part(shares, y) + np.reshape([*shares[:3], *[0.0] * 7], (10,) + (1,) * (np.ndim(y) - 1))


def linear_part(shares: Array, y: Any) -> Any:
    """Return the part of `moved_by` that is linear in y: all but the shift."""
    turn, own = Vector(*shares[3:6]), Vector(*shares[6:])
    p, q, Omega = Vector(*y[:3]), Quaternion(*y[3:7]), Vector(*y[7:])
    by_body = q * Quaternion(0.0, *own)
    dq = [a + 0.5 * b for a, b in zip(q.rate(turn), by_body, strict=True)]
    parts = [*turn.cross(p), *dq, *turn.cross(Omega)]
    return np.stack([np.broadcast_to(part, np.shape(y)[1:]) for part in parts])


def group_matrix(shares: Array) -> Array:
    """Return the finite move exp(ξ) as a matrix on (p, q, Ω, 1).

    Examples
    --------
    >>> turned = group_matrix(np.pi * TURN) @ np.array([1.0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1])
    >>> turned[:2].round(12).tolist()
    [-1.0, 0.0]
    """
    from scipy.linalg import expm

    return np.asarray(expm(generator(shares)))


def generator(shares: Array) -> Array:
    """Return the infinitesimal move as a matrix on (p, q, Ω, 1), (11, 11)."""
    whole = np.zeros((11, 11))
    whole[:10, :10] = linear_part(shares, np.eye(10))
    whole[:3, 10] = shares[:3]
    return whole


def symmetries(flow: Flow, y: Array) -> Array:
    """Return the symmetries of a flow: the moves of space and body that carry motions into motions.

    Examples
    --------
    A ball on a level plane may be shifted along it, turned about the vertical, and turned in itself at will:

    >>> import trundle as tr
    >>> from trundle.analysis.steady.finding import flow_of
    >>> level = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> flow, y = flow_of(level, level.place(velocity=(1.0, 0.0), spin=0.5))
    >>> len(symmetries(flow, y))
    6
    """
    sizes = np.array([flow.length] * 3 + [1.0] * 6)
    rows = []
    for there in samples(flow, y):
        f = flow.rates(there)
        moves = np.stack([moved_by(row, there) for row in np.diag(sizes)], axis=1)
        swapped = np.stack([linear_part(row, f) for row in np.diag(sizes)], axis=1)
        commutators = flow.slopes(flow.rates, there, moves) - swapped
        rows.append(commutators / (flow.scale * flow.rate)[:, None])
        n = [float(part) for part in normal_at(flow.system, flow.time, Vector(*there[:3]))]
        rows.append((np.array(n) @ moves[:3] / flow.length)[None, :])
    _, singular, basis = np.linalg.svd(np.vstack(rows))
    return np.asarray(basis[singular <= _COMMUTES * max(singular[0], 1.0)] * sizes)


def common(parts: list[Array]) -> Array:
    """Return the moves that some sets of moves, as `symmetries` returns them, have in common.

    Examples
    --------
    >>> shifts, turns = np.eye(COUNT)[:2], np.eye(COUNT)[1:6]
    >>> abs(common([shifts, turns])).round(12).tolist() == np.eye(COUNT)[1:2].tolist()
    True
    """
    if len(parts) == 1:
        return parts[0]
    left = [np.eye(COUNT) - np.linalg.pinv(rows) @ rows if len(rows) else np.eye(COUNT) for rows in parts]
    _, singular, basis = np.linalg.svd(np.vstack(left))
    return np.asarray(basis[singular <= _COMMUTES])


def samples(flow: Flow, y: Array) -> list[Array]:
    """Return states around a given one, on the support: the same ones each time."""
    random = np.random.default_rng(20031)
    basis, found = flow.tangent(y), []
    for _ in range(_SAMPLES):
        step = _SPREAD * random.uniform(-1, 1, basis.shape[1])
        found.append(flow.put_back(y + flow.scale * (basis @ step)))
    return found
