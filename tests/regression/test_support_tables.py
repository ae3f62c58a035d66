"""Each kind of support: from a scenario file to the surface, and back to the words of a file."""

from __future__ import annotations

import math
from typing import Any

import pytest

import trundle as tr
from trundle.errors import ScenarioError
from trundle.mechanics.algebra import Vector
from trundle.scenario import ScenarioFile
from trundle.scenario.serialize import words_of

SIDE = [-0.3, -0.1, 0.0, 0.1, 0.2, 0.4]
SADDLE = [[x * y for y in SIDE] for x in SIDE]
BODY = {"kind": "solid-sphere", "radius": "10 mm", "mass": "50 g"}
RUN = {"duration": "1 s", "every": "10 ms"}
# The keys of the file, and the surface that they mean.
TABLES: dict[str, tuple[dict[str, Any], Any]] = {
    "bowl": ({"radius": "50 cm", "rim": "30 cm"}, tr.Bowl(0.5, 0.3)),
    "closed bowl": ({"radius": 0.5}, tr.Bowl(0.5)),
    "dome": ({"radius": "1 m", "rim": 1}, tr.Dome(1.0, 1.0)),
    "cone": ({"half_angle": "45 deg", "rim": 2}, tr.Cone(math.pi / 4, "inside", 2.0)),
    "hill cone": ({"half_angle": "45 deg", "side": "outside"}, tr.Cone("45 deg", "outside")),
    "paraboloid": ({"radius": "20 cm"}, tr.Paraboloid(0.2)),
    "mound paraboloid": ({"radius": "-20 cm", "rim": "1 m"}, tr.Paraboloid(-0.2, 1.0)),
    "ellipsoidal-bowl": (
        {"semi_axes": ["40 cm", 0.3, "20 cm"], "depth": 0.1},
        tr.EllipsoidalBowl((0.4, 0.3, 0.2), 0.1),
    ),
    "torus-track": ({"ring_radius": 1, "tube_radius": "20 cm", "side": "outside"}, tr.TorusTrack(1.0, 0.2, "outside")),
    "revolution": ({"formula": "2*r**2 - r**4", "rim": 1}, tr.Revolution("2*r**2 - r**4", 1.0)),
    "measured revolution": (
        {"r": [0, "10 cm", 0.2, 0.3], "z": [0, "1 cm", 0.04, 0.09]},
        tr.Revolution.through([0.0, 0.1, 0.2, 0.3], [0.0, 0.01, 0.04, 0.09]),
    ),
    "height-field": ({"formula": "0.1*x*y"}, tr.HeightField("0.1*x*y")),
    "measured height-field": ({"x": SIDE, "y": SIDE, "z": SADDLE}, tr.HeightField.through(SIDE, SIDE, SADDLE)),
}


def whole(support: dict[str, Any], **changed: Any) -> dict[str, Any]:
    start = {"position": [0.1, 0.05]}
    return {"body": BODY, "support": support, "start": start, "run": RUN, **changed}


@pytest.mark.parametrize("name", TABLES)
def test_a_table_is_a_surface(name: str) -> None:
    table, surface = TABLES[name]
    scenario = ScenarioFile.read(whole({"kind": name.split()[-1], **table, "tilt": "5 deg", "friction": 0.2}))
    support = scenario.support.build()
    assert support.surface == surface
    assert (support.tilt, support.friction) == (math.radians(5), 0.2)
    assert ScenarioFile.loads(scenario.to_toml(), "again") == scenario.model_copy(update={"title": "scenario"})


@pytest.mark.parametrize("name", TABLES)
def test_a_surface_has_words_that_mean_it(name: str) -> None:
    words = words_of(TABLES[name][1], "support")
    assert words["kind"] == name.split()[-1]
    assert ScenarioFile.read(whole(words)).support.build().surface == TABLES[name][1]


def test_a_body_in_a_bowl_is_put_down_at_its_contact() -> None:
    read = ScenarioFile.read(whole({"kind": "bowl", "radius": "50 cm"}, start={"position": ["30 cm", 0]}))
    # The normal there leans by asin(3/5): the centre is 10 mm along it from (0.3, 0, 0.1).
    assert read.start_state().position == pytest.approx((0.3 - 0.006, 0.0, 0.1 + 0.008), abs=1e-15)


def test_a_torus_track_has_two_angles() -> None:
    table = {"kind": "torus-track", "ring_radius": 1, "tube_radius": 0.25}
    read = ScenarioFile.read(whole(table, start={"position": ["90 deg", "90 deg"]}))
    p = read.support.build().surface.point(*read.start.arguments()["position"])
    assert tuple(p) == pytest.approx((0.0, 1.25, 0.0), abs=1e-15)
    with pytest.raises(ScenarioError, match=r"start.position\[1\].*angle"):
        ScenarioFile.read(whole(table, start={"position": ["90 deg", "10 cm"]}))


def test_the_mistake_is_named_as_it_was_written() -> None:
    with pytest.raises(ScenarioError) as caught:
        ScenarioFile.read(whole({"kind": "bowl", "radius": "50 cm", "rim": "60 cm"}), "my.toml")
    assert str(caught.value) == (
        "my.toml: `support.rim` must be at most the radius; got '60 cm'. "
        "The sphere's radius is 0.5 m; a rim of that makes a hemisphere."
    )


WRONG = {
    "no radius": ({"kind": "bowl"}, r"support.radius` must be given"),
    "a hemisphere at most": ({"kind": "dome", "radius": 1, "rim": 2}, r"support.rim` must be at most"),
    "upright bowl": ({"kind": "bowl", "radius": 1, "tilt": "90 deg"}, r"support.tilt` must lie in"),
    "radians for degrees": ({"kind": "cone", "half_angle": 30}, r"support.half_angle` must lie .* deg"),
    "flat paraboloid": ({"kind": "paraboloid", "radius": 0}, r"support.radius` must not be zero"),
    "two semi-axes": ({"kind": "ellipsoidal-bowl", "semi_axes": [1, 1]}, r"semi_axes` must be a list of 3"),
    "deep bowl": ({"kind": "ellipsoidal-bowl", "semi_axes": [1, 1, 1], "depth": 2}, r"support.depth` must be at most"),
    "thick tube": ({"kind": "torus-track", "ring_radius": 1, "tube_radius": 1}, r"tube_radius` must be less"),
    "unknown side": ({"kind": "cone", "half_angle": "30 deg", "side": "in"}, r"support.side` must be one"),
    "no formula": ({"kind": "revolution"}, r"support.formula` must be given"),
    "formula and table": ({"kind": "revolution", "formula": "r2", "r": [0, 1, 2, 3]}, r"support.r` must not stand"),
    "half a table": ({"kind": "revolution", "r": [0, 1, 2, 3]}, r"support.z` must be given"),
    "not a formula": ({"kind": "height-field", "formula": "x + t"}, r"support.formula` must be a formula in x, y"),
    "formula that is code": ({"kind": "revolution", "formula": "open('f')"}, r"Not allowed: open"),
    "number for a formula": ({"kind": "revolution", "formula": 1.0}, r"support.formula` must be a formula in r, r2"),
    "three points": ({"kind": "revolution", "r": [0, 1, 2], "z": [0, 1, 2]}, r"support.r` must be 4 values"),
    "descending": ({"kind": "revolution", "r": [0, 2, 1, 3], "z": [0, 1, 2, 3]}, r"support.r` must ascend"),
    "negative": ({"kind": "revolution", "r": [-1, 0, 1, 2], "z": [0, 1, 2, 3]}, r"support.r` must not be negative"),
    "one short": ({"kind": "revolution", "r": [0, 1, 2, 3], "z": [0, 1, 2]}, r"support.z` must have as many"),
    "a mass in it": (
        {"kind": "revolution", "r": [0, 1, 2, "3 kg"], "z": [0, 1, 2, 3]},
        r"support.r\[3\]` must be a le",
    ),
    "nan in it": (
        {"kind": "revolution", "r": [0, 1, 2, 3], "z": [0, 1, 2, math.nan]},
        r"support.z\[3\]` must be a fin",
    ),
    "a rim on a table": (
        {"kind": "revolution", "r": [0, 1, 2, 3], "z": [0, 1, 2, 3], "rim": 1},
        r"support.rim` belongs",
    ),
    "a number for a grid": (
        {"kind": "height-field", "x": SIDE, "y": SIDE, "z": 1},
        r"support.z` must be a list of lists",
    ),
    "few rows": (
        {"kind": "height-field", "x": SIDE, "y": SIDE, "z": SADDLE[1:]},
        r"support.z` must have a row for each",
    ),
    "a short row": (
        {"kind": "height-field", "x": SIDE, "y": SIDE, "z": [*SADDLE[1:], [0.0]]},
        r"support.z\[5\]` must have a height for each y",
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_named(name: str) -> None:
    table, message = WRONG[name]
    with pytest.raises(ScenarioError, match=message):
        ScenarioFile.read(whole(table))


def test_a_table_is_no_parameter() -> None:
    from trundle.mechanics.parameters import numbers, with_numbers

    surface = TABLES["measured height-field"][1]
    assert numbers(surface) == []
    assert with_numbers(surface, []) == surface


def test_a_table_cannot_be_traced_and_says_so() -> None:
    sympy = pytest.importorskip("sympy")
    surface = TABLES["measured revolution"][1]
    x, y, z = sympy.symbols("x y z")
    assert not surface.analytic
    with pytest.raises(tr.OutOfDomainError, match=r"no formula to trace.*runge-kutta"):
        surface.normal(Vector(x, y, z))


@pytest.mark.parametrize("name", TABLES)
def test_a_start_in_python_is_written_so_that_it_reads_back(name: str) -> None:
    surface = TABLES[name][1]
    system = tr.RollingSystem(tr.Body.solid_sphere(0.01, 0.05), tr.Support(surface, motion=tr.Spin(2.0)))
    start = system.place((0.15, 0.05), (0.1, -0.2), spin=3.0)
    again = ScenarioFile.describe(system, start, duration=1.0, every=0.1).start_state()
    for part in ("position", "velocity", "angular_velocity"):
        assert getattr(again, part) == pytest.approx(getattr(start, part), abs=1e-13)
