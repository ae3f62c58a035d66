"""T14: moving air, couples and resistance against mpmath: quadratures, Newton and Euler, coincident exponents."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.precise import precisely
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.exact import SphereComingToRest, SphereInMovingAir, SphereOnPlane
from trundle.solve.exact.second_order import fundamental

A, M, G = 0.025, 0.065, 9.80665


def constants(lam: complex, mu: complex, t: float) -> list[Any]:
    """Return G, Ġ, ∫G and U as entries of the matrix exponential of (y, ẏ, ∫y), which knows no exponents."""
    with mpmath.workdps(60):
        number = mpmath.mpmathify
        A3 = mpmath.matrix([[0, 1, 0], [number(mu), number(lam), 0], [1, 0, 0]]) * number(t)
        E = mpmath.expm(A3, method="taylor")
        return [E[0, 1], E[1, 1], E[2, 1], E[0, 0]]


COINCIDENT = -((0.3j - 0.8) ** 2) / 4
PAIRS = [
    (0.0, 0.0),
    (0.3j - 0.8, 0.0),
    (0.3j - 0.8, COINCIDENT),
    *((0.3j - 0.8, COINCIDENT * (1 + e)) for e in (1e-15, 1e-9, 1e-4j)),
    (0.0, 0.7j),
    (1e-9j, 1e-12),
    (2.0j - 50.0, 3.0j),
    (2.0j - 0.1, 1e-10j),
    (-0.2, -9.0),
    (-30.0, -1e-3),
]


@pytest.mark.parametrize(("lam", "mu"), PAIRS)
@pytest.mark.parametrize("t", [0.0, 1e-6, 0.3, 2.0, 11.0])
def test_the_solutions_are_those_of_the_matrix_exponential(lam: complex, mu: complex, t: float) -> None:
    got = fundamental(lam, mu, t)
    size = max(
        1.0, float(abs(mpmath.exp(max((0.5 * lam + s * np.sqrt(0.25 * lam**2 + mu + 0j)).real for s in (1, -1)) * t)))
    )
    fastest = abs(lam) + abs(mu) ** 0.5
    scales = (t, 1.0, t * t, 1.0)
    for value, wanted, scale in zip((got.G, got.G_rate, got.H, got.U), constants(lam, mu, t), scales, strict=True):
        assert abs(complex(value) - wanted) <= EXACT(50, size * scale * (1 + fastest * t)) + 1e-300


@precisely
def test_many_digits_do_not_mind_coincidence() -> None:
    lam, mu = mpmath.mpc(-0.5, 0.25), -(mpmath.mpc(-0.5, 0.25) ** 2) / 4
    got = fundamental(lam, mu, mpmath.mpf(3))
    assert abs(got.G - 3 * mpmath.exp(lam * 3 / 2)) < mpmath.mpf(10) ** -50


def test_air_that_stands_still_is_t5() -> None:
    numbers = {"position": (0.1, 0.05), "velocity": (0.2, -0.1), "spin": 2.0, "force": (0.01, 0.0, -0.6), "drag": 0.02}
    t = np.linspace(0.0, 60.0, 61)
    ours, still = (form(A, M, 0.4, 3.5, **numbers).motion_at(t) for form in (SphereInMovingAir, SphereOnPlane))
    for one, other in zip(ours, still, strict=True):
        wanted = np.broadcast_to(other.array(), one.array().shape)
        assert np.allclose(one.array(), wanted, rtol=0, atol=EXACT(500, np.abs(wanted).max()))


@pytest.mark.parametrize(
    ("rate", "drag", "air", "couple"), [(3.5, 0.05, 3.5, 0.0), (3.5, 0.02, -1.0, 1e-5), (0.0, 0.3, 2.0, 0.0)]
)
def test_newton_and_euler_in_moving_air(rate: float, drag: float, air: float, couple: float) -> None:
    """R is eliminated by linear algebra, not by hand: V̇ and R are the unknowns, Ω̇ follows from the constraint."""
    moment = 0.4 * M * A * A

    def slopes(_: Any, y: Any) -> list[Any]:
        x, z, vx, vy = y
        # a Ω = n×V + ω r (T5c), so aΩ̇ = n×V̇ + ωV; k m a² Ω̇ = −c_r(Ω − 0) − a n×R; mV̇ = R − c(V − ω_a n×r).
        Ox, Oy = (rate * x - vy) / A, (rate * z + vx) / A
        matrix = mpmath.matrix([[M, 0, -1, 0], [0, M, 0, -1], [0, -moment / A, 0, -A], [moment / A, 0, A, 0]])
        right = mpmath.matrix(
            [
                -drag * (vx + air * z),
                -drag * (vy - air * x),
                -couple * Ox - moment * rate * vx / A,
                -couple * Oy - moment * rate * vy / A,
            ]
        )
        a = mpmath.lu_solve(matrix, right)
        return [vx, vy, a[0], a[1]]

    with mpmath.workdps(20):
        solution = mpmath.odefun(slopes, 0, [mpmath.mpf(p) for p in (0.1, 0.05, 0.2, -0.1)])
        motion = SphereInMovingAir(
            A, M, 0.4, rate, (0.1, 0.05), (0.2, -0.1), drag=drag, carried=drag * air, couple=couple
        )
        wanted = solution(mpmath.mpf(2))
        r, V, _, _ = motion.motion_at(2.0)
    for got, right in zip((r.x, r.y, V.x, V.y), wanted, strict=True):
        assert abs(got - right) <= EXACT(200, 0.5)


def test_air_that_turns_with_the_table_drives_the_ball_out() -> None:
    # Weak air: the circle grows at γ(ω_a/κ − 1), for the air overtakes the ball, and its centre comes in at γω_a/κ.
    motion = SphereInMovingAir(A, M, 0.4, 3.5, (0.1, 0.0), drag=1e-3, carried=3.5e-3)
    fast, slow = motion.exponents
    assert fast.real > 0 > slow.real
    assert fast.real == pytest.approx(motion.gamma * 2.5, rel=0.05)
    assert slow.real == pytest.approx(-motion.gamma * 3.5, rel=0.05)
    assert abs(fast + slow - (1j * motion.kappa - motion.gamma)) < 1e-15
    assert abs(fast * slow + 1j * motion.beta) < 1e-15
    with pytest.raises(tr.TrundleError, match="driven out"):
        motion.motion_at(1e9)


def test_the_couple_brings_the_spin_to_the_table_s() -> None:
    motion = SphereInMovingAir(A, M, 0.4, 3.5, (0.1, 0.0), spin=-2.0, pivot_couple=1e-6)
    rate = 1e-6 / (0.4 * M * A * A)
    for t in (1e-3, 5.0, 1e4):
        assert abs(motion.motion_at(t)[2].z - (3.5 - 5.5 * math.exp(-rate * t))) <= EXACT(8, 5.5)


def speed_by_quadrature(motion: SphereComingToRest, v: Any) -> Any:
    """Return the time at which the speed has fallen to v: ∫dv/(r + γv + ηv²)."""
    r, gamma, eta = (mpmath.mpf(float(p)) for p in (motion.deceleration, motion.gamma, motion.eta))
    return mpmath.quad(lambda u: 1 / (r + gamma * u + eta * u * u), [v, float(motion.speed) / 3, float(motion.speed)])


BRAKES = [
    {"offset": 1e-4},
    {"offset": 1e-4, "quadratic_drag": 0.05},
    {"offset": 1e-4, "drag": 0.05},
    {"offset": 1e-4, "drag": 0.05, "quadratic_drag": 0.05, "couple": 1e-6},
    {"offset": 1e-9, "drag": 0.05, "quadratic_drag": 1e-6},
    {
        "offset": 1e-4,
        "drag": 2 * math.sqrt(1.4 * M * 1e-4 * G * M / (A * 1.4 * M) * 0.05 / 1.0),
        "quadratic_drag": 0.05,
    },
]


@pytest.mark.parametrize("brakes", BRAKES)
def test_it_comes_to_rest_when_the_quadrature_says(brakes: dict[str, float]) -> None:
    motion = SphereComingToRest(A, M, 0.4, (0.0, 0.0), (0.6, -0.8), 1.0, M * G, **brakes)
    with mpmath.workdps(30):
        stops = speed_by_quadrature(motion, mpmath.mpf(0))
        assert abs(motion.stops_at - stops) <= EXACT(64, float(stops))
        for share in (0.2, 0.9):
            t = share * float(stops)
            _, V, Omega, R = motion.motion_at(t)
            v = math.hypot(V.x, V.y)
            # the speed's own error shows in the time as itself over the deceleration
            slowing = float(motion.deceleration + motion.gamma * v + motion.eta * v * v)
            assert abs(speed_by_quadrature(motion, mpmath.mpf(v)) - t) <= EXACT(64, 1.0) / slowing + EXACT(64, t)
            assert abs(A * Omega.y - V.x) <= EXACT(4, 1)
            assert R.z == M * G
    resting = motion.motion_at(1.5 * float(stops))
    assert resting[0].array() == pytest.approx(motion.motion_at(float(stops))[0].array(), rel=1e-15)
    assert resting[1].norm() == 0
    assert math.hypot(resting[0].x, resting[0].y) == pytest.approx(motion.way, rel=1e-14)


def test_rolling_resistance_alone_is_galileo_s_parabola() -> None:
    # g δ/(a(1 + k)) until it stops after v₀²/2 of that.
    slowing = G * 1e-4 / (A * 1.4)
    motion = SphereComingToRest(A, M, 0.4, (0.0, 0.0), (1.0, 0.0), 0.0, M * G, offset=1e-4)
    assert motion.stops_at == pytest.approx(1 / slowing, rel=4e-16)
    assert motion.way == pytest.approx(0.5 / slowing, rel=1e-15)
    assert motion.motion_at(2.0)[0].x == pytest.approx(2.0 - 2 * slowing, rel=1e-15)


@pytest.mark.parametrize("c", [1e-12, 1e-3, 0.5])
def test_quadratic_drag_alone_is_a_logarithm(c: float) -> None:
    motion = SphereComingToRest(A, M, 0.4, (0.0, 0.0), (2.0, 0.0), quadratic_drag=c)
    eta = mpmath.mpf(c) / (mpmath.mpf(M) * mpmath.mpf("1.4"))
    assert motion.stops_at == math.inf
    for t in (1e-3, 1.0, 60.0):
        r, V, _, _ = motion.motion_at(t)
        # but for the load's own rounding off of |v| below 1 µm/s, (c/2)(1 µm/s)²
        off = 1e-12 * float(eta) * t
        assert abs(r.x - mpmath.log1p(eta * 2 * t) / eta) <= EXACT(8, 2 * t) + off * t
        assert abs(V.x - 2 / (1 + eta * 2 * t)) <= EXACT(8, 2) + off


def test_at_rest_it_stays() -> None:
    motion = SphereComingToRest(A, M, 0.4, (0.1, 0.0), (0.0, 0.0), 3.0, M * G, offset=1e-4, quadratic_drag=0.1)
    r, V, Omega, R = motion.motion_at(np.array([0.0, 5.0]))
    assert r.array().tolist() == [[0.1, 0.0, A]] * 2
    assert V.array().tolist() == [[0.0] * 3] * 2
    assert Omega.z.tolist() == [3.0, 3.0]
    assert motion.way == 0
    assert R.x.tolist() == [0.0, 0.0]


LOADS = {
    "air": (3.5, (tr.Drag(0.05, 3.5), tr.RollingCouple(1e-6))),
    "quadratic": (0.0, (tr.QuadraticDrag(0.01),)),
    "all": (0.0, (tr.RollingResistance(1e-5), tr.Drag(1e-2), tr.QuadraticDrag(0.01), tr.RollingCouple(1e-6))),
}


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("case", LOADS)
def test_the_general_law_agrees(method: str, case: str) -> None:
    rate, loads = LOADS[case]
    table = tr.Support(tr.Plane(), motion=tr.Spin(rate) if rate else tr.Fixed())
    system = tr.RollingSystem(tr.Body.solid_sphere(A, M), table, loads)
    start = system.place((0.1, 0.05), (0.2, -0.1), spin=1.0)
    exact, other = (tr.simulate(system, start, 3.0, 0.25, method=name) for name in ("exact", method))
    turned = float(np.abs(exact.data.angular_velocity).max()) * 3.0
    for name in ("position", "velocity", "angular_velocity", "contact_force", "orientation"):
        size = float(np.abs(exact.data[name]).max())
        bound = SOLVER(20, max(other.tolerance, 1e-15), turned)
        assert float(np.abs(exact.data[name] - other.data[name]).max()) <= bound * size, name
