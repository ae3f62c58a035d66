"""Flights that all but graze the support: how long they last by a parabola, and what a card may say of them.

What leaves a loop of radius L about its centre, its speed v with v² = gL sin α at the height L sin α, falls on it again
after 4v cos α/g; near the top it comes down almost along the loop, and a rounding of the gap moves the landing far.
"""

from __future__ import annotations

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.methods import Method, tolerance_of
from trundle.verify.bounds import sizes_of, turned_in
from trundle.verify.compared import Compared

G, A, B = 9.81, 0.02, 0.5
ARM = B - A
BODIES = {
    "solid ball": (tr.Body.solid_sphere(A, 1.0), mpf(2) / 5),
    "shell": (tr.Body.hollow_sphere(A, 1.0), mpf(2) / 3),
    "hoop": (tr.Body.hoop(A, 1.0), mpf(1)),
}


def loop(name: str, short: float, method: str) -> tuple[tr.Trajectory, mpf, mpf]:
    """Return the run of a body too slow by a share of what the top of the loop takes, and lift-off and flight in s.

    (1+k)(v₀² − v²)/2 = gL(1 + sin α) with v² = gL sin α; the climb is an integral over the angle.
    """
    body, k = BODIES[name]
    with mpmath.workdps(40):
        g, arm = mpf(G), mpf(B) - mpf(A)
        v0 = float(mpmath.sqrt(g * arm * (5 + k) * (1 - mpf(short)) / (1 + k)))
        sine = ((1 + k) * mpf(v0) ** 2 / (2 * g * arm) - 1) * 2 / (3 + k)
        angle, v = mpmath.asin(sine), mpmath.sqrt(g * arm * sine)
        rate = lambda turn: mpmath.sqrt(mpf(v0) ** 2 - 2 * g * arm * (1 - mpmath.cos(turn)) / (1 + k)) / arm  # noqa: E731
        up = mpmath.quad(lambda turn: 1 / rate(turn), mpmath.linspace(0, mpmath.pi / 2 + angle, 9))
        flight = 4 * v * mpmath.cos(angle) / g
    system = tr.RollingSystem(body, tr.Support(tr.Cylinder(B), tilt="90 deg"), gravity=G)
    return tr.simulate(system, system.place((0.0, 0.0), (v0, 0.0)), 1.0, 0.02, method=method), up, flight


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("short", [1e-9, 1e-7, 1e-5, 1e-3, 1e-1])
@pytest.mark.parametrize("name", BODIES)
def test_a_loop_hardly_missed(name: str, short: float, method: str) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    ours, up, flight = loop(name, short, method)
    lift, land, *_ = ours.events
    assert (lift.kind, land.kind) == ("lift", "land")
    # sin α errs as the speed does, and cos α by as much over cos α.
    steep = float(flight) * G / 4 / math.sqrt(G * ARM)
    error = EXACT(32, 1.0) + SOLVER(100, tolerance_of(method), 1.0)
    assert lift.time == pytest.approx(float(up), abs=error / steep)
    # It came down where the gap was a rounding.
    closing = float(-np.dot(np.subtract(land.after.velocity, land.before.velocity), _inward(land)))
    assert land.time - lift.time == pytest.approx(float(flight), abs=4 * error / steep + EXACT(8, ARM) / abs(closing))
    assert ours.card().passed, ours.card().failures


def _inward(event: tr.Event) -> np.ndarray:
    place = np.array([*event.before.position])
    place[1] = 0.0
    return place / np.linalg.norm(place)


def test_a_landing_that_comes_down_fast_is_held_to_its_instant() -> None:
    pytest.importorskip("heyoka")
    ours, _, _ = loop("solid ball", 1e-1, "taylor")
    samples = ours.samples
    late = tuple(replace(event, time=event.time + (1e-7 if event.kind == "land" else 0.0)) for event in samples.events)
    method = Method.of("taylor")
    both = Compared(
        ours.system,
        ours.start,
        samples,
        replace(samples, events=late),
        method,
        method,
        sizes_of(ours.system, samples),
        turned_in(samples),
    )
    assert not both.figure("again", both.share, both.bound, "").passed


def test_a_disc_that_touches_with_its_edge_as_it_flies_past() -> None:
    """A disc turned by a torque without gravity, whose edge comes down at 1e-9 of its own speed: cannot be told."""
    pytest.importorskip("heyoka")
    turning = 0.1 * 9.80665 * 0.05 * math.sin(math.radians(20))
    run = tr.Scenario.read(
        {
            "gravity": 0,
            "body": {"kind": "disc", "radius": "50 mm", "mass": "100 g"},
            "support": {"kind": "plane", "tilt": "20 deg"},
            "start": {"position": [0.0, 0.0], "spin": "16 rad/s", "attitude": ["0 deg", "90 deg", "0 deg"]},
            "loads": [{"kind": "torque", "value": [f"-{turning!r}*sin(32*t)", f"-{turning!r}*(1 - cos(32*t))", 0]}],
            "run": {"duration": 3.0, "every": 0.02},
        }
    ).run()
    assert run.card().passed, run.card().failures
