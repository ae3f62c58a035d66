"""What must not matter does not: where one looks from, how heavy the ball is, in which units one measures."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.draws import runs, triples
from tests.precise import precisely, slope
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Vector
from trundle.solve.exact import SphereOnPlane
from trundle.solve.methods import tolerance_of

G = 9.80665
DURATION = 3.0
FIELDS = ("position", "velocity", "angular_velocity", "contact_force")
MOTIONS = ("position", "velocity", "angular_velocity")


def values(system: tr.RollingSystem, start: tr.State, method: str = "exact", duration: float = DURATION) -> Any:
    return tr.simulate(system, start, duration=duration, every=duration / 8, method=method).data


def radians(data: Any) -> float:
    return float(
        np.linalg.norm(data.angular_velocity.values, axis=1).max() * (data.time.values[-1] - data.time.values[0])
    )


def close(one: Any, other: Any, bound: float, size: float = 0.0) -> None:
    assert np.abs(one - other).max() <= bound * max(np.abs(other).max(), size)


def about_axis(angle: float) -> Any:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def product(p: Any, q: Any) -> Any:
    w = p[..., 0] * q[..., 0] - (p[..., 1:] * q[..., 1:]).sum(axis=-1)
    v = p[..., :1] * q[..., 1:] + q[..., :1] * p[..., 1:] + np.cross(p[..., 1:], q[..., 1:])
    return np.concatenate([w[..., None], v], axis=-1)


def sizes(system: tr.RollingSystem, data: Any) -> dict[str, float]:
    """Return the sizes that roundings are measured by: a small velocity may be the difference of two large ones."""
    rate, a = abs(float(system.support.motion.steady_rate or 0.0)), float(system.body.shape.radius)
    speed = float(np.abs(data.velocity).max()) + rate * float(np.abs(data.position).max())
    force = float(np.abs(data.contact_force).max())
    return {
        "velocity": speed,
        "angular_velocity": speed / a,
        "contact_force": force + float(system.body.mass) * rate * speed,
    }


@given(runs(tilts=st.just(0.0), pushes=st.tuples(st.builds(tr.Drag, st.floats(0.0, 0.05)))), st.floats(-4.0, 4.0))
def test_turning_the_start_about_the_axis_turns_the_path(run: tuple[tr.RollingSystem, tr.State], angle: float) -> None:
    system, start = run
    R = about_axis(angle)
    half = np.array([math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)])
    turned = replace(
        start,
        orientation=tuple(product(half, np.array(start.orientation)).tolist()),
        **{name: tuple((R @ getattr(start, name)).tolist()) for name in MOTIONS},
    )
    one, other = values(system, start), values(system, turned)
    size = sizes(system, one)
    for name in FIELDS:
        close(other[name].values, one[name].values @ R.T, EXACT(64, 1), size.get(name, 0.0))
    close(other.orientation.values, product(half, one.orientation.values), EXACT(64 + 8 * radians(one), 1))


@given(runs(), st.floats(1e-3, 1e3))
def test_mass_cancels(run: tuple[tr.RollingSystem, tr.State], factor: float) -> None:
    # With forces, torques and drag in proportion to the mass, the path is the same and the contact force in proportion.
    system, start = run
    grown = tuple(
        replace(load, coefficient=load.coefficient * factor)
        if isinstance(load, tr.Drag)
        else replace(load, value=tuple(load.value * factor))
        for load in system.loads
    )
    heavier = replace(system, body=replace(system.body, mass=system.body.mass * factor), loads=grown)
    one, other = values(system, start), values(heavier, start)
    size = sizes(system, one)
    for name in MOTIONS:
        close(other[name].values, one[name].values, EXACT(256, 1), size.get(name, 0.0))
    close(other.contact_force.values / factor, one.contact_force.values, EXACT(256, 1), size["contact_force"])
    close(other.orientation.values, one.orientation.values, EXACT(64 + 16 * radians(one), 1))


@given(runs(), st.floats(0.1, 10.0), st.floats(0.1, 10.0))
def test_units_do_not_matter(run: tuple[tr.RollingSystem, tr.State], length: float, time: float) -> None:
    system, start = run
    motion, support = system.support.motion, system.support
    if isinstance(motion, tr.Spin):
        support = replace(support, motion=tr.Spin(motion.rate / time))
    force, torque, drag = length / time**2, length**2 / time**2, 1 / time
    scaled = tuple(
        replace(load, coefficient=load.coefficient * drag)
        if isinstance(load, tr.Drag)
        else replace(load, value=tuple(load.value * (force if isinstance(load, tr.Force) else torque)))
        for load in system.loads
    )
    body = tr.Body.sphere(system.body.shape.radius * length, system.body.mass, system.body.inertia_ratio)
    other_system = tr.RollingSystem(body, support, scaled, gravity=system.gravity * length / time**2)
    other_start = replace(
        start,
        position=tuple(x * length for x in start.position),
        velocity=tuple(v * length / time for v in start.velocity),
        angular_velocity=tuple(w / time for w in start.angular_velocity),
    )
    one, other = values(system, start), values(other_system, other_start, duration=DURATION * time)
    size = sizes(system, one)
    for name, unit in zip(FIELDS, (length, length / time, 1 / time, force), strict=True):
        close(other[name].values / unit, one[name].values, EXACT(256, 1), size.get(name, 0.0))
    close(other.orientation.values, one.orientation.values, EXACT(64 + 16 * radians(one), 1))


@given(runs(pushes=st.tuples(st.builds(tr.Force, triples))))
def test_a_motion_run_backwards_returns(run: tuple[tr.RollingSystem, tr.State]) -> None:
    system, start = run
    there = tr.simulate(system, start, duration=DURATION, every=DURATION, method="exact")
    end = there.samples.state(-1)
    reverse = {name: tuple(-x for x in getattr(end, name)) for name in ("velocity", "angular_velocity")}
    motion = system.support.motion
    back = replace(
        system, support=replace(system.support, motion=tr.Spin(-motion.rate) if isinstance(motion, tr.Spin) else motion)
    )
    home = tr.simulate(back, replace(end, time=0.0, **reverse), duration=DURATION, every=DURATION, method="exact")
    arrived, size = home.samples.state(-1), sizes(system, there.data)
    # An error of the velocity is carried along for the whole way.
    reach = max(float(np.abs(there.data.position).max()), size["velocity"] * DURATION)
    assert np.abs(np.subtract(arrived.position, start.position)).max() <= EXACT(256, reach)
    assert np.abs(np.add(arrived.velocity, start.velocity)).max() <= EXACT(256, size["velocity"])
    assert np.abs(np.add(arrived.angular_velocity, start.angular_velocity)).max() <= EXACT(
        256, size["angular_velocity"] + 10
    )
    turned = EXACT(256 + 64 * radians(there.data) * (1 + reach / system.body.shape.radius), 1)
    assert np.abs(np.subtract(arrived.orientation, start.orientation)).max() <= turned


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@settings(max_examples=8)
@given(run=runs())
def test_two_methods_agree(method: str, run: tuple[tr.RollingSystem, tr.State]) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    system, start = run
    one, other = values(system, start, duration=1.0), values(system, start, method, duration=1.0)
    size, bound = sizes(system, one), SOLVER(30 * (1 + radians(one)), tolerance_of(method))
    for name in FIELDS:
        close(other[name].values, one[name].values, bound, size.get(name, 0.0))
    close(other.orientation.values, one.orientation.values, bound)


@settings(max_examples=20)
@given(runs())
def test_auto_takes_the_closed_form(run: tuple[tr.RollingSystem, tr.State]) -> None:
    system, start = run
    ours = tr.simulate(system, start, duration=1.0, every=0.25)
    assert ours.method == "exact"
    assert ours.data.identical(tr.simulate(system, start, duration=1.0, every=0.25, method="exact").data)


@settings(max_examples=20)
@given(runs(), st.permutations(["support", "world", "corotating"]))
def test_frames_round_trip(run: tuple[tr.RollingSystem, tr.State], frames: list[str]) -> None:
    ours = tr.simulate(*run, duration=DURATION, every=0.5)
    there = ours
    for frame in (*frames, "support"):
        there = there.in_frame(frame)
        assert there.frame == frame
        assert there.data.attrs["frame"] == frame
    size = sizes(run[0], ours.data)
    for name in (*FIELDS, "contact", "slip_velocity"):
        close(there.data[name].values, ours.data[name].values, EXACT(64, 1), size.get(name, size["velocity"]))
    close(there.data.orientation.values, ours.data.orientation.values, EXACT(64, 1))


@settings(max_examples=20)
@given(runs())
@precisely
def test_velocity_seen_from_the_table_is_the_slope_of_the_position_seen_from_it(run: Any) -> None:
    system, start = run
    seen, motion = (
        tr.simulate(system, start, duration=DURATION, every=0.5).in_frame("corotating").data,
        SphereOnPlane.of(*run),
    )
    rate = mpmath.mpf(system.support.motion.steady_rate)
    size = float(np.abs(seen.velocity).max()) + abs(float(rate)) * float(np.abs(seen.position).max()) + 1e-300

    def place(t: Any) -> Vector:
        r, c, s = motion.position_at(t), mpmath.cos(rate * t), mpmath.sin(rate * t)
        return Vector(c * r.x + s * r.y, c * r.y - s * r.x, r.z)

    for t, r, V in list(zip(seen.time.values, seen.position.values, seen.velocity.values, strict=True))[1:]:
        wanted, speed = place(mpmath.mpf(float(t))), slope(place, mpmath.mpf(float(t)))
        turned = 64 + 8 * abs(float(rate)) * DURATION
        assert max(abs(mpmath.mpf(float(x)) - y) for x, y in zip(r, wanted, strict=True)) <= EXACT(
            turned, size + np.abs(r).max()
        )
        assert max(abs(mpmath.mpf(float(x)) - y) for x, y in zip(V, speed, strict=True)) <= EXACT(turned, size)


@settings(max_examples=20)
@given(runs(pushes=st.just(())))
def test_gravity_points_down_in_the_world(run: tuple[tr.RollingSystem, tr.State]) -> None:
    # m V̇ − R is the weight: V̇ from a difference quotient in many digits, R as the world frame shows it.
    system, start = run
    ours = tr.simulate(system, start, duration=DURATION, every=0.5).in_frame("world").data
    m, tilt = float(system.body.mass), float(system.support.tilt)
    motion = SphereOnPlane.of(system, start)
    weight = np.array([0.0, 0.0, -m * system.gravity])
    for i, t in enumerate(ours.time.values[1:], start=1):
        with mpmath.workdps(50):
            rate = slope(lambda h, t=t: motion.motion_at(mpmath.mpf(float(t)) + h)[1])
        V_rate = np.array([float(part) for part in rate])
        world = (
            np.array([[math.cos(tilt), 0, math.sin(tilt)], [0, 1, 0], [-math.sin(tilt), 0, math.cos(tilt)]]) @ V_rate
        )
        scale = m * (system.gravity + np.abs(V_rate).max() * (1 + abs(float(motion.kappa)) * DURATION))
        assert np.abs(m * world - ours.contact_force.values[i] - weight).max() <= EXACT(64, scale)


def test_the_frames_see_the_same_body_turning() -> None:
    from scipy.spatial.transform import Rotation

    table = tr.Support(tr.Plane(), motion=tr.Spin(2.5), tilt=0.2)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.05, 0.2), table)
    start = system.place((0.1, 0.2), (0.3, -0.1), spin=2.0, orientation=(0.5, -0.5, 0.5, 0.5))
    ours = tr.simulate(system, start, duration=4.0, every=0.1)
    body = Rotation.from_quat(ours.data.orientation.values, scalar_first=True)
    tipped, carried = (
        Rotation.from_euler("y", 0.2),
        Rotation.from_rotvec(np.outer(-2.5 * ours.data.time.values, [0, 0, 1])),
    )
    for frame, turn in (("world", tipped), ("corotating", carried)):
        seen = ours.in_frame(frame).data
        there = Rotation.from_quat(seen.orientation.values, scalar_first=True)
        assert np.abs((turn * body).as_matrix() - there.as_matrix()).max() <= EXACT(64, 1)
        own = ours.data.angular_velocity.values - (np.array([0.0, 0.0, 2.5]) if frame == "corotating" else 0.0)
        assert np.abs(turn.apply(own) - seen.angular_velocity.values).max() <= EXACT(64, 20)
        assert np.abs(turn.apply(ours.data.contact_force.values) - seen.contact_force.values).max() <= EXACT(64, 2)


def test_a_ball_that_rides_on_the_table_rests_in_its_frame() -> None:
    table = tr.Support(tr.Plane(), motion=tr.Spin(2.5))
    system = tr.RollingSystem(tr.Body.solid_sphere(0.05, 0.2), table)
    seen = (
        tr.simulate(system, system.place((0.1, 0.2), "co-rotating"), duration=1.0, every=0.5)
        .in_frame("corotating")
        .data
    )
    assert np.abs(seen.velocity.values[0]).max() <= EXACT(4, 2.5 * 0.2)
    assert np.abs(seen.angular_velocity.values[0]).max() <= EXACT(4, 2.5)
