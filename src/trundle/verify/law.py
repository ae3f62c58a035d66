"""The law checked by a route that does not use T2: Newton, Euler and the differentiated constraint, solved together.

Rates come from the trajectory's own numbers: each is the slope at the middle of a polynomial through a short window.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.system import RollingSystem
from ..solve.samples import RESTING, ROLLING, Samples

Array = NDArray[np.float64]

WINDOWS = 24
_HALF_NODES = 6  # a polynomial of degree 12
_PHASE_A_WINDOW = 0.3  # rad of the fastest rotation: what a polynomial leaves of a body that is no sphere is rounding


@dataclass(frozen=True)
class Residuals:
    """How far a trajectory is from the law, each as a share of the terms that it is made of."""

    path: float  # the slope of the position against the velocity
    law: float  # accelerations and reaction against the 9 × 9 system
    virtual_power: float  # of the reaction over the admissible velocities


def window_times(begin: float, end: float, fastest: float) -> Array:
    """Return the instants of short windows spread over a run.

    Parameters
    ----------
    begin, end : float
        Of the run, s.
    fastest : float
        The largest rate in the motion, rad/s.

    Returns
    -------
    array (WINDOWS, nodes)
        Chebyshev points of each window, ascending, s.

    Examples
    --------
    >>> window_times(0.0, 10.0, 1.0).shape
    (24, 13)
    """
    width = min(end - begin, _PHASE_A_WINDOW / max(fastest, 1e-300))
    golden = 0.6180339887498949
    middles = begin + width / 2 + np.sort((golden * (1 + np.arange(WINDOWS))) % 1.0) * (end - begin - width)
    nodes = -np.cos(np.pi * np.arange(2 * _HALF_NODES + 1) / (2 * _HALF_NODES))
    return np.clip(middles[:, None] + nodes * (width / 2), begin, end)


def _slope_at_middle(times: Array, values: Array) -> Array:
    """Return dy/dt at the middle of each window, for the polynomial through its nodes; values (windows, nodes, ...).

    Barycentric weights (Berrut and Trefethen 2004) from the nodes as they are, which far from t = 0 are rounded.
    """
    half = (times[:, -1:] - times[:, :1]) / 2
    x = (times - times[:, _HALF_NODES : _HALF_NODES + 1]) / half
    apart = x[:, :, None] - x[:, None, :] + np.eye(x.shape[1])
    weights = 1 / apart.prod(axis=2)
    weights /= weights[:, _HALF_NODES : _HALF_NODES + 1]
    x[:, _HALF_NODES] = 1.0
    row = -weights / x
    row[:, _HALF_NODES] = 0.0
    change = values - values[:, _HALF_NODES : _HALF_NODES + 1]
    return np.einsum("wn,wn...->w...", row / half, change)


def residuals(system: RollingSystem, windows: Samples, times: Array) -> Residuals:
    """Compare a trajectory with the law by the independent route.

    Parameters
    ----------
    system : RollingSystem
        What moved.
    windows : Samples
        The trajectory at `times.ravel()`.
    times : array (windows, nodes)
        As `window_times` returns them, none across an event.

    Returns
    -------
    Residuals
        The largest over the windows.

    Examples
    --------
    See `trundle.verify.card`.
    """
    nodes = times.shape[1]
    phases = windows.phase[_HALF_NODES::nodes]
    found = []
    for phase in np.unique(phases):
        which = np.flatnonzero(phases == phase)
        index = (which[:, None] * nodes + np.arange(nodes)).ravel()
        found.append(_residuals_of(system, windows.part(index), times[which], int(phase)))
    return Residuals(*(max(getattr(part, name) for part in found) for name in ("path", "law", "virtual_power")))


def _residuals_of(system: RollingSystem, windows: Samples, times: Array, phase: int) -> Residuals:
    """Return the residuals of windows of one phase."""
    shape = times.shape

    def slope(array: Array) -> Array:
        return _slope_at_middle(times, array.reshape(*shape, -1))

    V_rate, Omega_rate = slope(windows.velocity), slope(windows.angular_velocity)
    p_rate, r_rate = slope(windows.contact), slope(windows.position)
    rho_rate = slope(windows.contact - windows.position)
    own_rate = slope(windows.own) if windows.own.size else None
    middle = windows.part(np.arange(_HALF_NODES, times.size, shape[1]))
    m, V, Omega = float(system.body.mass), middle.velocity, middle.angular_velocity
    rho = middle.contact - middle.position
    F, K, J, gyroscopic, u_rate = applied(system, middle, p_rate, own_rate)
    R = middle.contact_force
    if phase == ROLLING:  # what holds the body to the support is not asked for, but found
        solved = newton_euler(m, J, rho, F, K - gyroscopic, u_rate - np.cross(Omega, rho_rate))
    else:
        turned = Omega_rate if phase == RESTING else _euler(J, K - gyroscopic + np.cross(rho, R))
        solved = (F + R) / m, turned, R

    rate = np.linalg.norm(Omega, axis=1).max() + np.abs(V_rate).max() / max(np.abs(V).max(), 1e-300)
    a_size = max(np.abs(F).max() / m, np.abs(V_rate).max(), np.abs(V).max() * rate, 1e-300)
    lever = m * a_size * np.linalg.norm(rho, axis=1).max() / np.trace(J, axis1=1, axis2=2).min()  # what R may turn
    turn_size = max(np.abs(Omega_rate).max(), np.abs(Omega).max() * rate, lever)
    law = max(
        np.abs(solved[0] - V_rate).max() / a_size,
        np.abs(solved[1] - Omega_rate).max() / turn_size,
        np.abs(solved[2] - R).max() / (m * a_size),
    )
    half = (times[:, -1] - times[:, 0]).min() / 2
    path = np.abs(r_rate - V).max() / max(np.abs(V).max(), np.abs(middle.position).max() / half)
    if phase != ROLLING:
        return Residuals(float(path), float(law), 0.0)

    force = m * V_rate - F  # the reaction and its torque as the motion shows them
    torque = np.einsum("nij,nj->ni", J, Omega_rate) + gyroscopic - K
    power = [
        np.abs((force * np.cross(rho, turn)).sum(axis=1) + torque @ turn).max()  # δV = −δΩ×ρ = ρ×δΩ
        for turn in np.eye(3)
    ]
    turning = np.abs(J).max() * np.abs(Omega).max() * rate
    torque_size = max(m * a_size * np.linalg.norm(rho, axis=1).max(), turning)
    return Residuals(float(path), float(law), float(max(power) / torque_size))


def _euler(J: Array, torque: Array) -> Array:
    return np.asarray(np.linalg.solve(J, torque[..., None])[..., 0])


def applied(system: RollingSystem, at: Samples, p_rate: Array, own_rate: Array | None = None) -> tuple[Array, ...]:
    """Return F, K, J, Ω×JΩ and u̇ at each instant, as arrays.

    Parameters
    ----------
    system : RollingSystem
        Body, support and loads.
    at : Samples
        Instants of a motion, n of them; their contact force gives the normal force that couples follow.
    p_rate : array (n, 3)
        ṗ, m/s.
    own_rate : array (n, k), optional
        Rates of the coordinates of the support's own motion: the last is the ω̇ of a free axle.

    Returns
    -------
    tuple of array
        (n, 3) each, J (n, 3, 3); SI, inertial support frame.
    """
    q, shape = Quaternion.of(at.orientation), at.position.shape
    acting = system.acting_on(at.motion(system))
    torque = acting.torque
    if acting.has_couple:
        torque = torque + acting.couple * Vector.of(at.contact_force).dot(Vector.of(at.normals(system)))
    tensor = system.body.inertia_in_space(q.matrix())
    J = np.stack([np.broadcast_to(row.array(), shape) for row in tensor.rows], axis=1)
    JOmega = np.einsum("nij,nj->ni", J, at.angular_velocity)
    support, p = at.support(system), Vector.of(at.contact)
    u_rate = support.material_acceleration(p, Vector.of(p_rate))
    if system.support.motion.free and own_rate is not None:
        u_rate = u_rate + support.lever(p) * own_rate[:, -1]
    F, K, u = (np.broadcast_to(v.array(), shape) for v in (acting.force, torque, u_rate))
    return F, K, J, np.cross(at.angular_velocity, JOmega), u


def newton_euler(m: float, J: Array, rho: Array, F: Array, K: Array, constraint: Array) -> tuple[Any, Any, Any]:
    """Solve m V̇ − R = F, J Ω̇ − ρ×R = K − Ω×JΩ, V̇ − ρ×Ω̇ = u̇ − Ω×ρ̇ for V̇, Ω̇ and R, one 9×9 system an instant.

    Parameters
    ----------
    m : float
        Mass, kg.
    J : array (n, 3, 3)
        kg m².
    rho, F, K, constraint : array (n, 3)
        ρ, F, K − Ω×JΩ and u̇ − Ω×ρ̇; SI, inertial support frame.

    Returns
    -------
    V_rate, Omega_rate, R : array (n, 3)
        V̇, Ω̇ and R.
    """
    n, one = len(F), np.eye(3)
    cross = np.zeros((n, 3, 3))
    cross[:, 0, 1], cross[:, 0, 2], cross[:, 1, 2] = -rho[:, 2], rho[:, 1], -rho[:, 0]
    cross -= cross.transpose(0, 2, 1)
    A = np.zeros((n, 9, 9))
    A[:, :3, :3], A[:, :3, 6:] = m * one, -one
    A[:, 3:6, 3:6], A[:, 3:6, 6:] = J, -cross
    A[:, 6:, :3], A[:, 6:, 3:6] = one, -cross
    x = np.linalg.solve(A, np.concatenate([F, K, constraint], axis=1)[..., None])[..., 0]
    return x[:, :3], x[:, 3:6], x[:, 6:]
