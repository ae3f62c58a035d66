"""Poincaré sections against instants that are known by formula."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.chaos.bouncing import Bouncing, G

import trundle as tr

BALL = tr.Body.solid_sphere(0.025, 0.065)


def test_a_ball_on_a_turning_table_comes_round_in_its_own_circle():
    """A solid ball circles at 2/7 of the table's rate, whatever it started with: crossings of any line, both ways."""
    for rate in (3.0, -3.0):
        table = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(rate)))
        start = table.place(position=(0.1, 0.0), velocity=(0.05, 0.02))
        found = tr.poincare_section(table, "velocity.x falling through 0", start, "60 s")
        assert found.count > 5
        assert found.located
        assert np.allclose(found.intervals, 2 * math.pi / (2 / 7 * abs(rate)), rtol=1e-12)


def test_methods_agree_and_a_function_is_as_good_as_a_text():
    bowl = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.3)))
    start = bowl.place(position=(0.1, 0.0), velocity=(0.0, 0.4))
    said = tr.poincare_section(bowl, "position.x rising through 20 mm", start, "10 s", method="taylor")
    other = tr.poincare_section(bowl, "position.x rising through 20 mm", start, "10 s", method="runge-kutta")

    def x_beyond(data):
        return data.position.sel(axis="x").values - 0.02

    function = tr.poincare_section(bowl, x_beyond, start, "10 s", method="taylor")
    assert said.located
    assert function.located
    assert np.allclose(said.data.time, function.data.time, rtol=0, atol=1e-12)
    assert np.allclose(said.data.time, other.data.time, rtol=0, atol=1e-9)
    assert np.abs(said.values("position.x") - 0.02).max() < 1e-13
    assert (said.values("velocity.x") > 0).all()
    both = tr.poincare_section(bowl, x_beyond, start, "10 s", way="crossing", method="taylor")
    falling = tr.poincare_section(bowl, x_beyond, start, "10 s", way="falling", method="taylor")
    assert both.count == said.count + falling.count


def test_two_crossings_close_together_are_both_seen():
    """The top of a swing lifts over a level for a moment only."""
    trough = tr.RollingSystem(BALL, tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    start = trough.place(position=(0.4, 0.0))
    highest = tr.simulate(trough, start, "4 s", "1 ms").data.position.sel(axis="y").values
    level = float(highest.max()) * (1 - 1e-6)
    found = tr.poincare_section(trough, f"position.y crossing through {level} m", start, "4 s", every=0.02)
    assert found.count >= 3
    assert found.located


def test_a_stroboscope_sees_a_periodic_motion_where_it_was():
    bouncing = Bouncing(0.5, 1.3)
    found = tr.poincare_section(bouncing.system, None, bouncing.start, 10 * bouncing.period, period=bouncing.period)
    assert found.count == 10
    assert np.allclose(found.values("position.z"), bouncing.start.position[2], rtol=0, atol=1e-11)
    assert np.abs(found.values("velocity.z")).max() < 1e-9


def test_landings_are_a_section():
    bouncing = Bouncing(0.5, 1.3)
    found = tr.poincare_section(bouncing.system, "land", bouncing.start, 10 * bouncing.period)
    assert found.count == 10
    assert np.allclose(found.values("velocity.z"), G * bouncing.period / 2, rtol=1e-9)
    assert np.allclose(found.intervals, bouncing.period, rtol=1e-10)


def test_a_jump_at_a_landing_is_no_crossing():
    bouncing = Bouncing(0.5, 1.3)
    found = tr.poincare_section(bouncing.system, "velocity.z rising through 0", bouncing.start, 5 * bouncing.period)
    assert found.count == 0
    assert found.jumps == 5
    falling = tr.poincare_section(bouncing.system, "velocity.z falling through 0", bouncing.start, 5 * bouncing.period)
    assert falling.count in (4, 5)
    assert falling.located


def test_a_motion_that_ends_says_so():
    table = tr.RollingSystem(BALL, tr.Support(tr.Plane(rim=0.2)))
    found = tr.poincare_section(table, "position.x rising through 10 cm", table.place(velocity=(0.1, 0.0)), "60 s")
    assert found.count == 1
    assert "rim" in found.ended
    assert math.isclose(found.duration, 2.0, rel_tol=1e-9)
    assert "rim" in str(found)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"section": "position.w rising through 0"}, "position.w"),
        ({"section": "position.x rising above 0"}, "which quantity passes"),
        ({"section": "position.x sinking through 0"}, "sinking"),
        ({"section": "position.x rising through 10"}, "with its unit"),
        ({"section": "position.x rising through 3 kg"}, "length"),
        ({"section": "lend"}, "which quantity passes"),
        ({"section": 3.0}, "text or a function"),
        ({}, "or `period` instead"),
        ({"period": "1 s", "section": "land"}, "or `period` instead"),
        ({"period": "20 s"}, "must not be longer"),
        ({"section": lambda data: data.time.values * 0}, "zero throughout"),
        ({"section": lambda data: data.time.values[0]}, "a number for each"),
    ],
)
def test_what_is_no_section_is_refused_in_words(given, said):
    bowl = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.5)))
    given = {"section": None, **given}
    with pytest.raises(tr.TrundleError, match=said):
        tr.poincare_section(bowl, start=bowl.place(position=(0.1, 0.0)), duration="5 s", **given)


def test_a_body_at_rest_never_crosses():
    plane = tr.RollingSystem(BALL, tr.Support(tr.Plane()))
    found = tr.poincare_section(plane, "position.x rising through 10 cm", plane.place(), "5 s")
    assert found.count == 0
    assert found.plot().axes
