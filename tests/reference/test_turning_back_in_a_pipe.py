"""A ball in an upright pipe that rocks about its axis: where it turns back nothing presses it on, and it stays.

Round the axis, θ, the pipe's wall drags the ball: m v̇ = F and k m r ω̇ = F with v + r ω = R φ̇ at the contact, so that
v̇ = R φ̈ k/(1 + k), v = (R − r) θ̇. The wall pushes with N = m v²/(R − r), which touches zero where v changes its sign.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.tolerances import SOLVER

import trundle as tr
from trundle.solve.methods import tolerance_of

RADIUS, ROCKS, PACE, K = 0.25, 0.7, 3.0, 0.4  # m, rad, rad/s, I/(m r²)


def rolled(radius: float, drift: float, phase: float, method: str, *loads: tr.Load) -> tr.Trajectory:
    """Return a run of 5 s in which v is that of the wall's drag and a drift, a share of its fastest."""
    if method == "taylor":
        pytest.importorskip("heyoka")
    rocking = tr.Rock(ROCKS, PACE, phase=phase, axis=(0.0, 0.0, 1.0))
    pipe = tr.Support(tr.Cylinder(RADIUS), motion=rocking)
    system = tr.RollingSystem(tr.Body.solid_sphere(radius, 0.4), pipe, loads=loads)
    return tr.simulate(system, system.place((0.0, 0.0), (swing() * (math.cos(phase) + drift), 0.0)), 5.0, 0.01, method)


def swing() -> float:
    """Return the fastest that the pipe's swing makes the ball, m/s."""
    return RADIUS * ROCKS * PACE * K / (1 + K)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize(("drift", "phase"), [(0.0, 0.3), (0.5, 0.3), (-0.9, 2.0), (0.999, -1.0)])
@pytest.mark.parametrize("radius", [0.03, 0.1])
def test_a_ball_that_turns_back_rolls_on(radius: float, drift: float, phase: float, method: str) -> None:
    ours = rolled(radius, drift, phase, method)
    assert not ours.events
    t = ours.samples.time
    angle = np.unwrap(np.arctan2(ours.samples.position[:, 1], ours.samples.position[:, 0]))
    turned = swing() / (RADIUS - radius) * ((np.sin(PACE * t + phase) - math.sin(phase)) / PACE + drift * t)
    np.testing.assert_allclose(angle - angle[0], turned, rtol=0.0, atol=SOLVER(1000, tolerance_of(method)))
    assert ours.card().passed


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
@pytest.mark.parametrize("share", [1e-9, 1e-6])
@pytest.mark.parametrize("outwards", [1, -1])
def test_a_ball_that_is_pulled_off_where_it_turns_back_comes_off(outwards: int, share: float, method: str) -> None:
    radius, phase = 0.03, 0.3
    turns = (math.pi / 2 - phase) / PACE
    placed = rolled(radius, 0.0, phase, method).start.position
    where = math.atan2(placed[1], placed[0]) + swing() / (RADIUS - radius) * (1 - math.sin(phase)) / PACE
    force = outwards * share * 0.4 * 9.80665
    pulled = rolled(radius, 0.0, phase, method, tr.Force((force * math.cos(where), force * math.sin(where), 0.0)))
    assert [event.kind for event in pulled.events[:1]] == ["lift"] * (outwards < 0)
    # As much below zero as the square is above it: v² = |F| (R − r)/m.
    early = math.sqrt(share * 9.80665 * (RADIUS - radius)) / (swing() * PACE)
    for lift in pulled.events[:1]:
        assert lift.time == pytest.approx(turns - early, abs=early / 10)
