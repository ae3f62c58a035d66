"""What acts on a body, and how hard it is to turn: worked out again, without the sums and matrices of the law."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..mechanics.algebra import Matrix, Vector
from ..mechanics.system import RollingSystem
from ..solve.samples import FLIGHT, RESTING, SLIPPING, Samples
from .bounds import Array

_ROUNDING = 1e-14  # of Ω and ω, that may be left of their difference along the support


def cross(a: Array, b: Array) -> Array:
    """Return the vector products of rows, many times as fast as NumPy's own where there are few.

    Examples
    --------
    >>> cross(np.array([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]]), np.array([0.0, 0.0, 1.0])).tolist()
    [[0.0, -1.0, 0.0], [2.0, 0.0, 0.0]]
    """
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    first = y * w - z * v
    found = np.empty((*first.shape, 3), dtype=first.dtype)
    found[..., 0], found[..., 1], found[..., 2] = first, z * u - x * w, x * v - y * u
    return found


def rotated(q: Array, v: Array) -> Array:
    """Return vectors turned by unit quaternions, v + 2w(u×v) + 2u×(u×v).

    Examples
    --------
    >>> rotated(np.array([[0.0, 0.0, 0.0, 1.0]]), np.array([[1.0, 2.0, 3.0]])).tolist()
    [[-1.0, -2.0, 3.0]]
    """
    across = 2 * cross(q[:, 1:], v)
    return v + q[:, :1] * across + cross(q[:, 1:], across)


def inertia_of(system: RollingSystem, q: Array) -> Array:
    """Return J in the inertial support frame, turned by `rotated` and not by the law's own matrices."""
    own = np.array([list(row) for row in system.body.inertia_in_space(Matrix.identity()).rows], dtype=float)
    axes = np.stack([rotated(q, np.broadcast_to(e, (len(q), 3))) for e in np.eye(3)], axis=2)
    return axes @ own @ axes.transpose(0, 2, 1)


def acting(system: RollingSystem, at: Samples) -> tuple[Array, Array, Array, Array]:
    """Return F, K, J and Ω×JΩ at each instant, as arrays."""
    tilt = float(system.support.tilt)
    weight = float(system.body.mass * system.gravity) * np.array([np.sin(tilt), 0.0, -np.cos(tilt)])
    F, K, _ = exerted(system, at)
    J = inertia_of(system, at.orientation)
    JOmega = np.einsum("nij,nj->ni", J, at.angular_velocity)
    return F + weight, K, J, cross(at.angular_velocity, JOmega)


def unturning(system: RollingSystem, at: Samples) -> Any:
    """Tell in which samples resistance to rolling keeps a body that slips or rests from turning over the support."""
    if not system.resisted or (at.phase == FLIGHT).all():
        return np.zeros(at.time.size, dtype=bool)
    over, size = turning_over(system, at)
    return (at.phase == RESTING) | ((at.phase == SLIPPING) & (over <= _ROUNDING * size))


def turning_over(system: RollingSystem, at: Samples) -> tuple[Array, Array]:
    """Return how fast a body turns over the support, rad/s, and the two rates that it is the small difference of."""
    omega = np.broadcast_to(at.support(system).angular_velocity.array(), at.angular_velocity.shape)
    relative, n = at.angular_velocity - omega, at.normals(system)
    over = np.linalg.norm(relative - (relative * n).sum(axis=1, keepdims=True) * n, axis=1)
    return over, np.linalg.norm(at.angular_velocity, axis=1) + np.linalg.norm(omega, axis=1)


def exerted(system: RollingSystem, at: Samples) -> tuple[Array, Array, Array]:
    """Return force and torque of the loads besides the weight, and the part of the torque that the support exerts."""
    force, torque, from_support = np.zeros((3, *at.position.shape))
    if not system.loads:
        return force, torque, from_support
    motion = at.motion(system)
    N = 0.0 if motion.normal is None else Vector.of(at.contact_force).dot(motion.normal)
    turns = ~unturning(system, at)[:, None]
    for load in system.loads:
        couple = (load.torque_per_normal_force(motion) * N).array()
        couple = couple * turns if load.stops else couple  # where nothing turns it has no direction
        turning = load.torque(motion).array()
        force = force + load.force(motion).array()
        torque = torque + turning + couple
        from_support = from_support + couple + (turning if load.at_contact else 0.0)
    return force, torque, from_support
