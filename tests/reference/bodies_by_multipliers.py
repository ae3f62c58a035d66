"""Any body on a plane by Newton, Euler and Lagrange's multipliers: nothing of it comes from the rolling law.

The centre, the rotation matrix, V and Ω are integrated as if they were free. The contact force is the multiplier that
keeps the differentiated constraint, and nothing else holds the body to the plane, so that the constraint itself tests
the result. The rate of ρ is a complex step along the turning, not (T1).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import trundle as tr

_STEP = 1e-40
_NORMAL = np.array([0.0, 0.0, 1.0])

Support = Callable[[np.ndarray], np.ndarray]


def ball(radius: float, centre: Any = (0.0, 0.0, 0.0)) -> Support:
    """Return the point of a sphere with a given outward normal."""
    return lambda nu: np.array(centre) + radius * nu


def rim(radius: float) -> Support:
    """Return the point of a circle about the third axis that reaches furthest along a given direction."""
    return lambda nu: radius * np.array([nu[0], nu[1], 0.0]) / np.sqrt(nu[0] ** 2 + nu[1] ** 2)


def ellipsoid(semi_axes: Any, centre: Any) -> Support:
    """Return the point of an ellipsoid with a given outward normal."""
    squares = np.array(semi_axes) ** 2
    return lambda nu: np.array(centre) + squares * nu / np.sqrt((squares * nu * nu).sum())


def crossing(v: np.ndarray) -> np.ndarray:
    """Return the matrix of v×."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def cross(v: np.ndarray, w: np.ndarray) -> np.ndarray:
    """Return v×w of two vectors, ten times as fast as NumPy's for stacks of them."""
    (a, b, c), (x, y, z) = v, w
    return np.array([b * z - c * y, c * x - a * z, a * y - b * x])


@dataclass(frozen=True)
class Free:
    """A body on a plane that turns with `rate` about its normal; `slides` is the coefficient of slipping."""

    mass: float
    inertia: np.ndarray
    furthest: Support
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.80665)
    rate: float = 0.0
    couple: Callable[[float, np.ndarray], np.ndarray] | None = None  # K(t, Ω)
    couple_per_normal_force: Callable[[np.ndarray], np.ndarray] | None = None  # of Ω
    slides: float | None = None
    tolerance: float = 3e-14

    def offset(self, Q: np.ndarray) -> np.ndarray:
        """Return ρ."""
        return Q @ self.furthest(-(Q.T @ _NORMAL))

    def slip(self, y: np.ndarray) -> np.ndarray:
        """Return s, which rolling keeps at zero."""
        r, Q, V, Omega = y[:3], y[3:12].reshape(3, 3), y[12:15], y[15:]
        rho = self.offset(Q)
        return V + cross(Omega, rho) - self.rate * cross(_NORMAL, r + rho)

    def rates(self, time: float, y: np.ndarray) -> np.ndarray:
        """Return the rates of the state."""
        Q, V, Omega = y[3:12].reshape(3, 3), y[12:15], y[15:]
        Q_rate = crossing(Omega) @ Q
        rho, moved = self.offset(Q), self.offset(Q + 1j * _STEP * Q_rate)
        rho_rate = moved.imag / _STEP
        J = Q @ self.inertia @ Q.T
        K = np.zeros(3) if self.couple is None else self.couple(time, Omega)
        per_force = np.zeros(3) if self.couple_per_normal_force is None else self.couple_per_normal_force(Omega)
        free = np.concatenate([self.mass * np.array(self.gravity), K - cross(Omega, J @ Omega)])
        u_rate = self.rate * cross(_NORMAL, V + rho_rate)
        constraint = u_rate - cross(Omega, rho_rate)  # V̇ + Ω̇×ρ
        if self.slides is None:
            directions, rows = np.eye(3), np.eye(3)
        else:
            s = self.slip(y)
            directions, rows = (_NORMAL - self.slides * s / np.linalg.norm(s))[:, None], _NORMAL[None, :]
        k = directions.shape[1]
        A = np.zeros((6 + k, 6 + k))
        A[:3, :3], A[3:6, 3:6] = self.mass * np.eye(3), J
        A[:3, 6:] = -directions
        A[3:6, 6:] = -crossing(rho) @ directions - np.outer(per_force, _NORMAL @ directions)
        A[6:, :3], A[6:, 3:6] = rows, -rows @ crossing(rho)
        found = np.linalg.solve(A, np.concatenate([free, rows @ constraint]))
        return np.concatenate([V, Q_rate.ravel(), found[:6]])

    def follow(self, start: tr.State, times: np.ndarray) -> np.ndarray:
        """Return the states at the times, (time, 18)."""
        y = np.concatenate([start.position, matrix(start.orientation).ravel(), start.velocity, start.angular_velocity])
        span, least = (0.0, times[-1]), 0.3 * self.tolerance
        return solve_ivp(self.rates, span, y, method="DOP853", rtol=self.tolerance, atol=least, t_eval=times).y.T


def matrix(orientation: Any) -> np.ndarray:
    """Return the rotation matrix of a quaternion (w, x, y, z)."""
    w, v = orientation[0], np.array(orientation[1:])
    return (w * w - v @ v) * np.eye(3) + 2 * np.outer(v, v) + 2 * w * crossing(v)


def furthest_apart(run: tr.Trajectory, states: np.ndarray) -> tuple[float, float, float]:
    """Return the largest differences in position, m, turning, rad/s, and direction of the axes."""
    data = run.data
    turned = np.array([matrix(q) for q in data.orientation.to_numpy()])
    return (
        float(abs(data.position.to_numpy() - states[:, :3]).max()),
        float(abs(data.angular_velocity.to_numpy() - states[:, 15:]).max()),
        float(abs(turned - states[:, 3:12].reshape(-1, 3, 3)).max()),
    )
