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


BODIES = {
    "ball": tr.Body.solid_sphere(0.03, 0.1),
    "ring": tr.Body.ring(0.035, 0.2229),
    "disc": tr.Body.disc(0.04, 0.2),
    "torus": tr.Body.torus(0.04, 0.01, 0.2),
    "ellipsoid": tr.Body.ellipsoid((0.05, 0.03, 0.02), 0.1),
}
RESISTANCES: dict[str, list[tr.Load]] = {
    "none": [],
    "rolling": [tr.RollingResistance(5e-4)],
    "pivot": [tr.PivotFriction(3e-4)],
    "couple": [tr.RollingCouple(4e-5)],
}


@pytest.mark.parametrize("side", ["inside", "outside"])
@pytest.mark.parametrize("place", [(-0.1, -0.05), (0.0, 0.02)])
@pytest.mark.parametrize("friction", [0.05, 0.4, 1.5])
@pytest.mark.parametrize("resistance", RESISTANCES)
@pytest.mark.parametrize("body", BODIES)
def test_what_is_let_go_beside_an_upright_wall_falls_along_it(
    body: str, resistance: str, friction: float, place: tuple[float, float], side: str
) -> None:
    # Nothing presses it on, so nothing rubs: neither the wall nor a resistance has a part in it.
    wall = tr.Support(tr.Cylinder(0.355, side=side), friction=friction)
    system = tr.RollingSystem(BODIES[body], wall, loads=RESISTANCES[resistance])
    start = system.place(place)
    run = tr.simulate(system, start, 0.6, 0.1)
    assert run.card().passed, str(run.card())
    fallen = np.outer(-9.80665 / 2 * run.samples.time**2, (0.0, 0.0, 1.0))
    np.testing.assert_allclose(run.samples.position, start.position + fallen, rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.samples.orientation, np.tile(start.orientation, (7, 1)), rtol=0, atol=1e-9)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_friction_jams_a_rod_that_is_pressed_on_only_later(method: str) -> None:
    """b, how a newton of N opens the contact, is 0.046/m at first, and falls as the rod turns."""
    rod = tr.Body.ellipsoid(("5 mm", "5 mm", "50 cm"), mass="1 kg")
    press = tr.Force((0.0, 0.0, "-5*t**2"))
    system = tr.RollingSystem(rod, tr.Support(tr.Plane(), friction=1.0), loads=[press], gravity=0.0)
    leans = (np.cos(0.25), 0.0, np.sin(0.25), 0.0)
    dragged = system.place(velocity=(-1.0, 0.0), angular_velocity=(0.0, 0.0, 0.0), orientation=leans)
    with pytest.raises(tr.SolverError, match=r"At t = 0\.18467\d* s friction all but jams the body"):
        tr.simulate(system, dragged, 1.0, 0.02, method=method)
