"""The two kinds of chaos of a rattleback on a table that only pushes, and the equations of Borisov and Mamaev.

Borisov, Jalnine, Kuznetsov, Sataev and Sedova (2012) tell a strange attractor, with one positive and two negative
exponents of the map of three numbers, from chaos of the quasi-conservative kind, in which the positive and a negative
one are close in size and the other close to zero.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import trundle as tr

pytest.importorskip("heyoka")

SEMI_AXES, MASS, G = np.array([3.0, 2.0, 1.0]), 1.0, 100.0  # g in units of h, to have some seconds in a second
ATTRACTOR = ((2.0, 6.0, 6.5), 0.1, (2.45, 4.08, 8.17))  # principal moments, the angle that they are turned by, Ω
QUASI_CONSERVATIVE = ((2.0, 6.0, 7.0), 0.2, (2.4, 3.9, 7.6))
Stone = tuple[tuple[float, float, float], float, tuple[float, float, float]]


def inertia_of(moments: tuple[float, float, float], delta: float) -> Any:
    c, s = math.cos(delta), math.sin(delta)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return turn @ np.diag(moments) @ turn.T


def started(stone: Stone) -> tuple[tr.RollingSystem, tr.State]:
    moments, delta, Omega = stone
    J = inertia_of(moments, delta)
    body = tr.Body(MASS, tr.Tensor(J[0, 0], J[1, 1], J[2, 2], xy=J[0, 1]), tr.Ellipsoid(*SEMI_AXES))
    system = tr.RollingSystem(body, tr.Support(tr.Plane()), gravity=G)
    return system, system.place(velocity="rolling", angular_velocity=Omega)


def slopes(_: float, y: Any, J: Any) -> Any:
    """Return ω̇ and γ̇ along the body's axes: Ṁ = M×ω + m ṙ×(ω×r) + m g r×γ, M = Jω + m r×(ω×r), γ̇ = γ×ω."""
    omega, gamma = y[:3], y[3:]
    squares = SEMI_AXES**2
    root = math.sqrt(gamma @ (squares * gamma))
    r, gamma_rate = -squares * gamma / root, np.cross(gamma, omega)
    r_rate = -squares * gamma_rate / root + squares * gamma * (gamma @ (squares * gamma_rate)) / root**3
    A = J + MASS * ((r @ r) * np.eye(3) - np.outer(r, r))
    turned = np.cross(A @ omega, omega) + MASS * G * np.cross(r, gamma) - MASS * np.cross(r, np.cross(omega, r_rate))
    return np.concatenate([np.linalg.solve(A, turned), gamma_rate])


@pytest.mark.parametrize("stone", [ATTRACTOR, QUASI_CONSERVATIVE])
def test_a_rattleback_moves_by_the_equations_of_borisov_and_mamaev(stone: Stone) -> None:
    system, start = started(stone)
    run = tr.simulate(system, start, 4.0, 0.05)
    first = np.array([*stone[2], 0.0, 0.0, 1.0])
    given: Any = (inertia_of(*stone[:2]),)
    theirs = solve_ivp(slopes, (0.0, 4.0), first, "DOP853", run.samples.time, args=given, rtol=1e-12, atol=1e-13)
    w, *v = run.samples.orientation.T
    v = np.array(v)

    def to_body(vectors: Any) -> Any:
        across = np.cross(v.T, vectors).T
        return vectors.T - 2 * w * across + 2 * np.cross(v.T, across.T).T

    ours = np.vstack([to_body(run.samples.angular_velocity), to_body(np.tile([0.0, 0.0, 1.0], (w.size, 1)))])
    assert np.abs(ours - theirs.y).max() < 1e-7  # it parts exponentially


def test_one_has_a_strange_attractor_of_one_positive_and_two_negative_exponents() -> None:
    system, start = started(ATTRACTOR)
    found = tr.lyapunov_exponents(system, start, "500 s", transient="100 s")
    assert found.passed
    assert not found.ended
    exponents = np.array(found.exponents)
    zero = np.abs(exponents[1:6]).max()
    assert exponents[0] > 3 * zero
    assert (exponents[6:] < -3 * zero).all()
    assert exponents[7] < -0.3
    assert found.sum_between_events < -0.2


def test_another_is_chaotic_and_all_but_keeps_its_volume() -> None:
    system, start = started(QUASI_CONSERVATIVE)
    found = tr.lyapunov_exponents(system, start, "300 s", transient="50 s")
    assert found.passed
    exponents = np.array(found.exponents)
    assert exponents[0] > 0.2
    # A strange attractor has 1.3 to 1.7 here. Over 300 s chance has up to 0.4, by starts 1e-9 apart; over 1000 s 0.02.
    assert abs(exponents[0] + exponents[-1]) < 0.6 * exponents[0]
    assert abs(exponents[-2]) < 0.2 * exponents[0]
