"""Equilibria on every surface, above all on those without an end: found within seconds, where the support is level."""

import math
import time
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import trundle as tr

G = 9.80665
BALL = tr.Body.solid_sphere(radius=0.02, mass=0.1)
EGG = tr.Body.ellipsoid(semi_axes=(0.03, 0.02, 0.02), mass=0.1)
HEAVY_SIDE = tr.Body.weighted_cylinder(0.02, 0.1, 0.05, 0.015)
HEIGHTS = {
    "a bowl": "x**4 + y**2",
    "waves": "0.02*sin(5*x)*cos(3*y)",
    "a saddle": "x**2 - y**2",
    "a dent": "-0.1*exp(-x**2 - y**2)",
    "a hat without an inside": "-0.2*sqrt(1 - x**2 - y**2)",
    "a slope that ends": "0.1*log(1.5 + x) + y**2",
    "a trough": "x**2",
    "a crease": "0.1*abs(x)**3 + y**2",
    "a point": "0.3*hypot(x, y + 0.001)",
    "a hyperboloid": "0.3*hypot(hypot(x, y), 0.1)",
    "a high power": "x**12 + y**2",
}
SURFACES = {
    **{name: tr.HeightField(height) for name, height in HEIGHTS.items()},
    "a dish": tr.Paraboloid(1.0),
    "a narrow dish": tr.Paraboloid(0.1),
    "a hill": tr.Paraboloid(-1.0),
    "a quartic": tr.Revolution("r**4"),
    "a horn": tr.Revolution("-0.05/(0.1 + r**2)"),
    "a cone": tr.Cone("20 deg"),
    "a sphere": tr.Dome(1.0),
    "a hollow one": tr.Bowl(1.0),
}
SECONDS = 60.0  # of the processor: far more than it takes on any machine, and far less than for ever


def found_in_time(system: tr.RollingSystem, start: tr.State) -> tr.Equilibria:
    begun = time.process_time()
    found = tr.equilibria(system, start)
    assert time.process_time() - begun < SECONDS
    return found


# A search takes a second and more. So each surface is searched once level and once on a slope, once from aside and once
# from the line through its middle that runs down the slope, and these change places from one surface to the next. The
# egg takes a few seconds each: it sees another half of the surfaces on either slope.
ASIDE, ALONG = (0.05, 0.03), (0.2, 0.0)
BALLS = [
    (BALL, tilt, name, (ASIDE, ALONG)[(i + (tilt > 0)) % 2]) for tilt in (0.0, 0.05) for i, name in enumerate(SURFACES)
]
EGGS = [(EGG, tilt, name, ALONG) for tilt, first in ((0.0, 0), (0.05, 2)) for name in [*SURFACES][first::4]]


@pytest.mark.parametrize(("body", "tilt", "name", "place"), BALLS + EGGS)
def test_a_body_stays_where_its_centre_of_mass_is_over_the_contact(
    body: tr.Body, tilt: float, name: str, place: tuple[float, float]
) -> None:
    system = tr.RollingSystem(body, tr.Support(SURFACES[name], tilt=tilt))
    up = np.array([-math.sin(tilt), 0.0, math.cos(tilt)])
    found = found_in_time(system, system.place(place))
    for one in (*found, *found.pulled):
        arm = np.array(one.state.position) - np.array(one.contact)
        assert np.linalg.norm(np.cross(arm, up)) < 1e-9 * np.linalg.norm(arm)


@pytest.mark.parametrize("name", [*SURFACES][::4])
def test_the_energy_drawn_along_a_line_is_that_of_the_height(name: str) -> None:
    system = tr.RollingSystem(BALL, tr.Support(SURFACES[name], tilt=0.05))
    found = tr.equilibria(system, system.place(ASIDE))
    begun = time.process_time()
    line = found.line
    assert time.process_time() - begun < SECONDS
    assert line is not None
    up = np.array([-math.sin(0.05), 0.0, math.cos(0.05)])
    low, high = (
        np.array(system.place(tuple(map(float, line.place(end)[0]))[:2]).position) for end in (line.low, line.high)
    )
    rise = float(line.energy(line.high) - line.energy(line.low))
    assert rise == pytest.approx(0.1 * G * float((high - low) @ up), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("tilt", [0.0, 0.05, -0.1])
@pytest.mark.parametrize("profile", ["x**2", "0.02*sin(5*x)", "0.3*hypot(x, 0.2)", "0.1*exp(x)", "0.1*abs(x)**3"])
def test_a_cylinder_in_a_trough_without_end(profile: str, tilt: float) -> None:
    system = tr.RollingSystem(HEAVY_SIDE, tr.Support(tr.HeightField(profile), tilt=tilt))
    found = found_in_time(system, system.place((0.1, 0.0), roll=0.3))
    up = np.array([-math.sin(tilt), 0.0, math.cos(tilt)])
    for one in (*found, *found.pulled):
        arm = np.array(one.state.position) - np.array(one.contact)
        assert np.linalg.norm(np.cross(arm, up)) < 1e-9 * np.linalg.norm(arm)


@pytest.mark.parametrize("radius", [0.1, 1.0, 30.0])
def test_the_line_of_the_figure_is_no_longer_than_what_it_shows(radius: float, tmp_path: Path) -> None:
    system = tr.RollingSystem(EGG, tr.Support(tr.Paraboloid(radius)))
    found = found_in_time(system, system.place((0.5 * radius, 0.0)))
    assert found.line is not None
    way = found.line.high - found.line.low
    assert way < 2 * 100 * math.pi  # rad; 31 416, before
    found.plot().savefig(tmp_path / "it.png")


@pytest.mark.parametrize("surface", [tr.Bowl, tr.Dome])
@pytest.mark.parametrize("ratio", [30.0, 60.0, 150.0])
def test_a_support_that_comes_round_is_still_rolled_half_round(surface: type, ratio: float) -> None:
    system = tr.RollingSystem(BALL, tr.Support(surface(0.02 * ratio)))
    line = found_in_time(system, system.place((0.005, 0.0))).line
    assert line is not None
    # At a place where it stays the body has turned by R/r ∓ 1 for each radian that the support has.
    assert line.high == pytest.approx(math.pi * (ratio + (1 if surface is tr.Dome else -1)), rel=1e-6)


@pytest.mark.parametrize(
    ("surface", "bottom"),
    [
        (tr.EllipsoidalBowl((0.45, 0.12, 0.11)), (0.0, 0.0)),
        (tr.HeightField("-0.2*sqrt(1 - x**2 - y**2)"), (0.0, 0.0)),
        (tr.HeightField("0.1*x - 0.1*log(0.2 + x) + y**2"), (0.8, 0.0)),
        (tr.Revolution("-0.2*sqrt(0.09 - r**2)"), (0.0, 0.0)),
        (tr.Bowl(0.3), (0.0, 0.0)),
    ],
    ids=lambda one: type(one).__name__,
)
def test_where_a_search_would_reach_beyond_the_surface_it_stays_on_it(
    surface: tr.Surface, bottom: tuple[float, float]
) -> None:
    """Under a load that depends on where the body is, ten radii to either side are searched: 0.5 m here."""
    heavier = tr.Potential("0.1*z")
    system = tr.RollingSystem(tr.Body.solid_sphere(0.05, 0.1), tr.Support(surface), loads=(heavier,))
    found = found_in_time(system, system.place((0.02, 0.01)))
    places = np.array([one.contact[:2] for one in found])
    assert np.hypot(*(places - bottom).T).min() < 1e-9


@pytest.mark.parametrize(
    "loads", [(), (tr.RollingCouple(4e-5),), (tr.RollingResistance(1e-4),)], ids=["alone", "couple", "resistance"]
)
@pytest.mark.parametrize("facing", [0.0, 50.0])
def test_a_coin_on_its_edge_falls_over_whichever_way_it_faces(loads: tuple[tr.Load, ...], facing: float) -> None:
    """It tips over its rim by (5/4) m R² β̈ = m g R β, and the contact stays: it does not turn on the spot."""
    coin = tr.RollingSystem(tr.Body.disc(radius=0.0375, mass=0.4), tr.Support(tr.Plane()), loads=loads)
    found = found_in_time(coin, coin.place(attitude=(f"{facing} deg", 0.8, 0.0)))
    (one,) = found  # one family, of all headings and places
    assert one.stability == "unstable"
    couple = 4e-5 if loads and isinstance(loads[0], tr.RollingCouple) else 0.0
    A = 1.25 * 0.4 * 0.0375**2
    growth = (-couple / A + math.sqrt((couple / A) ** 2 + 4 * G * 0.8 / 0.0375)) / 2
    assert math.isclose(one.modes[0].growth, growth, rel_tol=1e-9)
    assert "tipping over its rim: a nudge grows" in str(one)
    figure = found.plot()
    assert figure.axes[0].get_xlabel() == ("angle tipped (°)" if facing else "distance rolled (cm)")
    FigureCanvasAgg(figure).draw()


@pytest.mark.parametrize("lean", [0.3, 0.8, 1.2])
@pytest.mark.parametrize(
    ("axes", "stable", "unstable"),
    [((0.05, 0.05, 0.02), 2, 1), ((0.05, 0.05, 0.09), 1, 2), ((0.05, 0.03, 0.09), 2, 4)],
    ids=["flat", "long", "of three axes"],
)
def test_an_ellipsoid_rests_on_either_end_of_an_axis_or_all_round_it(
    axes: tuple[float, float, float], stable: int, unstable: int, lean: float
) -> None:
    """Its height over the plane has two of each kind of points; of an equator all the points are one family."""
    system = tr.RollingSystem(tr.Body.ellipsoid(axes, mass=0.1), tr.Support(tr.Plane()))
    found = found_in_time(system, system.place(attitude=(0.3, lean, 0.0)))
    assert [one.stability for one in found].count("stable") == stable
    assert [one.stability for one in found].count("unstable") == unstable
    assert len(found) == stable + unstable
