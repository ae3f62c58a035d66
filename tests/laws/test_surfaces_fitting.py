"""Whether a body fits a surface: against parallel surfaces, closed forms, and places where it is known not to."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.laws.test_surfaces_rolled_on import SURFACES
from tests.precise import numbers, precisely, slope
from tests.tolerances import EXACT

import trundle as tr
from trundle.errors import InvalidValueError
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.contact import Contact, contact_at
from trundle.mechanics.fitting import check_curvature, check_place, check_start, fits, room, too_big
from trundle.mechanics.overlap import depth
from trundle.mechanics.shapes import Ellipsoid
from trundle.mechanics.surfaces import Surface

STILL = Quaternion(1.0, 0.0, 0.0, 0.0)
EGG = tr.Body(1.0, tr.Principal(0.02, 0.02, 0.005), Ellipsoid(0.1, 0.1, 0.3))


def of_ball(radius: Any, surface: Surface) -> tr.RollingSystem:
    return tr.RollingSystem(tr.Body.solid_sphere(radius, 1.0), tr.Support(surface))


def at(system: tr.RollingSystem, u: Any, v: Any) -> Contact:
    return contact_at(system, 0.0, system.support.surface.point(u, v), STILL)


# --- the curvature --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SURFACES)
@precisely
def test_a_ball_fits_as_the_parallel_surface_of_its_centres_keeps_its_area(name: str) -> None:
    # The centre runs on p + a n, and an element of that surface is det(1 + a S) times the one below it (Steiner).
    surface, a = SURFACES[name], mpmath.mpf("0.0625")
    for u, v in zip(numbers(f"{name} u", 3, 0.5), numbers(f"{name} v", 3, 0.5), strict=True):

        def element(height: Any, u: Any = u, v: Any = v) -> Vector:
            def lifted(u: Any, v: Any) -> Vector:
                p = surface.point(u, v)
                return p + surface.normal(p) * height

            return slope(lambda h: lifted(h, v), u).cross(slope(lambda h: lifted(u, h), v))

        n = surface.normal(surface.point(u, v))
        ratio = element(a).dot(n) / element(0).dot(n)
        assert abs(fits(at(of_ball(a, surface), u, v)) - ratio) <= EXACT(64, 1)


CLOSED = {
    # surface, coordinates, and 1 − (radius of the ball)/(radius of curvature) of both principal directions
    "bowl": (tr.Bowl(0.5), (0.1, 0.2), (0.5, 0.5)),
    "dome": (tr.Dome(0.5), (0.1, 0.2), (1.5, 1.5)),
    "pipe": (tr.Cylinder(0.5), (1.0, 0.2), (0.5, 1.0)),
    "dish at its vertex": (tr.Paraboloid(0.5), (0.0, 0.0), (0.5, 0.5)),
    "funnel": (tr.Cone("60 deg"), (0.3, 0.4), (0.5, 1.0)),  # cos β/r = 1/m
    "ellipsoid at its lowest point": (tr.EllipsoidalBowl((1.0, 0.5, 0.5)), (0.0, 0.0), (0.5, 0.875)),
    "tube, outermost": (tr.TorusTrack(1.0, 0.5), (0.0, math.pi / 2), (0.5, 1 - 0.25 / 1.5)),
    "tube, innermost": (tr.TorusTrack(1.0, 0.5), (0.0, -math.pi / 2), (0.5, 1.5)),
}


@pytest.mark.parametrize("name", CLOSED)
def test_how_well_a_ball_fits_in_closed_form(name: str) -> None:
    surface, coordinates, wanted = CLOSED[name]
    contact = at(of_ball(0.25, surface), *coordinates)
    if name == "funnel":
        wanted = (1 - 0.25 * math.cos(math.pi / 3) / 0.5, 1.0)
    assert fits(contact) == pytest.approx(math.prod(wanted), abs=EXACT(16, 2))
    least, along = room(contact)
    assert least == pytest.approx(min(wanted), abs=EXACT(16, 2))
    assert abs(along.norm() - 1) <= EXACT(8, 1) >= abs(along.dot(contact.normal))


def test_it_can_be_an_event_of_arrays_and_of_symbols() -> None:
    sympy = pytest.importorskip("sympy")
    system = of_ball(0.25, tr.Paraboloid(0.5))
    x = np.array([0.0, 0.1, 0.2])
    several = fits(contact_at(system, 0.0, system.support.surface.point(x, 0.0 * x), STILL))
    one = [fits(at(system, float(u), 0.0)) for u in x]
    assert np.abs(several - one).max() <= EXACT(8, 1)
    u = sympy.Symbol("u", real=True)
    traced = fits(at(system, u, sympy.Integer(0))).subs(u, 0.1)
    assert abs(float(traced) - one[1]) <= EXACT(32, 1)


@pytest.mark.parametrize(
    ("radius", "surface", "place", "radii"),
    [
        (0.6, tr.Bowl(0.5), (0.0, 0.0), ("0.6 m", "0.5 m")),
        (0.5, tr.Bowl(0.5), (0.1, 0.0), ("0.5 m", "0.5 m")),  # as big as the bowl: it touches everywhere
        (0.6, tr.Cylinder(0.5), (1.0, 0.0), ("0.6 m", "0.5 m")),
        (0.3, tr.Paraboloid(0.25), (0.0, 0.0), ("0.3 m", "0.25 m")),
        (0.3, tr.Cone("60 deg"), (0.1, 0.0), ("0.3 m", "0.2 m")),  # r/cos β
        (0.3, tr.EllipsoidalBowl((1.0, 0.5, 1.0)), (0.0, 0.0), ("0.3 m", "0.25 m")),  # across, B²/C
        (0.6, tr.TorusTrack(1.0, 0.5), (0.0, 1.0), ("0.6 m", "0.5 m")),
        (0.2, tr.HeightField("5*x**2"), (0.0, 3.0), ("0.2 m", "0.1 m")),
        (0.2, tr.Revolution.through([0, 0.1, 0.2, 0.3], [0, 0.05, 0.2, 0.45]), (0.0, 0.0), ("0.2 m", "0.1 m")),
    ],
)
def test_a_ball_that_is_too_big_is_told_both_radii(
    radius: float, surface: Surface, place: tuple[float, float], radii: tuple[str, str]
) -> None:
    contact = at(of_ball(radius, surface), *place)
    with pytest.raises(InvalidValueError, match=r"must be where the body fits") as caught:
        check_curvature(contact, place)
    said = str(caught.value)
    assert f"with a radius of {radii[0]}, the surface with {radii[1]}:" in said, said
    assert too_big(at(of_ball(radius / 4, surface), *place)) == ""


def test_two_misfits_do_not_make_a_fit() -> None:
    # Too big both ways: the determinant (1 − a/b)² is positive all the same.
    contact = at(of_ball(0.75, tr.Bowl(0.25)), 0.0, 0.0)
    assert fits(contact) > 0
    assert room(contact)[0] == pytest.approx(-2.0)


# --- where there is no smooth surface -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("surface", "place", "said"),
    [
        (tr.Cone(0.5), (0.0, 0.0), "smooth.*divided by 0"),
        (tr.Bowl(0.5), (0.4, 0.4), "on the surface.*outside"),
        (tr.Bowl(0.5, rim=0.3), (0.31, 0.0), "on the surface.*the rim"),
        (tr.EllipsoidalBowl((1, 1, 0.5), depth=0.1), (0.9, 0.0), "on the surface.*the edge of the bowl"),
        (tr.Revolution("r"), (0.0, 0.0), "smooth.*edge or an apex|smooth"),
        (tr.Revolution("sqrt(r2 - 1)"), (0.5, 0.0), "on the surface"),
        (tr.Revolution.through([0.1, 0.2, 0.3, 0.4], [0, 0, 0, 0]), (0.05, 0.0), "on the surface.*end of the table"),
        (tr.Revolution.through([0.1, 0.2, 0.3, 0.4], [0, 0, 0, 0]), (0.0, 0.5), "on the surface.*end of the table"),
        (tr.HeightField("sqrt(x)"), (0.0, 1.0), "smooth.*divided by 0"),
        (tr.HeightField("1/y"), (0.0, 0.0), "on the surface.*divided by 0"),
        (tr.HeightField("log(x)"), (-1.0, 0.0), "on the surface"),
        (tr.HeightField("exp(1000*x)"), (1.0, 0.0), "on the surface.*too large"),
    ],
)
def test_a_place_without_a_smooth_surface_is_refused(surface: Surface, place: tuple[float, float], said: str) -> None:
    def checked() -> None:
        check_place(surface, *place, place)
        check_curvature(at(of_ball(0.05, surface), *place), place)

    with pytest.raises(InvalidValueError, match=said) as caught:
        checked()
    assert str(place) in str(caught.value)


@pytest.mark.parametrize("name", SURFACES)
def test_a_place_on_a_smooth_surface_is_not(name: str) -> None:
    check_place(SURFACES[name], 0.2, -0.1, (0.2, -0.1))
    check_start(system := of_ball(0.01, SURFACES[name]), at(system, 0.2, -0.1), STILL, (0.2, -0.1))


# --- another part of the body ---------------------------------------------------------------------------------------


def test_a_tall_body_in_a_low_tube_goes_through_its_roof() -> None:
    system = tr.RollingSystem(EGG, tr.Support(tr.TorusTrack(1.0, 0.2)))
    contact = at(system, 0.0, 0.0)
    check_curvature(contact, (0, 0))
    below, where = depth(system, contact, STILL)
    assert below == pytest.approx(0.2, abs=1e-9)  # 0.6 m tall in a tube of 0.4 m
    assert where == pytest.approx((1.0, 0.0, 0.4), abs=1e-6)
    with pytest.raises(InvalidValueError, match=r"clear of the surface.*0.2 m below the surface, at \(1, "):
        check_start(system, contact, STILL, (0, 0))


def test_a_body_on_a_plane_or_over_its_rim_is_clear() -> None:
    for surface in (tr.Plane(), tr.Plane(rim=0.05), tr.Bowl(0.5, rim=0.05), tr.Dome(1.0)):
        system = of_ball(0.2, surface)
        below, _ = depth(system, at(system, 0.0, 0.0), STILL)
        assert abs(below) <= EXACT(16, 1)
        check_start(system, at(system, 0.0, 0.0), STILL, (0, 0))


def test_a_ball_between_two_hills_meets_the_other_one() -> None:
    # It fits the curvature of the flank it is put on, but the next flank is nearer than its other side.
    surface = tr.HeightField("0.1 - 0.1*cos(20*x)")
    system = of_ball(0.06, surface)
    contact = at(system, 0.04, 0.0)
    assert room(contact)[0] > 0.5
    below, where = depth(system, contact, STILL)
    # The distance from the centre to the profile, by search over the profile alone.
    x = np.linspace(-0.2, 0.2, 400001)
    nearest = np.hypot(x - contact.centre.x, 0.1 - 0.1 * np.cos(20 * x) - contact.centre.z).min()
    assert nearest < 0.06
    assert below == pytest.approx(0.06 - nearest, rel=0.1)  # φ/|∇φ| is the distance to first order
    assert where[0] < contact.centre.x
    with pytest.raises(InvalidValueError, match="clear of the surface"):
        check_start(system, contact, STILL, (0.04, 0))


def test_a_table_is_looked_under_too() -> None:
    side = [i / 50 - 0.2 for i in range(21)]
    heights = [[0.1 - 0.1 * math.cos(20 * x) for _ in side] for x in side]
    system = of_ball(0.06, tr.HeightField.through(side, side, heights))
    with pytest.raises(InvalidValueError, match="clear of the surface"):
        check_start(system, at(system, 0.04, 0.0), STILL, (0.04, 0))
