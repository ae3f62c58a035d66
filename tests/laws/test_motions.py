"""Balls on moving supports, against what follows for them by hand.

A ball of inertia ratio k on a level plane has (1 + k) V̇ = k u̇ + F/m, where u̇ is the rate of the plane's velocity at the
contact: Newton's m V̇ = F + f, Euler's k m a Ω̇ = −f a and V − aΩ×n = u leave nothing else (x and y components).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import E_Z, Quaternion, Vector
from trundle.mechanics.contact import Rolling, roll
from trundle.mechanics.motions import Motion

RADIUS, MASS, K, G = 0.05, 0.2, 0.4, 9.80665
BALL = tr.Body.sphere(radius=RADIUS, mass=MASS, inertia_ratio=K)
UPRIGHT = Quaternion(1.0, 0.0, 0.0, 0.0)


def on(motion: Motion, tilt: float = 0.0) -> tr.RollingSystem:
    return tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=motion, tilt=tilt))


def acceleration(now: Rolling, gravity: Vector) -> Vector:
    """Return V̇ from Newton's law."""
    return now.reaction / MASS + gravity


def simulated(system: tr.RollingSystem, duration: float, method: str = "taylor", **start: Any) -> Any:
    if method == "taylor":
        pytest.importorskip("heyoka")
    return tr.simulate(system, system.place(**start), duration=duration, every=0.05, method=method).data


def test_a_spin_at_any_rate_keeps_its_linear_integral() -> None:
    # (1 + k) V̇ = k d(ω e×r)/dt: V − k/(1 + k) ω(t) e×r is constant, whatever ω(t).
    motion = tr.SpinBy("3*exp(-t) - 2*sin(5*t)")
    system = on(motion)
    r, Omega = Vector(0.3, -0.2, RADIUS), Vector(4.0, -1.0, 2.0)
    for t, angle in ((0.0, 0.0), (0.7, 12.3), (2.0, -40.0)):
        now = roll(system, t, Vector(r.x, r.y, 0.0), UPRIGHT, Omega, (angle,))
        rate = 3 * math.exp(-t) - 2 * math.sin(5 * t)
        growth = -3 * math.exp(-t) - 10 * math.cos(5 * t)
        wanted = (E_Z.cross(r) * growth + E_Z.cross(now.velocity) * rate) * (K / (1 + K))
        off = acceleration(now, Vector(0.0, 0.0, -G)) - wanted
        assert off.norm() <= EXACT(64, G + wanted.norm())


def test_a_free_table_and_its_ball_keep_angular_momentum_and_energy() -> None:
    inertia = 0.004
    system = on(tr.FreeAxle(inertia, rate=2.5))
    p, Omega = Vector(0.3, -0.2, 0.0), Vector(4.0, -1.0, 2.0)
    own = (0.7, 2.5)
    now = roll(system, 0.0, p, UPRIGHT, Omega, own)
    V, moment = now.velocity, K * MASS * RADIUS**2
    V_rate = acceleration(now, Vector(0.0, 0.0, -G))
    turn, growth = system.support.motion.coordinate_rates(0.0, own, now.axle_moment)
    r = p + E_Z * RADIUS
    momentum = inertia * growth + MASS * r.cross(V_rate).z + moment * now.angular_acceleration.z
    energy = inertia * turn * growth + MASS * V.dot(V_rate) + moment * Omega.dot(now.angular_acceleration)
    assert abs(growth) > 0.1
    assert abs(momentum) <= EXACT(64, inertia * abs(growth))
    assert abs(energy) <= EXACT(256, inertia * turn * abs(growth) + MASS * V.norm() * V_rate.norm())


def test_a_motor_turns_the_table_alone_under_a_ball_in_the_middle() -> None:
    system = on(tr.FreeAxle(0.004, motor_torque="0.02*cos(t)", bearing_drag=0.001))
    now = roll(system, 0.0, Vector(0.0, 0.0, 0.0), UPRIGHT, Vector(0.0, 0.0, 3.0), (0.0, 2.0))
    _, growth = system.support.motion.coordinate_rates(0.0, (0.0, 2.0), now.axle_moment)
    assert growth == pytest.approx((0.02 - 0.001 * 2.0) / 0.004, rel=1e-14)
    assert now.angular_acceleration.norm() == 0.0  # touching at a point, it is not turned about the normal


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_a_shaken_plane_takes_a_share_of_its_own_motion_along(method: str) -> None:
    # (1 + k) V̇ = k Ẍ: with the plane's own frame for the observer it is the inertial force −mẌ that drives the ball.
    A, nu, phase = (0.03, -0.02, 0.0), 7.0, 0.4
    data = simulated(on(tr.Shake(A, nu, phase)), 2.0, method, position=(0.1, 0.2), velocity=(0.2, 0.1))
    t, share = data.time.values, K / (1 + K)
    for i, (start, speed) in enumerate(((0.1, 0.2), (0.2, 0.1))):
        # `position` counts from where the plane is at t = 0
        begin = start + A[i] * math.sin(phase)
        moved = share * A[i] * (np.sin(nu * t + phase) - math.sin(phase) - nu * math.cos(phase) * t)
        wanted = begin + speed * t + moved
        assert np.abs(data.position.values[:, i] - wanted).max() <= SOLVER(100, 1e-12)


def test_a_plane_shaken_upright_presses_harder_and_softer() -> None:
    data = simulated(on(tr.Shake((0.0, 0.0, 0.01), 20.0)), 1.0, position=(0.1, 0.2), velocity=(0.2, 0.0))
    wanted = MASS * (G - 0.01 * 400 * np.sin(20 * data.time.values))
    assert np.abs(data.contact_force.values[:, 2] - wanted).max() <= SOLVER(100, 1e-12)
    assert np.abs(data.velocity.values[:, 0] - 0.2).max() <= SOLVER(10, 1e-12)


def test_a_plane_that_is_pushed_steadily_leaves_the_ball_behind() -> None:
    # The box pushed from under a ball: of Ẍ = 0.5 m/s² it takes on k/(1 + k), 2/7.
    data = simulated(on(tr.Move(("0.25*t**2", 0.0, 0.0))), 1.0, position=(0.0, 0.0))
    assert np.abs(data.velocity.values[:, 0] - 2 / 7 * 0.5 * data.time.values).max() <= SOLVER(10, 1e-12)


def test_a_tilt_by_a_number_is_the_support_s_own() -> None:
    level = roll(on(tr.Tilt(0.2)), 0.0, Vector(0.0, 0.0, 0.0), UPRIGHT, Vector(0.0, 0.0, 0.0))
    down = acceleration(level, Vector(0.0, 0.0, -G))
    slope = roll(on(tr.Fixed(), tilt=0.2), 0.0, Vector(0.0, 0.0, 0.0), UPRIGHT, Vector(0.0, 0.0, 0.0))
    along = acceleration(slope, Vector(G * math.sin(0.2), 0.0, -G * math.cos(0.2)))
    assert along.x == pytest.approx(G * math.sin(0.2) / (1 + K), rel=1e-15)
    # 5/7 g sin α down the slope, seen in level axes
    assert down.x == pytest.approx(along.x * math.cos(0.2), rel=1e-14)
    assert down.z == pytest.approx(-along.x * math.sin(0.2), rel=1e-14)


def test_a_ball_that_turns_with_a_rocking_plane_rides_along() -> None:
    # As one body with the plane it does not roll: its centre goes round the axis with its point of contact.
    rate, x = -0.6, 0.7  # θ̇ = Aν cos φ about the second axis at t = 0, where θ = 0
    system = on(tr.Rock(0.2, 3.0, phase=math.pi))
    now = roll(system, 0.0, Vector(x, 0.0, 0.0), UPRIGHT, Vector(0.0, rate, 0.0))
    assert (now.point_rate - Vector(0.0, 0.0, -rate * x)).norm() <= EXACT(4, 1)
    assert (now.velocity - Vector(rate * RADIUS, 0.0, -rate * x)).norm() <= EXACT(4, 1)


def test_one_carries_the_other_as_the_order_says() -> None:
    # A table that spins on a shaken base, and a base that shakes on a spinning table, are two things.
    shake, spin = tr.Shake((0.1, 0.0, 0.0), 2.0), tr.Spin(1.0)
    t = 0.8
    on_base, on_table = tr.Combined((shake, spin)).at(t), tr.Combined((spin, shake)).at(t)
    there = 0.1 * math.sin(1.6)
    assert (on_base.origin - Vector(there, 0.0, 0.0)).norm() <= 1e-16
    assert (on_table.origin - Vector(there * math.cos(t), there * math.sin(t), 0.0)).norm() <= 1e-16
    # Coriolis: 2 ω×(v in the table)
    speed = 0.2 * math.cos(1.6)
    turned = Vector(math.cos(t), math.sin(t), 0.0)
    wanted = turned * (-there - 4 * there) + E_Z.cross(turned) * (2 * speed)
    assert (on_table.acceleration - wanted).norm() <= 1e-15


def test_a_swirled_pan_turns_nothing_round_but_the_ball() -> None:
    # After a round its low side has been all round and the pan is where it was, each point of it.
    motion, round_trip, t = tr.PrecessingTilt(0.1, 2.0), math.pi, 0.3
    system = on(motion)
    forces = []
    for later in (t, t + round_trip):
        there = motion.at(later).carried(Vector(0.2, 0.1, 0.0))
        forces.append(roll(system, later, there, UPRIGHT, Vector(1.0, 2.0, 3.0)).reaction)
    assert (forces[0] - forces[1]).norm() <= EXACT(256, MASS * G)
    # Half way round its slope is the opposite one.
    half = motion.at(t + round_trip / 2).rotation @ E_Z + motion.at(t).rotation @ E_Z
    assert half.x == pytest.approx(0.0, abs=1e-15)
    assert half.y == pytest.approx(0.0, abs=1e-15)
