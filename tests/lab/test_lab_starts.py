"""Starts made by hand: geometry done by hand beside them, and runs that must go on as they went."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from starlette.testclient import TestClient

import trundle as tr
from trundle.errors import OutOfDomainError
from trundle.lab.parts import all_parts
from trundle.lab.starts import dragged, nudged, start_by_hand, thrown
from trundle.scenario import files

BALL = {"kind": "solid-sphere", "radius": "10 cm", "mass": "1 kg"}
SINE, COSINE = 0.5, math.sqrt(3) / 2
NO = (0.0, 0.0, 0.0)


def scenario(
    support: dict[str, Any], start: dict[str, Any] | None = None, loads: Any = (), duration: Any = 1.0
) -> tr.Scenario:
    tables: dict[str, Any] = {"body": BALL, "support": support, "start": start or {"position": [0.1, 0.0]}}
    return tr.Scenario.read({**tables, "loads": list(loads), "run": {"duration": duration, "every": 0.01}})


def lies(contact: tuple[float, float, float], inwards: tuple[float, float, float]) -> dict[str, Any]:
    """A ball of 10 cm that touches there, its centre in a direction from there."""
    return {"contact": list(contact), "position": [p + 0.1 * n for p, n in zip(contact, inwards, strict=True)]}


TUBE = {"kind": "torus-track", "ring_radius": "40 cm", "tube_radius": "12 cm"}


@pytest.mark.parametrize(
    ("support", "at", "place"),
    [
        ({"kind": "plane"}, lies((0.1, -0.2, 0.0), (0, 0, 1)), [0.1, -0.2]),
        ({"kind": "cylinder", "radius": 0.4}, lies((0.0, 0.4, 0.1), (0, -1, 0)), [math.pi / 2, 0.1]),
        (TUBE, lies((0.52, 0, 0), (-1, 0, 0)), [0.0, math.pi / 2]),
        (TUBE, lies((0.0, 0.4, -0.12), (0, 0, 1)), [math.pi / 2, 0.0]),
        (TUBE | {"side": "outside"}, lies((0.4, 0.0, 0.12), (0, 0, 1)), [0.0, 0.0]),
        # 30° up the side of a bowl of 50 cm: b sin α, and not where the centre is.
        ({"kind": "bowl", "radius": 0.5}, lies((0.25, 0, 0.5 - 0.5 * COSINE), (-SINE, 0, COSINE)), [0.25, 0.0]),
    ],
)
def test_a_place_is_said_in_the_coordinates_of_the_surface(
    support: dict[str, Any], at: dict[str, Any], place: list[float]
) -> None:
    start = {"position": [0.1, 0.0] if support["kind"] in ("plane", "bowl") else [0.0, 0.0]}
    said = dragged(scenario(support, start), at)["position"]
    assert said == pytest.approx(place, rel=5e-9, abs=1e-12), "in nine digits"


UP_THE_SIDE = lies((0.25, 0, 0.5 - 0.5 * COSINE), (-SINE, 0, COSINE))
BOWL = {"kind": "bowl", "radius": 0.5}


def test_a_velocity_is_said_by_its_components_along_the_surface() -> None:
    drawn = (0.4 * COSINE, -0.1, 0.4 * SINE)
    assert thrown(scenario(BOWL), UP_THE_SIDE, drawn) == {"velocity": pytest.approx([0.4, -0.1])}


def test_what_turned_with_the_old_velocity_goes_where_it_cannot_slip() -> None:
    rolling = {"position": [0.1, 0.0], "velocity": [0.1, 0.0], "angular_velocity": [0.0, 1.0, 0.0]}
    at = lies((0.1, 0.0, 0.0), (0, 0, 1))
    assert thrown(scenario({"kind": "plane"}, rolling), at, (0.2, 0, 0))["angular_velocity"] is None
    rough = scenario({"kind": "plane", "friction": 0.2}, rolling)
    assert "angular_velocity" not in thrown(rough, at, (0.2, 0, 0))


def test_what_rolled_with_its_angular_velocity_rolls_elsewhere_too() -> None:
    rolling = {"position": [0.1, 0.0], "velocity": [0.0, 0.2], "angular_velocity": [0.0, 0.0, 2.0]}
    table = {"kind": "plane", "motion": {"kind": "spin", "rate": 2.0}}
    at = lies((-0.3, 0.2, 0.0), (0, 0, 1))
    said = dragged(scenario(table, rolling), at)
    assert said == {"position": [-0.3, 0.2], "velocity": "rolling"}
    there = scenario(table, rolling | said).start_state()
    assert there.velocity == pytest.approx((-0.4, -0.6, 0.0))
    assert "velocity" not in dragged(scenario(table | {"friction": 0.2}, rolling), at)


def changed(tables: Any, times: float) -> Iterator[tuple[str, Any]]:
    """The tables with each of their numbers changed, one at a time, by the key of that number."""
    for key, value in tables.items() if isinstance(tables, dict) else enumerate(tables):
        if isinstance(value, (dict, list)):
            others = [(f"{key}.{inner}", other) for inner, other in changed(value, times)]
        else:
            found = re.fullmatch(r"([-+]?[\d.]+(?:e-?\d+)?)(.*)", str(value), re.DOTALL)
            other = found and (f"{times * float(found[1])!r}{found[2]}" if isinstance(value, str) else times * value)
            others = [(str(key), other)] if found and not isinstance(value, bool) else []
        for place, other in others:
            copy = tables.copy()
            copy[key] = other
            yield place, copy


# A cylinder that lies along a level trough slides down it where the trough leans.
STUCK = {("cylinder-in-cylinder", "support.tilt"), ("cylinder-in-turning-cylinder", "support.tilt")}
BEYOND_ONE = {("superball", "support.restitution"), ("superball", "support.tangential_restitution")}


def test_no_number_of_a_shipped_scenario_is_stuck() -> None:
    """Each may be moved by 4 %, both ways: no start is so exact that it fits its own numbers only."""
    refused, moved = set(), 0
    for name in tr.Scenario.names():
        tables = {key: part for key, part in files.tables_of(name).items() if key not in ("title", "notes", "run")}
        for times in (0.96, 1.04):
            for key, other in changed(tables, times):
                moved += 1
                try:
                    tr.Scenario.read(other | {"run": files.tables_of(name)["run"]}, "").start_state()
                except tr.TrundleError:
                    refused.add((name, key))
    assert moved > 1000
    assert refused == STUCK | BEYOND_ONE


def test_no_run_can_start_where_the_surface_overhangs() -> None:
    above = lies((0.25, 0, 0.5 + 0.5 * COSINE), (-SINE, 0, -COSINE))
    with pytest.raises(OutOfDomainError, match="overhangs"):
        dragged(scenario(BOWL), above)
    lying = {"kind": "cylinder", "radius": 0.5, "tilt": "90 deg"}
    ceiling = dragged(scenario(lying, {"position": [0.0, 0.0]}), lies((-0.5, 0.0, 0.0), (1, 0, 0)))
    assert abs(ceiling["position"][0]) == pytest.approx(math.pi)


def test_a_nudge_in_flight_goes_on_from_its_height_with_all_of_its_turning() -> None:
    at = {"position": [0.1, -0.2, 0.4], "contact": [0.1, -0.2, 0.0], "height": 0.3, "time": 2.0}
    at |= {"velocity": [0.3, 0.0, -1.0], "angular_velocity": [1.0, 2.0, 3.0], "orientation": [1.0, 0.0, 0.0, 0.0]}
    start = nudged(scenario({"kind": "plane", "friction": 0.2}), at, (0.0, 0.1, 0.0))
    assert start["velocity"] == pytest.approx([0.3, 0.1, -1.0])
    assert (start["height"], start["angular_velocity"]) == (0.3, [1.0, 2.0, 3.0])
    assert "spin" not in start


SPIN = {"kind": "spin", "rate": 2.0}
GOING_ON: dict[str, dict[str, Any]] = {
    "table": {"kind": "plane", "motion": SPIN},
    "bowl": {"kind": "bowl", "radius": 0.8, "motion": SPIN},
    "hills": {"kind": "height-field", "formula": "0.3*x**2 + 0.1*y**2", "motion": SPIN},
    "elliptic bowl": {"kind": "ellipsoidal-bowl", "semi_axes": [0.8, 0.6, 0.5], "motion": SPIN},
    "uneven": {"kind": "plane", "motion": {"kind": "uneven-spin", "rate": 2.0, "variation": 0.3, "variation_rate": 5}},
    "shaken": {"kind": "bowl", "radius": 0.8, "motion": {"kind": "shake", "amplitude": [0.02, 0, 0], "rate": 7.0}},
    "free": {"kind": "plane", "motion": {"kind": "free-axle", "inertia": 0.5, "rate": 2.0}},
}


@pytest.mark.parametrize("name", list(GOING_ON))
@pytest.mark.parametrize("loads", [(), [{"kind": "force", "value": ["0.5*sin(3*t)", 0, 0]}]], ids=["", "by the clock"])
def test_a_run_goes_on_as_it_went_from_where_nobody_nudged_it(name: str, loads: Any) -> None:
    first = scenario(GOING_ON[name], {"position": [0.1, 0.0], "velocity": [0.0, 0.2], "spin": 1.0}, loads)
    run = first.run(method="runge-kutta")
    i = 40
    now, later = run.data.isel(time=i), run.data.isel(time=-1)
    rest = float(later.time - now.time)
    at = {key: now[key].values.tolist() for key in ("position", "velocity", "angular_velocity", "contact")}
    at |= {
        "time": float(now.time),
        "support": [float(now[f"support_{own}"]) for own in first.system().support.motion.coordinates],
    }
    start = nudged(first, at | {"orientation": now.orientation.values.tolist()}, NO)
    assert ("time" in start) == (bool(loads) or name not in ("table", "bowl")), "a round surface lies where it was"
    again = scenario(GOING_ON[name], start, loads, rest).run(method="runge-kutta")
    ends = again.data.isel(time=-1)
    for key in ("position", "velocity", "angular_velocity"):
        assert np.allclose(ends[key], later[key], rtol=0, atol=2e-7), key  # a start is said in nine digits


def test_the_server_says_it_and_refuses_what_makes_no_sense(lab: TestClient) -> None:
    tables = {"body": BALL, "support": {"kind": "plane"}, "start": {"position": [0, 0]}}
    asked: dict[str, Any] = {"scenario": tables | {"run": {"duration": 1, "every": 0.1}}}
    asked["at"] = lies((0.1, -0.2, 0.0), (0, 0, 1))
    assert lab.post("/api/start", json=asked).json() == {"position": [0.1, -0.2]}
    assert lab.post("/api/start", json=asked | {"velocity": [1, 0, 0]}).json() == {"velocity": [1.0, 0.0]}
    assert lab.post("/api/start", json=asked | {"nudge": [1, 0, 0]}).status_code == 422  # it does not say how it moves
    assert lab.post("/api/start", json=asked | {"at": {"position": [0, 0, 0]}}).status_code == 422
    far = asked | {"at": {"position": [1e308, 0, 0], "contact": [-1e308, 0, 0]}}
    assert lab.post("/api/start", json=far).status_code == 422


NUMBERS = st.one_of(st.sampled_from([0.0, 0.1, -0.2, 1e308]), st.floats(allow_nan=False, allow_infinity=False))
TRIPLES = st.tuples(NUMBERS, NUMBERS, NUMBERS)


@pytest.mark.parametrize("kind", list(all_parts()["support"]))
@given(at=st.fixed_dictionaries({"position": TRIPLES, "contact": TRIPLES}), drawn=st.none() | TRIPLES)
@example(at={"position": (0.0, 0.0, 0.1), "contact": NO}, drawn=NO)  # where a cone has its apex, a cylinder its axis
@settings(max_examples=30, deadline=None)
def test_whatever_was_done_the_start_is_numbers_or_a_refusal(kind: str, at: Any, drawn: Any) -> None:
    chosen = surfaces_chosen()[kind]
    try:
        found = start_by_hand(chosen, at, drawn)
    except tr.TrundleError:
        return
    assert all(math.isfinite(number) for numbers in found.values() for number in numbers)


@cache
def surfaces_chosen() -> dict[str, tr.Scenario]:
    """A small ball on each surface as the page chooses it."""
    body = BALL | {"radius": "1 cm"}
    run = {"duration": 1, "every": 0.1}
    return {
        kind: tr.Scenario.read({"body": body, "support": part["first"], "start": part["start"], "run": run})
        for kind, part in all_parts()["support"].items()
    }
