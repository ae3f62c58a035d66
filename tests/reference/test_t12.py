"""T12: a ball off a dome and round a bowl: 10/17, 27/10, slip before, each against the energy in many digits."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from tests.contracts.contract_closed_form import ClosedFormContract
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Vector
from trundle.solve.exact import OffADome, SphereOnSphere
from trundle.solve.methods import tolerance_of

G = 9.80665
BALL = tr.Body.solid_sphere(radius=0.1, mass=1.0)
SHELL = tr.Body.hollow_sphere(radius=0.02, mass=0.0027)


def on_sphere(
    body: tr.Body = BALL, surface: Any = None, loads: Any = (), friction: float | None = None, **start: Any
) -> tuple[tr.RollingSystem, tr.State]:
    system = tr.RollingSystem(body, tr.Support(surface or tr.Dome(0.9), friction=friction), loads=loads)
    return system, system.place(**start)


class TestSphereOnSphere(ClosedFormContract):
    form = SphereOnSphere
    span = 1.0

    def cases(self) -> list[tuple[tr.RollingSystem, tr.State]]:
        bowl = tr.Bowl(0.9)
        return [
            on_sphere(velocity=(1.0, 0.0)),
            on_sphere(SHELL, position=(0.03, 0.04)),
            on_sphere(surface=bowl, position=(0.5, 0.0)),
            on_sphere(SHELL, surface=bowl, velocity=(3.0, 0.9)),
            on_sphere(surface=bowl, velocity=(-7.0, 2.0)),  # round and round
            on_sphere(surface=bowl, position=(0.3, 0.0), velocity=(1.0, 0.0), loads=(tr.Force((2.0, 0.0, -1.0)),)),
            on_sphere(surface=bowl),  # on the bottom at rest
        ]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, start = on_sphere(surface=tr.Bowl(0.9), position=(0.5, 0.0))
        turning = replace(inside, support=replace(inside.support, motion=tr.Spin(1.0)))
        return [
            (turning, turning.place((0.5, 0.0)), "the support moves"),
            (*on_sphere(), "balances on the top"),
            (inside, inside.place((0.5, 0.0), (0.0, 1.0)), "out of the plane"),
            (inside, inside.place((0.5, 0.0), (1.0, 0.0), spin=2.0), "spins about the normal"),
            (replace(inside, loads=(tr.Torque((0.0, 0.0, 0.1)),)), start, "torque"),
            (replace(inside, loads=(tr.Drag(0.1),)), start, "load drag is"),
        ]

    def test_it_begins_at_the_start(self) -> None:
        for system, start in self.cases():  # places are computed from the sphere's centre, b away
            now = self.form.of(system, start).motion_at(0.0)
            for vector, wanted in zip(now, (start.position, start.velocity, start.angular_velocity), strict=False):
                size = max(0.9, float(np.abs(wanted).max()))
                assert np.allclose(vector.array(), wanted, rtol=0, atol=EXACT(4, size))

    def offset(self, system: tr.RollingSystem, at: Vector) -> Vector:
        sign = 1 if isinstance(system.support.surface, tr.Dome) else -1
        arm = Vector(at.x, at.y, at.z + sign * mpf(system.support.surface.radius))
        return arm * (-sign * mpf(system.body.radius) / arm.norm())


def near_a_pole(system: tr.RollingSystem, start: tr.State, t: float) -> tuple[Any, Any, Any, Any]:
    """Return x and z of a ball in the plane of x and z, ẋ and the angle gone, from the energy and Jacobi's functions.

    In so many digits that the start, counted from the pull or from the top, keeps enough of its own.
    """
    number, surface = mpmath.mpf, system.support.surface
    dome = isinstance(surface, tr.Dome)
    ell = number(surface.radius) + (1 if dome else -1) * number(system.body.radius)
    square = number(system.gravity) / ((1 + number(system.body.inertia_ratio)) * ell)
    from_pole = mpmath.asin(number(start.position[0]) / ell)
    rate = number(start.velocity[0]) / (ell * mpmath.cos(from_pole))
    top = mpmath.sign(from_pole) * mpmath.pi if dome else 0
    half, v = (top - from_pole if dome else from_pole) / 2, (-rate if dome else rate) / 2
    energy = v**2 + square * mpmath.sin(half) ** 2
    if energy < square:  # it swings
        m = energy / square
        u = mpmath.ellipf(mpmath.asin(mpmath.sin(half) / mpmath.sqrt(m)), m)
        u = (u if v >= 0 else 2 * mpmath.ellipk(m) - u) + mpmath.sqrt(square) * number(t)
        angle = 2 * mpmath.asin(mpmath.sqrt(m) * mpmath.ellipfun("sn", u, m=m))
        speed = 2 * mpmath.sqrt(energy) * mpmath.ellipfun("cn", u, m=m)
    else:  # over the top, less than once round
        m = square / energy
        u = mpmath.ellipf(mpmath.sign(v) * half, m) + mpmath.sqrt(energy) * number(t)
        behind = abs(u) > mpmath.ellipk(m)
        angle = 2 * mpmath.asin(mpmath.ellipfun("sn", u, m=m))
        angle = mpmath.sign(v) * (2 * mpmath.pi - angle if behind else angle)
        speed = 2 * mpmath.sign(v) * mpmath.sqrt(energy) * mpmath.ellipfun("dn", u, m=m)
    now, speed = (top - angle, -speed) if dome else (angle, speed)
    gone = now - from_pole
    rise = 2 * ell * mpmath.sin((now + from_pole) / 2) * mpmath.sin(gone / 2) * (-1 if dome else 1)
    return ell * mpmath.sin(now), number(start.position[2]) + rise, ell * speed * mpmath.cos(now), gone


class TestFromAnyStart:
    """Near the top, near the separatrix and in swings however small, on spheres however large: to the last digits."""

    @pytest.mark.parametrize("surface", [tr.Dome, tr.Bowl])
    @pytest.mark.parametrize("radius", [0.9, 30.0, 1e5, 1e9])
    @pytest.mark.parametrize(("share", "speed"), [(-1e-24, 0.0), (1e-9, 0.0), (1e-4, -1.0), (-0.3, 0.4), (0.5, 1e-6)])
    def test_as_the_pendulum_of_many_digits_says(self, surface: Any, radius: float, share: float, speed: float) -> None:
        """Starts at a share of the radius from the pole, towards it or away at a share of what gets it across."""
        body = tr.Body.solid_sphere(radius=0.1, mass=1.0)
        pace = math.sqrt(G / (1.4 * radius))
        at, v = share * radius, speed * share * radius * pace
        system, start = on_sphere(body, surface(radius), position=(at, 0.0), velocity=(v, 0.0))
        form = SphereOnSphere.of(system, start)
        for t in (1e-9 / pace, 0.7 / pace, 2.0 / pace):
            with mpmath.workdps(120):
                x, z, along, gone = near_a_pole(system, start, t)
            r, V, _, _ = form.motion_at(t)
            assert abs(r.x - x) <= EXACT(16, max(abs(x), abs(start.position[0]))), (t, "x")
            assert abs(r.z - z) <= EXACT(16, max(abs(x), abs(z), abs(start.position[0]))), (t, "z")
            assert abs(V.x - along) <= EXACT(16, pace * max(abs(x), abs(start.position[0]))), (t, "speed")
            way = max(abs(gone), abs(v) * t / radius)
            assert abs(abs(form.pendulum.turned_at(t)) - abs(gone)) <= EXACT(16, way), (t, "angle gone")

    def test_a_start_that_balances_is_the_one_with_nothing_aside(self) -> None:
        for aside in (0.0, 1e-12, 1e-30):
            system, start = on_sphere(surface=tr.Dome(1e9), position=(aside, 0.0))
            assert bool(SphereOnSphere.violations(system, start)) == (aside == 0.0)

    def test_beside_the_top_of_a_large_dome_a_way_aside_is_not_small(self) -> None:
        system, start = on_sphere(surface=tr.Dome(1e12), position=(0.002, 0.0), velocity=(0.0, 1e-6))
        assert "out of the plane" in SphereOnSphere.violations(system, start)[0]


def angle_from_the_top(event: Any, radius: float) -> float:
    x, y, z = event.before.position
    return math.atan2(math.hypot(x, y), z + radius)


class TestOffADome:
    @pytest.mark.parametrize(("body", "ratio"), [(BALL, mpf(10) / 17), (SHELL, mpf(6) / 11)])
    def test_from_rest_near_the_top_it_leaves_at_two_over_three_and_k(self, body: tr.Body, ratio: Any) -> None:
        system, start = on_sphere(body, position=(1e-9, 0.0))
        run = tr.simulate(system, start, 12.0, 0.5, method="exact")
        angle = angle_from_the_top(run.events[0], 0.9)
        assert run.events[0].kind == "lift"
        assert abs(math.cos(angle) - ratio) <= EXACT(16, 1.0)
        assert abs(SphereOnSphere.of(system, start).lift_cosine - ratio) <= EXACT(16, 1.0)

    def test_the_time_it_takes_is_the_integral_of_the_energy(self) -> None:
        run = tr.simulate(*on_sphere(velocity=(1.0, 0.0)), 1.0, 0.5, method="exact")
        ell, k, g = mpf(0.9) + mpf(0.1), mpf(BALL.inertia_ratio), mpf(G)

        def slowness(angle: Any) -> Any:
            return 1 / mpmath.sqrt(1 / ell**2 + 4 * g / ell * mpmath.sin(angle / 2) ** 2 / (1 + k))

        cosine = (2 + (1 + k) / (g * ell)) / (3 + k)
        wait = mpmath.quad(slowness, [0, mpmath.acos(cosine)])
        assert abs(run.events[0].time - wait) <= EXACT(16, wait)

    def test_it_flies_on_as_the_numerical_method_says(self) -> None:
        case = on_sphere(position=(0.05, 0.02))
        ours, theirs = (tr.simulate(*case, 2.0, 0.1, method=name) for name in ("exact", "runge-kutta"))
        for field in ("position", "velocity", "angular_velocity", "orientation"):
            size = max(1.0, float(np.abs(ours.data[field]).max()))
            difference = float(np.abs(ours.data[field] - theirs.data[field]).max())
            assert difference <= SOLVER(100, tolerance_of("runge-kutta"), size), field

    @pytest.mark.parametrize("mu", [0.1, 0.3, 1.0])
    def test_it_slips_first_where_friction_has_a_limit(self, mu: float) -> None:
        system, start = on_sphere(friction=mu, velocity=(1.0, 0.0))
        run = tr.simulate(system, start, 1.0, 0.5, method="runge-kutta")
        slip, lift = run.events
        dome = OffADome(BALL.inertia_ratio, mu, speed=1.0 / G)
        assert (slip.kind, lift.kind) == ("slip", "lift")
        assert abs(angle_from_the_top(slip, 0.9) - dome.slips_at) <= SOLVER(1000, 1e-12)
        assert abs(angle_from_the_top(lift, 0.9) - dome.lifts_at) <= SOLVER(1000, 1e-12)

    @pytest.mark.parametrize("mu", [0.1, 0.3, 1.0])
    def test_slip_as_integration_with_many_digits_says(self, mu: float) -> None:
        dome, k = OffADome(0.4, mu, 0.2), mpf("0.4")
        begin = mpf(dome.slips_at)
        rolls = mpf("0.2") + 2 * (1 - mpmath.cos(begin)) / (1 + k)
        assert abs(k / (1 + k) * mpmath.sin(begin) - mu * (mpmath.cos(begin) - rolls)) <= EXACT(8, 1.0)  # f = μN
        with mpmath.workdps(20):  # dT = (F − μN) ℓ dθ, N = mg cos θ − mℓθ̇²
            speed = mpmath.odefun(lambda angle, u: 2 * (mpmath.sin(angle) - mu * (mpmath.cos(angle) - u)), begin, rolls)
            for angle in (begin + mpf("0.05"), mpf(dome.lifts_at)):
                assert abs(speed(angle) - dome.slipping(float(angle))) <= EXACT(32, 1.0)
            assert abs(mpmath.cos(mpf(dome.lifts_at)) - speed(mpf(dome.lifts_at))) <= EXACT(32, 1.0)


class TestLoop:
    def test_it_takes_27_tenths_of_the_way_to_the_axis(self) -> None:
        """A ball let go at height 27/10 ℓ over the lowest place stays on: v² = 2g·2.7ℓ/1.4 there, N = 0 on top."""
        ell = 0.9 - 0.1
        needed = math.sqrt(2 * G * 2.7 * ell / 1.4)
        for speed, lifts in ((needed * (1 - 1e-9), True), (needed * (1 + 1e-9), False)):
            case = on_sphere(surface=tr.Bowl(0.9), velocity=(speed, 0.0))
            run = tr.simulate(*case, 1.0, 0.5, method="exact")
            assert any(event.kind == "lift" for event in run.events) == lifts
