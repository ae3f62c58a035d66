"""A ball on a turntable with some shortcoming, by Newton, Euler and the constraint.

The table may wobble, turn unevenly, lean or resist rolling, and there may be air about it.

Nothing is eliminated: the reaction is solved for, with the two accelerations, at every instant. Written for the table's
axle along the third axis and for a sphere alone, without a line of trundle's own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp


def cross(v: Any) -> Any:
    """Return the matrix of v×."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


@dataclass(frozen=True)
class Table:
    """The numbers of one demonstration, SI."""

    radius: float
    mass: float
    inertia_ratio: float
    rate: float
    rim: float = np.inf
    tilt: float = 0.0
    drag: float = 0.0
    air_rate: float = 0.0
    askew: float = 0.0
    offset: float = 0.0  # of the normal force, ahead of the contact
    variation: float = 0.0
    variation_rate: float = 1.0
    gravity: float = 9.80665

    def axle(self, t: float) -> tuple[float, float]:
        """Return ω and its rate of change."""
        phase = self.variation_rate * t
        share = self.variation * self.variation_rate
        return self.rate * (1 + self.variation * np.sin(phase)), self.rate * share * np.cos(phase)

    def normal(self, t: float) -> tuple[Any, Any]:
        """Return the normal, which leans away from the second axis at first and goes round, and its rate."""
        s, c = np.sin(self.rate * t), np.cos(self.rate * t)
        lean = np.sin(self.askew)
        n = np.array([lean * s, -lean * c, np.cos(self.askew)])
        return n, self.rate * np.array([lean * c, lean * s, 0.0])

    def motion(self, t: float, state: Any) -> Any:
        """Return the rates of centre, velocity and angular velocity."""
        r, V, Omega = state[:3], state[3:6], state[6:9]
        a, m, inertia = self.radius, self.mass, self.inertia_ratio * self.mass * self.radius**2
        n, n_rate = self.normal(t)
        omega, omega_rate = (np.array([0.0, 0.0, part]) for part in self.axle(t))
        p, p_rate = r - a * n, V - a * n_rate
        weight = m * self.gravity * np.array([np.sin(self.tilt), 0.0, -np.cos(self.tilt)])
        force = weight - self.drag * (V - np.cross([0.0, 0.0, self.air_rate], r))
        # Unknown: V̇, Ω̇, R.
        matrix, right = np.zeros((9, 9)), np.zeros(9)
        matrix[:3, :3], matrix[:3, 6:] = m * np.eye(3), -np.eye(3)
        matrix[3:6, 3:6], matrix[3:6, 6:] = inertia * np.eye(3), a * cross(n)
        over = Omega - omega - n * (n @ (Omega - omega))
        matrix[3:6, 6:] += self.offset * np.outer(over / (np.linalg.norm(over) or 1.0), n)
        matrix[6:, :3], matrix[6:, 3:6] = np.eye(3), a * cross(n)  # V = u + a Ω×n, differentiated
        right[:3] = force
        right[6:] = np.cross(omega_rate, p) + np.cross(omega, p_rate) + a * np.cross(Omega, n_rate)
        solved = np.linalg.solve(matrix, right)
        return np.concatenate([V, solved[:3], solved[3:6]])

    def run(self, position: Any, velocity: Any, duration: float, spin: float = 0.0, rtol: float = 1e-11) -> Any:
        """Start with the centre over a place at a velocity along the table, and return SciPy's solution."""
        n, _ = self.normal(0.0)
        lean = self.askew
        own = np.array([[1, 0, 0], [0, np.cos(lean), -np.sin(lean)], [0, np.sin(lean), np.cos(lean)]])
        p = own @ np.array([*position, 0.0])
        along = own @ np.array([*velocity, 0.0])
        u = np.cross([0.0, 0.0, self.axle(0.0)[0]], p)
        V = along + n * (u @ n)  # along n the body moves with the table
        Omega = np.cross(n, V - u) / self.radius + spin * n
        first = np.concatenate([p + self.radius * n, V, Omega])

        def at_rim(t: float, state: Any) -> float:
            return float(np.linalg.norm(state[:3] - self.radius * self.normal(t)[0]) - self.rim)

        at_rim.terminal = True  # type: ignore[attr-defined]
        events = at_rim if np.isfinite(self.rim) else None
        tight = {"rtol": rtol, "atol": 0.01 * rtol, "dense_output": True}
        return solve_ivp(self.motion, (0.0, duration), first, "DOP853", events=events, **tight)

    def path(self, position: Any, velocity: Any, duration: float, rtol: float = 1e-11) -> Callable[[Any], Any]:
        """Return the centre as x + iy of the time."""
        solved = self.run(position, velocity, duration, rtol=rtol)
        return lambda t: solved.sol(t)[0] + 1j * solved.sol(t)[1]
