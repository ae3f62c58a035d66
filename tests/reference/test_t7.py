"""T7, the golfer's dilemma: against the published frequency ratio, an ODE in the vectors themselves, other methods."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.precise import precisely
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.exact import BallInUprightCylinder

G, A, B, M = 9.80665, 0.02, 0.054, 0.046


def ball(k: float, side: float = -1.0, rate: float = 0.0, **start: Any) -> BallInUprightCylinder:
    values = {"angle": 0.3, "angular_rate": 25.0, "height": 0.1, "climb": -0.2, "spin": 7.0} | start
    return BallInUprightCylinder(A, M, k, B, side, rate, **values, force=(0.0, 0.0, -M * G))


def by_series(motion: BallInUprightCylinder, t: float) -> tuple[Any, Any, Any]:
    """Return z, ż and Ω·n by mpmath's Taylor series of the Newton-Euler equations in cylindrical components.

    (1 + k) v̇ = −g + k a θ̇ s N, Ṅ = −s θ̇ v/a with N = Ω·e_r, which here are not simplified to one equation.
    """
    number = mpmath.mpf
    k, a, side, rate = (number(getattr(motion, name)) for name in ("inertia_ratio", "radius", "side", "angular_rate"))

    def slopes(_: Any, y: Any) -> list[Any]:
        z, v, radial = y
        del z
        return [v, (-number(G) + k * a * rate * side * radial) / (1 + k), -side * rate * v / a]

    start = [number(motion.height), number(motion.climb), number(motion.spin) * side]
    z, v, radial = mpmath.odefun(slopes, 0, start)(number(t))
    return z, v, radial * side


@pytest.mark.parametrize("k", [1e-9, 0.4, 2 / 3, 1.0])
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("rate", [25.0, 1e-9, 0.0])
def test_height_and_spin_solve_newton_and_euler(k: float, side: float, rate: float) -> None:
    with mpmath.workdps(30):
        motion = ball(k, side, angular_rate=rate)
        for t in (0.1, 0.7):
            z, v, spin = by_series(motion, t)
            r, V, Omega, _ = motion.motion_at(t)
            turned = Omega.x * r.x / motion.length + Omega.y * r.y / motion.length
            size = abs(motion.climb) * t + G * t * t + 0.1
            assert abs(r.z - z) <= EXACT(32, size)
            assert abs(V.z - v) <= EXACT(64, size / t)
            assert abs(turned * side - spin) <= EXACT(64, abs(motion.spin) + abs(rate) * size / A)


@pytest.mark.parametrize(("body", "k"), [("solid_sphere", 2 / 5), ("hollow_sphere", 2 / 3)])
def test_the_ratio_of_the_frequencies_is_the_published_one(body: str, k: float) -> None:
    # √(k/(1 + k)), whatever the radii and the speed: √(2/7) for a solid ball (Gualtieri, Tokieda et al. 2006).
    for radius, speed in ((0.01, 0.5), (0.05, 3.0)):
        hole = tr.RollingSystem(getattr(tr.Body, body)(radius, M), tr.Support(tr.Cylinder(B)))
        start = hole.place((0.0, 0.0), (speed, 0.0))
        one = tr.simulate(hole, start, 3.0, 1e-3, method="taylor")
        rate = speed / (B - radius)
        period = 2 * math.pi / (rate * math.sqrt(k / (1 + k)))
        below = G / (k * rate**2)  # z comes back to 0, and goes down to −2g/(kθ̇²), no further
        assert abs(one.at([period]).data.position[0, 2]) <= 1e-9 * below
        assert math.isclose(float(one.data.position[:, 2].min()), -2 * below, rel_tol=1e-3)


def test_it_falls_where_it_does_not_go_round() -> None:
    motion = ball(0.4, angular_rate=0.0, climb=0.0)
    assert motion.motion_at(2.0)[0].z == pytest.approx(0.1 - (5 / 7) * G * 2.0, rel=1e-15)
    assert motion.bobbing_period == math.inf
    # and slowly going round it falls all the same, until it has gone round by about a turn
    assert ball(0.4, angular_rate=1e-8, climb=0.0).motion_at(2.0)[0].z == pytest.approx(motion.motion_at(2.0)[0].z)


@precisely
def test_after_a_million_rounds_the_phase_is_right() -> None:
    motion = ball(0.4)
    t = mpmath.mpf(1e6 * 2 * math.pi / 25.0)
    share = mpmath.mpf(0.4) / (1 + mpmath.mpf(0.4))
    nu = 25 * mpmath.sqrt(share)
    push = -mpmath.mpf(G) / (1 + mpmath.mpf(0.4)) + share * 25 * mpmath.mpf(7) * mpmath.mpf(A)
    wanted = mpmath.mpf(0.1) - mpmath.mpf(0.2) * mpmath.sin(nu * t) / nu + push * (1 - mpmath.cos(nu * t)) / nu**2
    assert abs(motion.motion_at(float(t))[0].z - wanted) <= EXACT(64, 0.2)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_the_general_law_agrees(method: str) -> None:
    wall = tr.Support(tr.Cylinder(B), motion=tr.Spin(-4.0))
    system = tr.RollingSystem(tr.Body.hollow_sphere(A, M), wall)
    start = system.place((0.3, 0.1), (0.5, -0.2), spin=7.0)
    exact, other = (tr.simulate(system, start, 3.0, 0.25, method=name) for name in ("exact", method))
    turned = float(np.abs(exact.data.angular_velocity).max()) * 3.0
    for name in ("position", "velocity", "angular_velocity", "contact_force", "orientation"):
        size = float(np.abs(exact.data[name]).max())
        bound = SOLVER(20, max(other.tolerance, 1e-15), turned)
        assert float(np.abs(exact.data[name] - other.data[name]).max()) <= bound * size, name
