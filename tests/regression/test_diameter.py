"""A diameter may stand instead of any radius of a body or a surface: it is halved to the last digit and checked."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel

from trundle.errors import ScenarioError
from trundle.scenario import ScenarioFile
from trundle.scenario.fields import diameter_of
from trundle.scenario.path_file import PathFile
from trundle.scenario.tables import KINDS

# Each kind that has a radius, with the other keys that it needs.
NEEDED: dict[str, dict[str, Any]] = {
    "sphere": {"inertia_ratio": 0.4},
    "sphere-with-moment": {"moment_of_inertia": 1e-4},
    "eccentric-sphere": {"moments": [1e-4, 1e-4, 1e-4]},
    "weighted-cylinder": {"weight": 0.1, "distance": 0.01},
    "eccentric-cylinder": {"moment_of_inertia": 1e-4, "centre": [0.001, 0, 0]},
}
SIZES = {"radius": "25 mm", "rim_radius": "5 mm", "ring_radius": "1 m", "tube_radius": "20 cm"}
TWICE = {"radius": "50 mm", "rim_radius": "10 mm", "ring_radius": "2 m", "tube_radius": "40 cm"}
LARGE = {"radius": "1 m", "ring_radius": "1 m", "tube_radius": "20 cm"}
LARGE_TWICE = {"radius": "2 m", "ring_radius": "2 m", "tube_radius": "40 cm"}


def radii(table: type[BaseModel]) -> list[str]:
    return [key for key in table.model_fields if key.endswith("radius")]


BODIES = [kind for kind, table in KINDS["body"].items() if radii(table)]
SUPPORTS = [kind for kind, table in KINDS["support"].items() if radii(table) and kind != "paraboloid"]


@pytest.mark.parametrize("kind", BODIES)
def test_a_body_by_its_diameter(kind: str) -> None:
    table: Any = KINDS["body"][kind]
    keys = radii(table)
    given = {"kind": kind, "mass": 0.3, **NEEDED.get(kind, {})}
    by_radius = table.model_validate({**given, **{key: SIZES[key] for key in keys}})
    by_diameter = table.model_validate({**given, **{key.replace("radius", "diameter"): TWICE[key] for key in keys}})
    assert by_diameter == by_radius
    assert by_diameter.build() == by_radius.build()
    assert [getattr(by_diameter, key).text for key in keys] == [SIZES[key] for key in keys]


@pytest.mark.parametrize("kind", SUPPORTS)
def test_a_surface_by_its_diameter(kind: str) -> None:
    table: Any = KINDS["support"][kind]
    keys = radii(table)
    by_radius = table.model_validate({"kind": kind, **{key: LARGE[key] for key in keys}})
    whole = {key.replace("radius", "diameter"): LARGE_TWICE[key] for key in keys}
    assert table.model_validate({"kind": kind, **whole}) == by_radius


def test_every_radius_but_that_of_a_curve_has_a_diameter() -> None:
    for family in ("body", "support"):
        for kind, table in KINDS[family].items():
            for key in radii(table):
                assert (diameter_of(table, key) is None) == (kind == "paraboloid")
    assert len(BODIES) > 10
    assert SUPPORTS == ["cylinder", "bowl", "dome", "torus-track"]


def scenario(**body: Any) -> ScenarioFile:
    return ScenarioFile.read(
        {
            "body": {"kind": "solid-sphere", "mass": "70 g", **body},
            "support": {"kind": "plane"},
            "start": {"position": [0, 0]},
            "run": {"duration": 1, "every": 0.1},
        },
        "my.toml",
    )


@given(st.decimals(min_value="0.001", max_value=1000, places=6), st.sampled_from(["mm", "inch", "cm", "e-3 m", " mm"]))
def test_the_half_is_the_half_to_the_last_digit(number: Any, unit: str) -> None:
    ball = scenario(diameter=f"{number}{unit}").body
    assert Fraction(ball.radius) * 2 == Fraction(scenario(radius=f"{number}{unit}").body.radius)
    assert ScenarioFile.loads(scenario(diameter=f"{number}{unit}").to_toml()).body.radius == ball.radius


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ({"diameter": "50 mm", "radius": "25 mm"}, "`body.diameter` must not stand beside `radius`; got '50 mm'"),
        ({"diameter": "-50 mm"}, "`body.diameter` must be positive; got '-50 mm'"),
        ({"diameter": 0}, "`body.diameter` must be positive; got 0"),
        ({"diameter": "5 kg"}, "`body.diameter` must be a length; got '5 kg'"),
        ({"diameter": True}, "`body.diameter` must be a length; got True"),
        ({"diameter": [1, 2]}, "`body.diameter` must be a length; got [1, 2]"),
        ({"diametre": "50 mm"}, "`body.diametre` is no key of [body]; got '50 mm'. Did you mean 'diameter'?"),
    ],
)
def test_what_is_wrong_with_a_diameter_is_said_of_the_diameter(body: dict[str, Any], said: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        scenario(**body)
    assert str(caught.value).startswith(f"my.toml: {said}")
    assert caught.value.others == ()


def test_a_wrong_diameter_hides_no_other_mistake() -> None:
    with pytest.raises(ScenarioError) as caught:
        scenario(diameter=-1, mass=-1)
    assert {caught.value.key, caught.value.others[0].key} == {"body.diameter", "body.mass"}


def test_a_ball_that_rolls_along_a_path_may_have_a_diameter_too() -> None:
    tables = {"path": [{"kind": "arc", "diameter": "1 m", "angle": "90 deg"}]}
    by_diameter = PathFile.read({"body": {"diameter": "50 mm"}, **tables})
    assert (by_diameter.body.radius, by_diameter.path[0].radius) == (0.025, 0.5)
