"""T8: a ball round and along a leaning cylinder against quadrature and an ODE in mpmath, T6, T7 and other methods."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.exact import BallInLeaningCylinder, BallInUprightCylinder, CylinderOnCylinder

G, A, B, M, L = 9.80665, 0.1, 0.5, 0.75, 0.4


def ball(
    angle: float,
    rate: float,
    k: float = 0.4,
    across: float = G,
    along: float = 0.0,
    climb: float = 0.3,
    spin: float = 4.0,
) -> BallInLeaningCylinder:
    return BallInLeaningCylinder(A, M, k, B, -1.0, 0.0, angle, rate, 0.2, climb, spin, (M * across, 0.0, M * along))


def by_series(motion: BallInLeaningCylinder, t: float) -> list[Any]:
    """Return θ, z, ż and Ω·n by mpmath's Taylor series of the Newton-Euler equations, inside a cylinder."""
    k, a = mpmath.mpf(motion.inertia_ratio), mpmath.mpf(motion.radius)
    gx, gz = (mpmath.mpf(motion.force[i]) / mpmath.mpf(motion.mass) for i in (0, 2))
    length = mpmath.mpf(motion.track_radius) - a

    def slopes(_: Any, y: Any) -> list[Any]:
        theta, rate, z, v, spin = y
        del z
        pendulum = -gx * mpmath.sin(theta) / ((1 + k) * length)
        return [rate, pendulum, v, (gz + k * a * rate * spin) / (1 + k), -rate * v / a]

    names = ("angle", "angular_rate", "height", "climb", "spin")
    values = mpmath.odefun(slopes, 0, [mpmath.mpf(getattr(motion, name)) for name in names])(mpmath.mpf(t))
    return [values[0], *values[2:]]


STARTS = [(1.0, 0.0), (-2.5, 0.3), (0.3, 8.5), (1.0, -9.0), (1e-8, 0.0)]


@pytest.mark.parametrize(("angle", "rate"), STARTS)
@pytest.mark.parametrize(("k", "along"), [(0.4, 0.0), (1 / 3, -2.0), (1e-8, 1.0)])
def test_it_solves_newton_and_euler(angle: float, rate: float, k: float, along: float) -> None:
    # k = 1/3 makes q = 1/2: after two rounds everything along the axis comes back.
    with mpmath.workdps(20):
        motion = ball(angle, rate, k, along=along)
        for t in (0.8,):
            theta, z, v, spin = by_series(motion, t)
            r, V, Omega, _ = motion.motion_at(t)
            size = 1 + abs(along) * t + abs(v) + abs(z)
            assert abs(r.x - L * mpmath.cos(theta)) <= EXACT(200, 1)
            assert abs(r.z - z) <= EXACT(200, size * t)
            assert abs(V.z - v) <= EXACT(200, size)
            assert abs(-(Omega.x * r.x + Omega.y * r.y) / L - spin) <= EXACT(400, size / A * (1 + abs(rate) * t))


@pytest.mark.parametrize(("angle", "rate"), [*STARTS, (3.0, 0.0)])
def test_the_height_is_the_quadrature_of_its_rate(angle: float, rate: float) -> None:
    motion = ball(angle, rate)
    q = math.sqrt(2 / 7)
    theta = motion.pendulum.angle_at

    def climb(t: Any) -> float:
        turned = q * (theta(float(t)) - angle)
        return 0.3 * math.cos(turned) + q * A * 4.0 * math.sin(turned)

    wanted = 0.2 + mpmath.quad(climb, mpmath.linspace(0, 3, 31))
    assert abs(motion.motion_at(3.0)[0].z - wanted) <= EXACT(100, 1)


@pytest.mark.parametrize(("angle", "rate"), STARTS)
@pytest.mark.parametrize("k", [0.4, 1 / 3, 1e-12])
def test_any_time_is_reached_by_periods_as_by_pieces(angle: float, rate: float, k: float) -> None:
    # The same motion taken up again at a time in between: n periods and a rest against other periods and rests.
    motion = ball(angle, rate, k, along=0.5)
    for first, then in ((0.37, 40.0), (11.0, 0.1), (25.0, 25.0)):
        r, V, Omega, _ = motion.motion_at(first)
        spin = -(Omega.x * r.x + Omega.y * r.y) / L
        turn = (r.x * V.y - r.y * V.x) / L**2
        again = BallInLeaningCylinder(A, M, k, B, -1.0, 0.0, math.atan2(r.y, r.x), turn, r.z, V.z, spin, motion.force)
        late, same = motion.motion_at(first + then)[0].z, again.motion_at(then)[0].z
        assert abs(late - same) <= 1e-12 * (1 + abs(late) + 0.5 * (first + then) ** 2) * (1 + abs(rate) * then)


@pytest.mark.parametrize("near", [1e-6, 1e-12, 0.0, -1e-12])
def test_beside_and_on_the_separatrix(near: float) -> None:
    # G/(m (1 + k) ℓ) = 16 exactly where k = 1/2 and g = 9.6: θ̇ = 8 at the lowest line ends at the top.
    motion = BallInLeaningCylinder(
        0.5, 1.0, 0.5, 1.5, -1.0, 0.0, 0.0, 8.0 * (1 + near), 0.0, 0.3, 2.0, (24.0, 0.0, 0.1)
    )
    law = CylinderOnCylinder(0.5, 1.0, 0.5, 1.5, -1.0, 0.0, 0.0, 8.0 * (1 + near), 0.0, (24.0, 0.0))
    q = math.sqrt(1 / 3)

    def pair(t: Any) -> tuple[float, float]:
        turned = q * law.angle_at(float(t))
        return math.cos(turned), math.sin(turned) / q

    for t in (0.5, 2.0, 8.0):
        C, S = (
            float(mpmath.quad(lambda s, i=i: pair(s)[i], mpmath.linspace(0, t, int(8 * t) + 1), maxdegree=5))
            for i in (0, 1)
        )
        wanted = 0.3 * C + 1.0 * S / 3 + 0.5 * (0.1 / 1.5) * (C * C + S * S / 3)
        assert abs(motion.motion_at(t)[0].z - wanted) <= 1e-12 * (1 + abs(wanted))


def test_at_rest_along_the_axis_it_is_t6() -> None:
    for angle, rate in STARTS:
        still = ball(angle, rate, climb=0.0, spin=0.0)
        t = np.linspace(0.0, 50.0, 101)
        for ours, theirs in zip(still.motion_at(t), still.pendulum.motion_at(t), strict=True):
            assert np.array_equal(np.broadcast_to(ours.array(), (101, 3)), np.broadcast_to(theirs.array(), (101, 3)))


def test_upright_it_is_t7() -> None:
    numbers = {
        "angle": 0.3,
        "angular_rate": 5.0,
        "height": 0.1,
        "climb": -0.2,
        "spin": 7.0,
        "force": (0.0, 0.0, -M * G),
    }
    t = np.linspace(0.0, 50.0, 101)
    ours, upright = (
        form(A, M, 0.4, B, -1.0, 2.0, **numbers).motion_at(t) for form in (BallInLeaningCylinder, BallInUprightCylinder)
    )
    for one, other in zip(ours, upright, strict=True):
        size = np.abs(other.array()).max()
        assert np.allclose(one.array(), other.array(), rtol=0, atol=EXACT(500, size))


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("tilt", ["90 deg", "40 deg"])
@pytest.mark.parametrize("speed", [0.5, -9.0])
def test_the_general_law_agrees(method: str, tilt: str, speed: float) -> None:
    support = tr.Support(tr.Cylinder(B), motion=tr.Spin(3.0), tilt=tilt)
    system = tr.RollingSystem(tr.Body.solid_sphere(A, M), support)
    start = system.place((1.0, 0.25), (speed, 0.4), spin=-3.0)
    exact, other = (tr.simulate(system, start, 3.0, 0.5, method=name) for name in ("exact", method))
    turned = float(np.abs(exact.data.angular_velocity).max()) * 3.0
    bound = SOLVER(20, max(other.tolerance, 1e-15), max(1.0, turned))
    for name in ("position", "velocity", "angular_velocity", "contact_force", "orientation"):
        size = float(np.abs(exact.data[name]).max())
        assert float(np.abs(exact.data[name] - other.data[name]).max()) <= bound * size, name
