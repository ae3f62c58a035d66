"""T6 against Jacobi's functions of mpmath, by way of the incomplete integral, and against other methods."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.precise import precisely
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.exact import CylinderOnCylinder, closed_form
from trundle.solve.exact.jacobi import elliptic

G = 9.80665
COMPLEMENTS = [1.0, 0.999999, 0.7, 0.1, 1e-3, 1e-8, 1e-13, 1e-20, 1e-40, 0.0]


def quarter(complement: Any) -> Any:
    return mpmath.pi / (2 * mpmath.agm(1, mpmath.sqrt(complement)))


def rolling(angle: float, rate: float, k: float = 0.5) -> CylinderOnCylinder:
    """A cylinder of 0.1 m in one of 0.5 m that stands still."""
    return CylinderOnCylinder(0.1, 0.75, k, 0.5, -1.0, 0.0, angle, rate, 0.0, (0.75 * G, 0.0))


def theta(motion: CylinderOnCylinder, t: Any) -> Any:
    """Return θ(t) from the energy integral: u₀ by the incomplete integral, then the amplitude."""
    number = mpmath.mpf
    pendulum = number(motion.force[0]) / (number(motion.mass) * (1 + number(motion.inertia_ratio)))
    pendulum /= number(motion.track_radius) - number(motion.radius)
    start, v = number(motion.angle), number(motion.angular_rate) / 2
    energy = v**2 + pendulum * mpmath.sin(start / 2) ** 2
    if energy < pendulum:  # swings
        m = energy / pendulum
        u0 = mpmath.ellipf(mpmath.asin(mpmath.sin(start / 2) / mpmath.sqrt(m)), m)
        u0 = u0 if v >= 0 else 2 * mpmath.ellipk(m) - u0
        return 2 * mpmath.asin(mpmath.sqrt(m) * mpmath.ellipfun("sn", u0 + mpmath.sqrt(pendulum) * t, m=m))
    m, sign = pendulum / energy, mpmath.sign(v)
    u = mpmath.ellipf(sign * start / 2, m) + mpmath.sqrt(energy) * t
    K = mpmath.ellipk(m)
    rounds = mpmath.floor((u + K) / (2 * K))
    rest = mpmath.asin(mpmath.ellipfun("sn", u - 2 * K * rounds, m=m))
    return sign * 2 * (rest + mpmath.pi * rounds)


class TestJacobi:
    @pytest.mark.parametrize("complement", COMPLEMENTS)
    @precisely
    def test_within_a_period_nothing_is_lost(self, complement: float) -> None:
        K = float(quarter(mpmath.mpf(complement))) if complement else 30.0
        u = np.append(np.linspace(-2, 2, 41), [0.999999, -1.000001, 1e-9]) * K
        got = elliptic(u, complement)
        for name, values in zip(("sn", "cn", "dn"), got, strict=True):
            for argument, value in zip(u, values, strict=True):
                wanted = self._by_mpmath(name, mpmath.mpf(argument), mpmath.mpf(complement))
                assert abs(value - wanted) <= EXACT(64, 1)

    @staticmethod
    def _by_mpmath(name: str, u: Any, complement: Any) -> Any:
        if complement == 0:
            return mpmath.tanh(u) if name == "sn" else mpmath.sech(u)
        return mpmath.ellipfun(name, u, m=1 - complement)

    def test_scalars_and_members_are_one_call(self) -> None:
        u, complements = np.linspace(-3.0, 3.0, 7), np.array(COMPLEMENTS)[:, None]
        many = elliptic(u, complements)
        for i, complement in enumerate(COMPLEMENTS):
            for j, argument in enumerate(u):
                one = elliptic(float(argument), complement)
                for a, b in zip(many, one, strict=True):
                    assert abs(a[i, j] - b) <= EXACT(8, 1)


STARTS = [
    (1.0, 0.0),
    (-2.5, 0.0),
    (0.3, 2.0),
    (0.3, -2.0),
    (3.1, -0.01),
    (1e-8, 0.0),
    (0.5, 12.0),
    (-1.5, -9.0),
    (3.0, 20.0),
    (0.0, 500.0),
]


class TestMotion:
    @pytest.mark.parametrize(("angle", "rate"), STARTS)
    @precisely
    def test_the_angle_is_the_amplitude(self, angle: float, rate: float) -> None:
        motion = rolling(angle, rate)
        for t in (0.0, 0.01, 0.7, 3.0, 20.0, 1e4):
            wanted = theta(motion, mpmath.mpf(t))
            assert abs(motion.angle_at(t) - wanted) <= EXACT(64, max(1, abs(wanted)) * motion.sensitivity)
            x, y, _ = motion.position_at(t)
            size = EXACT(64, 0.4 * motion.sensitivity)
            assert abs(x - mpmath.mpf("0.4") * mpmath.cos(wanted)) <= size
            assert abs(y - mpmath.mpf("0.4") * mpmath.sin(wanted)) <= size

    @pytest.mark.parametrize("near", [1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
    @pytest.mark.parametrize("over", [False, True])
    @precisely
    def test_beside_the_separatrix(self, near: float, over: bool) -> None:
        # From the lowest line, a little less or more than gets it to the top. Ten seconds are several passes near it.
        top = 2 * math.sqrt(G / (1.5 * 0.4))
        motion = rolling(0.0, top * (1 + near if over else 1 - near))
        assert bool(motion.goes_round) == over
        for t in np.linspace(0.0, 10.0, 23):
            wanted = theta(motion, mpmath.mpf(t))
            assert abs(motion.angle_at(t) - wanted) <= 1e-12 * max(1, abs(wanted))

    @precisely
    def test_on_the_separatrix(self) -> None:
        # G/(m (1 + k) ℓ) = 4 exactly, so that θ̇ = 4 at the lowest line ends at the top: tan((θ + π)/4) = e^{2t}.
        motion = CylinderOnCylinder(0.25, 1.0, 1.0, 0.75, -1.0, 0.0, 0.0, 4.0, 0.0, (4.0, 0.0))
        assert motion.period == math.inf
        for t in (0.0, 0.1, 1.0, 5.0, 20.0, 1000.0):
            wanted = 4 * mpmath.atan(mpmath.exp(2 * mpmath.mpf(t))) - mpmath.pi
            assert abs(motion.angle_at(t) - wanted) <= EXACT(16, 3)

    def test_it_stays_on_top_where_it_is_put_there(self) -> None:
        # No float is π; from the nearest, 1.2e-16 off, it stays for a second and passes the lowest line after
        # ln(4/6e-17)/4.04 = 9.56 s.
        motion = rolling(math.pi, 0.0)
        assert abs(motion.angle_at(1.0) - math.pi) < 1e-13
        assert abs(motion.angle_at(9.5)) < 1.5

    @pytest.mark.parametrize("aside", [1e-9, -1e-11, 1e-13])
    @pytest.mark.parametrize("along", [0.0, 0.3])
    @pytest.mark.parametrize("radius", [0.5, 1e8])
    def test_beside_the_top_no_digit_of_the_way_is_lost(self, aside: float, along: float, radius: float) -> None:
        # φ̈ = λ²φ from the top, up to φ²/6: it goes φ₀ (cosh λt − 1) further. No float near π has so many digits.
        log = tr.RollingSystem(
            tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(radius, "outside"), tilt="90 deg")
        )
        start = log.place((math.pi - aside, 0.0), (0.0, along))
        form = closed_form(log, start)
        across = form if isinstance(form, CylinderOnCylinder) else form.pendulum
        pace = math.sqrt(G / (1.4 * (radius + 0.1)))
        from_top = -start.position[1] / start.position[0]
        for t in (1e-6 / pace, 1.0 / pace):
            wanted = 2 * from_top * math.sinh(pace * t / 2) ** 2
            assert abs(-across.turned_at(t) - wanted) <= EXACT(16, abs(wanted))

    def test_a_small_way_on_a_large_cylinder_turns_the_body_by_as_much_as_it_goes(self) -> None:
        # 5e8 m wide, the wall is a slope of 60° for the first seconds: g sin 60°/(1 + k) t²/2, over a.
        drum = tr.RollingSystem(tr.Body.cylinder(0.025, 0.2), tr.Support(tr.Cylinder(5e8), tilt="90 deg"))
        form = CylinderOnCylinder.of(drum, drum.place(("60 deg", 0.0)))
        turned = form.fixed_axis_rotation(0.1)[1]
        assert abs(turned - G * math.sin(math.pi / 3) / 1.5 * 0.005 / 0.025) <= 1e-9 * abs(turned)

    @precisely
    def test_a_small_swing_is_harmonic(self) -> None:
        motion = rolling(1e-7, 0.0, k=1.0)
        omega = mpmath.sqrt(mpmath.mpf(G) / (2 * mpmath.mpf("0.4")))
        # θ̈ = −ω²θ up to θ³/6, which shifts the phase by ω t θ²/16 = 2e-15 in this time.
        for t in (0.5, 4.0):
            assert abs(motion.angle_at(t) - mpmath.mpf(1e-7) * mpmath.cos(omega * t)) < 1e-7 * 1e-13

    @pytest.mark.parametrize(("angle", "rate"), STARTS[:4])
    def test_the_period_is_the_complete_integral(self, angle: float, rate: float) -> None:
        # T = 4 ∫ dθ/θ̇ over a quarter, by the substitution that Legendre used, in mpmath.
        motion = rolling(angle, rate)
        pendulum = G / (1.5 * 0.4)
        m = math.sin(angle / 2) ** 2 + (rate / 2) ** 2 / pendulum
        wanted = 4 * mpmath.quad(lambda x: 1 / mpmath.sqrt(1 - m * mpmath.sin(x) ** 2), [0, mpmath.pi / 2])
        assert abs(motion.period - wanted / mpmath.sqrt(pendulum)) <= 1e-13 * motion.period

    @pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
    @pytest.mark.parametrize(
        "body", [tr.Body.cylinder(0.1, 0.75), tr.Body.hoop(0.3, 1.0), tr.Body.solid_sphere(0.1, 1.0)]
    )
    @pytest.mark.parametrize("rate", [0.0, 3.0])
    @pytest.mark.parametrize("speed", [0.0, 3.0, -9.0])
    def test_the_general_law_agrees(self, method: str, body: tr.Body, rate: float, speed: float) -> None:
        support = tr.Support(tr.Cylinder(0.5), motion=tr.Spin(rate), tilt="90 deg")
        system = tr.RollingSystem(body, support)
        start = system.place((1.0, 0.25), (speed, 0.0))
        exact, other = (tr.simulate(system, start, 3.0, 0.5, method=name) for name in ("exact", method))
        turned = float(np.abs(exact.data.angular_velocity).max()) * 3.0
        bound = SOLVER(20, max(other.tolerance, 1e-15), max(1.0, turned))
        for name in ("position", "velocity", "angular_velocity", "contact_force", "orientation"):
            size = float(np.abs(exact.data[name]).max())
            assert float(np.abs(exact.data[name] - other.data[name]).max()) <= bound * size, name


class TestOrientation:
    @pytest.mark.parametrize("speed", [0.0, 6.0])
    def test_inside_a_cylinder_it_follows_from_the_place(self, speed: float) -> None:
        # a φ = (b − a)(θ − θ₀), backwards: the lecture's x = a φ for a wall. After many rounds as after none.
        system = tr.RollingSystem(tr.Body.cylinder(0.1, 0.75), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
        start = system.place((1.0, 0.0), (speed, 0.0))
        run = tr.simulate(system, start, 30.0, 0.25)
        mark = [tr.State(*[()] * 3, tuple(q)) for q in run.data.orientation.values]
        theta = np.unwrap(np.arctan2(run.data.position[:, 1], run.data.position[:, 0]))
        for state, angle in zip(mark, theta, strict=True):
            w, x, y, z = state.orientation
            first = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 0.0])  # the body's first axis
            turned = math.pi + 1.0 - 4.0 * (angle - 1.0)  # it pointed inwards
            assert np.allclose(first, [math.cos(turned), math.sin(turned), 0.0], atol=1e-12)

    def test_on_a_plane_it_is_x_over_a(self) -> None:
        slope = tr.RollingSystem(tr.Body.hoop(0.25, 1.0), tr.Support(tr.Plane(), tilt=0.2))
        run = tr.simulate(slope, slope.place((0.0, 0.0), (-1.0, 0.0)), 4.0, 0.5)
        for r, q in zip(run.data.position.values, run.data.orientation.values, strict=True):
            w, x, y, z = q
            up = [2 * (x * z - w * y), 2 * (x * z + w * y), 1 - 2 * (x * x + y * y)]
            first = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), up[0]]
            phi = r[0] / 0.25
            assert np.allclose(first, [math.sin(phi), 0.0, math.cos(phi)], atol=1e-13)

    @pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
    def test_a_numerical_method_turns_it_as_far(self, method: str) -> None:
        system = tr.RollingSystem(tr.Body.cylinder(0.1, 0.75), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
        start = system.place((1.0, 0.0), (6.0, 0.0), roll=0.3)
        exact, other = (tr.simulate(system, start, 5.0, 0.5, method=name) for name in ("exact", method))
        dot = np.abs((exact.data.orientation * other.data.orientation).sum(axis=1))
        assert float(np.abs(1 - dot).max()) <= SOLVER(1e3, max(1e-15, other.tolerance))
