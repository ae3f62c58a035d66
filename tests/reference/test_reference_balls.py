"""The classic problems of rolling balls and cylinders, each a shipped scenario, against answers from elsewhere.

Published results, closed forms worked out by hand (mpmath where they need quadrature), and `ball_round_axis`, an
integration of Newton's and Euler's laws that shares nothing with trundle's.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import mpmath
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.reference.ball_round_axis import Around
from tests.tolerances import SOLVER

import trundle as tr
from trundle.solve.laws import CONE_SLACK

G = 9.80665
TAYLOR = 1e-15
Array = Any


@cache
def run(name: str) -> tr.Trajectory:
    return tr.Scenario.load(name).run()


def changed(name: str, *pairs: tuple[str, str], method: str | None = None) -> tr.Trajectory:
    text = tr.Scenario.load(name).to_toml()
    for there, instead in pairs:
        assert text.count(there) == 1, (there, text)
        text = text.replace(there, instead)
    return tr.Scenario.loads(text).run(method)


def flat(path: tr.Trajectory, name: str = "position") -> Array:
    """Return x + iy."""
    x, y, _ = path.data[name].values.T
    return x + 1j * y


def kinds(path: tr.Trajectory) -> list[str]:
    return [event.kind for event in path.events]


def says(name: str, *numbers: str) -> None:
    notes = " ".join(tr.Scenario.load(name).notes.split())
    for number in numbers:
        assert number in notes, number


# --- turntables -------------------------------------------------------------------------------------------------


def test_a_ball_let_go_on_a_turntable_circles_about_a_point_beyond_the_axis() -> None:
    """Weltner (1979), Burns (1981): let go at r₀ it goes round −5/2 r₀ with the radius 7/2 r₀."""
    name = "level-turntable-corotating"
    path = run(name)
    away = flat(path) - (-2.5 * 0.05)
    np.testing.assert_allclose(abs(away), 3.5 * 0.05, rtol=0, atol=SOLVER(20, TAYLOR))
    turned = np.unwrap(np.angle(away))
    rate = 33.3 * math.pi / 30
    np.testing.assert_allclose(turned, 2 / 7 * rate * path.data.time, rtol=0, atol=SOLVER(1000, TAYLOR))
    says(name, "17.5 cm", "12.5 cm")


def test_on_a_tilted_turntable_the_drift_alone_is_a_straight_line() -> None:
    """Romer (1981): g sin α/(k ω), along the horizontal."""
    name = "tilted-turntable-straight"
    drift = G * math.sin(math.radians(1)) / (0.4 * 33.3 * math.pi / 30)
    path = run(name)
    expected = 1j * (-0.45 + drift * path.data.time.values)
    loops = abs(drift - 0.122699) / (2 / 7 * 33.3 * math.pi / 30)  # the file gives the speed in six digits
    np.testing.assert_allclose(flat(path), expected, rtol=0, atol=2.01 * loops + SOLVER(100, TAYLOR))
    assert loops < 1e-6
    says(name, f"{100 * drift:.2f} cm/s", f"{0.9 / drift:.2f} s")


@pytest.mark.parametrize("name", ["free-turntable-ellipse", "free-turntable-hyperbola"])
def test_on_a_free_turntable_the_path_is_a_conic(name: str) -> None:
    """Weckesser (1997). B = V − γ ω n×r and L = I ω + m n·(r×V) stay, γ = k/(1 + k).

    So ω = (L − m n·(r×B))/(I + m γ r²); and with y across B, d(r²)/dy = 2B/(γω) integrates to
    I + m γ r² = (L + m B y)²/((I + m γ r₀²) ω₀²): a conic, an ellipse where m B² < γ ω₀² (I + m γ r₀²).
    """
    path, scenario = run(name), tr.Scenario.load(name)
    m, gamma, inertia, rate = scenario.body.mass, 2 / 7, scenario.support.motion.inertia, scenario.support.motion.rate
    r, V, omega = flat(path), flat(path, "velocity"), path.data.support_rate.values
    B0 = V[0] - gamma * rate * 1j * r[0]
    spread = SOLVER(1e4, TAYLOR)
    np.testing.assert_allclose(V - gamma * omega * 1j * r, B0, rtol=0, atol=spread)
    momentum = inertia * omega + m * (np.conj(r) * V).imag
    np.testing.assert_allclose(momentum, momentum[0], rtol=0, atol=spread)
    heavy = inertia + m * gamma * abs(r[0]) ** 2
    across = (r * np.conj(B0)).imag  # B y
    conic = inertia + m * gamma * abs(r) ** 2 - (momentum[0] + m * across) ** 2 / (heavy * rate**2)
    np.testing.assert_allclose(conic, 0, atol=spread)
    np.testing.assert_allclose(omega, (momentum[0] + m * across) / (inertia + m * gamma * abs(r) ** 2), atol=spread)
    eccentricity = math.sqrt(m * abs(B0) ** 2 / (gamma * rate**2 * heavy))
    assert (eccentricity < 1) == name.endswith("ellipse")
    if name.endswith("ellipse"):
        assert kinds(path) == []
        says(name, f"{100 * np.ptp(r.real):.1f} cm long", f"{100 * np.ptp(r.imag):.1f} cm wide")
        says(name, f"{omega.min():.2f} rad/s")
    else:
        assert kinds(path) == ["rim"]
        says(name, f"{eccentricity**2:.1f} times", f"{omega.max():.2f} rad/s")


DROP = "turntable-drop"


@pytest.mark.parametrize("friction", ["0.07", "0.1", "0.3", "1"])
@pytest.mark.parametrize("restitution", ["0", "0.5"])
def test_a_dropped_ball_circles_about_the_axis_whatever_the_friction(friction: str, restitution: str) -> None:
    """A contact force f turns Ω by −a n×f: a Ω×n + V/k stays 0 through slip and bounces, so that V = (2/7) ω n×r."""
    path = changed(DROP, ("friction = 0.07", f"friction = {friction}"), ("tion = 0.5\n", f"tion = {restitution}\n"))
    rate = 78 * math.pi / 30
    assert kinds(path)[-1] in ("grip", "settle", "land")  # where the friction is large a landing takes all the slip
    assert path.data.phase[-1] == 0
    rolling = path.data.time.values > path.events[-1].time
    r, V = flat(path)[rolling], flat(path, "velocity")[rolling]
    np.testing.assert_allclose(V, 2 / 7 * rate * 1j * r, rtol=0, atol=SOLVER(1e6, TAYLOR))
    np.testing.assert_allclose(abs(r), abs(r[0]), rtol=0, atol=SOLVER(1e6, TAYLOR))


def test_how_far_out_a_dropped_ball_ends_is_told_by_the_slip() -> None:
    """With V/k + a Ω×n = 0 the slip is s = V(1 + 1/k) − ω n×r, and r̈ = −μ g ŝ: a problem of its own."""
    path = changed(DROP, ('height = "2 cm"', "angular_velocity = [0, 0, 0]"))
    rate = 78 * math.pi / 30

    def slipping(_: float, state: Array) -> list[float]:
        x, y, u, v = state
        s = 3.5 * (u + 1j * v) - rate * 1j * (x + 1j * y)
        pull = -0.07 * G * s / abs(s)
        return [u, v, pull.real, pull.imag]

    # The slip falls to 0 at a finite rate and its direction has a limit: stop a rounding before.
    def stuck(_: float, state: Array) -> float:
        x, y, u, v = state
        return float(abs(3.5 * (u + 1j * v) - rate * 1j * (x + 1j * y)) - 1e-9)

    stuck.terminal = True  # type: ignore[attr-defined]
    done = solve_ivp(slipping, (0, 2), [0.1, 0, 0, 0], "DOP853", events=stuck, rtol=1e-12, atol=1e-13)
    assert kinds(path) == ["grip"]
    assert path.events[0].time == pytest.approx(done.t_events[0][0], abs=1e-8)
    assert abs(flat(path)[-1]) == pytest.approx(math.hypot(*done.y_events[0][0][:2]), abs=1e-8)
    limit = (2 / 7 * rate) ** 2 * 0.1 / G
    says(DROP, f"{limit:.3f}")


def test_on_a_table_that_starts_up_the_ball_turns_by_two_sevenths() -> None:
    path = run("turntable-starting-up")
    angle = [3.5 * (t - 2 * (1 - mpmath.exp(-t / 2))) for t in map(mpmath.mpf, path.data.time.values)]
    expected = [0.2 * mpmath.expj(mpmath.mpf(2) / 7 * a) for a in angle]
    np.testing.assert_allclose(flat(path), np.array([complex(z) for z in expected]), atol=SOLVER(100, TAYLOR))
    other = tr.Scenario.load("turntable-starting-up").run("taylor")
    np.testing.assert_allclose(flat(other), np.array([complex(z) for z in expected]), atol=SOLVER(1000, TAYLOR))


def test_a_ball_on_a_pushed_box_gains_two_sevenths_of_it() -> None:
    """SimBenchmark's rolling test, one ball: (M + (2/7) m) A = P − μ (M + m) g, and f = (2/7) m A."""
    name, gain = "ball-on-a-pushed-box", 10.388
    path = run(name)
    t = path.data.time.values
    np.testing.assert_allclose(flat(path), gain / 7 * t**2, rtol=0, atol=SOLVER(100, TAYLOR))
    force = path.data.contact_force.values
    np.testing.assert_allclose(force[:, 0] / force[:, 2], 2 / 7 * gain / G, rtol=1e-12)
    assert abs((150 - 0.4 * 11 * G) / (10 + 2 / 7) - gain) < 5e-4
    says(name, f"{gain:.3f} m/s", f"{2 / 7 * gain:.3f} m/s", f"{2 / 7 * gain / G:.3f}")
    slipping = changed(name, ("friction = 0.8", "friction = 0.05"))
    np.testing.assert_allclose(flat(slipping), 0.5 * 0.05 * G * t**2, rtol=0, atol=SOLVER(1e4, TAYLOR))


# --- slipping and bouncing on a plane ---------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["billiard-draw", "billiard-follow", "billiard-swerve"])
def test_a_billiard_ball_slips_then_rolls(name: str) -> None:
    """t = 2|s₀|/(7 μ g) and V = V₀ − (2/7) s₀; a parabola, then a straight line."""
    path, a = run(name), 0.028575
    V0, (x, y, _) = flat(path, "velocity")[0], path.data.angular_velocity.values[0]
    s0 = V0 - a * (y - 1j * x)
    end = 2 * abs(s0) / (7 * 0.2 * G)
    V1 = V0 - 2 / 7 * s0
    assert kinds(path) == ["grip"]
    bound = SOLVER(1e4, TAYLOR)
    assert path.events[0].time == pytest.approx(end, abs=bound)
    t = path.data.time.values
    parabola = V0 * t - 0.5 * 0.2 * G * s0 / abs(s0) * t**2
    line = V0 * end - 0.5 * 0.2 * G * s0 / abs(s0) * end**2 + V1 * (t - end)
    np.testing.assert_allclose(flat(path), np.where(t < end, parabola, line), rtol=0, atol=bound)
    np.testing.assert_allclose(flat(path, "velocity")[t > end], V1, rtol=0, atol=bound)
    if name != "billiard-swerve":
        says(name, f"{end:.3f} s", f"{abs(s0):.3f} m/s", f"{100 * abs(V1):.1f} cm/s")
        assert (V1.real < 0) == (name == "billiard-draw")


def test_on_a_steep_slope_a_ball_never_begins_to_roll() -> None:
    name = "incline-with-slip"
    path, t = run(name), run(name).data.time.values
    gain = G * (math.sin(math.pi / 6) - 0.1 * math.cos(math.pi / 6))
    turning = 2.5 * 0.1 * G * math.cos(math.pi / 6) / 0.025
    np.testing.assert_allclose(flat(path), 0.5 * gain * t**2, rtol=0, atol=SOLVER(1e3, TAYLOR))
    np.testing.assert_allclose(path.data.angular_velocity.values[:, 1], turning * t, atol=SOLVER(1e4, TAYLOR, turning))
    assert (path.data.phase == 1).all()
    says(name, f"{gain:.3f} m/s", f"{gain - 2.5 * 0.1 * G * math.cos(math.pi / 6):.3f} m/s", "19.3 degrees")
    assert math.degrees(math.atan(0.35)) == pytest.approx(19.3, abs=0.05)
    limit = math.atan(0.35)
    for tilt, phase in ((limit - 1e-6, 0), (limit + 1e-6, 1)):
        near = changed(name, ('"30 deg"', f"{tilt!r}"))
        assert (near.data.phase == phase).all()


def test_a_bouncing_ball_loses_its_slip_and_comes_back() -> None:
    """The first bounce: V − (2/7) s where friction can take that, 2|s|/7 ≤ μ(1 + e)|v|; and the times of them all."""
    name = "bouncing-ball-with-backspin"
    path, a, e = run(name), 0.025, 0.8
    Omega, down = -20 * 2 * math.pi, math.sqrt(2 * G * 0.5)
    slip = 1 - a * Omega
    first = path.events[0]
    assert first.kind == "land"
    assert first.time == pytest.approx(down / G, abs=SOLVER(100, TAYLOR))
    assert 2 / 7 * slip < 0.5 * (1 + e) * down
    after = 1 - 2 / 7 * slip
    assert first.after.velocity == pytest.approx((after, 0, e * down), abs=SOLVER(1e3, TAYLOR))
    assert first.after.angular_velocity == pytest.approx((0, after / a, 0), abs=SOLVER(1e5, TAYLOR))
    landings = [event.time for event in path.events if event.kind == "land"]
    flights = 2 * down / G * e ** np.arange(1, len(landings))
    np.testing.assert_allclose(np.diff(landings), flights, rtol=0, atol=SOLVER(1e5, TAYLOR))
    whole = down / G * (1 + 2 * e / (1 - e))
    assert path.events[-1].kind == "settle"
    assert 0 <= whole - path.events[-1].time < 1e-2
    says(name, f"{after:.3f} m/s", f"{slip:.2f} m/s", f"{whole:.2f} s")


def test_a_superball_jumps_forth_and_back() -> None:
    """Garwin: V − (4/7) s at the first bounce, with the slip turned round; the second bounce undoes the first."""
    name, a = "superball", 0.025
    path = run(name)
    Omega, down = -8 * 2 * math.pi, math.sqrt(2 * G * 0.5)
    slip = 1 - a * Omega
    back = 1 - 4 / 7 * slip
    for n, event in enumerate(path.events):
        V, turning = (1.0, Omega) if n % 2 else (back, (back + slip) / a)
        assert event.kind == "land"
        assert event.time == pytest.approx((2 * n + 1) * down / G, abs=SOLVER(1e4, TAYLOR))
        assert event.after.velocity == pytest.approx((V, 0, down), abs=SOLVER(1e4, TAYLOR))
        assert event.after.angular_velocity[1] == pytest.approx(turning, abs=SOLVER(1e6, TAYLOR))
    assert len(path.events) == 6
    says(name, f"{back:.3f} m/s", f"{slip:.2f} m/s", f"{(back + slip) / a / (2 * math.pi):.1f} turns")


def test_a_smooth_floor_takes_less_than_the_slip() -> None:
    """Where friction cannot take all the slip in one bounce, it takes μ(1 + e)|v|."""
    path = changed("bouncing-ball-with-backspin", ("friction = 0.5", "friction = 0.1"))
    down = math.sqrt(2 * G * 0.5)
    assert path.events[0].after.velocity[0] == pytest.approx(1 - 0.1 * 1.8 * down, abs=SOLVER(1e3, TAYLOR))


# --- loops, spheres and holes -----------------------------------------------------------------------------------


def test_the_loop_needs_twenty_seven_tenths() -> None:
    """m v²/ℓ = m g at the top, with (7/10) v² of energy: a drop of (27/10) ℓ from rest, ℓ = R − a."""
    name, reach = "loop-the-loop-too-slow", 0.19
    enough = math.sqrt(10 / 7 * G * 2.7 * reach)
    for speed, lifts in ((enough * (1 - 1e-6), True), (enough * (1 + 1e-6), False)):
        path = changed(name, ('"2.5 m/s"', f"{speed!r}"))
        assert ("lift" in kinds(path)) == lifts
    says(name, f"{100 * 2.7 * reach:.1f} cm", f"{enough:.2f} m/s")


def test_where_and_when_a_slow_ball_leaves_the_loop() -> None:
    """cos θ of the lift, then a parabola."""
    name, reach, v0 = "loop-the-loop-too-slow", 0.19, 2.5
    path = run(name)
    lift, land = path.events[:2]
    assert (lift.kind, land.kind) == ("lift", "land")
    cosine = (10 / 7 - v0**2 / (G * reach)) / (17 / 7)
    angle = math.acos(cosine)
    assert lift.before.position[:2] == pytest.approx((reach * cosine, reach * math.sin(angle)), abs=1e-12)
    speed = mpmath.sqrt(-G * reach * mpmath.mpf(cosine))
    assert math.hypot(*lift.before.velocity) == pytest.approx(float(speed), abs=1e-12)
    time = mpmath.quad(
        lambda q: reach / mpmath.sqrt(v0**2 - mpmath.mpf(10) / 7 * G * reach * (1 - mpmath.cos(q))), [0, angle]
    )
    assert lift.time == pytest.approx(float(time), abs=1e-12)
    t = land.time - lift.time
    x, y = lift.before.position[0] + lift.before.velocity[0] * t, lift.before.position[1] + lift.before.velocity[1] * t
    assert math.hypot(x + 0.5 * G * t * t, y) == pytest.approx(reach, abs=1e-12)
    says(name, f"{math.degrees(angle):.1f} degrees")


def test_a_ball_leaves_a_sphere_at_ten_seventeenths() -> None:
    """(7/10) v² = g ℓ (cos θ₀ − cos θ) and v² = g ℓ cos θ; the time by quadrature."""
    name, reach = "roll-off-a-sphere", 0.21
    path = run(name)
    (lift,) = path.events
    start = mpmath.asin(mpmath.mpf("0.002") / mpmath.mpf("0.2"))
    angle = mpmath.acos(mpmath.mpf(10) / 17 * mpmath.cos(start))
    x, _, z = lift.before.position
    assert math.atan2(x, z + 0.2) == pytest.approx(float(angle), abs=1e-10)

    # v falls to 0 at θ₀ as a root: with θ = θ₀ + q² the integrand is smooth.
    def slowness(q: Any) -> Any:
        theta = start + q * q
        fallen = 2 * mpmath.sin(start + q * q / 2) * mpmath.sin(q * q / 2)
        return (
            2 * q / mpmath.sqrt(mpmath.mpf(10) / 7 * mpmath.mpf(G) / reach * fallen)
            if q
            else mpmath.sqrt(4 * reach / (mpmath.mpf(10) / 7 * mpmath.mpf(G) * mpmath.sin(theta)))
        )

    time = mpmath.quad(slowness, [0, 0.05, 0.2, mpmath.sqrt(angle - start)])
    assert lift.time == pytest.approx(float(time), abs=1e-9)
    says(name, f"{math.degrees(math.acos(10 / 17)):.1f} degrees", f"{math.degrees(math.acos(2 / 3)):.1f} degrees")


@pytest.mark.parametrize("friction", [0.1, 0.3, 1.0])
def test_with_finite_friction_it_slips_off_a_sphere(friction: float) -> None:
    """Rolls while (2/7) sin θ ≤ μ N/(m g); then v̇ = g sin θ − μ N/m with N/m = g cos θ − v²/ℓ, until N is 0."""
    name, reach = "roll-off-a-sphere-slipping", 0.21
    path = changed(name, ("friction = 0.3", f"friction = {friction}"))
    assert kinds(path) == ["slip", "lift"]
    start, g = mpmath.asin(mpmath.mpf("0.01")), mpmath.mpf(G)

    def speed_of(theta: Any) -> Any:
        return mpmath.sqrt(mpmath.mpf(10) / 7 * g * reach * (mpmath.cos(start) - mpmath.cos(theta)))

    def slips_at(mu: float) -> Any:
        def spare(theta: Any) -> Any:
            pressed = mpmath.cos(theta) - mpmath.mpf(10) / 7 * (mpmath.cos(start) - mpmath.cos(theta))
            return mpmath.mpf(2) / 7 * mpmath.sin(theta) - mu * pressed

        return mpmath.findroot(spare, 0.6)

    slips = slips_at(friction)
    late = float(slips_at(friction * (1 + CONE_SLACK)) - slips)  # rolling may take so much more, lest it chatter

    def slipping(_: float, state: Array) -> list[float]:
        theta, v = state
        return [v / reach, G * math.sin(theta) - friction * (G * math.cos(theta) - v * v / reach)]

    def off(_: float, state: Array) -> float:
        return float(G * math.cos(state[0]) - state[1] ** 2 / reach)

    off.terminal = True  # type: ignore[attr-defined]
    first = [float(slips), float(speed_of(slips))]
    done = solve_ivp(slipping, (0, 1), first, "DOP853", events=off, rtol=1e-13, atol=1e-14)
    angles = [math.atan2(event.before.position[0], event.before.position[2] + 0.2) for event in path.events]
    assert 0 <= angles[0] - slips <= late
    assert angles[1] == pytest.approx(done.y_events[0][0][0], abs=late + 1e-12)
    took = path.events[1].time - path.events[0].time
    assert took == pytest.approx(done.t_events[0][0], abs=late * reach / first[1] + 1e-12)
    if friction == 0.3:
        says(name, *(f"{math.degrees(angle):.1f}" for angle in angles))


def test_a_golf_ball_comes_out_of_the_hole() -> None:
    """Gualtieri, Tokieda and others (2006): z sinks and rises at √(2/7) of the rate of the round, by 5 g/φ̇²."""
    name, reach = "golfers-dilemma", 0.054 - 0.02135
    path = run(name)
    round_rate = 1 / reach
    t = path.data.time.values
    depth = 5 * G / round_rate**2
    z = -0.5 * depth * (1 - np.cos(math.sqrt(2 / 7) * round_rate * t))
    np.testing.assert_allclose(path.data.position.values[:, 2], z, rtol=0, atol=SOLVER(1000, TAYLOR))
    np.testing.assert_allclose(flat(path), reach * np.exp(1j * round_rate * t), rtol=0, atol=SOLVER(1000, TAYLOR))
    taylor = tr.Scenario.load(name).run("taylor").data.position.values[:, 2]
    np.testing.assert_allclose(taylor, z, rtol=0, atol=SOLVER(1e4, TAYLOR))
    says(name, f"{100 * depth:.1f} cm", f"{math.sqrt(2 / 7):.3f} times")


def test_a_cylinder_in_a_cylinder_is_a_pendulum() -> None:
    """(1 + k) ℓ θ̈ = −g sin θ: the period is 4 √((1 + k) ℓ/g) K(sin²(θ₀/2))."""
    name, reach = "cylinder-in-cylinder", 0.47
    path = run(name)
    small = mpmath.sqrt(1.5 * reach / mpmath.mpf(G))
    period = float(4 * small * mpmath.ellipk(mpmath.sin(mpmath.pi / 6) ** 2))
    back = path.at([0.0, period / 4, period / 2, period, 5 * period]).data.position.values
    angles = np.arctan2(back[:, 1], back[:, 0])
    np.testing.assert_allclose(angles, np.array([1, 0, -1, 1, 1]) * math.pi / 3, rtol=0, atol=SOLVER(1e3, TAYLOR))
    says(name, f"{period:.2f} s", f"{float(2 * mpmath.pi * small):.2f} s")


# --- bowls, domes, funnels and dishes -----------------------------------------------------------------------------

ROUND: dict[str, Any] = {  # h, h′ and h″ of the meridian
    "ball-in-a-turning-bowl": (
        lambda s: 0.5 - math.sqrt(0.25 - s * s),
        lambda s: s / math.sqrt(0.25 - s * s),
        lambda s: 0.25 / (0.25 - s * s) ** 1.5,
    ),
    "ball-on-a-spinning-dome": (
        lambda s: math.sqrt(0.29**2 - s * s) - 0.29,
        lambda s: -s / math.sqrt(0.29**2 - s * s),
        lambda s: -(0.29**2) / (0.29**2 - s * s) ** 1.5,
    ),
    "ball-in-a-funnel": (lambda s: s, lambda _: 1.0, lambda _: 0.0),
    "ball-in-a-turning-funnel": (lambda s: s, lambda _: 1.0, lambda _: 0.0),
    "ball-in-a-turning-dish": (lambda s: s * s / 1.612, lambda s: s / 0.806, lambda _: 1 / 0.806),
}


@pytest.mark.parametrize("name", ROUND)
def test_round_surfaces_against_an_integration_by_hand(name: str) -> None:
    scenario = tr.Scenario.load(name)
    rate = getattr(scenario.support.motion, "rate", 0.0)
    by_hand = Around(0.01, 0.4, float(rate), *ROUND[name])
    path = run(name)
    assert kinds(path) == []
    times = path.data.time.values
    few = times <= 4
    expected = by_hand.solve(scenario.start.position, path.data.angular_velocity.values[0], times[few])
    np.testing.assert_allclose(path.data.position.values[few], expected, rtol=0, atol=SOLVER(3000, 1e-12))


def modes(rate: float, spin: float, bowl: float, a: float) -> Array:
    """Return iλ of ζ̈ = i γ (ω b − a Ω_n)/ℓ ζ̇ − g/((1 + k) ℓ) ζ about the lowest point of a bowl, ℓ = b − a.

    Linearised by hand; of a dome the radius b and so ℓ = b − a are negative.
    """
    reach = bowl - a
    gamma, pull = 2 / 7 * (rate * bowl - spin * a) / reach, 5 / 7 * G / reach
    return np.roots([1, -1j * gamma, pull])


def test_near_the_lowest_point_the_bowl_turns_the_swing() -> None:
    path = changed("ball-in-a-turning-bowl", ('["15 cm", "0 cm"]', "[1e-6, 0]"), ('"20 s"', '"5 s"'))
    rate = 33.3 * math.pi / 30
    one, other = modes(rate, 0.0, 0.5, 0.01)
    z, V, t = flat(path), flat(path, "velocity"), path.data.time.values
    A, B = np.linalg.solve([[1, 1], [one, other]], [z[0], V[0]])
    np.testing.assert_allclose(z, A * np.exp(one * t) + B * np.exp(other * t), rtol=0, atol=1e-15)


def test_the_top_of_a_dome_is_stable_beyond_the_threshold() -> None:
    """σ² − (2/7) ω σ + (5/7) g/ℓ = 0 for a ball that spins along: real from ω² = 35 g/ℓ on."""
    name, reach = "ball-on-a-spinning-dome", 0.3
    threshold = math.sqrt(35 * G / reach)
    says(name, f"{threshold:.2f} rad/s", f"{threshold * 30 / math.pi:.0f} rpm")
    for share, stable in ((0.99, False), (1.01, True)):
        rate = share * threshold
        pair = modes(rate, rate, -0.29, 0.01)
        assert bool(max(pair.real) < 1e-9) == stable
        small = (('"360 rpm"', f"{rate!r}"), ('["5 mm", "0 mm"]', "[1e-6, 0]"))
        path = changed(name, *small)
        z, V, t = flat(path), flat(path, "velocity"), path.data.time.values
        A, B = np.linalg.solve([[1, 1], pair], [z[0], V[0]])
        expected = A * np.exp(pair[0] * t) + B * np.exp(pair[1] * t)
        early = t <= 1  # what is left out grows with the third power, and with the time
        np.testing.assert_allclose(abs(z - expected)[early] / abs(expected)[early], 0, atol=2e-8)
        assert (abs(z).max() < 1e-4) == stable
    slow = changed(name, ('"360 rpm"', '"280 rpm"'))
    assert kinds(slow) == ["end"]
    assert slow.events[0].time < 1
