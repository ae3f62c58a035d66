"""The pushed box a second time: Newton's and Euler's equations of all 26 bodies, solved for accelerations and forces.

This knows nothing of the formula in `pushed_box`. Nothing slips but the box on the ground; the unknowns are the
acceleration of the box, the acceleration and angular acceleration of each ball along the force, and the friction
between each ball and the box.
"""

from __future__ import annotations

import math

import numpy as np

from .case import Array, Task


def integrated(situation: Task, times: Array) -> tuple[Array, Array, Array, Array]:
    """Return displacement, speed, rate of turning and angle of each body along the force, by DOP853."""
    from scipy.integrate import solve_ivp

    gains, spins = accelerations(situation)
    count = gains.size

    def rates(t: float, y: Array) -> Array:  # noqa: ARG001  nothing depends on the time
        speed, turning = np.split(y, 4)[1:3]
        return np.concatenate([speed, gains, spins, turning])

    found = solve_ivp(rates, (times[0], times[-1]), np.zeros(4 * count), "DOP853", times, rtol=1e-13, atol=1e-15)
    moved, speed, turning, turned = np.split(found.y.T, 4, axis=1)
    return moved, speed, turning, turned


def accelerations(situation: Task) -> tuple[Array, Array]:
    """Return the acceleration of each body along the force, and its angular acceleration about the axis across it."""
    box, *balls = situation["bodies"]
    g, n = -situation["gravity"][2], len(balls)
    weight = g * (box["mass"] + sum(ball["mass"] for ball in balls))
    push = math.hypot(*box["force"][:2])
    A, b = np.zeros((1 + 3 * n, 1 + 3 * n)), np.zeros(1 + 3 * n)
    A[0, 0], b[0] = box["mass"], push - situation["friction"] * weight
    for i, ball in enumerate(balls):
        a, alpha, f = 1 + 3 * i, 2 + 3 * i, 3 + 3 * i
        radius = ball["shape"]["radius"]
        A[0, f] = 1.0  # the friction on the box is against that on the ball
        A[a, a], A[a, f] = ball["mass"], -1.0
        A[alpha, alpha], A[alpha, f] = ball["inertia"][0][0], -radius  # about an axis across, turned backwards
        A[f, a], A[f, alpha], A[f, 0] = 1.0, radius, -1.0  # its lowest point goes with the box
    found = np.asarray(np.linalg.solve(A, b), dtype=float)
    return found[[0, *range(1, 1 + 3 * n, 3)]], np.array([0.0, *found[2::3]])
