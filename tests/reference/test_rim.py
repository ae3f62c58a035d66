"""Running off the rim: the instant against many digits, and circles that only just stay or only just leave."""

from __future__ import annotations

import functools
import itertools
import math
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from tests.reference.t5 import Ball
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.methods import tolerance_of

A, M, G = 0.025, 0.065, 9.80665
METHODS = ["exact", "taylor", "runge-kutta"]


@pytest.fixture(params=METHODS)
def method(request: pytest.FixtureRequest) -> str:
    if request.param == "taylor":
        pytest.importorskip("heyoka")
    return request.param


def system_of(rate: float, tilt: float, drag: float, rim: float) -> tr.RollingSystem:
    support = tr.Support(tr.Plane(rim=rim), motion=tr.Spin(rate) if rate else tr.Fixed(), tilt=tilt)
    return tr.RollingSystem(tr.Body.solid_sphere(A, M), support, loads=(tr.Drag(drag),) if drag else ())


def exit_of(ours: tr.Trajectory) -> float:
    (event,) = ours.events
    assert event.kind == "rim"
    assert ours.data.time.values[-1] == event.time
    return event.time


CASES = {
    "level circle": (3.5, 0.0, 0.0, 0.35, (0.1, 0.0), (0.3, 0.1)),
    "tilted cycloid": (8.0, 0.05, 0.0, 0.4, (0.1, 0.0), (0.1, -0.1)),
    "fixed slope, up and over": (0.0, 0.1, 0.0, 0.3, (0.25, 0.0), (-0.5, 0.05)),
    "with drag": (3.5, 0.03, 0.01, 0.5, (0.1, 0.0), (0.3, 0.1)),
    "through the axis": (0.0, 0.0, 0.0, 0.3, (-0.2, 0.0), (0.25, 0.0)),
}


@functools.cache
def first_exit(name: str) -> tuple[Any, float]:
    """Return the first time at which |ζ| = rim, looked for closely and then refined in many digits, and the speed."""
    rate, tilt, drag, rim, position, velocity = CASES[name]
    ball = Ball(A, M, 0.4, rate, position, velocity, force=(M * G * math.sin(tilt), 0.0, 0.0), drag=drag)
    times = np.linspace(0.0, 20.0, 2001)
    inside = (abs(ball.at(t)["position"].value) < rim for t in times)
    last = sum(1 for _ in itertools.takewhile(bool, inside)) - 1

    def excess(t: Any) -> Any:
        return abs(ball.at(t)["position"].value) - mpf(rim)

    with mpmath.workdps(40):
        ends = (mpf(times[last]), mpf(times[last + 1]))
        found = mpmath.findroot(excess, ends, solver="anderson", tol=1e-60)
    return found, float(abs(ball.at(found)["velocity"].value))


@pytest.mark.parametrize("name", CASES)
def test_the_instant_at_the_rim(name: str, method: str) -> None:
    rate, tilt, drag, rim, position, velocity = CASES[name]
    system = system_of(rate, tilt, drag, rim)
    ours = tr.simulate(system, system.place(position, velocity), duration=20.0, every=0.01, method=method)
    wanted, speed = first_exit(name)
    turned = speed / A * float(wanted)
    slack = EXACT(64, 1 + float(wanted)) + SOLVER(20 * (1 + turned), tolerance_of(method), rim / speed)
    assert abs(exit_of(ours) - wanted) <= slack
    edge = np.hypot(*ours.data.contact.values[-1, :2])
    assert abs(edge - rim) <= EXACT(64, rim) + SOLVER(20 * (1 + turned), tolerance_of(method), rim)
    assert (np.hypot(*ours.data.contact.values[:-1, :2].T) < rim).all()


# A circle of radius ϱ about c reaches |c| + ϱ, and there the ball runs along the rim.
KAPPA = 3.5 * (2 / 7)
CENTRE, RADIUS = 0.1, 0.2


def grazing(rim: float, method: str) -> tr.Trajectory:
    """Start on the near side of the circle, half a circle before the place farthest from the axis."""
    system = system_of(3.5, 0.0, 0.0, rim)
    start = system.place((CENTRE - RADIUS, 0.0), (0.0, -KAPPA * RADIUS))
    return tr.simulate(system, start, duration=3 * 2 * math.pi / KAPPA, every=0.05, method=method)


def test_a_circle_that_only_just_stays(method: str) -> None:
    over = 1e-9 if method != "runge-kutta" else 1e-7
    ours = grazing((CENTRE + RADIUS) * (1 + over), method)
    assert ours.events == ()
    assert ours.data.time.values[-1] == pytest.approx(6 * math.pi / KAPPA)


@pytest.mark.parametrize("depth", [1e-9, 1e-6, 1e-3])
def test_a_circle_that_only_just_leaves(method: str, depth: float) -> None:
    depth = max(depth, 1e-7 if method == "runge-kutta" else 0.0)  # DOP853 at 1e-12 is off by some 1e-10
    rim = (CENTRE + RADIUS) * (1 - depth)
    # |ζ|² = c² + ϱ² + 2cϱ cos(κt − π) = rim²
    with mpmath.workdps(40):
        angle = mpmath.acos((mpf(rim) ** 2 - mpf(CENTRE) ** 2 - mpf(RADIUS) ** 2) / (2 * mpf(CENTRE) * mpf(RADIUS)))
        wanted = (mpmath.pi - angle) / mpf(KAPPA)
    ours = grazing(rim, method)
    # d|ζ|/dt there is only of the order √depth.
    outward = KAPPA * CENTRE * RADIUS * math.sin(float(angle)) / rim
    place = EXACT(16, rim) + SOLVER(200, tolerance_of(method), rim)
    assert abs(exit_of(ours) - wanted) <= place / outward + EXACT(16, float(wanted))


def test_the_rim_is_reached_once_by_a_ball_that_leaves_and_would_come_back(method: str) -> None:
    # Up the slope over the rim and down again: the first crossing counts, though every sample might be inside.
    system = system_of(0.0, 0.2, 0.0, 0.3)
    start = system.place((0.0, 0.0), (-math.sqrt(2 * 5 / 7 * G * math.sin(0.2) * 0.3 * (1 + 1e-6)), 0.0))
    ours = tr.simulate(system, start, duration=1.2, every=0.6, method=method)
    slowing, v = 5 / 7 * G * math.sin(0.2), -start.velocity[0]
    outward = math.sqrt(v * v - 2 * slowing * 0.3)  # what is left of the speed at the rim
    place = EXACT(16, 0.3) + SOLVER(200, tolerance_of(method), 0.3)
    assert abs(exit_of(ours) - (v - outward) / slowing) <= place / outward


def test_it_says_when_and_where(method: str) -> None:
    system = system_of(3.5, 0.0, 0.0, 0.35)
    ours = tr.simulate(system, system.place((0.1, 0.0), (0.3, 0.1)), duration=20.0, every=0.01, method=method)
    assert "0.35 m" in ours.events[0].text
    assert f"{ours.events[0].time:.6g}"[:6] in ours.events[0].text
    assert "ran off the rim" in repr(ours)
    assert abs(math.hypot(*ours.events[0].contact) - 0.35) <= EXACT(64, 0.35) + SOLVER(200, tolerance_of(method), 0.35)
