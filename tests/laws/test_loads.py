"""Balls under every load, against what follows for them by hand; all on a level plane."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import E_Z, ZERO, Quaternion, Vector
from trundle.mechanics.contact import Rolling, roll

RADIUS, MASS, K, G = 0.05, 0.2, 0.4, 9.80665
BALL = tr.Body.sphere(radius=RADIUS, mass=MASS, inertia_ratio=K)
UPRIGHT = Quaternion(1.0, 0.0, 0.0, 0.0)


def rolling(load: Any, velocity: Vector, spin: float = 0.0, at: Vector = ZERO) -> Rolling:
    """Return the rates of a ball that rolls with a velocity over a fixed level plane."""
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane()), (load,))
    Omega = E_Z.cross(velocity) / RADIUS + E_Z * spin
    return roll(system, 0.0, at, UPRIGHT, Omega)


def path(load: Any, duration: float, **start: Any) -> Any:
    """Integrate a run on a fixed level plane."""
    pytest.importorskip("heyoka")
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane()), (load,))
    return tr.simulate(system, system.place(**start), duration=duration, every=0.05, method="taylor").data


def test_rolling_resistance_decelerates_as_its_conversion_says() -> None:
    # (1 + k) m a² Ω̇ = −δ m g: V̇ = −δ g/(a(1 + k)) against the motion, at any speed and whatever the spin.
    for speed in (1e-9, 0.3, 20.0):
        V = Vector(0.6 * speed, -0.8 * speed, 0.0)
        now = rolling(tr.RollingResistance(2e-4), V, spin=5.0)
        V_rate = now.reaction / MASS - E_Z * G
        wanted = Vector(-0.6, 0.8, 0.0) * (2e-4 * G / (RADIUS * (1 + K)))
        assert (V_rate - wanted).norm() <= EXACT(64, G)
        assert now.reaction.z == pytest.approx(MASS * G, rel=1e-15)


def test_on_a_slope_of_its_angle_a_ball_with_rolling_resistance_rolls_steadily() -> None:
    # tan α = δ/a: the incline on which a wheel keeps its speed measures δ/a itself, whatever k.
    alpha = math.atan(2e-4 / RADIUS)
    for ratio in (0.4, 2 / 3):
        body = tr.Body.sphere(radius=RADIUS, mass=MASS, inertia_ratio=ratio)
        system = tr.RollingSystem(body, tr.Support(tr.Plane(), tilt=alpha), (tr.RollingResistance(2e-4),))
        now = roll(system, 0.0, ZERO, UPRIGHT, Vector(0.0, 0.3 / RADIUS, 0.0))
        assert now.angular_acceleration.norm() <= EXACT(16, G / RADIUS)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("friction", [None, 0.5])
def test_up_a_steeper_slope_it_stops_for_an_instant_and_rolls_back(friction: float | None, method: str) -> None:
    # V̇ = g(sin α ± (δ/a) cos α)/(1 + k): down the slope the resistance is against the pull.
    if method == "taylor":
        pytest.importorskip("heyoka")
    slope = tr.Support(tr.Plane(), tilt=0.1, friction=friction)
    system = tr.RollingSystem(BALL, slope, (tr.RollingResistance(1e-3),))
    run = tr.simulate(system, system.place(velocity=(-0.3, 0.0)), duration=2.0, every=0.05, method=method)
    up, down = (G * (math.sin(0.1) + way * 1e-3 / RADIUS * math.cos(0.1)) / (1 + K) for way in (1, -1))
    assert [event.kind for event in run.events] == ["stop", "start"]
    assert run.events[0].text.startswith("stopped turning over the support at")  # it does not stay at rest
    for event in run.events:
        assert abs(event.time - 0.3 / up) <= SOLVER(100, run.tolerance)
    first = 4e-12 * math.sqrt(G * RADIUS)  # m/s, the way it is driven, with which it begins to roll from rest
    assert abs(run.data.velocity.values[-1, 0] - down * (2.0 - 0.3 / up)) <= first + SOLVER(100, run.tolerance)
    card = run.card()
    assert card.passed, str(card)
    named = tuple(replace(event, kind="slip") for event in run.events)  # it never slips
    assert not replace(run, events=named, _kept={}).card().passed


def test_rolling_resistance_on_a_turning_table_is_against_the_turning_over_it() -> None:
    # A ball at rest in space on a turning table is rolled under by it, and driven along with it.
    table = tr.Support(tr.Plane(), motion=tr.Spin(2.0))
    system = tr.RollingSystem(BALL, table, (tr.RollingResistance(2e-4),))
    now = roll(system, 0.0, Vector(0.3, 0.0, 0.0), UPRIGHT, Vector(2.0 * 0.3 / RADIUS, 0.0, 0.0))
    assert now.velocity.norm() <= EXACT(4, 1)
    V_rate = now.reaction / MASS - E_Z * G
    assert V_rate.y == pytest.approx(2e-4 * G / (RADIUS * (1 + K)), rel=1e-12)


def test_pivot_friction_slows_the_spin_alone_and_evenly() -> None:
    # k m a² Ω̇_n = −ε m g
    now = rolling(tr.PivotFriction(1e-4, below=1e-9), Vector(0.3, 0.1, 0.0), spin=5.0)
    assert now.angular_acceleration.z == pytest.approx(-1e-4 * G / (K * RADIUS**2), rel=1e-14)
    assert (now.reaction - E_Z * (MASS * G)).norm() <= EXACT(16, MASS * G)


@pytest.mark.parametrize("below", [1e-3, 3e-4])
@pytest.mark.parametrize("gain", [0.3, 0.8])
def test_pivot_friction_takes_along_what_did_not_spin(gain: float, below: float) -> None:
    """On a table that starts to turn as αt, a ball in the middle soon spins as the table less what keeps it going.

    With x = Ω_n − αt and c = εg/(ka²), ẋ = −α − c x/√(x² + w²) settles where x = −αw/√(c² − α²), and in the end as
    e^{−t(c² − α²)^{3/2}/(c²w)}.
    """
    pytest.importorskip("heyoka")
    table = tr.Support(tr.Plane(), motion=tr.SpinBy(f"{gain!r}*t"))
    system = tr.RollingSystem(BALL, table, (tr.PivotFriction(1e-4, below=below),))
    run = tr.simulate(system, system.place((0.0, 0.0), spin=0.0), 1.0, 0.25, "taylor")
    c = 1e-4 * G / (K * RADIUS**2)
    wanted = gain * run.samples.time - gain * below / math.sqrt(c * c - gain * gain)
    assert (c * c - gain * gain) ** 1.5 * 0.25 / (c * c * below) > 40.0
    assert np.abs(run.samples.angular_velocity[1:, 2] - wanted[1:]).max() <= SOLVER(1000, run.tolerance, gain)


def test_a_rolling_couple_lets_speed_and_spin_die_out_each_at_its_rate() -> None:
    # (1 + k) m a² Ω̇_t = −c Ω_t and k m a² Ω̇_n = −c_n Ω_n
    data = path(tr.RollingCouple(3e-4, 2e-4), 2.0, velocity=(0.3, -0.1), spin=4.0)
    t, moment = data.time.values, MASS * RADIUS**2
    decay = np.exp(-3e-4 / (moment * (1 + K)) * t)
    assert np.abs(data.velocity.values[:, 0] - 0.3 * decay).max() <= SOLVER(100, 1e-14)
    assert np.abs(data.velocity.values[:, 1] + 0.1 * decay).max() <= SOLVER(100, 1e-14)
    spin = 4.0 * np.exp(-2e-4 / (moment * K) * t)
    assert np.abs(data.angular_velocity.values[:, 2] - spin).max() <= SOLVER(100, 1e-14, 4.0)


def test_quadratic_drag_slows_down_as_one_over_the_way() -> None:
    # m(1 + k) V̇ = −c V²: V = V₀/(1 + c V₀ t/(m(1 + k)))
    data = path(tr.QuadraticDrag(0.3), 2.0, velocity=(0.8, -0.6))
    speed = np.hypot(*data.velocity.values[:, :2].T)
    wanted = 1 / (1 + 0.3 * data.time.values / (MASS * (1 + K)))
    assert np.abs(speed - wanted).max() <= SOLVER(100, 1e-14) + 0.3 * 1e-12 * 2.0  # v₀² c t: see the class


def test_air_that_goes_round_with_the_ball_does_not_slow_it() -> None:
    at = Vector(0.3, 0.0, 0.0)
    now = rolling(tr.QuadraticDrag(0.3, air=2.0), Vector(0.0, 0.6, 0.0), at=at)
    assert (now.reaction - E_Z * (MASS * G)).norm() <= EXACT(16, MASS * G)


def test_a_harmonic_trap_swings_the_ball_as_an_inertia_of_1_plus_k() -> None:
    # (1 + k) m r̈ = −c r: an ellipse about the middle at √(c/(m(1 + k))), here √10 rad/s
    data = path(tr.Potential("0.5*2.8*(x**2 + y**2)"), 3.0, position=(0.1, 0.0), velocity=(0.0, 0.2))
    phase = math.sqrt(10.0) * data.time.values
    assert np.abs(data.position.values[:, 0] - 0.1 * np.cos(phase)).max() <= SOLVER(1000, 1e-15)
    assert np.abs(data.position.values[:, 1] - 0.2 / math.sqrt(10.0) * np.sin(phase)).max() <= SOLVER(1000, 1e-15)


def test_a_potential_in_the_time_is_the_force_by_its_formula() -> None:
    field, push = tr.Potential("-0.1*sin(3*t)*x + 0.02*t*y"), tr.Force(("0.1*sin(3*t)", "-0.02*t", 0.0))
    one, other = (path(load, 1.0, velocity=(0.1, 0.0)) for load in (field, push))
    assert np.abs(one.position.values - other.position.values).max() <= SOLVER(10, 1e-15)


def test_the_magnus_force_of_a_spinning_ball_bends_its_way_into_a_circle() -> None:
    # (1 + k) m V̇ = c Ω_n n×V: once round in 2π m(1 + k)/(c Ω_n); the part of Ω that rolls only presses it down.
    c, spin = 0.004, 30.0
    data = path(tr.Magnus(c), 2.0, velocity=(0.5, 0.0), spin=spin)
    phase = c * spin / (MASS * (1 + K)) * data.time.values
    assert np.abs(data.velocity.values[:, 0] - 0.5 * np.cos(phase)).max() <= SOLVER(1000, 1e-15)
    assert np.abs(data.velocity.values[:, 1] - 0.5 * np.sin(phase)).max() <= SOLVER(1000, 1e-15)
    pressed = MASS * G + c * 0.5**2 / RADIUS
    assert np.abs(data.contact_force.values[:, 2] - pressed).max() <= SOLVER(1000, 1e-15, pressed)


def test_a_motor_about_the_axis_it_rolls_by_drives_the_ball_straight() -> None:
    # (1 + k) m a² Ω̇ = τ(t) about the body's second axis, which keeps its direction.
    data = path(tr.Motor((0.0, "0.002*cos(3*t)", 0.0)), 2.0, velocity=(0.1, 0.0))
    wanted = 0.1 + 0.002 * np.sin(3 * data.time.values) / 3 / (MASS * RADIUS * (1 + K))
    assert np.abs(data.velocity.values[:, 0] - wanted).max() <= SOLVER(1000, 1e-15)
    assert np.abs(data.velocity.values[:, 1]).max() <= SOLVER(1000, 1e-15)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_no_step_leads_across_a_kink_of_a_formula(method: str) -> None:
    # (1 + k) m V̇ = c|t − t₁|: V and x are the integrals of a function that goes down to 0 and up again.
    if method == "taylor":
        pytest.importorskip("heyoka")
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane()), (tr.Force(("0.3*abs(t - 0.77)", 0.0, 0.0)),))
    run = tr.simulate(system, system.place(), 2.0, 0.05, method)
    late = run.data.time.values - 0.77
    gained = 0.3 / (MASS * (1 + K)) * (0.77**2 + late * np.abs(late)) / 2
    gone = 0.3 / (MASS * (1 + K)) * (0.77**2 * run.data.time.values / 2 + (np.abs(late) ** 3 - 0.77**3) / 6)
    assert np.abs(run.data.velocity.values[:, 0] - gained).max() <= SOLVER(100, max(run.tolerance, 1e-15))
    assert np.abs(run.data.position.values[:, 0] - gone).max() <= SOLVER(100, max(run.tolerance, 1e-15))
    assert run.card().passed


def test_a_motor_turns_its_torque_with_the_ball() -> None:
    # A quarter turn about the normal later the same torque in the body drives along the other axis.
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane()), (tr.Motor((0.0, 0.002, 0.0)),))
    half = math.sqrt(0.5)
    quarter = roll(system, 0.0, ZERO, Quaternion(half, 0.0, 0.0, half), ZERO)
    gain = 0.002 / (MASS * RADIUS**2 * (1 + K))
    assert (quarter.angular_acceleration - Vector(-gain, 0.0, 0.0)).norm() <= EXACT(16, gain)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_a_ball_let_go_rolls_against_any_small_resistance(method: str) -> None:
    # From rest the first step must be no longer than it has rolled: beyond that the series is rounding.
    a, k, alpha = 0.05, 0.4, 0.1
    for offset in np.geomspace(1e-6, 4e-3, 40).tolist():
        load = tr.RollingResistance(offset)
        system = tr.RollingSystem(tr.Body.solid_sphere(a, 0.2), tr.Support(tr.Plane(), tilt=alpha), (load,))
        run = tr.simulate(system, system.place(), 1.0, 1.0, method=method)
        g = system.gravity
        wanted = 0.5 * g * (np.sin(alpha) - offset / a * np.cos(alpha)) / (1 + k)
        assert abs(run.data.position.values[-1, 0] - wanted) <= 1e-11
