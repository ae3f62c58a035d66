"""A flight goes past focal points of its support, such as the centre of a bowl, as if nothing were there.

It ended there, with the event `curved`: from there on another point of the support is nearest to the body. Held against
parabolas.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import trundle as tr
from trundle.mechanics.system import STANDARD_GRAVITY as G
from trundle.solve import contact_state, focal

pytest.importorskip("heyoka")

A = 0.02  # m
BALL = tr.Body.solid_sphere(A, 0.1)
EGG = tr.Body.ellipsoid((0.02, 0.025, 0.03), 0.1)
HOLLOW: dict[str, Any] = {
    "bowl": tr.Bowl(0.5),
    "ellipsoidal bowl": tr.EllipsoidalBowl((0.5, 0.4, 0.6)),
    "paraboloid": tr.Paraboloid(0.2),
    "valley": tr.HeightField("x**2 + y**2/4"),
}
METHODS = ("auto", "taylor", "runge-kutta")


def on(surface: Any, body: tr.Body = BALL, **given: Any) -> tr.RollingSystem:
    return tr.RollingSystem(body, tr.Support(surface, friction=0.3, restitution=0.5, **given))


def checked(run: tr.Trajectory) -> tr.Trajectory:
    assert run.card().passed, str(run.card())
    return run


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("surface", HOLLOW)
@pytest.mark.parametrize("body", [BALL, EGG], ids=["ball", "egg"])
@pytest.mark.parametrize("method", METHODS)
def test_what_is_thrown_straight_up_comes_straight_down(surface: str, body: tr.Body, method: str) -> None:
    system = on(HOLLOW[surface], body)
    speed = 4.0
    run = checked(tr.simulate(system, system.place((0.0, 0.0), (0.0, 0.0, speed)), 0.9, 0.05, method=method))
    assert [event.kind for event in run.events] == ["land"]
    assert abs(run.events[0].time - 2 * speed / G) <= 1e-12
    flies = run.samples.time < run.events[0].time
    t = run.samples.time[flies]
    apart = run.samples.position[flies] - run.samples.position[0] - np.outer(speed * t - G * t * t / 2, (0, 0, 1))
    assert np.abs(apart).max() <= 1e-13


@pytest.mark.parametrize(("offset", "side"), [(1e-12, 1), (1e-9, -1), (1e-6, 1), (1e-4, -1), (1e-3, 1), (1e-2, -1)])
@pytest.mark.parametrize("method", METHODS)
def test_what_passes_near_the_centre_of_a_bowl_lands_where_its_parabola_meets_it(
    offset: float, side: int, method: str
) -> None:
    R, speed = 0.5, 3.9
    system = on(tr.Bowl(R))
    run = checked(tr.simulate(system, system.place((side * offset, 0.0), (0.0, 0.0, speed)), 0.85, 0.05, method=method))
    (x, _, z), (v, _, w) = run.samples.position[0], run.samples.velocity[0]  # off the surface, straight

    def gap(t: float) -> float:
        return R - A - math.hypot(x + v * t, z + w * t - G * t * t / 2 - R)

    landed = brentq(gap, 0.7, 0.85, xtol=1e-15, rtol=1e-15)
    assert run.events[0].kind == "land"
    assert abs(run.events[0].time - landed) <= 1e-12
    flies = run.samples.time < landed  # and all the while the nearest point is straight behind it, seen from the centre
    seen, touched = (places[flies] - (0.0, 0.0, R) for places in (run.samples.position, run.samples.contact))
    far = np.linalg.norm(seen, axis=1)
    assert np.abs(touched - seen * (R / far)[:, None])[far > 1e-4].max() <= 1e-11


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("every", [0.1, 0.04])
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("tube", [tr.Cylinder(0.5), tr.Bowl(0.5), tr.TorusTrack(2.0, 0.5)], ids=repr)
@pytest.mark.parametrize("along", [0.0, 0.3])
def test_a_sample_on_the_focal_point_has_one_of_the_points_that_are_nearest(
    tube: Any, method: str, every: float, along: float
) -> None:
    """At 0.12 s it is in the middle, at 0.24 s on the other side, and at half the speed it is back at 0.72 s."""
    system = tr.RollingSystem(BALL, tr.Support(tube, friction=0.3, restitution=0.5), gravity=0.0)
    speed = 4.0 if along == 0 or isinstance(tube, tr.Cylinder) else math.hypot(4.0, along)
    start = system.place((0.0, 0.0), (0.0, along if isinstance(tube, tr.Cylinder) else 0.0, speed))
    run = checked(tr.simulate(system, start, 0.8, every, method=method))
    assert [event.kind for event in run.events] == ["land", "land"]
    np.testing.assert_allclose([event.time for event in run.events], np.array([0.96, 2.88]) / speed, rtol=1e-12)
    here = run.samples.time < run.events[0].time
    reach = np.linalg.norm(run.samples.contact[here] - run.samples.position[here], axis=1)
    np.testing.assert_allclose(reach, 0.5 - np.abs(0.48 - speed * run.samples.time[here]), rtol=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_a_cylinder_falls_across_a_pipe_through_its_axis(method: str) -> None:
    pipe = tr.Support(tr.Cylinder(0.5), tilt="90 deg", friction=0.6)
    system = tr.RollingSystem(tr.Body.cylinder(0.03, 0.2), pipe)
    start = system.place((math.pi, -0.56), (0.0, 0.0))
    run = checked(tr.simulate(system, start, 1.0, 0.1, method=method))
    assert [event.kind for event in run.events] == ["lift", "land"]
    assert abs(run.events[1].time - math.sqrt(2 * 0.94 / G)) <= 1e-12


@pytest.mark.parametrize("spin", [(0.0, 0.0, 30.0), (20.0, 10.0, 5.0), (-300.0, 200.0, 100.0)])
@pytest.mark.parametrize("surface", HOLLOW)
def test_what_tumbles_past_lands_at_one_instant_by_both_methods(surface: str, spin: tuple[float, float, float]) -> None:
    system = on(HOLLOW[surface], EGG)
    start = system.place((0.0, 0.0), (0.0, 0.0, 4.0), angular_velocity=spin)
    ours, theirs = (checked(tr.simulate(system, start, 0.83, 0.05, method=method)) for method in METHODS[1:])
    assert ours.events[0].kind == "land"
    assert abs(ours.events[0].time - theirs.events[0].time) <= 1e-11
    assert ours.events[0].time > 0.8


def test_many_at_once_pass_as_each_alone_does() -> None:
    system = on(tr.Bowl(0.5))
    starts = [system.place((x, 0.0), (0.0, 0.0, v)) for x, v in ((0.0, 4.0), (1e-9, 4.0), (1e-6, 3.9), (0.1, 4.0))]
    together = tr.simulate_many(system, starts, 1.0, 0.05)
    for member, start in enumerate(starts):
        alone = tr.simulate(system, start, 1.0, 0.05, method="taylor")
        assert together.ending.values[member] == ""
        assert float(abs(together.position[member] - alone.data.position).max()) <= 1e-14
        assert together.events.values[member] == len(alone.events)


@pytest.mark.parametrize("offset", [0.0, 1e-6, 1e-3])
def test_derivatives_go_past_too(offset: float) -> None:
    text = f"""
    body = {{ kind = "solid-sphere", radius = {A}, mass = 0.1 }}
    support = {{ kind = "bowl", radius = 0.5, friction = 0.3, restitution = 0.5 }}
    start = {{ position = [{offset}, 0.0], velocity = [0.0, 0.0, 4.0] }}
    run = {{ duration = 0.9, every = 0.05 }}
    """
    found = tr.sensitivities(tr.Scenario.loads(text), wrt=["start.velocity[2]"])
    assert float(found["event_time"][0, 0]) == pytest.approx(2 / G, rel=1e-3 if offset > 1e-4 else 1e-5)


def test_a_disc_that_touches_where_the_bowl_is_as_round_ends_there_still(through_walls: None) -> None:  # noqa: ARG001
    """It is no flight that ends there: nothing is clear of it."""
    bowl = tr.Support(tr.EllipsoidalBowl((0.766638, 0.274539, 0.141292)), friction=0.069146)
    system = tr.RollingSystem(tr.Body.disc(0.0118513, thickness=0.0302067, density=1234.96), bowl)
    start = system.place((0.104954, 0.0123729), velocity=(0.0676024, -0.0997183, 0.125977), height=0.0257207)
    run = tr.simulate(system, start, 2.0, 0.02)
    assert [event.kind for event in run.events] == ["land", "curved"]


def test_where_no_point_is_nearest_again_few_are_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a ball in a narrow cone: each search takes ten milliseconds, and there were five hundred."""
    text = """
    run = { duration = 2.0, every = 0.02 }
    [support]
    kind = "cone"
    half_angle = 0.0364117
    rim = 0.769311
    tilt = 0.0196795
    motion = { kind = "precessing-tilt", angle = 0.0307107, rate = 0.0 }
    [body]
    kind = "hemisphere"
    radius = 0.0696214
    density = 7133.92
    moments = [2.71943e-05, 2.92599e-05, 2.9794e-05]
    centre = [-0.0198483, -0.0159255, 0.0]
    [start]
    position = [-0.259523, 0.0]
    orientation = [-0.520199, 0.0316677, -0.526761, -0.0944973]
    """
    searches, past_it, contact_of = [0], focal.past_it, contact_state.contact_of
    counts = list[int]()

    def searched(*given: Any) -> Any:
        searches[0] += 1
        return contact_of(*given)

    def counted(*given: Any) -> Any:
        searches[0] = 0
        found = past_it(*given)
        counts.append(searches[0])
        return found

    monkeypatch.setattr(contact_state, "contact_of", searched)
    monkeypatch.setattr(focal, "past_it", counted)
    run = tr.Scenario.loads(text).run()
    assert [event.kind for event in run.events] == ["lift", "curved"]
    assert counts
    assert max(counts) <= 10


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_no_flight_goes_on_over_what_lies_beyond_the_rim(method: str) -> None:
    """Past the focal point of a dish the nearest point would be where the dish has ended."""
    run = tr.Scenario.loads("""
run = { duration = 2.0, every = 0.00543881 }
[body]
kind = "ellipsoid"
semi_axes = [0.0224594, 0.158547, 0.0765165]
mass = 0.022957
moments = [1.3092e-05, 1.38492e-05, 2.61917e-05]
turn = "-90 deg"
[support]
kind = "paraboloid"
radius = 0.273181
rim = 0.283512
friction = 0.024994
motion = { kind = "spin", rate = -3.3672 }
[start]
position = [-0.00420703, 0.0125676]
velocity = [-0.0599773, -1.3438]
orientation = [-0.21109, 0.587692, 0.0, -0.205405]
""").run(method)
    assert (np.hypot(*run.in_frame("support").data.contact.values[:, :2].T) < 0.283512).all()
    assert run.card().passed
