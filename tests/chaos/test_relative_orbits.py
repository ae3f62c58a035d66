"""Orbits that come back but for a shift and a turn, against formulas and against an implementation of their own."""

import math

import pytest
from scipy.optimize import brentq
from scipy.special import mathieu_b

import trundle as tr
from trundle.errors import InvalidValueError


def rounds(radius=0.5, speed=3.0):
    """Return a ball that goes round in an upright cylinder, and bobs."""
    inside = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(radius)))
    return inside, inside.place(velocity=(speed, 0.2))


def rate_of(orbit):
    """Return how fast the ball goes round, which it does steadily."""
    x, y, _ = orbit.state.position
    vx, vy, _ = orbit.state.velocity
    return (x * vy - y * vx) / (x * x + y * y)


def test_a_ball_bobs_in_a_cylinder_at_a_fixed_share_of_its_rounds():
    inside, start = rounds()
    orbit = tr.periodic_orbit(inside, start, period=1.6, relative=True)
    assert math.isclose(2 * math.pi / orbit.period, math.sqrt(2 / 7) * abs(rate_of(orbit)), rel_tol=1e-9)
    gone = math.remainder(orbit.turned - rate_of(orbit) * orbit.period, 2 * math.pi)
    assert abs(gone) < 1e-9
    assert orbit.verdict == "neutral"


def test_it_is_followed_along_the_radius_of_the_cylinder():
    inside, start = rounds()
    branch = tr.periodic_orbit(inside, start, period=1.6, relative=True).along("support.radius", 0.45, 0.55, step=0.4)
    assert branch.folds == branch.period_doublings == ()
    assert branch.values[0] <= 0.45
    assert branch.values[-1] >= 0.55
    for orbit, radius in zip(branch.orbits, branch.values, strict=True):
        x, y, _ = orbit.state.position
        assert math.isclose(math.hypot(x, y), radius - 0.1, rel_tol=1e-12)
        assert math.isclose(2 * math.pi / orbit.period, math.sqrt(2 / 7) * abs(rate_of(orbit)), rel_tol=1e-9)


@pytest.mark.parametrize("rate", [40.0, -25.0])
def test_a_disc_that_rolls_upright_wobbles_at_the_rate_of_the_textbook(rate):
    a = 0.05  # m
    disc = tr.RollingSystem(tr.Body.disc(a, 0.1), tr.Support(tr.Plane()))
    wobble = math.sqrt((12 * rate**2 - 4 * 9.80665 / a) / 5)
    start = disc.place(velocity=(rate * a, 0.0), attitude=(0, "90.05 deg", 0))
    orbit = tr.periodic_orbit(disc, start, period=2 * math.pi / wobble, relative=True)
    assert math.isclose(2 * math.pi / orbit.period, wobble, rel_tol=1e-4)


def test_a_coin_that_nods_and_drifts_against_differences_of_whole_runs():
    coin = tr.RollingSystem(tr.Body.disc(0.012, mass=0.0075), tr.Support(tr.Plane()))
    start = coin.place(velocity=(0.3, 0.0), attitude=(0, "70 deg", 0))
    other = tr.periodic_motion(coin, start)
    orbit = tr.periodic_orbit(coin, other.state, period=other.period, relative=True)
    assert math.isclose(orbit.period, other.period, rel_tol=1e-9)
    assert math.isclose(orbit.turned, other.turned, rel_tol=1e-8)
    assert orbit.verdict == other.verdict


@pytest.mark.parametrize("drift", [0.0, 0.7])
def test_the_period_doubles_where_mathieu_says_while_the_ball_rolls_along_its_trough(drift):
    r, R = 0.1, 0.5
    pendulum = 1.4 * (R - r)  # m
    a = 0.9
    rate = 2 * math.sqrt(9.80665 / (pendulum * a))
    # x'' + (a − 2q cos 2τ) x = 0 with 2τ = ωt, q = 2A/(7/5 (R − r)); the multiplier is −1 where a = b₁(q).
    critical = brentq(lambda q: mathieu_b(1, q) - a, 1e-3, 0.5, xtol=1e-15) * pendulum / 2
    trough = tr.Support(tr.Cylinder(R), motion=tr.Shake((0.7 * critical, 0.0, 0.0), rate), tilt="90 deg")
    system = tr.RollingSystem(tr.Body.solid_sphere(r, 1.0), trough)
    start = system.place(velocity=(0.0, drift))
    orbit = tr.periodic_orbit(system, start, period=2 * math.pi / rate, relative=True)
    assert orbit.driven
    branch = orbit.along("support.motion.amplitude.x", 0.6 * critical, 1.3 * critical, step=0.2)
    assert len(branch.period_doublings) == 1
    assert math.isclose(branch.period_doublings[0], critical, rel_tol=1e-7)


def test_what_is_in_flight_has_no_relative_orbit():
    table = tr.RollingSystem(tr.Body.solid_sphere(0.01, 0.01), tr.Support(tr.Plane(), restitution=0.5))
    with pytest.raises(InvalidValueError, match="relative"):
        tr.periodic_orbit(table, tr.State((0, 0, 0.1), (0, 0, 0), (0, 0, 0)), period=0.1, relative=True)
