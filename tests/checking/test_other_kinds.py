"""Checking motions of other bodies than balls, with tensors that are turned and couples that need the normal force."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import trundle as tr
from trundle.analysis.checking import laws


def test_a_turned_tensor_of_inertia_is_not_taken_for_a_number() -> None:
    body = tr.Body.ellipsoid((0.1, 0.05, 0.02), 1.0, turn=0.3)
    system = tr.RollingSystem(body, tr.Support(tr.Plane()))
    assert isinstance(body.inertia, tr.Tensor)
    doubled = laws.with_inertia(system, 2.0).body.inertia
    assert doubled == tr.Tensor(*(2.0 * element for element in body.inertia.elements))
    start = system.place((0.0, 0.0), (0.1, 0.05), spin=9.0, attitude=(0.3, 0.2, 0.1))
    run = tr.simulate(system, start, 0.5, 0.001, "runge-kutta")
    assert tr.check(run, system).passed
    lean = replace(body, inertia=tr.Principal(*body.inertia.elements[:3]))
    assert not tr.check(run, replace(system, body=lean)).passed


def test_couples_at_the_contact_belong_to_the_law() -> None:
    table = tr.Support(tr.Bowl(0.5), motion=tr.Spin(1.0))
    loads = (tr.RollingResistance(2e-4), tr.PivotFriction(1e-4, 0.5), tr.RollingCouple(1e-5))
    system = tr.RollingSystem(tr.Body.solid_sphere(0.03, 0.5), table, loads)
    run = tr.simulate(system, system.place((0.1, 0.0), (0.0, 0.8), spin=20.0), 0.5, 0.001, "runge-kutta")
    assert tr.check(run, system).passed
    for load in loads:
        others = tuple(other for other in loads if other is not load)
        assert not tr.check(run, replace(system, loads=others)).passed, load


@pytest.mark.parametrize("motion", [tr.SpinBy("2 + sin(t)"), tr.FreeAxle(0.1, 3.0)])
def test_a_support_that_only_its_own_course_tells_is_refused(motion: tr.SpinBy | tr.FreeAxle) -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.03, 0.5), tr.Support(tr.Plane(), motion=motion))
    t = np.linspace(0.0, 1.0, 50)
    with pytest.raises(tr.InvalidValueError, match=r"`support\.motion` must say where the support is"):
        tr.check({"t": t, "x": 0.1 + t, "y": 0 * t}, system)
    with pytest.raises(tr.InvalidValueError, match=r"`support\.motion`"):
        tr.check_equations(lambda *_: (0.0, 0.0), system)


@pytest.mark.parametrize("parts", ["angular velocity", "both"])
def test_a_coin_that_whirls_faster_than_it_is_sampled_is_no_matter_for_a_check(parts: str) -> None:
    """It falls towards its face and turns 2.8 rad a sample: Ω so far apart adds up to no orientation."""
    coin = tr.RollingSystem(tr.Body.disc(radius=0.07, mass=0.004), tr.Support(tr.Plane()))
    start = coin.place(attitude=(0.0, "-8 deg", 0.0), velocity=(-0.04, 0.0))
    run = tr.simulate(coin, start, 10.0, 0.267467)
    q, Omega = run.data.orientation.values, run.data.angular_velocity.values
    seen = {"t": run.samples.time, **dict(zip("xyz", run.samples.position.T, strict=True))}
    if parts != "angular velocity":
        seen |= dict(zip(("qw", "qx", "qy", "qz"), q.T, strict=True))
    seen |= dict(zip(("wx", "wy", "wz"), Omega.T, strict=True))
    with pytest.raises(tr.TrundleError, match="often enough to follow the orientation"):
        tr.check(seen, coin)


@pytest.mark.filterwarnings("error")
def test_what_stays_where_it_is_is_drawn_as_well() -> None:
    slope = tr.RollingSystem(tr.Body.solid_sphere(0.03, 0.5), tr.Support(tr.Plane()))
    still = tr.check(tr.simulate(slope, slope.place((0.4, -0.3)), 1.0, 0.02), slope)
    assert still.passed, str(still)
    still.plot().draw_without_rendering()
