"""Derivatives by the numbers of every kind of part, against differences of runs as the result makes them."""

from __future__ import annotations

from typing import Any

import pytest

import trundle as tr
from trundle.analysis.sensitivities.keys import chosen, keys, varied
from trundle.mechanics.loads import Load
from trundle.mechanics.motions import Motion
from trundle.mechanics.parts import kinds_of
from trundle.mechanics.surfaces import Surface
from trundle.solve.charts import charts
from trundle.solve.laws import RollingLaw
from trundle.solve.variational import VariationalLaw, VariedSystem

GRID = [i * 0.05 - 0.5 for i in range(21)]
AWAY = {"position": [0.1, 0.05], "velocity": [0.1, 0.2]}
LEANING = {**AWAY, "spin": 2.0, "attitude": [0.2, 0.4, 0.1]}
ON_EDGE = {"position": [0, 0], "velocity": [0.4, 0.0], "spin": 2.0, "attitude": [0, 1.4, 0]}
FORMULA = "sqrt(0.01*nu_x**2 + 0.0064*nu_y**2 + 0.0049*nu_z**2)"
CASES: dict[str, tuple[dict[str, Any], tuple[str, ...]]] = {
    "a height field": ({"support": {"kind": "height-field", "formula": "0.3*x*x + 0.2*y*y"}}, ("body.radius", "start")),
    "a table of heights": (
        {"support": {"kind": "height-field", "x": GRID, "y": GRID, "z": [[x * x + y * y for y in GRID] for x in GRID]}},
        ("body.radius", "start"),
    ),
    "a surface of revolution": ({"support": {"kind": "revolution", "formula": "0.3*r*r"}}, ("body.radius", "start")),
    "a cone": (
        {"support": {"kind": "cone", "half_angle": 1.0}, "start": {"position": [0.3, 0.2], "velocity": [0.1, 0.3]}},
        ("support.half_angle", "body.radius", "start"),
    ),
    "a paraboloid": ({"support": {"kind": "paraboloid", "radius": 0.4}}, ("support.radius", "body.radius", "start")),
    "a bowl": ({"support": {"kind": "bowl", "radius": 0.4}}, ("support.radius", "body.radius", "start")),
    "a dome": ({"support": {"kind": "dome", "radius": 0.4}}, ("support.radius", "body.radius", "start")),
    "a cylinder": (
        {"support": {"kind": "cylinder", "radius": 0.4, "tilt": 1.4}, "start": AWAY},
        ("support.radius", "support.tilt", "start"),
    ),
    "an ellipsoidal bowl": (
        {"support": {"kind": "ellipsoidal-bowl", "semi_axes": [0.5, 0.4, 0.3]}},
        ("support.semi_axes", "body.radius", "start"),
    ),
    "an ellipsoid in a torus": (
        {
            "body": {"kind": "ellipsoid", "semi_axes": [0.1, 0.08, 0.06], "density": "2 g/cm^3"},
            "support": {"kind": "torus-track", "ring_radius": 0.5, "tube_radius": 0.3},
            "start": {**AWAY, "spin": 1.0},
        },
        ("body.density", "body.semi_axes", "support.tube_radius", "support.ring_radius", "start"),
    ),
    "a body by a support function": (
        {
            "body": {"kind": "formula", "support_function": FORMULA, "mass": 0.2, "moments": [5e-4, 6e-4, 7e-4]},
            "support": {"kind": "plane", "tilt": 0.1},
            "start": LEANING,
        },
        ("body.mass", "body.moments", "start"),
    ),
    "a body by a support function and its density": (
        {
            "body": {"kind": "formula", "support_function": FORMULA, "density": "2 g/cm^3"},
            "support": {"kind": "plane"},
            "start": LEANING,
        },
        ("body.density", "start"),
    ),
    "a torus": (
        {
            "body": {"kind": "torus", "radius": 0.05, "rim_radius": 0.02, "density": "2 g/cm^3"},
            "support": {"kind": "plane", "tilt": 0.1},
            "start": ON_EDGE,
        },
        ("body.radius", "body.rim_radius", "body.density", "start"),
    ),
    "a hemisphere": (
        {
            "body": {"kind": "hemisphere", "radius": 0.05, "mass": 0.2},
            "support": {"kind": "plane", "tilt": 0.1},
            "start": {**LEANING, "velocity": [0.1, 0.0]},
        },
        ("body.radius", "body.mass", "start"),
    ),
    "an eccentric sphere": (
        {
            "body": {
                "kind": "eccentric-sphere",
                "radius": 0.05,
                "mass": 0.2,
                "moments": [2e-4, 2.1e-4, 1.9e-4],
                "centre": [0.003, 0, 0.01],
            },
            "support": {"kind": "plane", "tilt": 0.1},
            "start": LEANING,
        },
        ("body.radius", "body.centre", "body.moments", "start"),
    ),
    **{
        f"a support that moves: {motion['kind']}": (
            {"support": {"kind": "plane", "tilt": 0.05, "motion": motion}},
            tuple(f"support.motion.{key}" for key in motion if key != "kind" and not isinstance(motion[key], str)),
        )
        for motion in (
            {"kind": "spin", "rate": -3.0},
            {"kind": "uneven-spin", "rate": 3.0, "variation": 0.1, "variation_rate": 2.0},
            {"kind": "wobble", "rate": 3.0, "angle": 0.1},
            {"kind": "shake", "amplitude": [0.01, 0.002, 0.003], "rate": 5.0},
            {"kind": "rock", "amplitude": 0.1, "rate": 5.0},
            {"kind": "precessing-tilt", "angle": 0.1, "rate": 5.0},
            {"kind": "free-axle", "inertia": 0.01, "rate": 3.0},
        )
    },
    "motions combined": (
        {
            "support": {
                "kind": "plane",
                "motion": {
                    "kind": "combined",
                    "parts": [{"kind": "spin", "rate": 3.0}, {"kind": "shake", "amplitude": [0.01, 0, 0], "rate": 5.0}],
                },
            }
        },
        ("support.motion.parts[0].rate", "support.motion.parts[1].rate", "start"),
    ),
    "a flight with drag and Magnus's force": (
        {
            "support": {"kind": "plane", "friction": 0.3, "restitution": 0.5},
            "loads": [{"kind": "magnus", "coefficient": 0.01}, {"kind": "drag", "coefficient": 0.01}],
            "start": {
                "position": [0.1, 0.05],
                "velocity": [0.5, 0.2, 1.0],
                "height": 0.1,
                "angular_velocity": [10, 3, 20],
            },
        },
        ("loads[0].coefficient", "loads[1].coefficient", "start"),
    ),
    "an ellipsoid that creeps as it begins to slip": (
        {
            "body": {"kind": "ellipsoid", "semi_axes": [0.1, 0.08, 0.06], "mass": 0.2},
            "support": {"kind": "plane", "friction": 0.05, "tilt": 0.6},
            "start": {"position": [0.1, 0.2], "velocity": [0.0, 0.0], "attitude": [0.2, 0.5, 0.1]},
        },
        ("support.friction", "support.tilt", "body.semi_axes", "start.attitude"),
    ),
    "slip against a resistance to rolling": (
        {
            "support": {"kind": "plane", "friction": 0.2, "tilt": 0.1},
            "loads": [{"kind": "rolling-resistance", "offset": 0.002}],
            "start": {"position": [0.1, 0.05], "velocity": [1.0, 0.2], "angular_velocity": [0, 0, 0]},
        },
        ("loads[0].offset", "support.friction", "start.velocity", "body.radius"),
    ),
    "a potential and a couple": (
        {
            "support": {"kind": "plane"},
            "loads": [{"kind": "potential", "formula": "2*x*x + 3*y*y"}, {"kind": "torque", "value": [0.01, 0, 0.002]}],
        },
        ("loads[1].value", "body.mass", "start"),
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_each_kind_of_part_has_its_derivatives(name: str) -> None:
    tables, wanted = CASES[name]
    plain = {"body": {"kind": "solid-sphere", "radius": 0.02, "mass": 0.1}, "start": AWAY}
    scenario = tr.Scenario.read({**plain, **tables, "run": {"duration": 0.5, "every": 0.05}})
    given = [key.name for key in keys(scenario)]
    wrt = [one for key in wanted for one in given if one.split("[")[0].startswith(key.split("[")[0]) and key in one]
    found = tr.sensitivities(scenario, wrt)
    assert not found.agreement.left_out
    assert found.agreement.apart <= 1e-8
    assert found.passed


def test_every_number_of_the_shipped_scenarios_has_its_unit() -> None:
    units = {"mass": "kg", "radius": "m", "tilt": "rad", "rate": "rad/s", "friction": "", "gravity": "m/s^2"}
    seen = set()
    for name in tr.Scenario.names():
        for key in keys(tr.Scenario.load(name)):
            last = key.name.rpartition(".")[2]
            if last in units:
                assert key.unit == units[last], (name, key.name)
                seen.add(last)
    assert seen == set(units)


def test_a_coordinate_on_a_cylinder_is_an_angle() -> None:
    units = {key.name: key.unit for key in keys(tr.Scenario.load("golfers-dilemma"))}
    assert (units["start.position[0]"], units["start.position[1]"]) == ("rad", "m")


def test_no_kind_is_left_out_that_only_these_tests_know() -> None:
    said = str(CASES)
    known = {*kinds_of(Surface), *kinds_of(Motion)} - {"plane", "fixed", "tilt", "spin-by", "move"}
    assert [kind for kind in known if f"'{kind}'" not in said] == []
    assert {"drag", "magnus", "potential", "rolling-resistance", "torque"} <= set(kinds_of(Load))


COIN = {
    "body": {"kind": "disc", "radius": 0.05, "mass": 0.02, "moments": [1.3e-5, 1.3e-5, 2.5e-5]},
    "support": {"kind": "plane", "tilt": 0.1},
    "start": {"position": [0, 0], "velocity": [0.6, 0], "spin": 3.0, "attitude": [0.2, 1.4, 0.1]},
    "run": {"duration": 1.0, "every": 0.1},
}


@pytest.mark.parametrize("wrt", ["body.moments", "start.attitude", "body.radius", "support.tilt", "start.spin"])
def test_a_coin_has_its_derivatives_also_by_what_makes_it_no_coin(wrt: str) -> None:
    found = tr.sensitivities(tr.Scenario.read(COIN), wrt)
    assert found.agreement.apart <= 1e-8
    assert not found.agreement.left_out


def test_a_chart_that_leans_on_a_symmetry_serves_only_what_keeps_it() -> None:
    scenario = tr.Scenario.read(COIN)

    def taken(*wrt: str) -> set[str]:
        wanted = chosen(scenario, wrt)
        system, _ = varied(scenario, wanted)
        law = VariationalLaw(RollingLaw(), 10, len(wanted))
        found = charts(VariedSystem.of(system), law)
        return {type(getattr(chart, "chart", chart)).__name__ for chart in found}

    assert "LineOfNodes" in taken("body.radius", "start.attitude")
    assert "LineOfNodes" not in taken("body.moments[0]")
    assert "LineOfNodes" not in taken("body.radius", "body.moments[1]")
