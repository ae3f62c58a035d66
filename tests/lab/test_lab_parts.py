"""What a page may offer: every kind of part, each with a first picture that can be computed, and its sliders."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

import trundle as tr
from trundle.lab import create_app
from trundle.lab.parts import all_parts
from trundle.mechanics.loads import Load
from trundle.mechanics.motions import Motion
from trundle.mechanics.parts import kinds_of
from trundle.mechanics.surfaces import Surface
from trundle.units import UNITS, unit_registry

ROOT = Path(__file__).parents[2]
PARTS = all_parts()
FAMILIES = ("body", "support", "motion", "loads")
KINDS = [(family, kind) for family in FAMILIES for kind in PARTS[family]]
BALL = {"kind": "solid-sphere", "radius": "25 mm", "mass": "510 g"}


def chosen(family: str, kind: str) -> dict[str, Any]:
    """A ball at rest on a table, with a part chosen as the page does it."""
    first = PARTS[family][kind]["first"]
    tables: dict[str, Any] = {
        "body": BALL,
        "support": {"kind": "plane"},
        "start": {"position": ["15 cm", 0]},
        "run": {"duration": "1 s", "every": "10 ms"},
    }
    if family == "motion":
        tables["support"]["motion"] = first
    else:
        tables[family] = [first] if family == "loads" else first
    tables["start"] |= PARTS[family][kind].get("start", {})
    return tables


@pytest.mark.parametrize(("family", "kind"), KINDS)
def test_what_is_chosen_can_be_run(family: str, kind: str) -> None:
    if PARTS[family][kind]["first"] is None:
        assert (family, kind) == ("motion", "combined"), "it takes more than numbers"
        return
    run = tr.Scenario.read(chosen(family, kind)).run("runge-kutta", tolerance=1e-6)
    assert float(run.data.time[-1]) > 0.3, "it runs for a while, where it does not come to an edge"


@pytest.mark.parametrize("kind", [kind for kind in PARTS["support"] if kind != "plane"])
def test_on_a_surface_that_is_chosen_something_happens(kind: str) -> None:
    state = tr.Scenario.read(chosen("support", kind)).start_state()
    assert math.hypot(*state.velocity) > 0.1


def test_every_kind_is_offered_with_a_name_and_a_sentence() -> None:
    unstarted = TestClient(create_app(), base_url="http://127.0.0.1")
    told = unstarted.get("/api/parts").json()  # a page has its controls before there is a worker
    for family, base in (("support", Surface), ("motion", Motion), ("loads", Load)):
        assert list(told[family]) == list(kinds_of(base))
    for family in FAMILIES:
        labels = [kind["label"] for kind in told[family].values()]
        assert len(set(labels)) == len(labels)
        assert all(kind["said"].endswith(".") for kind in told[family].values())


def sliders() -> list[tuple[str, dict[str, Any]]]:
    groups = [(f"{f}.{k}", part["fields"]) for f in FAMILIES for k, part in PARTS[f].items()]
    groups += [*PARTS["common"].items(), *PARTS["path"].items()]
    fields = ((f"{name}.{key}", field) for name, found in groups for key, field in found.items())
    return [(name, field) for name, field in fields if field["type"] in ("number", "vector")]


@pytest.mark.parametrize(("name", "field"), sliders())
def test_a_slider_goes_as_far_as_its_number_may(name: str, field: dict[str, Any]) -> None:  # noqa: ARG001
    assert field["min"] < field["max"]
    assert field["min"] > 0 or not field["decades"]
    assert field["unit"] in PARTS["units"][field["dimension"]]
    if "default" in field and isinstance(field["default"], float):
        assert field["min"] <= field["default"] <= field["max"]


def test_no_slider_goes_beyond_a_limit() -> None:
    common, ratio = PARTS["common"]["support"], PARTS["body"]["sphere"]["fields"]["inertia_ratio"]
    assert (common["restitution"]["min"], common["restitution"]["max"]) == (0.0, 1.0)
    assert ratio["max"] == pytest.approx(2 / 3, rel=1e-9)
    assert PARTS["support"]["cone"]["fields"]["half_angle"]["max"] == pytest.approx(math.pi / 2, rel=1e-9)
    assert PARTS["support"]["cone"]["fields"]["half_angle"]["max"] < math.pi / 2
    assert common["friction"]["min"] == 0


def test_a_ratio_is_told_of_the_balls_that_have_only_one() -> None:
    ratios = {kind: body["inertia_ratio"] for kind, body in PARTS["body"].items() if body["inertia_ratio"] is not None}
    assert ratios.keys() >= {"solid-sphere", "hollow-sphere"}
    assert ratios["solid-sphere"] == pytest.approx(2 / 5)
    assert ratios["hollow-sphere"] == pytest.approx(2 / 3)
    assert "sphere-with-moment" not in ratios
    assert {kind for kind, body in PARTS["body"].items() if body["ball"]} == {*ratios, "sphere-with-moment"}


def test_a_motion_says_which_number_is_its_rate() -> None:
    rates = {kind: motion["rate"] for kind, motion in PARTS["motion"].items() if motion["rate"]}
    assert rates == dict.fromkeys(("spin", "uneven-spin", "wobble", "free-axle"), "rate")


@pytest.mark.parametrize("dimension", list(UNITS))
def test_units_are_as_large_as_pint_has_them(dimension: str) -> None:
    registry = unit_registry()
    for unit, size in PARTS["units"][dimension].items():
        theirs = registry.Quantity(1.0, unit or "dimensionless").to(UNITS[dimension][0] or "dimensionless").magnitude
        assert size == pytest.approx(theirs, rel=1e-14), unit


def test_the_page_names_no_kind() -> None:
    kinds = "|".join(re.escape(kind) for _, kind in KINDS)
    hyphened = "|".join(re.escape(kind) for _, kind in KINDS if "-" in kind)
    named = re.compile(rf"""kind\W+['"]({kinds})['"]|['"]({hyphened})['"]|^ +'?({kinds})'?: [{{\[]""", re.MULTILINE)
    sources = [*(ROOT / "web/src/viewer").glob("*.ts"), *(ROOT / "web/src/lab/bench").glob("*.ts")]
    assert len(sources) > 50
    found = {
        f"{path.name}: {match[0]}"
        for path in sources
        if not path.name.endswith((".test.ts", "fixture.ts"))
        for match in named.finditer(path.read_text(encoding="utf-8"))
    }
    assert not found
