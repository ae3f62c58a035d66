"""Periodic orbits, their multipliers and their bifurcations against closed formulas."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.chaos.bouncing import Bouncing, G

import trundle as tr

BALL = tr.Body.solid_sphere(0.025, 0.065)


def raised(state: tr.State, factor: float) -> tr.State:
    return replace(state, position=(0.0, 0.0, state.position[2] * factor))


@pytest.mark.parametrize(("restitution", "Gamma"), [(0.5, 1.3), (0.8, 0.6), (0.3, 2.3)])
def test_a_bounce_in_step_with_the_table_has_the_multipliers_of_the_formula(restitution, Gamma):
    bouncing = Bouncing(restitution, Gamma)
    found = tr.periodic_orbit(bouncing.system, raised(bouncing.start, 1.001), period=bouncing.period)
    assert found.driven
    assert found.events == 1
    assert np.allclose(found.state.position, bouncing.start.position, rtol=0, atol=1e-10)
    assert np.allclose(np.sort_complex(found.multipliers)[:2], bouncing.multipliers, rtol=0, atol=1e-9)
    assert found.free == 10
    stable = abs(bouncing.multipliers).max() < 1
    assert found.verdict == ("stable" if stable else "unstable")


def test_its_fold_and_its_period_doubling_are_where_the_formula_has_them():
    """Γ = πn(1 − e)/(1 + e), and √(that² + (2(1 + e²)/(1 + e)²)²) [guckenheimer1983, section 2.4]."""
    bouncing = Bouncing(0.5, 1.3)
    unit = G / bouncing.rate**2
    orbit = tr.periodic_orbit(bouncing.system, bouncing.start, period=bouncing.period)
    branch = orbit.along("support.motion.amplitude.z", 1.0 * unit, 1.7 * unit, step=0.1)
    assert np.allclose(branch.folds, [Bouncing.least(0.5) * unit], rtol=1e-9)
    assert np.allclose(branch.period_doublings, [Bouncing.doubling(0.5) * unit], rtol=1e-9)
    assert branch.values[0] > 1.7 * unit  # round the fold, along the other branch
    assert branch.orbits[0].verdict == "unstable"
    assert branch.stopped == ("the end that was asked for", "the end that was asked for")
    assert branch.plot().axes
    assert len(branch.as_dict()["values"]) == len(branch.orbits)
    other = replace(bouncing, Gamma=float(branch.values[0]) / unit, upper=True)
    assert np.allclose(np.sort(np.real(branch.orbits[0].multipliers))[[0, -1]], np.real(other.multipliers), rtol=1e-8)


def test_behind_the_doubling_there_is_an_orbit_of_twice_the_period():
    bouncing = Bouncing(0.5, 1.02 * Bouncing.doubling(0.5))
    run = tr.simulate(bouncing.system, raised(bouncing.start, 1.01), 400 * bouncing.period, 400 * bouncing.period)
    last = run.data.isel(time=-1)
    settled = replace(bouncing.start, position=tuple(last.position.values), velocity=tuple(last.velocity.values))
    found = tr.periodic_orbit(bouncing.system, settled, period=2 * bouncing.period)
    assert found.events == 2
    assert found.verdict == "stable"
    assert abs(found.state.position[2] - bouncing.start.position[2]) > 1e-5


def test_a_swing_in_a_trough_has_the_period_of_a_pendulum_by_an_elliptic_integral():
    from scipy.special import ellipk

    trough = tr.RollingSystem(BALL, tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    for angle in (0.4, -0.9):
        found = tr.periodic_orbit(trough, trough.place(position=(angle, 0.0)), period=1.7)
        lean = math.asin(found.state.position[1] / 0.475)
        speed = math.hypot(*found.state.velocity)
        lean = math.acos(math.cos(lean) - 1.4 * speed**2 / (2 * G * 0.475))  # where it turns round
        expected = 4 * math.sqrt(1.4 * 0.475 / G) * ellipk(math.sin(lean / 2) ** 2)
        assert not found.driven
        assert math.isclose(found.period, expected, rel_tol=1e-9)
        assert found.residual < 1e-9


def test_the_table_is_told_from_its_rate_where_the_period_changes_with_it():
    bouncing = Bouncing(0.5, 1.3)

    def period(system):
        return 2 * math.pi / system.support.motion.rate

    orbit = tr.periodic_orbit(bouncing.system, bouncing.start, period=period)
    branch = orbit.along("support.motion.rate", 0.95 * bouncing.rate, 1.05 * bouncing.rate)
    for value, one in zip(branch.values, branch.orbits, strict=True):
        assert math.isclose(one.period, 2 * math.pi / value, rel_tol=1e-12)


@pytest.mark.parametrize(
    ("given", "said"),
    [({}, "period"), ({"period": "-1 s"}, "period"), ({"period": "0.3 s"}, "No motion that closes|comes back")],
)
def test_what_is_no_orbit_is_refused_in_words(given, said):
    plane = tr.RollingSystem(BALL, tr.Support(tr.Plane(), tilt=0.1))
    with pytest.raises(tr.TrundleError, match=said):
        tr.periodic_orbit(plane, plane.place(), **given)


def test_a_motion_over_the_rim_does_not_come_back():
    plane = tr.RollingSystem(BALL, tr.Support(tr.Plane(rim=0.1)))
    with pytest.raises(tr.SolverError, match="does not come back"):
        tr.periodic_orbit(plane, plane.place(velocity=(0.5, 0.0)), period=1.0)


def test_a_number_that_is_not_there_is_answered_with_those_that_are():
    trough = tr.RollingSystem(BALL, tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    orbit = tr.periodic_orbit(trough, trough.place(position=(0.1, 0.0)), period=1.7)
    with pytest.raises(tr.UnknownNameError, match=r"support\.tilt"):
        orbit.along("tilt")
    with pytest.raises(tr.InvalidValueError, match="about what"):
        orbit.along("gravity", 20.0, 30.0)


def test_what_stands_still_has_no_period():
    bowl = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.5)))
    with pytest.raises(tr.SolverError, match="stands still"):
        tr.periodic_orbit(bowl, bowl.place(), period=1.0)
