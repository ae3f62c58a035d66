"""The rolling law on every surface: against Lagrange multipliers, against the same surface in other words; energy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.laws.test_multipliers import LOADS, MOTIONS, Case, accelerations, contact_after, normal_at, offset_at
from tests.precise import numbers, precisely, quaternions, size_of, slope, vectors
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.contact import roll
from trundle.mechanics.shapes import Ellipsoid, Sphere
from trundle.mechanics.surfaces import Surface

PRINCIPAL = tr.Principal(0.003, 0.004, 0.005)
BODIES = {
    "weighted ball": tr.Body(0.75, PRINCIPAL, Sphere(0.125, Vector(0.01, -0.02, 0.03))),
    "ellipsoid": tr.Body(0.75, PRINCIPAL, Ellipsoid(0.15, 0.125, 0.1)),
}
SURFACES: dict[str, Surface] = {
    "bowl": tr.Bowl(0.75),
    "dome": tr.Dome(0.75),
    "funnel": tr.Cone(0.5),
    "hill": tr.Cone(0.5, "outside"),
    "paraboloid": tr.Paraboloid(0.5),
    "mound": tr.Paraboloid(-0.5),
    "ellipsoidal bowl": tr.EllipsoidalBowl((1.25, 1.0, 0.75)),
    "track": tr.TorusTrack(1.25, 0.5),
    "ring": tr.TorusTrack(0.75, 0.25, "outside"),
    "revolution": tr.Revolution("0.5*r**2 - 0.25*r**4"),
    "ripples": tr.Revolution("0.05*cos(4*r)"),
    "hills": tr.HeightField("0.2*sin(1.5*x)*cos(y) + 0.1*x*y**2"),
}
CASES = [
    (body, surface, list(MOTIONS)[(i + j) % len(MOTIONS)])
    for i, body in enumerate(BODIES)
    for j, surface in enumerate(SURFACES)
]


def case_of(body: str, surface: str, motion: str) -> Case:
    """Return a random state; only the torus has coordinates in which a float is no point near the axis."""
    seed = f"{body} {surface} {motion}"
    support = tr.Support(SURFACES[surface], motion=MOTIONS[motion], tilt=0.25)
    system = tr.RollingSystem(BODIES[body], support, loads=LOADS)
    (time,) = (abs(t) for t in numbers(f"{seed} time", 1))
    now = support.motion.at(time)
    u, v = numbers(f"{seed} place", 2, 0.5)
    point = now.origin + now.rotation @ support.surface.point(u, v)
    return Case(system, time, point, quaternions(seed, 1)[0], vectors(f"{seed} turning", 1, size=4.0)[0])


@pytest.mark.parametrize(("body", "surface", "motion"), CASES, ids=[" ".join(case) for case in CASES])
@precisely
def test_the_law_is_that_of_the_multipliers(body: str, surface: str, motion: str) -> None:
    case = case_of(body, surface, motion)
    rho = offset_at(case, case.orientation, normal_at(case, case.time, case.point))
    u = case.system.support.motion.at(case.time).material_velocity(case.point)
    velocity = u - case.angular_velocity.cross(rho)
    p_at = contact_after(case, velocity)
    found = roll(case.system, case.time, case.point, case.orientation, case.angular_velocity)

    speed = size_of(velocity) + size_of(u) + size_of(case.angular_velocity) * rho.norm()
    assert size_of(found.point_rate - slope(p_at)) <= EXACT(64, speed)  # T1
    _, Omega_rate, R = accelerations(case, velocity, rho, p_at)
    assert size_of(found.angular_acceleration - Omega_rate) <= EXACT(512, size_of(Omega_rate))  # T2
    assert size_of(found.reaction - R) <= EXACT(512, size_of(R))  # T3


# --- the same surface by another formula, or by a table: the same rates --------------------------------------------

GRID = [i / 8 - 0.75 for i in range(13)]


def cubic(x: float, y: float) -> float:
    return 0.5 * x * x - 0.25 * x * y * y + 0.125 * x**3


PAIRS: dict[str, tuple[Surface, Surface, float]] = {
    # name: two ways to write a surface, and how many ulps of rounding the less good one has
    "paraboloid, by a formula": (tr.Paraboloid(0.5), tr.Revolution("r**2"), 64),
    "paraboloid, over x and y": (tr.Paraboloid(0.5), tr.HeightField("x**2 + y**2"), 64),
    "bowl, by a formula": (tr.Bowl(0.75), tr.Revolution("0.75 - sqrt(0.75**2 - r**2)"), 512),
    "bowl, of three equal axes": (tr.Bowl(0.75), tr.EllipsoidalBowl((0.75, 0.75, 0.75)), 64),
    "cone, by a formula": (tr.Cone(math.pi / 4), tr.Revolution("r"), 64),
    # A spline of degree 5 goes through a polynomial of that degree as it is, but for the rounding of its coefficients.
    "quartic, by points": (
        tr.Revolution("r**2 - r**4"),
        tr.Revolution.through([i / 10 for i in range(11)], [(i / 10) ** 2 - (i / 10) ** 4 for i in range(11)]),
        2**14,
    ),
    "cubic, by a grid": (
        tr.HeightField("0.5*x**2 - 0.25*x*y**2 + 0.125*x**3"),
        tr.HeightField.through(GRID, GRID, [[cubic(x, y) for y in GRID] for x in GRID]),
        2**14,
    ),
}
# On the axis and near it, too, where a distance from the axis is divided by; and on a knot of the tables.
PLACES = [(0.0, 0.0), (1e-9, 0.0), (0.0, -1e-160), (0.125, 0.25), (0.3, -0.4), (-0.5, 0.1)]


@pytest.mark.parametrize("name", PAIRS)
def test_one_surface_written_in_two_ways_is_rolled_on_alike(name: str) -> None:
    first, second, ulps = PAIRS[name]
    places = PLACES if "cone" not in name else PLACES[3:]
    for x, y in places:
        rates = []
        for surface in (first, second):
            system = tr.RollingSystem(BODIES["weighted ball"], tr.Support(surface, tr.Spin(2.0), tilt=0.1))
            q = Quaternion(0.5, -0.5, 0.5, 0.5)
            now = roll(system, 0.0, surface.point(x, y), q, Vector(1.0, -2.0, 3.0))
            rates.append([*now.contact.point, *now.point_rate, *now.angular_acceleration, *now.reaction])
        scale = max(map(abs, rates[0]))
        assert np.abs(np.subtract(*rates)).max() <= EXACT(ulps, scale), (x, y)


def test_a_table_takes_arrays_and_steps_aside_into_the_complex_plane() -> None:
    formula, table, ulps = PAIRS["quartic, by points"]
    x, y = np.array(PLACES[3:]).T
    step = 1e-30
    for aside in (0.0, 1j * step):  # the second gives a derivative, as finding equilibria takes them
        p = Vector(x + aside, y, 0.0 * x)
        ours, theirs = (
            [*s.normal(p), *(part for row in s.shape_operator(p).rows for part in row)] for s in (table, formula)
        )
        for mine, wanted in zip(ours, theirs, strict=True):
            assert np.abs(np.real(mine) - np.real(wanted)).max() <= EXACT(ulps, 8)
            assert np.abs(np.imag(mine) - np.imag(wanted)).max() <= EXACT(ulps, 64 * step)


# --- energy, from a start that rolls through the singular places ---------------------------------------------------

BALL = tr.Body.solid_sphere(radius=0.05, mass=0.2)
ROLLS: dict[str, tuple[Any, ...]] = {
    # surface, place of the contact, velocity, perhaps a duration: most of them lead straight through the middle
    "bowl": (tr.Bowl(0.5), (0.3, 0.0), (0.0, 0.0)),
    "bowl, from the bottom": (tr.Bowl(0.5), (0.0, 0.0), (0.5, 0.25)),
    "dome": (tr.Dome(2.0), (0.0, 0.0), (0.1, 0.0)),
    "funnel": (tr.Cone(0.75), (0.3, 0.0), (0.0, 1.5)),
    "hill": (tr.Cone(1.25, "outside"), (0.2, 0.0), (0.1, 0.2)),
    "paraboloid": (tr.Paraboloid(0.25), (0.2, 0.1), (0.0, 0.0)),
    "ellipsoidal bowl": (tr.EllipsoidalBowl((0.75, 0.5, 0.4)), (0.3, -0.2), (0.0, 0.4)),
    "track": (tr.TorusTrack(0.5, 0.2), (0.0, 0.5), (1.0, 0.0)),
    "ring": (tr.TorusTrack(0.5, 0.2, "outside"), (0.0, 0.0), (0.5, 0.1), 0.3),  # it falls off later
    "revolution": (tr.Revolution("r**2 - r**4/4"), (0.3, 0.0), (0.0, 0.0)),
    "hills": (tr.HeightField("0.1*sin(3*x)*cos(2*y)"), (0.0, 0.0), (0.5, 0.1)),
}


def energy(data: Any) -> Any:
    v2, W2 = (data.velocity**2).sum("axis"), (data.angular_velocity**2).sum("axis")
    m, moment = 0.2, 0.4 * 0.2 * 0.05**2
    return m * v2 / 2 + moment * W2 / 2 + m * 9.80665 * data.position.sel(axis="z")


@pytest.mark.parametrize("name", ROLLS)
def test_energy_is_kept(name: str) -> None:
    pytest.importorskip("heyoka")
    surface, position, velocity, *duration = ROLLS[name]
    system = tr.RollingSystem(BALL, tr.Support(surface))
    start = system.place(position, velocity, spin=1.0 if any(velocity) else 0.0)
    length = duration[0] if duration else 1.0
    run = tr.simulate(system, start, duration=length, every=0.05, method="taylor")
    assert run.data.time[-1] == length
    E = energy(run.data)
    kinetic = float((0.1 * (run.data.velocity**2).sum("axis")).max())
    assert abs(E - E[0]).max() <= SOLVER(1e4, 1e-15, kinetic + 0.2 * 9.80665 * 0.3)
    level = [float(surface.level(Vector(*map(float, p)))) for p in run.data.contact.values]
    assert max(map(abs, level)) <= 1e-13


@pytest.mark.parametrize("name", ["quartic, by points", "cubic, by a grid"])
def test_a_table_is_rolled_on_by_runge_kutta_as_its_formula(name: str) -> None:
    from scipy.integrate import solve_ivp

    ends = []
    for surface in PAIRS[name][:2]:
        system = tr.RollingSystem(BALL, tr.Support(surface))
        begin = system.place((0.2, 0.1), (0.1, -0.2))
        q = Quaternion(*begin.orientation)
        p = surface.point(0.2, 0.1)

        def law(t: float, y: Any, system: Any = system) -> list[float]:
            y = y.tolist()
            now = roll(system, t, Vector(*y[:3]), Quaternion(*y[3:7]), Vector(*y[7:]))
            return [*now.point_rate, *now.orientation_rate, *now.angular_acceleration]

        y0 = [*p, *q, *begin.angular_velocity]
        ends.append(solve_ivp(law, (0.0, 1.0), y0, method="DOP853", rtol=1e-11, atol=1e-12).y[:, -1])
    assert np.abs(ends[0] - ends[1]).max() <= SOLVER(1e3, 1e-11)
    assert abs(surface.level(Vector(*ends[1][:3]))) <= SOLVER(100, 1e-11)
