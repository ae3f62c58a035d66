"""T15: Chaplygin's ball: Newton and Euler in many digits, his equations in the body frame, the numerical methods."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from tests.contracts.contract_closed_form import ClosedFormContract
from tests.contracts.test_closed_forms import BALL, Spring
from tests.precise import precisely, size_of, slope
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.solve.exact import ChaplyginBall, SteadyChaplyginBall, UprightChaplyginBall, closed_form
from trundle.solve.exact.upright_polhode import Constants
from trundle.solve.methods import tolerance_of

Case = tuple[tr.RollingSystem, tr.State]
FLAT, LONG = (4e-3, 4e-3, 5e-3), (4e-3, 4e-3, 3e-3)


def rolled(moments: Any = LONG, loads: Any = (), gravity: Any = None, **start: Any) -> Case:
    inertia = moments if isinstance(moments, tr.Tensor) else tr.Principal(*moments)
    body = tr.Body(1.0, inertia, tr.Sphere(0.1))
    more = {} if gravity is None else {"gravity": gravity}
    friction = start.pop("friction", None)
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), friction=friction), loads=loads, **more)
    lean = {"position": (0.1, -0.05), "velocity": (0.3, 0.2), "spin": 2.5, "orientation": (0.8, 0.48, 0.36, 0.0)}
    return system, system.place(**(lean | start))


def turning(Omega: Any, moments: Any = LONG, orientation: Any = (1.0, 0.0, 0.0, 0.0), **more: Any) -> Case:
    x, y, z = Omega
    return rolled(moments, velocity=(0.1 * y, -0.1 * x), spin=z, orientation=orientation, **more)


def upright_momentum(x: float) -> tuple[float, float, float]:
    """Return Ω = (J + D)⁻¹n for LONG leaning by (0.8, 0.6, 0, 0): the axis is then (0, −0.96, 0.28), x its height."""
    first, third = 0.05 / 14e-3, 0.05 / 13e-3
    return 0.0, -0.96 * x * (third - first), first + 0.28 * x * (third - first)


CASES: dict[str, Case] = {
    "long": rolled(),
    "flat": rolled(FLAT),
    "needle": rolled((4e-3, 4e-3, 0.1e-3)),
    "coin": rolled((2e-3, 2e-3, 4e-3)),
    "light": rolled((4e-8, 4e-8, 5e-8)),
    "its own axis is the second": rolled((4e-3, 3e-3, 4e-3)),
    "turned axes": rolled(tr.Tensor(4e-3, 4.5e-3, 4.5e-3, 0.0, 0.0, 0.5e-3)),
    "all but round": rolled((4e-3, 4e-3, 4e-3 * (1 + 1e-12))),
    "all but about its leaning axis": turning((1e-12, -4.8, 1.4), orientation=(0.8, 0.6, 0.0, 0.0)),
    "all but spins upright": turning((1e-12, 0.0, 5.0), orientation=(1.0, 1e-12, 0.0, 0.0)),
    "no part along n": turning((3.0, 4.0, 0.0), orientation=(0.8, 0.48, 0.36, 0.0)),
    "M upright but for rounding": turning(upright_momentum(0.28), orientation=(0.8, 0.6, 0.0, 0.0)),
    "M nearly upright": turning(upright_momentum(0.28 - 1e-9), orientation=(0.8, 0.6, 0.0, 0.0)),
    "no weight": rolled(gravity=0.0),
    "pressed down": rolled(FLAT, loads=(tr.Force((0.0, 0.0, -5.0)),)),
}


STEADY: dict[str, Case] = {
    "spins upright": turning((0.0, 0.0, 5.0)),
    "rolls across its axis": turning((3.0, 4.0, 0.0)),
    "about its leaning axis": turning((0.0, -4.8, 1.4), orientation=(0.8, 0.6, 0.0, 0.0)),
    "pivots on its side": turning((0.0, 0.0, 5.0), orientation=(0.5, 0.5, 0.5, 0.5)),
}
THREE = (2e-3, 3.2e-3, 4.8e-3)


class TestChaplyginBall(ClosedFormContract):
    form = ChaplyginBall
    span = 4.0

    def cases(self) -> list[Case]:
        return list(CASES.values())

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, start = CASES["long"]
        tilted = replace(inside, support=tr.Support(tr.Plane(), tilt=0.1))
        turntable = replace(inside, support=tr.Support(tr.Plane(), motion=tr.Spin(1.0)))
        bowl = replace(inside, support=tr.Support(tr.Bowl(2.0)))
        off = replace(inside, body=replace(inside.body, shape=tr.Sphere(0.1, Vector(0.0, 0.0, 0.01))))
        return [
            (*rolled((3e-3, 4e-3, 5e-3)), "no two of its moments"),
            (tilted, tilted.place((0.1, 0.0), (0.3, 0.2)), "along the plane"),
            (turntable, turntable.place((0.1, 0.0)), "the support moves"),
            (off, off.place((0.1, 0.0), (0.3, 0.2)), "centre of mass at its centre"),
            (replace(inside, loads=(Spring(1.0),)), start, "Spring"),
            (replace(inside, loads=(tr.Torque((0.0, 0.0, 0.1)),)), start, "torque"),
            (bowl, bowl.place((0.1, 0.0), (0.3, 0.2)), "surface is a bowl"),
        ]

    def _obeys(self, system: tr.RollingSystem, start: tr.State, t: Any) -> None:
        """Newton, Euler, the constraint and ė = Ω×e, each by its residual."""
        form = self.form.of(system, start)
        m, across, along = mpf(system.body.mass), mpf(form.across), mpf(form.along)
        rho = self.offset(system, form.motion_at(t)[0])
        _, V, Omega, R = form.motion_at(t)
        r_rate, V_rate = (slope(lambda t, i=i: form.motion_at(t)[i], t) for i in range(2))

        def own_momentum(t: Any) -> Vector:
            e, turn = form.axis_at(t), form.motion_at(t)[2]
            return turn * across + e * ((along - across) * turn.dot(e))

        F, _ = self.applied(system, V)
        e, speed = form.axis_at(t), size_of(V) + size_of(Omega) * rho.norm()
        push = size_of(F) + m * size_of(V_rate)
        assert size_of(r_rate - V) <= EXACT(32, speed)
        assert size_of(V + Omega.cross(rho)) <= EXACT(32, speed)
        assert abs(e.norm() - 1) <= EXACT(32, 1)
        assert size_of(slope(form.axis_at, t) - Omega.cross(e)) <= EXACT(32, size_of(Omega) + mpf("1e-12"))
        assert size_of(V_rate * m - F - R) <= EXACT(32, push)
        assert size_of(slope(own_momentum, t) - rho.cross(R)) <= EXACT(32, push * rho.norm())

    def test_it_repeats_after_its_period(self) -> None:
        """The place drifts, so the whole never repeats; Ω, e and R do, and each nutation drifts as far as any."""
        for system, start in self.cases():
            form = self.form.of(system, start)
            assert form.period == math.inf
            if form.nutation_period == math.inf:
                continue
            some = np.array([0.1, 0.6, 0.9]) * form.nutation_period
            now, later = form.motion_at(some), form.motion_at(some + form.nutation_period)
            for i in (1, 2, 3):
                size = np.abs(now[i].array()).max()
                assert np.allclose(now[i].array(), later[i].array(), rtol=0, atol=EXACT(200, size))
            far = [form.drift.x * form.nutation_period, form.drift.y * form.nutation_period, 0.0]
            assert np.allclose(later[0].array() - now[0].array(), far, rtol=0, atol=EXACT(64, 1.0))


class TestSteadyChaplyginBall(TestChaplyginBall):
    form = SteadyChaplyginBall

    def cases(self) -> list[Case]:
        leaning = turning((0.0, -4.8, 1.4), THREE, orientation=(0.8, 0.6, 0.0, 0.0))
        return [*STEADY.values(), leaning, turning((2.0, 0.0, 0.0), THREE), turning((0.0, 0.0, 0.0), THREE)]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, _ = CASES["long"]
        tilted = replace(inside, support=tr.Support(tr.Plane(), tilt=0.1))
        return [
            (*rolled(THREE), "about a principal axis"),
            (*turning((0.0, 2.0, 0.0), THREE), "middle axis"),
            (tilted, tilted.place((0.1, 0.0)), "along the plane"),
        ]

    def _obeys(self, system: tr.RollingSystem, start: tr.State, t: Any) -> None:
        """Euler's equation holds without a torque, for Ω is along JΩ and stays; friction is zero."""
        form = self.form.of(system, start)
        r, V, Omega, R = form.motion_at(t)
        rho, Q = self.offset(system, r), Quaternion(*start.orientation).matrix()
        assert size_of(slope(lambda t: form.motion_at(t)[0], t) - V) <= EXACT(32, size_of(V))
        assert size_of(V + Omega.cross(rho)) <= EXACT(32, size_of(Omega) * rho.norm())
        own = system.body.inertia_in_space(Q) @ Omega
        assert size_of(own.cross(Omega)) <= EXACT(32, size_of(own) * size_of(Omega))
        F, _ = self.applied(system, V)
        assert size_of(F + R) <= EXACT(32, size_of(F))

    def test_it_repeats_after_its_period(self) -> None:
        assert all(self.form.of(*case).period == math.inf for case in self.cases())


@pytest.mark.parametrize("name", STEADY)
def test_the_nodding_ball_has_the_steady_one_in_it(name: str) -> None:
    steady, general = SteadyChaplyginBall.of(*STEADY[name]), ChaplyginBall.of(*STEADY[name])
    t = np.linspace(0.0, 10.0, 11)
    for one, other in zip(steady.motion_at(t), general.motion_at(t), strict=True):
        size = 1.0 + np.abs(one.array()).max()
        assert np.allclose(one.array(), other.array(), rtol=0, atol=EXACT(64, size))


def upright(moments: Any, orientation: Any, momentum: float) -> Case:
    """Return a ball with (J + D)Ω = Ln."""
    size = math.sqrt(sum(part * part for part in orientation))
    q = tuple(part / size for part in orientation)
    J = rolled(moments)[0].body.inertia_in_space(Quaternion(*q).matrix())
    Omega = momentum * np.linalg.solve(np.array([[*row] for row in J.rows]) + 0.01 * np.eye(3), [0.0, 0.0, 1.0])
    return turning(Omega, moments, q)


TUMBLING: dict[str, Case] = {
    "round the longest": upright(THREE, (0.8, 0.6, 0.0, 0.0), -0.05),
    "round the shortest": upright(THREE, (0.8, 0.48, 0.36, 0.0), 0.08),
    "upside down": upright((2e-3, 2.2e-3, 4e-3), (0.1, 0.9, 0.3, 0.1), 0.06),
    "turned axes": upright(tr.Tensor(3e-3, 4e-3, 4.5e-3, 0.2e-3, -0.4e-3, 0.5e-3), (0.7, 0.1, 0.6, 0.2), 0.07),
    "nearly two equal": upright((2e-3, 3.99e-3, 4e-3), (0.6, 0.4, 0.3, 0.2), 0.06),
}


class TestUprightChaplyginBall(TestChaplyginBall):
    form = UprightChaplyginBall
    span = 0.5

    def cases(self) -> list[Case]:
        return list(TUMBLING.values())

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        return [
            (*rolled(THREE), "momentum about the contact is not along"),
            (*turning((0.0, 2.0, 1.0), THREE, orientation=(0.5**0.5, 0.5**0.5, 0.0, 0.0)), "not along the normal"),
            (*upright(THREE, (0.5**0.5, 0.5**0.5, 0.0, 0.0), 0.05), "middle axis"),
        ]

    @precisely
    def test_it_obeys_newton_euler_and_the_constraint(self) -> None:
        for name, t in {"turned axes": "0.3", "nearly two equal": "0.1"}.items():
            self._obeys(*TUMBLING[name], mpf(t))

    def _obeys(self, system: tr.RollingSystem, start: tr.State, t: Any) -> None:
        """Newton and the constraint; Euler's equation of a ball whose momentum stays: the torque is m a² of its own."""
        form = self.form.of(system, start)
        m = mpf(system.body.mass)
        _, V, Omega, R = form.motion_at(t)
        rho = self.offset(system, V)
        r_rate, V_rate, Omega_rate = (slope(lambda t, i=i: form.motion_at(t)[i], t) for i in range(3))
        F, _ = self.applied(system, V)
        push = size_of(F)
        assert size_of(r_rate - V) <= EXACT(32, size_of(V))
        assert size_of(V + Omega.cross(rho)) <= EXACT(32, size_of(Omega) * rho.norm())
        assert size_of(V_rate * m - F - R) <= EXACT(32, push)
        Q = form.representative_orientation(t).matrix()
        J = system.body.inertia_in_space(Q)
        assert size_of(J @ Omega_rate + Omega.cross(J @ Omega) - rho.cross(R)) <= EXACT(200, push * rho.norm())
        for column, rate in zip(
            Q.transpose.rows,
            slope(lambda t: form.representative_orientation(t).matrix(), t).transpose.rows,
            strict=True,
        ):
            assert size_of(rate - Omega.cross(column)) <= EXACT(200, size_of(Omega))

    def test_it_repeats_after_its_period(self) -> None:
        """Ω turns about n from one round to the next; its size, and that of the force, repeat."""
        for system, start in self.cases():
            form = self.form.of(system, start)
            some = np.array([0.1, 0.6, 0.9]) * form.round_period
            now, later = form.motion_at(some), form.motion_at(some + form.round_period)
            for i in (1, 2, 3):
                one, other = (np.hypot(part[i].x, part[i].y) for part in (now, later))
                assert np.allclose(one, other, rtol=0, atol=EXACT(500, 1 + one.max()))


def chaplygins_equations(moments: Any, m: Any, a: Any, M: Any, n: Any, times: list[float]) -> list[Any]:
    """Return M, n and Ω in the body frame by Ṁ = M×Ω, ṅ = n×Ω, M = (J + D)Ω − D(Ω·n)n [chaplygin1903]."""
    D = m * a * a
    A = [1 / (J + D) for J in moments]

    def turn(y: Any) -> Any:
        momentum, up = y[:3], y[3:]
        s = sum(x * b * g for x, b, g in zip(momentum, A, up, strict=True))
        s = s / (1 - D * sum(b * g * g for b, g in zip(A, up, strict=True)))
        return [b * (x + D * s * g) for x, b, g in zip(momentum, A, up, strict=True)]

    def cross(u: Any, v: Any) -> Any:
        return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]

    def rates(_: Any, y: Any) -> Any:
        Omega = turn(y)
        return cross(y[:3], Omega) + cross(y[3:], Omega)

    solution = mpmath.odefun(rates, 0, [*M, *n])
    found = [solution(mpf(t)) for t in times]
    return [(y, turn(y)) for y in found]


@pytest.mark.parametrize("name", ["flat", "no part along n"])
def test_chaplygins_own_equations_agree(name: str) -> None:
    system, start = CASES[name]
    form = ChaplyginBall.of(system, start)
    times = [0.3, 0.7]
    with mpmath.workdps(30):
        Q = [[mpf(part) for part in row] for row in quaternion_matrix(start.orientation)]
        own = [sum(Q[i][j] * mpf(start.angular_velocity[i]) for i in range(3)) for j in range(3)]
        n, m, a = Q[2], mpf(system.body.mass), mpf(system.body.radius)
        inertia: Any = system.body.inertia
        moments = [mpf(inertia.x), mpf(inertia.y), mpf(inertia.z)]
        D, s = m * a * a, sum(w * g for w, g in zip(own, n, strict=True))
        M = [(J + D) * w - D * s * g for J, w, g in zip(moments, own, n, strict=True)]
        followed = chaplygins_equations(moments, m, a, M, n, times)
    for t, (y, Omega) in zip(times, followed, strict=True):
        now, e = form.motion_at(t)[2], form.axis_at(t)
        assert abs(float(e.z) - float(y[5])) <= EXACT(64, 1.0)
        upright = sum(w * g for w, g in zip(Omega, y[3:], strict=True))
        size = float(mpmath.sqrt(sum(w * w for w in Omega)))
        assert abs(float(now.z) - float(upright)) <= EXACT(64, size)
        assert abs(float(now.norm()) - size) <= EXACT(64, size)
        assert abs(float(now.dot(e)) - float(Omega[2])) <= EXACT(64, size)


def quaternion_matrix(q: Any) -> list[list[Any]]:
    w, x, y, z = (mpf(part) for part in q)
    size = w * w + x * x + y * y + z * z
    w, x, y, z = (part / mpmath.sqrt(size) for part in (w, x, y, z))
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]


@pytest.mark.parametrize("name", ["long", "flat", "needle", "M upright but for rounding", *TUMBLING])
@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_the_general_law_agrees(name: str, method: str) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    system, start = {**CASES, **TUMBLING}[name]
    exact, other = (tr.simulate(system, start, 5.0, 0.25, method=way).data for way in ("exact", method))
    turned = float(np.abs(exact.angular_velocity).max()) * 5.0
    for name in ("position", "velocity", "angular_velocity", "orientation", "contact_force"):
        a, b = exact[name].values, other[name].values
        bound = SOLVER(50, tolerance_of(method), np.abs(a).max() * (1 + turned))
        assert np.abs(a - b).max() < max(bound, EXACT(200, np.abs(a).max() * (1 + turned))), name


def test_chaplygins_vector_and_the_energy_stay_for_a_million_seconds() -> None:
    form = ChaplyginBall.of(*CASES["long"])
    t = np.array([0.0, 1.0, 1e6 - 0.5, 1e6])
    _, V, Omega, _ = form.motion_at(t)
    e = form.axis_at(t)
    own = Omega * form.across + e * ((form.along - form.across) * Omega.dot(e))
    D = form.mass * form.radius**2
    M = np.stack([own.x + D * Omega.x, own.y + D * Omega.y, own.z])
    assert np.abs(M - M[:, :1]).max() <= EXACT(64, np.abs(M).max())
    energy = 0.5 * (Omega.dot(own) + form.mass * V.dot(V))
    assert np.ptp(energy) <= EXACT(64, energy.max())


def test_the_upright_ball_is_where_it_was_after_a_million_rounds() -> None:
    """The precession of one round, n times, by mpmath: Ω over the plane and the path, which is a sum of turned arcs."""
    form = UprightChaplyginBall.of(*TUMBLING["round the shortest"])
    many, T = 10**6, form.round_period
    first, last = ([mpf(float(part)) for part in form.motion_at(t)[2]] for t in (T, (many + 1) * T))
    with mpmath.workdps(40):
        c = Constants.of(form, mpf(0))
        turned = mpmath.expj((mpf(c.gain) + c.gain_rest) * many)
        wanted = mpmath.mpc(first[0], first[1]) * turned
        # The time of so many rounds, in floats, is off by its own last digit, and so is the angle.
        assert abs(mpmath.mpc(last[0], last[1]) - wanted) < EXACT(8, many * T * form.max_rate(1.0) * abs(wanted))


def test_a_plane_that_is_not_rough_enough_lets_it_slip_when_the_numerical_law_says() -> None:
    pytest.importorskip("heyoka")
    system, start = rolled((4e-3, 4e-3, 1e-3), friction=0.03)
    form = ChaplyginBall.of(system, start)
    R = form.motion_at(np.linspace(0.0, form.nutation_period, 1000))[3]
    share = np.hypot(R.x, R.y) / R.z
    assert share[0] < 0.03 < share.max()
    runs = [tr.simulate(system, start, 2.0, 0.1, method=method) for method in ("auto", "taylor")]
    first, second = (run.events[0] for run in runs)
    assert (first.kind, second.kind) == ("slip", "slip")
    assert 0 < first.time < form.nutation_period
    assert abs(first.time - second.time) < SOLVER(1e4, tolerance_of("taylor"))


def test_the_upright_ball_slips_when_the_numerical_law_says() -> None:
    pytest.importorskip("heyoka")
    system, start = TUMBLING["round the shortest"]
    R = UprightChaplyginBall.of(system, start).motion_at(np.linspace(0.0, 5.0, 5000))[3]
    share = np.hypot(R.x, R.y) / R.z
    friction = float(0.5 * (share[0] + share.max()))
    rough = replace(system, support=tr.Support(tr.Plane(), friction=friction))
    runs = [tr.simulate(rough, start, 5.0, 0.1, method=method) for method in ("auto", "taylor")]
    first, second = (run.events[0] for run in runs)
    assert (first.kind, second.kind) == ("slip", "slip")
    assert abs(first.time - second.time) < SOLVER(1e4, tolerance_of("taylor"))


def test_the_shipped_ball_is_exact() -> None:
    scenario = tr.Scenario.load("chaplygin-ball")
    form = closed_form(scenario.system(), scenario.start_state())
    assert isinstance(form, UprightChaplyginBall)
    assert tr.simulate(scenario.system(), scenario.start_state(), 1.0, 0.1).method == "exact"


def test_on_a_plane_that_is_rough_enough_it_never_slips() -> None:
    system, start = rolled(FLAT, friction=0.3)
    run = tr.simulate(system, start, 2.0, 0.1)
    assert (run.method, run.events) == ("exact", ())
    assert "the same moment" in ChaplyginBall.violations(replace(system, body=BALL))[0]
