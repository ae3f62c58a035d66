"""T11: slipping and flight against billiards by hand, Newton and Euler with many digits, and the numerical methods."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from tests.contracts.contract_closed_form import ClosedFormContract
from tests.precise import precisely, size_of, slope
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.errors import OutOfDomainError
from trundle.mechanics.algebra import Vector
from trundle.solve.exact import SlidingSphere, SphereInFlight, closed_form
from trundle.solve.methods import tolerance_of

G = 9.80665
BALL = tr.Body.solid_sphere(radius=0.1, mass=1.0)
SHELL = tr.Body.hollow_sphere(radius=0.02, mass=0.0027)
SHOT = {"velocity": (3.0, 1.0), "angular_velocity": (20.0, -30.0, 5.0)}


def on_cloth(
    body: tr.Body = BALL, friction: float = 0.2, tilt: float = 0.0, loads: Any = (), motion: Any = None, **start: Any
) -> tuple[tr.RollingSystem, tr.State]:
    support = tr.Support(tr.Plane(), motion=motion or tr.Fixed(), tilt=tilt, friction=friction)
    system = tr.RollingSystem(body, support, loads=loads)
    return system, system.place(**({"position": (0.1, -0.2)} | SHOT | start))


class TestSlidingSphere(ClosedFormContract):
    form = SlidingSphere
    span = 0.05  # s: all of the cases slip longer

    def cases(self) -> list[tuple[tr.RollingSystem, tr.State]]:
        straight = {"velocity": (2.0, 0.0), "angular_velocity": (0.0, 0.0, 1.0)}
        return [
            on_cloth(),
            on_cloth(SHELL, velocity=(-2.0, 0.5)),
            on_cloth(tilt=0.1),
            on_cloth(tilt=1e-12),
            on_cloth(tilt=-0.3, friction=0.05),  # too slippery to grip
            on_cloth(tilt=math.atan(0.2 * 3.5)),  # B = A but for rounding
            on_cloth(tilt=0.3, friction=0.1, **straight),
            on_cloth(tilt=0.3, friction=0.1, **(straight | {"velocity": (-2.0, 0.0)})),
            on_cloth(friction=0.0),
            on_cloth(tilt=0.2, loads=(tr.Force((0.3, 0.4, -1.0)),)),
        ]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        oblong = tr.Body(1.0, tr.Principal(1e-2, 2e-2, 2.5e-2), BALL.shape)
        pipe = tr.RollingSystem(BALL, tr.Support(tr.Cylinder(0.5), tilt="90 deg", friction=0.01))
        return [
            (*on_cloth(motion=tr.Spin(2.0)), "the plane turns"),
            (*on_cloth(motion=tr.UnevenSpin(2.0, 0.1, 1.0)), "motion, uneven-spin, is"),
            (*on_cloth(loads=(tr.Drag(0.1),)), "load drag is"),
            (*on_cloth(loads=(tr.Torque((0.0, 0.0, 0.1)),)), "torque"),
            (*on_cloth(oblong), "isotropic inertia"),
            (pipe, pipe.place((1.0, 0.0), (1.0, 0.0), angular_velocity=(0.0, 0.0, 3.0)), "surface is a cylinder"),
        ]

    def test_it_repeats_after_its_period(self) -> None:
        assert all(math.isinf(self.form.of(*case).period) for case in self.cases())

    def _obeys(self, system: tr.RollingSystem, start: tr.State, t: Any) -> None:
        motion, I, m = self.form.of(system, start), self.inertia(system), mpf(system.body.mass)
        (r, V, Omega, R), rho = motion.motion_at(t), self.offset(system, Vector(0, 0, 0))
        r_rate, V_rate, Omega_rate = (slope(lambda t, i=i: motion.motion_at(t)[i], t) for i in range(3))
        F, _ = self.applied(system, V)
        s, f = V + Omega.cross(rho), Vector(R.x, R.y, 0)
        push, speed = size_of(F) + size_of(R), size_of(V) + size_of(s)
        assert r.z == mpf(system.body.radius)
        assert size_of(r_rate - V) <= EXACT(32, speed)
        assert size_of(V_rate * m - F - R) <= EXACT(32, push)
        assert size_of(Omega_rate * I - rho.cross(R)) <= EXACT(32, push * rho.norm())
        assert abs(R.z + F.z) <= EXACT(8, push)
        mu = mpf(system.support.sliding_friction)  # f = −μN ŝ
        assert size_of(f * s.norm() + s * (mu * R.z)) <= EXACT(64, push * speed)


def exactly(*case: Any, until: float = 2.0, every: float = 0.05, method: str = "exact") -> tr.Trajectory:
    return tr.simulate(*case, until, every, method=method)


class TestBilliards:
    @pytest.mark.parametrize("body", [BALL, SHELL, tr.Body.sphere(0.3, 2.0, 0.1)])
    def test_it_grips_after_the_slip_over_its_rate_and_then_rolls_on(self, body: tr.Body) -> None:
        system, start = on_cloth(body)
        run = exactly(system, start, until=8.0)
        (event,) = run.events
        a, k = mpf(body.radius), mpf(body.inertia_ratio)
        s0 = mpmath.matrix([mpf(3) - a * mpf(-30), mpf(1) + a * mpf(20)])
        wait = mpmath.norm(s0) / (mpf(0.2) * mpf(G) * (1 + 1 / k))
        assert event.kind == "grip"
        assert abs(event.time - wait) <= EXACT(4, wait)
        V = mpmath.matrix([3, 1]) - s0 * k / (1 + k)  # what is left of V₀ when s₀ has gone
        last = run.data.velocity.values[-1]
        assert np.allclose(last[:2], [float(part) for part in V], rtol=0, atol=EXACT(16, 8.0))
        middle = mpmath.matrix([mpf(0.1), mpf(-0.2)]) + (mpmath.matrix([3, 1]) + V) * wait / 2 + V * (8 - wait)
        position = run.data.position.values[-1][:2]
        assert np.allclose(position, [float(part) for part in middle], rtol=0, atol=EXACT(16, 20.0))

    def test_draw_brings_a_ball_back(self) -> None:
        run = exactly(*on_cloth(velocity=(1.0, 0.0), angular_velocity=(0.0, -40.0, 0.0)), until=3.0)
        assert abs(run.data.velocity.values[-1][0] - (1.0 - 5.0 * 2 / 7)) <= EXACT(8, 1.0)

    def test_where_friction_is_too_weak_it_slips_for_ever(self) -> None:
        run = exactly(*on_cloth(tilt=0.3, friction=0.05), until=50.0)
        assert not run.events
        assert math.isinf(SlidingSphere.of(*on_cloth(tilt=0.3, friction=0.05)).grips_at)

    def test_a_ball_that_cannot_roll_down_so_steep_a_slope_slips_from_rest(self) -> None:
        alpha, mu = 0.3, 0.05  # rolling takes tan α/(1 + 1/k) = 0.088
        run = exactly(*on_cloth(tilt=alpha, friction=mu, position=(0.0, 0.0), velocity=None, angular_velocity=None))
        way = 0.5 * G * (math.sin(alpha) - mu * math.cos(alpha)) * 4.0
        assert abs(run.data.position.values[-1][0] - way) <= SOLVER(100, 1e-12, way)

    @precisely
    def test_on_a_slope_it_is_what_integration_with_many_digits_says(self) -> None:
        system, start = on_cloth(tilt=0.4, friction=0.15)
        motion, until = SlidingSphere.of(system, start), mpf("0.5")
        force = [mpf(part) for part in motion.force]
        brake, pull = mpf(0.15) * -force[2], force[:2]
        with mpmath.workdps(25):

            def rates(_: Any, y: Any) -> list[Any]:
                size = mpmath.hypot(y[0], y[1])
                f = [-brake * y[0] / size, -brake * y[1] / size]
                return [*(F + 7 * g / 2 for F, g in zip(pull, f, strict=True)), *y[4:], *map(sum, zip(pull, f))]  # noqa: B905

            first = [*motion.slip, *motion.position, *motion.velocity]
            y = mpmath.odefun(rates, 0, [mpf(part) for part in first])(until)
        r, V, Omega, _ = motion.motion_at(float(until))
        got = [V.x - 0.1 * Omega.y, V.y + 0.1 * Omega.x, r.x, r.y, V.x, V.y]
        assert all(abs(one - other) <= EXACT(64, 6.0) for one, other in zip(got, y, strict=True))


class TestFlight:
    def test_a_drop_and_its_bounces(self) -> None:
        support = tr.Support(tr.Plane(), friction=0.2, restitution=0.5)
        system = tr.RollingSystem(BALL, support)
        run = exactly(system, system.place(height=0.5), until=1.0, every=0.01)
        fall = mpmath.sqrt(2 * mpf(0.5) / mpf(G))
        for n, event in enumerate(run.events[:8]):  # each flight lasts half as long as the one before
            wanted = fall * (1 + 2 * (1 - mpf(0.5) ** n))
            assert event.kind == "land"
            assert abs(event.time - wanted) <= EXACT(64, wanted)
        assert run.events[-1].kind == "settle"

    @pytest.mark.parametrize("method", ["exact", "taylor"])
    def test_thirty_bounces_on_nothing_has_been_added(self, method: str) -> None:
        ball = tr.Body.solid_sphere(radius=0.025, mass=0.51)
        system = tr.RollingSystem(ball, tr.Support(tr.Plane(), friction=0.5, restitution=0.8))
        run = tr.simulate(system, system.place(height=0.02), 0.6, 0.1, method=method)
        fall, e = mpmath.sqrt(2 * mpf(0.02) / mpf(G)), mpf(0.8)
        assert len(run.events) == 31
        for n, event in enumerate(run.events):
            down, wanted = -mpf(event.before.velocity[2]), mpf(G) * fall * e**n
            assert abs(down - wanted) <= EXACT(64, mpf(G) * fall)
            assert abs(event.time - fall * (1 + 2 * e * (1 - e**n) / (1 - e))) <= EXACT(64, 0.6)

    @pytest.mark.parametrize("every", [0.01, 1e-4])  # few in a flight, and more than a thousand
    def test_between_its_bounces_it_is_where_the_parabolas_say(self, every: float) -> None:
        # Without friction nothing but the fall changes: it goes on, and turns on about one axis.
        system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.0, restitution=0.5))
        Omega = (3.0, -2.0, 6.0)
        start = system.place((0.1, 0.0), (0.3, 0.4, 0.0), angular_velocity=Omega, height=0.5)
        run = exactly(system, start, until=1.1, every=every)
        fall = mpmath.sqrt(2 * mpf(0.5) / mpf(G))
        bounces = [fall * (1 + 2 * (1 - mpf(0.5) ** n)) for n in range(40)]
        samples = run.samples
        for i in range(0, samples.time.size, max(1, samples.time.size // 100)):
            t = mpf(samples.time[i])
            n = sum(t >= bounce for bounce in bounces)
            if n > 5:  # the bounces grow too low to tell
                break
            since, up = (t - bounces[n - 1], mpf(0.5) ** n * mpf(G) * fall) if n else (t, mpf(0))
            height = (mpf(0.5) if n == 0 else 0) + up * since - mpf(G) * since**2 / 2
            wanted = (mpf(0.1) + mpf(0.3) * t, mpf(0.4) * t, mpf(BALL.radius) + height)
            assert max(abs(mpf(a) - b) for a, b in zip(samples.position[i], wanted, strict=True)) <= EXACT(64, 1.0)
            assert np.abs(samples.contact[i] - [*samples.position[i][:2], 0.0]).max() <= EXACT(4, 1.0)
            turned = mpmath.cos(mpf(7) * t / 2), *(mpmath.sin(mpf(7) * t / 2) * mpf(part) / 7 for part in Omega)
            assert max(abs(mpf(a) - b) for a, b in zip(samples.orientation[i], turned, strict=True)) <= EXACT(64, 7.0)
        assert n > 5

    @pytest.mark.parametrize("pull", [G, 0.0, -3.0])
    def test_over_a_plane_it_lands_at_the_root_of_the_quadratic(self, pull: float) -> None:
        ball = SphereInFlight(0.1, 1.0, 0.4, (0, 0, 0.7), (1.0, 0, 2.0), (0, 0, 0), (0.0, 0.0, -pull))
        if pull > 0:
            wanted = (2 + mpmath.sqrt(4 + 2 * mpf(pull) * (mpf(0.7) - mpf(0.1)))) / mpf(pull)
            assert abs(ball.ends_at["land"] - wanted) <= EXACT(8, wanted)
        else:
            assert math.isinf(ball.ends_at["land"])

    def test_across_a_pipe_it_lands_where_the_parabola_meets_the_circle(self) -> None:
        track, a = mpf(0.5), mpf(0.1)
        system = tr.RollingSystem(BALL, tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
        start = system.place((1.0, 0.25), (3.0, 0.0))
        run = exactly(system, start, every=0.01)
        lift, land = run.events[:2]
        # N = G cos θ + mv²/ℓ = 0 with (1 + k)(v² − v₀²)/2 = gℓ(cos θ − cos θ₀)
        ell, g, k = track - a, mpf(G), mpf("0.4")
        cosine = (2 * mpmath.cos(1) / (1 + k) - mpf(9) / (g * ell)) / (1 + 2 / (1 + k))
        x, y, _ = lift.before.position
        assert (lift.kind, land.kind) == ("lift", "land")
        assert abs(x / math.hypot(x, y) - cosine) <= EXACT(64, 1.0)
        speed = mpmath.sqrt(-g * ell * cosine)
        sine = mpmath.sqrt(1 - cosine**2)

        def outside(t: Any) -> Any:
            return mpmath.hypot(ell * cosine - speed * sine * t + g * t * t / 2, ell * sine + speed * cosine * t) - ell

        wait = mpmath.findroot(outside, land.time - lift.time)
        assert wait > mpf("0.1")
        assert abs(land.time - lift.time - wait) <= EXACT(256, 1.0)
        for event in (lift, land):  # on the ray through the centre, on the pipe itself
            (x, y, _), (p, q, _) = event.before.position, event.contact
            assert abs(math.hypot(p, q) - 0.5) <= EXACT(8, 0.5)
            assert abs(x * q - y * p) <= EXACT(64, 0.25)

    @pytest.mark.parametrize("method", ["exact", "taylor", "runge-kutta"])
    def test_it_leaves_a_dome_where_the_point_straight_under_it_does(self, method: str) -> None:
        if method == "taylor":
            pytest.importorskip("heyoka")
        b, rim = mpf(0.29), mpf(0.2)
        system = tr.RollingSystem(BALL, tr.Support(tr.Dome(float(b), rim=float(rim))))
        start = system.place((0.01, 0.0), (2.0, 0.0, 0.5), height=0.05)
        (x, _, z), (v, _, w) = (tuple(map(mpf, part)) for part in (start.position, start.velocity))

        def left(t: Any) -> Any:  # how far the point on the dome is above the rim, but for a millionth of the radius
            up, out = z + b + w * t - mpf(G) * t * t / 2, x + v * t
            return b * up / mpmath.hypot(up, out) - mpmath.sqrt(b * b - rim * rim) - mpf(BALL.radius) / 10**6

        run = exactly(system, start, until=1.0, every=0.01, method=method)
        wanted = mpmath.findroot(left, 0.1)
        assert [event.kind for event in run.events] == ["end"]
        assert abs(run.events[0].time - wanted) <= EXACT(64, 1.0) + SOLVER(20, tolerance_of(method), 1.0)
        assert run.card().passed, str(run.card())

    def test_the_start_in_the_air_is_covered(self) -> None:
        system = tr.RollingSystem(BALL, tr.Support(tr.Dome(0.5)))
        assert isinstance(closed_form(system, system.place(height=0.2)), SphereInFlight)

    def test_what_lies_outside_is_named(self) -> None:
        system = tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=(tr.Drag(0.1),))
        with pytest.raises(OutOfDomainError, match="load drag is"):
            exactly(system, system.place(height=0.2))


CHAINS: dict[str, Any] = {
    "billiards": on_cloth(),
    "down a slope": on_cloth(tilt=0.1),
    "up a slope and down": on_cloth(tilt=0.3, friction=0.05, velocity=(-3.0, 1.0)),
    "starts rolling on a slope": on_cloth(tilt=0.3, friction=0.5, velocity=(1.0, 0.5), angular_velocity=None),
    "falls, slips, rolls": on_cloth(height=0.05),
}


def off_and_on_again() -> Any:
    """A ball that rolls on a cylinder, comes off, lands, and comes off once more; its angle from the top is NaN."""
    ball = tr.Body.solid_sphere(radius=0.01, mass=0.0327)
    system = tr.RollingSystem(ball, tr.Support(tr.Cylinder(0.2), tilt="90 deg"))
    return system, system.place((0.0, 0.0), (2.5, 0.0))


@pytest.mark.parametrize("name", [*CHAINS, "off and on again"])
def test_a_phase_between_two_samples_is_passed(name: str) -> None:
    system, start = CHAINS[name] if name in CHAINS else off_and_on_again()
    many, few = (exactly(system, start, until=1.0, every=every) for every in (0.01, 1.0))
    assert [event.kind for event in few.events] == [event.kind for event in many.events]
    for field in ("position", "velocity", "angular_velocity", "contact_force", "orientation"):
        end, same = few.data[field].values[-1], many.data[field].values[-1]
        # NumPy's loops for many numbers at once may round otherwise than those for one, by the processor.
        assert np.abs(end - same).max() <= 4 * np.spacing(np.abs(same).max()), field


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_the_chain_agrees_with_the_numerical_methods(name: str, method: str) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    ours, theirs = exactly(*CHAINS[name]), exactly(*CHAINS[name], method=method)
    bound = SOLVER(1000, max(tolerance_of(method), 1e-15))
    assert [event.kind for event in ours.events] == [event.kind for event in theirs.events]
    for one, other in zip(ours.events, theirs.events, strict=True):
        assert abs(one.time - other.time) <= bound
    for field in ("position", "velocity", "angular_velocity", "contact_force", "orientation"):
        size = max(1.0, float(np.abs(ours.data[field]).max()))
        assert float(np.abs(ours.data[field] - theirs.data[field]).max()) <= 50 * bound * size, field


def test_auto_leaves_the_closed_forms_where_one_is_missing() -> None:
    system, start = on_cloth(motion=tr.Spin(3.0))
    assert tr.simulate(system, start, 1.0, 0.5).method != "exact"
    with pytest.raises(OutOfDomainError, match="the plane turns"):
        exactly(system, start)


@pytest.mark.parametrize(
    ("radius", "wall", "angle", "rate"),
    [(0.125, 0.3125, 2.0, 1.0), (0.18, 0.47, 2.45, -5.94), (0.07, 0.35, 2.26, -4.07)],
)
def test_a_ball_at_rest_under_the_roof_of_a_turning_pipe_falls(
    radius: float, wall: float, angle: float, rate: float
) -> None:
    pipe = tr.Support(tr.Cylinder(wall), motion=tr.Spin(rate), tilt="90 deg")  # its first axis points down
    system = tr.RollingSystem(tr.Body.cylinder(radius, 1.0), pipe)
    run = exactly(system, system.place((angle, 0.0), (0.0, 0.0)), until=0.35)
    # From ℓ(cos θ, sin θ), by g t²/2 down, to the circle of radius ℓ.
    wait = mpmath.sqrt(-4 * (mpf(wall) - mpf(radius)) * mpmath.cos(mpf(angle)) / mpf(G))
    assert [event.kind for event in run.events][:2] == ["lift", "land"]
    assert abs(run.events[1].time - wait) <= EXACT(16, wait)
