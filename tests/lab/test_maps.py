"""A map that the lab computes piece by piece is the sweep that the package runs at once."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient
from tests.lab.conftest import shipped
from tests.sweeps.refined import refine

import trundle as tr
from trundle.analysis.sweep.refining import next_places
from trundle.lab.maps import map_numbers
from trundle.scenario import files

OVER = [
    {"key": "support.tilt", "from": "0.1 deg", "to": "3 deg", "count": 7, "scale": "linear"},
    {"key": "support.motion.rate", "from": "5 rpm", "to": "60 rpm", "count": 6, "scale": "log"},
]
SHORT = {"duration": "1 s", "every": "50 ms"}


def tables() -> dict[str, Any]:
    return {**shipped("tilted-turntable"), "run": SHORT}


def drawn(lab: TestClient, **more: Any) -> dict[str, Any]:
    answer = lab.post("/api/map", json={"scenario": tables(), "over": OVER, "measure": "max z", **more})
    assert answer.status_code == 200, answer.text[:500]
    return answer.json()


def test_it_is_the_sweep_of_the_package(lab: TestClient) -> None:
    part = drawn(lab, measure="max hypot(x, y)")
    assert part["left"] == 0
    over = {one["key"]: {key: value for key, value in one.items() if key != "key"} for one in OVER}
    found = tr.sweep("tilted-turntable", over, {"far": "max hypot(x, y)"}, **SHORT)
    assert np.allclose(part["picture"], found.far.values.ravel(), rtol=1e-12)
    assert part["unit"] == "m"
    for axis in part["axes"]:
        assert np.allclose(axis["values"], found.dataset[axis["key"]].values, rtol=1e-12)


def test_it_goes_on_with_what_is_known(lab: TestClient) -> None:
    """What is said to be known is believed, and not run again."""
    known = list(range(40))
    part = drawn(lab, places=known, values=[None] + [7.0] * 39)
    assert part["places"] == [40, 41]
    assert part["picture"][:2] == [None, 7.0]
    assert (part["run"], part["left"]) == (42, 0)


@pytest.mark.parametrize("shape", [(40, 33), (64, 64), (17, 5)])
def test_a_map_refined_in_pieces_runs_what_one_refined_at_once_runs(shape: tuple[int, int]) -> None:
    def disc(places: Any) -> Any:
        x, y = np.unravel_index(places, shape)
        return (np.hypot(x - shape[0] / 2, y - shape[1] / 2.2) < min(shape) / 3.1).astype(int)

    whole, classes = refine(shape, disc)
    run, found = np.zeros(shape, dtype=bool), np.full(shape, np.nan)
    while (left := next_places(run, found)[0]).size:
        some = left[:11]
        found.ravel()[some], run.ravel()[some] = disc(some), True
    assert np.array_equal(run, whole)
    assert np.array_equal(next_places(run, found)[1], classes)


def test_a_run_that_the_bench_shows_has_a_map(lab: TestClient) -> None:
    """The rattleback's has 10 000 samples; here it lasts a hundredth as long."""
    scenario = {**shipped("rattleback"), "run": {"duration": 1.0, "every": 1e-4}}
    over = [{"key": key, "from": 9, "to": 10, "count": 2} for key in ("gravity", "body.mass")]
    assert drawn(lab, scenario=scenario, over=over, measure="end-time")["picture"] == [1.0] * 4


def test_the_scenario_of_a_field_is_that_of_the_sweep(lab: TestClient) -> None:
    answer = lab.post("/api/map/point", json={"scenario": tables(), "over": OVER, "place": 2 * 6 + 5})
    member = tr.Scenario.read(answer.json()["scenario"])
    assert member.support.tilt == pytest.approx(np.radians(np.linspace(0.1, 3, 7)[2]), rel=1e-12)
    assert member.support.motion.rate == pytest.approx(60 * np.pi / 30, rel=1e-12)


def test_a_member_that_cannot_be_has_no_value(lab: TestClient) -> None:
    over = [{"key": "body.mass", "from": -1, "to": 1, "count": 3}, {**OVER[0], "count": 2}]
    answer = lab.post("/api/map", json={"scenario": tables(), "over": over, "measure": "end-time"})
    assert answer.status_code == 422  # and not one by one: the least and the largest are looked at first
    assert answer.json()["error"]["key"] == "over.body.mass"


@pytest.mark.parametrize(
    ("change", "key", "said"),
    [
        ({"measure": "max q"}, "measure[0]", "must be a formula"),
        ({"over": [OVER[0], OVER[0]]}, "over", "must be two numbers"),
        ({"over": [OVER[0], {**OVER[1], "key": "support.rate"}]}, "over.support.rate", "must be a number"),
        ({"places": [42], "values": [1]}, "place", "must be below 42"),
        ({"over": [OVER[0], {**OVER[1], "count": 65}]}, "over.1.count", "less than or equal to 64"),
        ({"scenario": {**tables(), "run": {"duration": 60, "every": 0.005}}}, "run.every", "at most 10000 samples"),
        ({"scenario": "tippe-top"}, "scenario", "dictionary"),
        ({"scenario": shipped("roll-x-then-y")}, "scenario", "must have forces"),
    ],
)
def test_what_is_wrong_is_told_with_its_key(lab: TestClient, change: Any, key: str, said: str) -> None:
    answer = lab.post("/api/map", json={"scenario": tables(), "over": OVER, "measure": "max z", **change})
    assert answer.status_code == 422
    error = answer.json()["error"]
    assert error["key"] == key
    assert said in error["message"]


def test_what_it_offers_to_measure_can_be_measured(lab: TestClient) -> None:
    from trundle.analysis.sweep.measures import read_measures

    told = lab.get("/api/sweeps").json()
    assert len(read_measures(told["figures"])) == len(told["figures"])
    assert all(set(one["measures"]) and len(one["over"]) == 2 for one in told["sweeps"])
    assert json.dumps(told["colours"]["numbers"]).count("#") == 64


def test_what_it_offers_to_draw_is_taken(lab: TestClient) -> None:
    """A shipped sweep may be finer than a page can draw."""
    for one in lab.get("/api/sweeps").json()["sweeps"]:
        answer = lab.post("/api/map/point", json={"scenario": one["scenario"], "over": one["over"], "place": 0})
        assert answer.status_code == 200, answer.text


@pytest.mark.parametrize("name", [name for name in files.names() if not files.rolls_along_path(files.tables_of(name))])
def test_each_number_has_a_name_of_its_own_in_words(name: str) -> None:
    numbers = json.loads(map_numbers(files.tables_of(name)).body)
    named = [(one["group"], one["label"]) for one in numbers]
    assert len(set(named)) == len(named)
    assert not [words for words in named if "_" in "".join(words) or not words[1]]


def test_a_number_has_the_label_of_its_control(lab: TestClient) -> None:
    parts = lab.get("/api/parts").json()
    numbers = {one["key"]: one["label"] for one in json.loads(map_numbers(tables()).body)}
    assert numbers["body.radius"] == parts["body"]["solid-sphere"]["fields"]["radius"]["label"]
    assert numbers["start.position[1]"] == parts["support"]["plane"]["coordinates"][1]["label"]
    velocity = parts["common"]["start"]["velocity"]
    assert numbers["start.velocity[0]"] == f"{velocity['label']} {velocity['names'][0]}"
    assert [axis["label"] for axis in drawn(lab)["axes"]] == ["Tilt", "Rate"]
