"""A body that is put down touches, rolls, and has the velocity and spin that were asked for."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.nearest import closest_contact
from trundle.mechanics.shapes import Disc, Ellipsoid, Hemisphere, Sphere, Torus
from trundle.solve.samples import FLIGHT

PRINCIPAL = tr.Principal(0.003, 0.004, 0.005)
BODIES = {
    "ball": tr.Body.solid_sphere(0.125, 0.75),
    "weighted ball": tr.Body(0.75, PRINCIPAL, Sphere(0.125, Vector(0.01, -0.02, 0.03))),
    "ellipsoid": tr.Body(0.75, PRINCIPAL, Ellipsoid(0.15, 0.125, 0.1)),
    "torus": tr.Body(0.75, PRINCIPAL, Torus(0.1, 0.03)),
}
RATE = -2.5
TABLES = {
    "fixed": tr.Support(tr.Plane(rim=1.0)),
    "spinning": tr.Support(tr.Plane(rim=1.0), motion=tr.Spin(RATE), tilt=0.1),
}
SIDE = [-0.2, -0.1, 0.0, 0.1, 0.2]
TRAY = tr.RollingSystem(BODIES["ball"], tr.Support(tr.HeightField.through(SIDE, SIDE, [[0.0] * 5] * 5), friction=0.1))
TURNED = (0.8, 0.3, -0.4, 0.2)


@pytest.fixture(params=BODIES)
def body(request: pytest.FixtureRequest) -> tr.Body:
    return BODIES[request.param]


def lowest(body: tr.Body, orientation: Any) -> Any:
    """Return ρ: the point whose outward normal points down, the rotation made by SciPy."""
    Q = Rotation.from_quat(orientation, scalar_first=True).as_matrix()
    down = -Q.T[:, 2]  # the direction in the body frame
    return Q @ body.shape.support_map(Vector(*down)).array()


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("spin", [None, 0.0, 3.0])
def test_it_touches_and_rolls_as_asked(body: tr.Body, table: str, spin: float | None) -> None:
    system = tr.RollingSystem(body, TABLES[table])
    start = system.place((0.2, -0.3), (0.4, 0.1), spin=spin, orientation=TURNED)
    V, Omega, r = (np.array(getattr(start, name)) for name in ("velocity", "angular_velocity", "position"))
    assert math.hypot(*start.orientation) == pytest.approx(1.0, abs=EXACT(4, 1))
    assert np.abs(np.array(start.orientation) - np.array(TURNED) / math.hypot(*TURNED)).max() <= EXACT(4, 1)
    rho = lowest(body, start.orientation)
    assert np.abs(r[:2] - [0.2, -0.3]).max() <= EXACT(4, 0.5)
    assert abs((r + rho)[2]) <= EXACT(8, 0.2)
    assert start.velocity[:2] == (0.4, 0.1)
    turn = RATE if table == "spinning" else 0.0
    u = np.cross([0.0, 0.0, turn], r + rho)
    assert np.abs(V + np.cross(Omega, rho) - u).max() <= EXACT(16, 2.0)
    assert abs(Omega[2] - (spin or 0.0)) <= EXACT(16, 20.0)


def test_released_with_the_table_it_moves_with_what_is_under_it(body: tr.Body) -> None:
    system = tr.RollingSystem(body, TABLES["spinning"])
    start = system.place((0.2, -0.3), "co-rotating", orientation=TURNED)
    assert np.abs(np.array(start.velocity[:2]) - [-RATE * -0.3, RATE * 0.2]).max() <= EXACT(4, 1.0)
    assert abs(start.angular_velocity[2] - RATE) <= EXACT(16, 4.0)
    # As one piece with the table: Ω = ω n, whatever the body.
    assert np.abs(np.array(start.angular_velocity) - [0.0, 0.0, RATE]).max() <= EXACT(64, 4.0)
    assert abs(start.velocity[2]) <= EXACT(16, 1.0)
    spun = system.place((0.2, -0.3), "co-rotating", spin=1.0, orientation=TURNED)
    assert abs(spun.angular_velocity[2] - 1.0) <= EXACT(16, 4.0)


def test_an_angular_velocity_that_agrees_is_taken_as_it_is(body: tr.Body) -> None:
    system = tr.RollingSystem(body, TABLES["spinning"])
    start = system.place((0.2, -0.3), (0.4, 0.1), spin=3.0, orientation=TURNED)
    again = system.place((0.2, -0.3), (0.4, 0.1), angular_velocity=start.angular_velocity, orientation=TURNED)
    assert again == start


@pytest.mark.parametrize("turning", [(3.0, -2.0, 4.0), (0.0, 0.0, -4.0), (0.0, 0.0, 0.0), (1e-9, 0.0, 0.0)])
def test_rolling_is_the_velocity_that_goes_with_the_angular_velocity(body: tr.Body, turning: Any) -> None:
    place = {"position": (0.2, -0.3), "angular_velocity": turning, "orientation": TURNED}
    for table in (TABLES["spinning"], tr.Support(tr.Plane(), motion=tr.Spin(-RATE), friction=0.3)):
        start = tr.RollingSystem(body, table).place(velocity="rolling", **place)
        assert start.angular_velocity == turning
        rho = lowest(body, start.orientation)
        omega = [0.0, 0.0, RATE if table.friction is None else -RATE]
        u = np.cross(omega, np.array(start.position) + rho)
        assert np.abs(np.array(start.velocity) + np.cross(turning, rho) - u).max() <= EXACT(16, 2.0)


@pytest.mark.parametrize(
    ("arguments", "key"),
    [
        ({"velocity": "rolling"}, "velocity"),
        ({"velocity": "rolling", "spin": 1.0}, "velocity"),
        ({"velocity": "rolling", "angular_velocity": (0.0, 0.0, 1.0), "height": 0.1}, "velocity"),
        ({"velocity": "roling", "angular_velocity": (0.0, 0.0, 1.0)}, "velocity"),
        ({"position": (1.0, 0.0)}, "position"),
        ({"position": (0.8, -0.7)}, "position"),
        ({"position": (0.1,)}, "position"),
        ({"position": (0.1, math.nan)}, "position"),
        ({"position": "here"}, "position"),
        ({"velocity": "corotating"}, "velocity"),
        ({"velocity": (0.1, 0.2, 0.3, 0.4)}, "velocity"),
        ({"velocity": ("1 m", "2 m")}, "velocity"),
        ({"spin": "3 m/s"}, "spin"),
        ({"spin": math.inf}, "spin"),
        ({"angular_velocity": (1.0, 2.0, 3.0)}, "angular_velocity"),
        ({"angular_velocity": (0.0, 0.0, 1.0), "spin": 1.0}, "angular_velocity"),
        ({"orientation": (0.0, 0.0, 0.0, 0.0)}, "orientation"),
        ({"orientation": (1.0, 0.0, 0.0)}, "orientation"),
    ],
)
def test_a_contradiction_is_refused_by_name(arguments: dict[str, Any], key: str) -> None:
    system = tr.RollingSystem(BODIES["ball"], TABLES["spinning"])
    with pytest.raises(tr.InvalidValueError, match=key):
        system.place(**arguments)


def test_a_body_beyond_the_end_of_a_table_of_numbers_is_over_nothing() -> None:
    assert TRAY.place((0.19, 0.0)).position[0] == 0.19
    with pytest.raises(tr.SolverError, match="no point of the surface is nearest"):
        tr.simulate(TRAY, tr.State((0.21, 0.0, 0.3), (0.0,) * 3, (0.0,) * 3), 0.1, 0.05)


def test_a_body_slips_on_a_table_of_numbers_as_on_the_plane() -> None:
    start = TRAY.place((0.0, 0.0), (0.3, 0.0), angular_velocity=(0.0, 0.0, 0.0))
    run = tr.simulate(TRAY, start, 0.05, 0.05)
    assert abs(run.samples.velocity[-1, 0] - (0.3 - 0.1 * TRAY.gravity * 0.05)) <= SOLVER(10, 1e-12)


# --- which point of the support is nearest ---------------------------------------------------------------

ASIDE = Vector(0.02, -0.015, 0.01)  # of a shape of 1 cm: its centre of mass is outside it
FLAT_OR_NOT = {
    "half a sphere": Hemisphere(0.01, ASIDE),
    "ball": Sphere(0.01, ASIDE),
    "disc": Disc(0.01, ASIDE),
    "torus": Torus(0.007, 0.003, ASIDE),
}
HOLLOW = {
    "needle": (tr.Cone("0.36 deg"), (0.0, -0.0135)),
    "narrow cone": (tr.Cone("5 deg"), (0.012, 0.006)),
    "pipe": (tr.Cylinder(0.0135), ("40 deg", 0.0)),
    "bowl": (tr.Bowl(0.0135), (0.003, 0.002)),
}


@pytest.mark.parametrize("shape", FLAT_OR_NOT)
@pytest.mark.parametrize("hollow", HOLLOW)
def test_what_is_put_down_touches_where_it_was_asked_for_or_is_refused(shape: str, hollow: str) -> None:
    """In a support hardly wider than the body its centre of mass may be nearer to the other side, or beyond it."""
    surface, place = HOLLOW[hollow]
    body = tr.Body(0.01, tr.Principal(1e-6, 1.2e-6, 1.4e-6), FLAT_OR_NOT[shape])
    system = tr.RollingSystem(body, tr.Support(surface, friction=0.2))
    u, v = (math.radians(40.0), 0.0) if hollow == "pipe" else place
    asked, begun = surface.point(u, v).array(), 0
    for seed in range(12):
        draw = np.random.default_rng(seed)
        try:
            start = system.place(place, orientation=tuple(draw.normal(size=4)))
        except tr.InvalidValueError:
            continue
        contact = closest_contact(system, 0.0, Vector(*start.position), Quaternion(*start.orientation))
        assert np.abs(contact.point.array() - asked).max() <= SOLVER(10, 1e-13)
        assert abs(np.linalg.norm(contact.centre.array() - start.position)) <= SOLVER(10, 1e-13)
        begun += 1
    assert begun > 0


def test_half_a_sphere_in_a_needle_rolls_from_where_it_was_put() -> None:
    body = tr.Body.hemisphere(0.012856, density=620.463, centre=(-0.0259989, -0.0218652, -0.0156239))
    needle = tr.RollingSystem(body, tr.Support(tr.Cone(0.00625451), friction=0.161795))
    start = needle.place((0.0, -0.013479), spin=0.0, attitude=(-0.038595, -0.0463211, "-90 deg"))
    run = tr.simulate(needle, start, 0.2, 0.01)
    assert run.samples.phase[0] != FLIGHT
    assert np.abs(run.samples.contact[0] - needle.support.surface.point(0.0, -0.013479).array()).max() <= 1e-13
    assert run.card().passed, str(run.card())


@pytest.mark.parametrize(
    ("surface", "place", "most"),
    [
        (tr.Bowl(0.5), (0.1, 0.0), 0.4),  # up to the middle: R − a
        (tr.Cylinder(0.5), (0.0, 0.0), 0.4),
        (tr.Cone("45 deg"), (0.3, 0.0), 0.3 * math.sqrt(2) - 0.1),  # up to the axis
    ],
    ids=["bowl", "pipe", "funnel"],
)
def test_a_height_at_which_another_side_is_nearer_is_refused(surface: Any, place: Any, most: float) -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(surface, friction=0.1))
    start = system.place(place, height=0.99 * most)
    at = tr.simulate(system, start, 0.01, 0.001, method="runge-kutta").samples
    assert at.phase[0] == FLIGHT
    assert np.abs(at.contact[0] - surface.point(*place).array()).max() <= SOLVER(100, 1e-13)
    for height in (1.01 * most, 1.5 * most):
        with pytest.raises(tr.InvalidValueError, match=r"`height` must leave the body nearest.*got .*Put it lower"):
            system.place(place, height=height)


@pytest.mark.parametrize("turn", [math.pi / 2 + 1e-6, 2.0, math.pi])
def test_a_body_over_its_flat_side_is_refused(turn: float) -> None:
    floor = tr.RollingSystem(tr.Body.hemisphere(0.1, 1.0), tr.Support(tr.Plane(), friction=0.1))
    over = floor.place(height=0.3)
    turned = replace(over, orientation=(math.cos(turn / 2), math.sin(turn / 2), 0.0, 0.0))
    with pytest.raises(tr.InvalidValueError, match=r"start.position.*got .*flat side.*turn or move the body"):
        tr.simulate(floor, turned, 0.1, 0.01)
    with pytest.raises(tr.InvalidValueError, match=r"orientation.*got .*turn it"):
        floor.place(height=0.3, orientation=turned.orientation)


@pytest.mark.parametrize("surface", [tr.Plane(), tr.Bowl(1.4)], ids=["plane", "bowl"])
@pytest.mark.parametrize("side", [-1, 1])
def test_a_start_on_the_edge_of_the_round_side_is_refused_whatever_rounding_says(surface: Any, side: int) -> None:
    body = tr.Body.hemisphere(0.04, 0.02)
    system = tr.RollingSystem(body, tr.Support(surface, friction=0.2))
    for heading in np.linspace(0.0, 3.0, 7):
        with pytest.raises(tr.InvalidValueError, match=r"attitude.*on its edge"):
            system.place((0.9 * isinstance(surface, tr.Bowl), 0.0), attitude=(heading, side * math.pi / 2, -0.17))
    inside = system.place(attitude=(0.3, side * (math.pi / 2 - 1e-6), -0.17))  # turned so far from it, it is let go
    card = tr.simulate(system, inside, 0.05, 0.01).card()
    assert card.passed, str(card)


@pytest.mark.parametrize("speed", [3e-28, 1e-300, 0.0])
def test_where_nothing_moves_a_slip_of_a_rounding_is_none(speed: float) -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 0.1), tr.Support(tr.Plane()))
    start = system.place(velocity=(speed, 0.0), angular_velocity=(0.0, 0.0, 0.0))
    run = tr.simulate(system, start, 0.1, 0.05)
    assert np.abs(run.samples.velocity).max() <= speed
    with pytest.raises(tr.InvalidValueError, match="must agree with rolling"):
        system.place(velocity=(1e-12, 0.0), angular_velocity=(0.0, 0.0, 0.0))
