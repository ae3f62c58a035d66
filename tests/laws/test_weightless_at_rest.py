"""A weightless body at rest on a support that begins to turn, however smoothly: nothing presses, and it stays."""

from __future__ import annotations

import numpy as np
import pytest

import trundle as tr
from trundle.solve.contact_state import ContactState

BALL = tr.Body.solid_sphere(0.1, 1.0)


@pytest.mark.parametrize("surface", [tr.Plane(), tr.Bowl(0.6), tr.Dome(0.6)], ids=lambda one: type(one).__name__)
@pytest.mark.parametrize("rate", ["t", "-t**2", "t**3", "sin(t)**2", "t*exp(t)"])
@pytest.mark.parametrize("friction", [0.3, 0.0])
def test_it_stays_where_it_is_while_the_support_slips_by(surface: tr.Surface, rate: str, friction: float) -> None:
    """A surface of revolution that turns about its axis stays where it is, so that no force is asked for."""
    system = tr.RollingSystem(BALL, tr.Support(surface, motion=tr.SpinBy(rate), friction=friction), gravity=0.0)
    start = system.place((0.1, 0.05))
    run = tr.simulate(system, start, 1.5, 0.05)
    for quantity, rest in (("position", start.position), ("velocity", 0.0), ("angular_velocity", 0.0)):
        assert np.abs(run.data[quantity].values - rest).max() < 1e-12, quantity
    assert np.abs(run.data.contact_force.values).max() < 1e-12
    assert run.card()["normal force"].passed is not False


@pytest.mark.parametrize("power", [1, 2, 3, 5])
@pytest.mark.parametrize("begin", [0.0, 40.0])
def test_a_motion_that_is_yet_to_begin_has_a_time_in_which_it_does(power: int, begin: float) -> None:
    """A force c tⁿ leads over |ρ| in about (|ρ| m/c)^1/(n+2); it is looked for decade by decade."""
    push = tr.Force((f"0.7*(t - {begin})**{power}", 0.0, 0.0))
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=(push,), gravity=0.0)
    start = system.place((0.0, 0.0), time=begin)
    expected = (0.1 * 1.0 / 0.7) ** (1 / (power + 2))
    assert expected <= ContactState.of(system, start).moment(system) <= 10 * expected
