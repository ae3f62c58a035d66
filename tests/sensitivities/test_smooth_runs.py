"""Derivatives of runs without events: against fifty digits where there is a formula, else against differences."""

from __future__ import annotations

from typing import Any

import mpmath
import pytest
from mpmath import mpf
from tests.precise import precisely, slope
from tests.reference.t5 import Ball
from tests.sensitivities.differences import check

import trundle as tr

RADIUS, MASS, RATIO, G = 0.025, 0.065, 0.4, 9.80665
END = 3.0


def table(tilt: float, rate: float, drag: float, velocity: tuple[float, float], spin: float) -> dict[str, Any]:
    """Return the scenario of a ball on a plane that leans and turns."""
    return {
        "gravity": G,
        "body": {"kind": "sphere", "radius": RADIUS, "mass": MASS, "inertia_ratio": RATIO},
        "support": {"kind": "plane", "tilt": tilt, "motion": {"kind": "spin", "rate": rate}},
        "loads": [{"kind": "drag", "coefficient": drag}],
        "start": {"position": [0.1, -0.03], "velocity": list(velocity), "spin": spin},
        "run": {"duration": END, "every": 0.5},
    }


def in_fifty_digits(tables: dict[str, Any], key: str) -> dict[str, Any]:
    """Return the derivatives of the complex position, velocity and angular velocity at the end, by the formula T5."""

    def moved(by: Any) -> dict[str, Any]:
        start = tables["start"]
        numbers = {
            "gravity": mpf(G),
            "body.radius": mpf(RADIUS),
            "body.mass": mpf(MASS),
            "body.inertia_ratio": mpf(RATIO),
            "support.tilt": mpf(tables["support"]["tilt"]),
            "support.motion.rate": mpf(tables["support"]["motion"]["rate"]),
            "loads[0].coefficient": mpf(tables["loads"][0]["coefficient"]),
            "start.spin": mpf(start["spin"]),
            **{f"start.position[{i}]": mpf(part) for i, part in enumerate(start["position"])},
            **{f"start.velocity[{i}]": mpf(part) for i, part in enumerate(start["velocity"])},
        }
        numbers[key] += by
        n = numbers
        pull = n["body.mass"] * n["gravity"]
        ball = Ball(
            n["body.radius"],
            n["body.mass"],
            n["body.inertia_ratio"],
            n["support.motion.rate"],
            (n["start.position[0]"], n["start.position[1]"]),
            (n["start.velocity[0]"], n["start.velocity[1]"]),
            n["start.spin"],
            (pull * mpmath.sin(n["support.tilt"]), mpf(0), -pull * mpmath.cos(n["support.tilt"])),
            drag=n["loads[0].coefficient"],
        )
        return {name: found.value for name, found in ball.at(END).items() if name != "spin"}

    return {name: slope(lambda by, name=name: moved(by)[name]) for name in moved(0)}


KEYS = ("gravity", "body.radius", "body.mass", "body.inertia_ratio", "support.tilt", "support.motion.rate")
KEYS += ("loads[0].coefficient", "start.position", "start.velocity", "start.spin")
TABLES = [
    table(0.05, 3.5, 0.01, (0.0, 0.2), 0.0),
    table(-0.05, -3.5, 0.01, (0.1, -0.2), 4.0),
    table(0.0, 3.5, 0.02, (0.0, 0.2), 0.0),  # level
    table(0.02, 0.0, 0.02, (0.05, 0.0), 1.0),  # no turning
    table(0.02, -1.0, 0.03, (0.0, 0.0), 0.0),  # from rest
]


@pytest.mark.parametrize("method", ["auto", "variational"])
@pytest.mark.parametrize("tables", TABLES)
@precisely
def test_a_ball_on_a_plane_has_the_derivatives_of_its_formula(tables: dict[str, Any], method: str) -> None:
    found = tr.sensitivities(tr.Scenario.read(tables), KEYS, method=method, compared=False)
    assert found.method == ("exact" if method == "auto" else "variational")
    for key in found.data.parameter.values:
        exact = in_fifty_digits(tables, str(key))
        for name, value in exact.items():
            x, y, *_ = found[name].sel(parameter=key).values[-1]
            assert abs(complex(x, y) - complex(value)) <= 1e-11 * max(1.0, abs(complex(value))), (key, name)


ELLIPSOID = {"kind": "ellipsoid", "semi_axes": [0.1, 0.06, 0.04], "mass": 0.3}
SMOOTH = {
    "a ball in a turning bowl": (
        {
            "body": {"kind": "solid-sphere", "radius": 0.02, "mass": 0.1},
            "support": {"kind": "bowl", "radius": 0.3, "tilt": 0.03, "motion": {"kind": "spin", "rate": -4.0}},
            "start": {"position": [0.06, 0.05], "velocity": [0.2, -0.1], "spin": 3.0},
        },
        ("body.radius", "body.mass", "support.radius", "support.tilt", "support.motion.rate", "start.position[0]"),
    ),
    "an ellipsoid in a hollow": (
        {
            "body": ELLIPSOID,
            "support": {"kind": "paraboloid", "radius": 0.5},
            "start": {"position": [0.03, 0.01], "velocity": [0.1, 0.05], "spin": 2.0, "attitude": [0.3, 0.4, 0.1]},
        },
        ("body.semi_axes[0]", "body.semi_axes[2]", "support.radius", "start.position[1]", "start.attitude[1]"),
    ),
    "a coin": (
        {
            "body": {"kind": "disc", "radius": 0.05, "mass": 0.02},
            "support": {"kind": "plane", "tilt": 0.1},
            "start": {"position": [0, 0], "velocity": [0.6, 0], "spin": 3.0, "attitude": [0.0, 1.4, 0.0]},
        },
        ("body.radius", "support.tilt", "gravity", "start.attitude[1]", "start.velocity[0]", "start.spin"),
    ),
    "a ball on a free table": (
        {
            "body": {"kind": "solid-sphere", "radius": 0.02, "mass": 0.1},
            "support": {"kind": "plane", "motion": {"kind": "free-axle", "inertia": 0.01, "rate": 3.0}},
            "start": {"position": [0.1, 0.0], "velocity": [0.0, 0.1]},
        },
        ("body.mass", "support.motion.inertia", "support.motion.rate", "start.velocity[1]"),
    ),
    "a shaken ball in a trough": (
        {
            "body": {"kind": "hollow-sphere", "radius": 0.03, "mass": 0.05},
            "support": {
                "kind": "cylinder",
                "radius": 0.2,
                "tilt": "80 deg",
                "motion": {"kind": "shake", "amplitude": [0.01, 0, 0], "rate": 9.0},
            },
            "start": {"position": [0.2, 0.0], "velocity": [0.1, 0.2]},
        },
        ("support.motion.amplitude[0]", "support.motion.rate", "support.radius", "body.radius", "start.position[0]"),
    ),
}


@pytest.mark.parametrize("name", SMOOTH)
def test_a_rolling_body_has_the_derivatives_of_its_runs(name: str) -> None:
    tables, keys = SMOOTH[name]
    tables = {"gravity": G, **tables, "run": {"duration": 1.0, "every": 0.25}}
    check(tables, keys)
