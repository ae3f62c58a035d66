"""Supports whose velocity jumps, against impulses and times worked out by hand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.errors import InvalidValueError
from trundle.mechanics import kinks
from trundle.solve.exact import closed_form

METHODS = ("taylor", "runge-kutta")
A, M, G = 0.1, 2.0, 9.80665
BALL = tr.Body.solid_sphere(A, M)
SHELL = tr.Body.hollow_sphere(A, M)
EGG = tr.Body.ellipsoid(("0.1 m", "0.12 m", "0.16 m"), M)
EXACT = 1e-11  # of the speeds: at 1e-12 Runge and Kutta's method has come to the instant


def on(motion: Any, body: tr.Body = BALL, **support: Any) -> tr.RollingSystem:
    return tr.RollingSystem(body, tr.Support(tr.Plane(), motion=motion, **support))


def moved(*position: Any) -> tr.Move:
    return tr.Move(position)


def run_of(
    system: tr.RollingSystem, method: str = "taylor", duration: float = 1.2, every: float = 0.05, **start: Any
) -> tr.Trajectory:
    run = tr.simulate(system, system.place(**start), duration, every, method)
    failures = run.card().failures
    assert not failures, failures
    return run


def jolt_of(run: tr.Trajectory) -> tr.Event:
    (jolt,) = (event for event in run.events if event.kind == "jolt")
    return jolt


def change(jolt: tr.Event, name: str = "velocity") -> np.ndarray:
    return np.subtract(getattr(jolt.after, name), getattr(jolt.before, name))


def velocity_of(run: tr.Trajectory, time: float, jolt: tr.Event) -> np.ndarray:
    state = run.system.support.motion.at(time, *jolt.before.support)
    return np.array([float(part) for part in state.velocity])


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize(("body", "share"), [(BALL, 2 / 7), (SHELL, 2 / 5)])
def test_friction_without_limit_takes_a_ball_along_by_its_share(
    body: tr.Body, share: float, sign: int, method: str
) -> None:
    # P (1/m + a²/J) = Δu ends the slip: of it the centre gets k/(1 + k), with k = J/(m a²).
    run = run_of(on(moved(f"{0.5 * sign}*abs(t - 0.79)", "0.3*t", 0.0), body), method, velocity=(0.2, 0.1))
    jolt, jump = jolt_of(run), 1.0 * sign
    assert jolt.time == 0.79
    assert np.allclose(change(jolt), [share * jump, 0.0, 0.0], rtol=0, atol=EXACT)
    assert np.allclose(change(jolt, "angular_velocity"), [0.0, -(1 - share) * jump / A, 0.0], rtol=0, atol=EXACT / A)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("sign", [-1, 1])
def test_friction_with_a_limit_has_no_impulse_along_a_level_plane(sign: int, method: str) -> None:
    # Nothing presses harder at that instant. Then μ g takes the slip away in 2 s/(7 μ g).
    run = run_of(on(moved(f"{0.5 * sign}*abs(t - 0.5)", 0.0, 0.0), friction=0.2), method)
    jolt, grip = run.events
    assert (jolt.kind, grip.kind) == ("jolt", "grip")
    assert np.allclose(change(jolt), 0.0, rtol=0, atol=EXACT)
    assert abs(grip.time - 0.5 - 2 / (7 * 0.2 * G)) < EXACT
    assert np.allclose(grip.after.velocity, [sign * 2 / 7, 0.0, 0.0], rtol=0, atol=EXACT)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("restitution", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("friction", [None, 0.0, 0.3])
def test_a_floor_that_comes_up_throws_a_ball_off(friction: float | None, restitution: float, method: str) -> None:
    floor = on(moved(0.0, 0.0, "0.4*abs(t - 0.5)"), friction=friction, restitution=restitution)
    run = run_of(floor, method, 0.6, velocity=(0.3, 0.0))
    jolt = jolt_of(run)
    assert np.allclose(change(jolt), [0.0, 0.0, (1 + restitution) * 0.8], rtol=0, atol=EXACT)
    assert np.allclose(change(jolt, "angular_velocity"), 0.0, rtol=0, atol=EXACT)
    assert ("threw it off" in jolt.text) == (restitution > 0)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("friction", "restitution"), [(0.1, 0.0), (0.1, 0.5), (2.0, 0.5), (None, 0.5)])
def test_a_floor_that_strikes_askew(friction: float | None, restitution: float, method: str) -> None:
    # The impulse along it is 2/7 of what would stop the slip, or μ times the normal one where that is less.
    floor = on(moved("-0.7*abs(t - 0.5)", 0.0, "0.4*abs(t - 0.5)"), friction=friction, restitution=restitution)
    jolt = jolt_of(run_of(floor, method, 0.55))
    normal = (1 + restitution) * 0.8
    along = 2 / 7 * 1.4 if friction is None else min(2 / 7 * 1.4, friction * normal)
    assert np.allclose(change(jolt), [-along, 0.0, normal], rtol=0, atol=EXACT)


@pytest.mark.parametrize("method", METHODS)
def test_a_superball_is_thrown_back(method: str) -> None:
    # Of the slip it keeps −e_t: the impulse along the floor is (1 + e_t) times that which ends it [cross2002].
    rubber = {"friction": 2.0, "restitution": 1.0, "tangential_restitution": 0.6}
    jolt = jolt_of(run_of(on(moved("0.5*abs(t - 0.5)", 0.0, "0.4*abs(t - 0.5)"), **rubber), method, 0.55))
    assert np.allclose(change(jolt), [1.6 * 2 / 7, 0.0, 1.6], rtol=0, atol=EXACT)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("friction", [None, 0.3])
def test_a_floor_that_drops_away_leaves_a_ball_behind(friction: float | None, method: str) -> None:
    run = run_of(on(moved(0.0, 0.0, "-0.4*abs(t - 0.5)"), friction=friction), method, velocity=(0.3, 0.0))
    jolt, land = run.events
    assert jolt.before == jolt.after
    assert abs(land.time - 0.5 - 2 * 0.8 / G) < EXACT  # it falls after a floor that goes down at a steady 0.4 m/s
    assert np.allclose(land.after.velocity, [0.3, 0.0, -0.4], rtol=0, atol=EXACT)
    assert set(run.samples.phase[(run.samples.time > 0.5) & (run.samples.time < land.time)].tolist()) == {2}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("side", [-1, 1])
def test_a_tilt_with_a_kink_strikes_on_one_side_and_leaves_behind_on_the_other(side: int, method: str) -> None:
    run = run_of(on(tr.Tilt("0.2*abs(t - 0.3)"), friction=0.5, restitution=0.5), method, 0.31, position=(side * 0.4, 0))
    jolt = jolt_of(run)
    jump = -0.4 * jolt.contact[0]  # Δω × p, the plane just being level; of a ball on the falling side nothing is asked
    assert np.allclose(change(jolt), [0.0, 0.0, 1.5 * max(jump, 0.0)], rtol=0, atol=EXACT)
    assert ("struck" in jolt.text) == (side < 0)


@pytest.mark.parametrize("method", METHODS)
def test_a_tilt_with_a_kink_under_a_ball_on_its_axis_changes_nothing(method: str) -> None:
    run = run_of(on(tr.Tilt("0.2*abs(t - 0.3)", axis=(1, 0, 0)), friction=0.5), method, 0.3, position=(0.1, 0.0))
    assert not run.events or abs(run.events[0].before.position[1]) > 0


@pytest.mark.parametrize("method", METHODS)
def test_a_turntable_that_is_jerked(method: str) -> None:
    motion = tr.Combined((moved("0.5*abs(t - 0.5)", "-0.2*abs(2*t - 1)", 0.0), tr.SpinBy("2 + abs(t - 0.2)")))
    jolt = jolt_of(run_of(on(motion), method, position=(0.2, 0.1)))
    assert np.allclose(change(jolt), [2 / 7 * 1.0, 2 / 7 * -0.8, 0.0], rtol=0, atol=EXACT)
    assert abs(change(jolt, "angular_velocity")[2]) < EXACT


@pytest.mark.parametrize("method", METHODS)
def test_a_free_axle_that_is_jerked_is_turned_by_the_ball(method: str) -> None:
    # Slip ends where (1/m + a²/J) P + l (l·P)/I = Δu, the lever of the contact on the axle being l.
    inertia = 0.05
    motion = tr.Combined((moved("0.5*abs(t - 0.3)", 0.0, 0.0), tr.FreeAxle(inertia, rate=1.5)))
    jolt = jolt_of(run_of(on(motion), method, 0.6, position=(0.2, 0.1)))
    x, y, _ = jolt.contact - np.array([0.0, 0.0, 0.0])
    lever = np.array([-y, x])
    P = np.linalg.solve(np.eye(2) * 3.5 / M + np.outer(lever, lever) / inertia, [1.0, 0.0])
    assert np.allclose(change(jolt)[:2], P / M, rtol=0, atol=EXACT)
    assert abs(change(jolt, "support")[1] + lever @ P / inertia) < EXACT


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("sign", [-1, 1])
def test_a_body_that_is_no_ball_is_struck_by_one_impulse_at_its_contact(sign: int, method: str) -> None:
    leans = (np.cos(0.2), 0.1, np.sin(0.2), 0.3)
    motion = moved(f"{0.3 * sign}*abs(t - 0.2)", "0.1*abs(t - 0.2)", 0.0)
    jolt = jolt_of(run_of(on(motion, EGG), method, 0.25, orientation=leans, spin=3.0))
    P, rho = M * change(jolt), np.subtract(jolt.contact, jolt.before.position)
    q = tr.mechanics.algebra.Quaternion(*jolt.before.orientation)
    J = np.array([[float(x) for x in row] for row in EGG.inertia_in_space(q.matrix()).rows])
    assert np.allclose(J @ change(jolt, "angular_velocity"), np.cross(rho, P), rtol=0, atol=EXACT)
    slip = np.add(jolt.after.velocity, np.cross(jolt.after.angular_velocity, rho)) - [0.3 * sign, 0.1, 0.0]
    assert P[2] > -EXACT
    assert np.abs(slip[:2]).max() < EXACT  # nothing slips behind it; what the impulse throws off has come off
    assert slip[2] > -EXACT


@pytest.mark.parametrize("method", METHODS)
def test_a_slipping_body_goes_on_with_another_slip(method: str) -> None:
    system = on(moved("0.5*abs(t - 0.2)", 0.0, 0.0), friction=0.1)
    run = run_of(system, method, 2.0, velocity=(2.0, 0.0), angular_velocity=(0, 0, 0))
    jolt, grip = run.events
    slip = 2.5 - 0.1 * G * 3.5 * 0.2 - 1.0
    assert np.allclose(change(jolt), 0.0, rtol=0, atol=EXACT)
    assert abs(grip.time - 0.2 - 2 * slip / (7 * 0.1 * G)) < EXACT


@pytest.mark.parametrize("method", METHODS)
def test_a_body_at_rest_is_thrown_off_or_set_moving(method: str) -> None:
    loads = (tr.RollingResistance("2 mm"),)
    up = replace(on(moved(0.0, 0.0, "0.1*abs(t - 0.3)"), friction=0.3), loads=loads)
    run = run_of(up, method, velocity="co-rotating")
    assert [event.kind for event in run.events] == ["jolt"]
    assert set(run.samples.phase.tolist()) == {3}
    assert np.allclose(change(jolt_of(run)), [0.0, 0.0, 0.2], rtol=0, atol=EXACT)
    aside = replace(on(moved("0.1*abs(t - 0.3)", 0.0, 0.0), friction=0.3), loads=loads)
    run = run_of(aside, method, 2.0, velocity="co-rotating")
    assert [event.kind for event in run.events] == ["jolt", "grip", "stop"]
    assert np.allclose(run.samples.velocity[-1], [0.1, 0.0, 0.0], rtol=0, atol=EXACT)


@pytest.mark.parametrize("method", METHODS)
def test_a_flight_is_not_struck(method: str) -> None:
    system = on(moved("abs(t - 0.1)", 0.0, "0.1*abs(t - 0.1)"), friction=0.3)
    run = run_of(system, method, 0.2, velocity=(0.5, 0.0, 0.0), height=1.0)
    assert run.events == ()
    assert np.allclose(run.samples.velocity[-1], [0.5, 0.0, -G * 0.2], rtol=0, atol=EXACT)


@pytest.mark.parametrize("text", ["0.5*abs(t - 1)", "0.5*abs(1 - t)", "0.5*abs(-(t - 1))", "0.25*abs(t*t - 1) + 0*t"])
@pytest.mark.parametrize("end", [1.0, 1.5])
def test_the_sample_at_the_very_instant_is_that_after_it(text: str, end: float) -> None:
    run = run_of(on(moved(text, 0.0, 0.0)), duration=end)
    jolt = jolt_of(run)
    assert jolt.time == 1.0
    assert np.array_equal(run.data.velocity.sel(time=1.0), jolt.after.velocity)


def test_a_run_that_begins_at_a_kink_begins_behind_it() -> None:
    run = run_of(on(moved("0.5*abs(1 - t)", 0.0, 0.0)), time=1.0)
    assert run.events == ()


def test_jumps_at_one_instant_are_one_jolt() -> None:
    # One after the other they would throw the ball off before the floor jerks aside.
    motion = moved("0.3*abs(3*t - 0.3)", "0.3*abs(t - 0.1)", "0.3*abs(sin(t - 0.1))")
    jolt = jolt_of(run_of(on(motion, friction=5.0, restitution=0.5), duration=0.12))
    assert np.allclose(change(jolt), [2 / 7 * 1.8, 2 / 7 * 0.6, 0.9], rtol=0, atol=EXACT)


@pytest.mark.parametrize("method", METHODS)
def test_an_acceleration_that_jumps_is_no_jolt_but_may_break_the_contact(method: str) -> None:
    # The rim of the table speeds up by 32 r from then on, of which 2/7 is more than μ g.
    faster = on(tr.SpinBy("5 + 2*t + 15*(abs(t - 0.5) + t - 0.5)"), friction=0.1)
    slip = run_of(faster, method, 0.8, position=(0.3, 0.0)).events[0]
    assert (slip.kind, slip.time) == ("slip", 0.5)
    # A floor that goes down faster than a ball falls.
    falls = on(moved(0.0, 0.0, "-8*(t - 0.5)*(abs(t - 0.5) + t - 0.5)"), friction=0.3)
    run = run_of(falls, method, 0.8)
    assert [(event.kind, event.time) for event in run.events] == [("lift", 0.5)]
    assert abs(run.samples.position[-1, 2] - A + 0.5 * G * 0.09) < EXACT


def test_no_closed_form_takes_a_jolt() -> None:
    for system in (on(moved("0.5*abs(t - 0.5)", 0.0, 0.0)), on(tr.Tilt("0.2*abs(t - 0.5)"))):
        assert closed_form(system, system.place()) is None
        assert tr.simulate(system, system.place((0.1, 0.0)), 1.0, 0.5).method == "taylor"


def test_many_members_are_jolted_one_by_one() -> None:
    system = on(moved("0.5*abs(t - 0.5)", 0.0, 0.0))
    starts = [system.place(velocity=(v, 0.0)) for v in (0.0, 0.4)]
    runs = tr.simulate_many(system, starts, 1.0, 0.25)
    assert runs.events.values.tolist() == [1, 1]
    assert np.allclose(runs.velocity[:, -1, 0], [2 / 7, 0.4 + 2 / 7], rtol=0, atol=EXACT)


def test_a_check_takes_the_parts_before_and_behind_a_jolt() -> None:
    system = on(moved("0.5*abs(t - 1)", 0.0, 0.0))
    data = run_of(system, duration=2.0, every=0.01, velocity=(0.2, 0.1)).data
    with pytest.raises(InvalidValueError, match="with a jump at 1 s"):
        tr.check(data, system)
    for part in (data.sel(time=slice(0.0, 0.995)), data.sel(time=slice(0.995, 2.0))):
        assert tr.check(part, system).passed


@pytest.mark.parametrize("text", ["abs(t - 1)/(t - 1)", "(t - 1)/sqrt((t - 1)**2)", "sign(t - 1)", "heaviside(t)"])
def test_a_place_that_jumps_is_refused(text: str) -> None:
    with pytest.raises(InvalidValueError, match="must be"):
        tr.simulate(on(moved(text, 0.0, 0.0)), on(tr.Fixed()).place(), 2.0, 0.5)


@pytest.mark.parametrize("system", [
    on(moved("0.5*abs(t - 0.2)", 0.0, 0.0)),
    on(tr.Tilt("0.2*abs(t - 0.2)", axis=(0, 0, 1)), EGG),
    on(moved(0.0, 0.0, "0.2*abs(t - 0.2)"), EGG, friction=0.3),
])  # fmt: skip
def test_the_card_tells_a_jolt_that_was_missed(system: tr.RollingSystem, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kinks, "_jumps", lambda *_: False)
    run = tr.simulate(system, system.place((0.2, 0.0)), 0.3, 0.05)
    assert not run.card()["events at their instants"].passed
