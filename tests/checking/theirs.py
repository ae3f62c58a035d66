"""Somebody else's integration: Newton, Euler and the constraint with a multiplier, in NumPy, stepped by SciPy.

Nothing of trundle is used. The mistakes that people make are options.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

N = np.array([0.0, 0.0, 1.0])
G = 9.80665


@dataclass(frozen=True)
class Ball:
    """A ball on a plane that may turn and lean; J in the body's principal axes."""

    a: float = 0.025
    m: float = 0.5
    J: tuple[float, float, float] = (0.4 * 0.5 * 0.025**2,) * 3
    omega: float = 3.5
    tilt: float = 0.02
    drag: float = 0.0
    push: tuple[float, float, float] = (0.0, 0.0, 0.0)
    gyroscopic: bool = True
    carried: bool = True

    def slope(self, _: float, y: Any) -> Any:
        V, Omega, q = y[3:6], y[6:9], y[9:13]
        Q = turned(q)
        J, rho = Q @ np.diag(self.J) @ Q.T, -self.a * N
        F = self.m * G * np.array([np.sin(self.tilt), 0, -np.cos(self.tilt)]) - self.drag * V + np.array(self.push)
        K = -crossing(Omega) @ (J @ Omega) if self.gyroscopic else np.zeros(3)
        u_rate = self.omega * crossing(N) @ V if self.carried else np.zeros(3)
        arm = -crossing(rho)  # arm @ w = w×ρ
        one, nil = np.eye(3), np.zeros((3, 3))
        A = np.block([[self.m * one, nil, -one], [nil, J, arm], [one, arm, nil]])
        x = np.linalg.solve(A, np.concatenate([F, K, u_rate]))
        turning = 0.5 * np.array(
            [
                -Omega @ q[1:],
                *(q[0] * Omega + crossing(Omega) @ q[1:]),
            ]
        )
        return np.concatenate([V, x[:6], turning])

    def start(self, x: float, y: float, vx: float, vy: float, spin: float = 0.0) -> Any:
        r, V = np.array([x, y, self.a]), np.array([vx, vy, 0.0])
        Omega = np.cross(N, V - self.omega * np.cross(N, r)) / self.a + spin * N
        return np.concatenate([r, V, Omega, [1.0, 0.0, 0.0, 0.0]])

    def run(self, y0: Any, duration: float = 4.0, step: float = 0.01) -> dict[str, Any]:
        t = np.arange(0.0, duration, step)
        found = solve_ivp(self.slope, (0.0, duration), y0, "DOP853", t, rtol=1e-10, atol=1e-12)
        return columns(found.t, found.y.T)

    def stepped(self, y0: Any, duration: float = 4.0, step: float = 1e-3) -> dict[str, Any]:
        """Semi-implicit Euler: velocities first, then places with the new velocities."""
        y, rows = y0.copy(), []
        for _ in range(round(duration / step)):
            rows.append(y.copy())
            y[3:9] += step * self.slope(0.0, y)[3:9]
            y[:3] += step * y[3:6]
        return columns(np.arange(len(rows)) * step, np.array(rows))


def turned(q: Any) -> Any:
    w, v = q[0], q[1:] / np.linalg.norm(q)
    w = w / np.linalg.norm(q)
    cross = crossing(v)
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def crossing(v: Any) -> Any:
    """Return the matrix of v×, which is much quicker than np.cross for a single vector."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def columns(t: Any, y: Any) -> dict[str, Any]:
    names = ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "qw", "qx", "qy", "qz"]
    return {"t": t} | {name: y[:, i].copy() for i, name in enumerate(names)}


def only(data: dict[str, Any], stems: str) -> dict[str, Any]:
    """Return time, position and some more: v, w, q."""
    return {name: array for name, array in data.items() if name in "txyz" or name[0] in stems}


def with_parts(data: dict[str, Any], stem: str, vectors: Any) -> dict[str, Any]:
    parts = "wxyz" if stem == "q" else "xyz"
    return data | {f"{stem}{part}": vectors[:, i] for i, part in enumerate(parts)}


def vectors(data: dict[str, Any], stem: str) -> Any:
    return np.column_stack([data[f"{stem}{part}"] for part in ("wxyz" if stem == "q" else "xyz")])


def integrated(data: dict[str, Any], *, body_axes: bool) -> Any:
    """Return quaternions from the Ω of the columns: q̇ = ½ Ω q, or q̇ = ½ q Ω for body axes."""
    spline, side = CubicSpline(data["t"], vectors(data, "w")), -1.0 if body_axes else 1.0

    def slope(t: float, q: Any) -> Any:
        w = spline(t)
        return 0.5 * np.array([-w @ q[1:], *(q[0] * w + side * crossing(w) @ q[1:])])

    start = [1.0, 0.0, 0.0, 0.0]
    return solve_ivp(slope, data["t"][[0, -1]], start, "DOP853", data["t"], rtol=1e-9, atol=1e-10).y.T


def skidding(ball: Ball, mu: float, V0: Any, Omega0: Any, step: float = 0.002) -> tuple[dict[str, Any], float]:
    """A ball that skids on a level plane at rest until it rolls at t = 2 s₀/(7 μ g), a solid one (Coriolis 1835)."""
    slip = V0 + np.cross(Omega0, -ball.a * N)
    ahead, end = slip / np.linalg.norm(slip), 2 * np.linalg.norm(slip) / (7 * mu * G)
    t = np.arange(0.0, 2 * end, step)
    skid = np.minimum(t, end)[:, None]
    V = V0 - mu * G * skid * ahead
    Omega = Omega0 + ball.m * ball.a / ball.J[0] * mu * G * skid * np.cross(N, ahead)
    r = ball.a * N + V0 * skid - 0.5 * mu * G * skid**2 * ahead + (t[:, None] - skid) * V
    return with_parts(with_parts(with_parts({"t": t}, "", r), "v", V), "w", Omega), float(end)


__all__ = [
    "Ball",
    "G",
    "N",
    "integrated",
    "only",
    "replace",
    "skidding",
    "turned",
    "vectors",
    "with_parts",
]
