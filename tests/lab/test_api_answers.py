"""The lab's answers are the package's own: every number that it sends is one that the package returns."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient
from tests.lab.conftest import shipped

import trundle as tr
from trundle.analysis.derivation.naming import derive_scenario_numbers
from trundle.lab import Settings, create_app
from trundle.lab.deriving import rows_of
from trundle.lab.settings import FILMS
from trundle.scenario import ScenarioFile, files
from trundle.views.scene import unpack


def ask(lab: TestClient, route: str, **asked: Any) -> Any:
    answer = lab.post(f"/api/{route}", json=asked)
    assert answer.status_code == 200, answer.text[:500]
    return answer


def test_the_list_names_every_scenario_and_says_which_are_exact(lab: TestClient) -> None:
    listed = {entry["name"]: entry for entry in lab.get("/api/scenarios").json()}
    assert list(listed) == files.names()
    for name in ("tilted-turntable", "rattleback", "roll-x-then-y"):
        assert listed[name]["title"] == files.title_of(name)
    told = {"support": "plane", "body": "solid-sphere", "motion": "spin", "exact": True}
    assert told.items() <= listed["tilted-turntable"].items()
    assert not listed["rattleback"]["exact"]
    assert listed["roll-x-then-y"]["motion"] == "path"
    assert all(entry["summary"] for entry in listed.values())
    headings = [entry["group"] for entry in listed.values()]
    assert all(headings)
    assert min(headings.count(heading) for heading in headings) > 1, "a heading for one scenario alone"


def test_a_scenario_comes_as_it_is_written_and_as_tables(lab: TestClient) -> None:
    told = lab.get("/api/scenarios/tilted-turntable").json()
    assert told["toml"] == files.read("tilted-turntable")
    assert told["scenario"] == shipped("tilted-turntable")


def test_the_schema_is_the_packages_own(lab: TestClient) -> None:
    assert lab.get("/api/schema").json() == json.loads(json.dumps(ScenarioFile.schema()))


def test_it_says_whether_a_worker_has_answered_yet(lab: TestClient) -> None:
    unstarted = TestClient(create_app(), base_url="http://127.0.0.1")
    assert unstarted.get("/api/ready").json() == {"ready": False}
    ask(lab, "simulate", scenario=shipped("tilted-turntable"), samples=50)
    answer = lab.get("/api/ready")
    assert answer.json() == {"ready": True}
    assert answer.headers["cache-control"] == "no-store"  # it is not to be remembered


@pytest.mark.parametrize("name", ["level-turntable-nudged", "ball-in-a-trough", "ball-in-a-funnel"])
def test_a_scene_holds_the_run(lab: TestClient, name: str) -> None:
    run = tr.Scenario.load(name).run()
    scene = unpack(ask(lab, "simulate", scenario=shipped(name)).content)
    assert scene.header["method"] == run.method
    assert scene.header["card"] is None
    shown = run.at(scene.columns["time"]).data
    size = float(np.abs(run.data.position).max())
    assert np.allclose(scene.columns["position"], shown.position, rtol=0, atol=1e-6 * size)  # float32
    assert np.allclose(scene.columns["velocity"], shown.velocity, rtol=1e-5, atol=1e-5)


def test_a_changed_number_changes_the_path(lab: TestClient) -> None:
    tables = shipped("level-turntable-nudged")
    tables["support"]["motion"]["rate"] = "20 rpm"
    scene = unpack(ask(lab, "simulate", scenario=tables, samples=100).content)
    run = tr.Scenario.read(tables).run()
    assert scene.columns["time"].size <= 110  # events add their own instants
    assert np.allclose(scene.columns["position"][-1], run.data.position[-1], rtol=0, atol=1e-6)


def test_what_is_asked_again_comes_from_the_cache_byte_for_byte(lab: TestClient) -> None:
    tables = shipped("tilted-turntable")
    first = ask(lab, "simulate", scenario=tables)
    turned_round = dict(reversed(tables.items()))
    again = ask(lab, "simulate", scenario=turned_round)
    assert again.content == first.content  # with the seconds that the first one took
    assert again.headers["etag"] == first.headers["etag"]
    other = ask(lab, "simulate", scenario=tables, samples=50)
    assert other.headers["etag"] != first.headers["etag"]


def test_a_lab_without_a_cache_computes_again_and_takes_no_long_request() -> None:
    settings = Settings(workers=1, slow_workers=1, cache_bytes=0, body_bytes=5000)
    with TestClient(create_app(settings), base_url="http://127.0.0.1") as lab:
        tables = shipped("tilted-turntable")
        first, again = (ask(lab, "simulate", scenario=tables, samples=50) for _ in range(2))
        assert again.content != first.content  # each has the seconds that it took
        long = lab.post("/api/simulate", json={"scenario": {**tables, "notes": 5000 * "a"}})
        assert long.status_code == 413


def test_a_film_has_as_long_to_arrive_as_its_setting_says() -> None:
    settings = Settings(film_bytes=7, film_reading_time=8.0, body_bytes=9, upload_bytes=10, reading_time=11.0)
    assert settings.body_bounds(FILMS) == (7, 8.0)
    assert settings.body_bounds("/api/track") == (10, 11.0)
    assert settings.body_bounds("/api/fit") == (9, 11.0)


def test_who_has_an_answer_is_not_sent_it_again(lab: TestClient) -> None:
    for answer in (lab.get("/api/scenarios"), lab.get("/api/schema")):
        assert answer.status_code == 200
        again = lab.get(answer.request.url, headers={"if-none-match": f'"other", {answer.headers["etag"]}'})
        assert (again.status_code, again.content) == (304, b"")
        assert again.headers["etag"] == answer.headers["etag"]


def test_words_are_compressed_for_who_can_read_that(lab: TestClient) -> None:
    small = lab.get("/api/scenarios", headers={"accept-encoding": "gzip"})
    plain = lab.get("/api/scenarios", headers={"accept-encoding": "identity"})
    assert small.headers["content-encoding"] == "gzip"
    assert "content-encoding" not in plain.headers
    assert small.json() == plain.json()
    assert int(small.headers["content-length"]) < len(plain.content) / 2


def test_a_scene_is_compressed_for_who_can_read_that(lab: TestClient) -> None:
    asked = {"scenario": shipped("tilted-turntable"), "samples": 500}
    small = lab.post("/api/simulate", json=asked, headers={"accept-encoding": "gzip"})
    plain = lab.post("/api/simulate", json=asked, headers={"accept-encoding": "identity"})
    assert small.headers["content-encoding"] == "gzip"
    assert "content-encoding" not in plain.headers
    assert small.content == plain.content
    assert int(small.headers["content-length"]) < 0.7 * len(plain.content)


def test_the_card_is_the_packages_own(lab: TestClient) -> None:
    told = ask(lab, "card", scenario=shipped("level-turntable-nudged")).json()
    card = tr.Scenario.load("level-turntable-nudged").run().card()
    assert [figure["name"] for figure in told["figures"]] == [figure.name for figure in card.figures]
    assert told["passed"] is True
    circle = next(figure for figure in card.figures if figure.passed is None and figure.value > 0)
    assert next(f for f in told["figures"] if f["name"] == circle.name)["value"] == circle.value


def test_a_scene_brings_its_card_where_asked(lab: TestClient) -> None:
    scene = unpack(ask(lab, "simulate", scenario=shipped("roll-home-turned"), card=True).content)
    assert scene.header["card"]["passed"] is True


def test_the_derivation_is_told_step_by_step(lab: TestClient) -> None:
    told = ask(lab, "derivation", scenario=shipped("tilted-turntable")).json()
    derived = tr.derive(tr.Scenario.load("tilted-turntable"))
    assert [step["title"] for step in told["steps"]] == [step.title for step in derived.steps]
    assert all(step["latex"] for step in told["steps"] if "closed form" not in step["title"])
    numbers = {number["symbol"]: number["value"] for number in told["numbers"]}
    assert numbers[r"\kappa"] == pytest.approx(2 / 7 * 33.3 * 2 * np.pi / 60)
    names = {number["symbol"]: number["name"] for number in told["numbers"]}
    assert names[r"\varrho"] == "radius of the circle"
    assert names[r"\operatorname{Im} v_{d}"] == "velocity at which the circle drifts, along the second axis"
    assert numbers[r"\operatorname{Re} \varphi"] == pytest.approx(9.80665 * np.sin(np.radians(0.3)) / 1.4)


def test_every_number_of_a_derivation_has_a_name_of_its_own() -> None:
    seen = set()
    for name in files.names():
        if files.rolls_along_path(files.parse(files.read(name), name)):
            continue
        rows = [row for one in derive_scenario_numbers(name) for row in rows_of(one, str(one.symbol))]
        nameless = [row["symbol"] for row in rows if not row["name"] or row["name"].startswith(",")]
        assert nameless == [], name
        assert len({row["name"] for row in rows}) == len(rows), name
        seen |= {row["symbol"] for row in rows}
    assert {"varrho", "v_d", "lambda_0", "theta_0", "T"} <= {symbol.rpartition(" ")[2] for symbol in seen}


def test_a_time_that_never_ends_is_not_among_the_numbers(lab: TestClient) -> None:
    """Without weight nothing swings: JSON has no infinity."""
    still = {**shipped("cylinder-in-cylinder"), "gravity": 0, "start": {"position": ["30 deg", 0]}}
    told = ask(lab, "derivation", scenario=still).json()
    assert [number["symbol"] for number in told["numbers"]] == ["m", "a", "k", "b", r"\ell", r"\theta_{0}"]


def test_where_nothing_closed_covers_it_the_general_law_is_derived(lab: TestClient) -> None:
    told = ask(lab, "derivation", scenario=shipped("rattleback")).json()
    assert told["steps"]
    assert told["numbers"] == []


def test_the_charge_moves_as_the_ball(lab: TestClient) -> None:
    scene = unpack(ask(lab, "twin", scenario=shipped("tilted-turntable"), samples=500).content)
    run = tr.Scenario.load("tilted-turntable").run().at(scene.columns["time"])
    assert scene.header["kind"] == "charge"
    assert np.allclose(scene.columns["position"][:, :2], run.data.position[:, :2], rtol=0, atol=1e-6)
    assert np.allclose(scene.columns["velocity"][:, :2], run.data.velocity[:, :2], rtol=0, atol=1e-6)
    (ex, _, _), (_, _, b) = scene.header["E"], scene.header["B"]
    assert scene.header["drift"][1] == pytest.approx(-ex / b)  # E×B/B²
    force = scene.columns["electric_force"] + scene.columns["magnetic_force"]
    pushed = np.gradient(scene.columns["velocity"].astype(float), scene.columns["time"], axis=0)
    assert np.allclose(force[5:-5], scene.header["body"]["mass"] * pushed[5:-5], rtol=0, atol=1e-3)


def test_a_ball_that_no_charge_is_like_is_refused_in_words(lab: TestClient) -> None:
    answer = lab.post("/api/twin", json={"scenario": shipped("rattleback")})
    assert answer.status_code == 422
    assert "Nothing corresponds to this" in answer.json()["error"]["message"]
    assert answer.json()["error"]["kind"] == "OutOfDomainError"


def test_quarter_turns_in_two_orders_end_differently(lab: TestClient) -> None:
    pole = {}
    for order in ((0, 90), (90, 0)):
        pieces = [{"kind": "straight", "heading": f"{way} deg", "turn": "90 deg"} for way in order]
        scene = unpack(ask(lab, "roll", radius="25 mm", curve={"path": pieces}).content)
        pole[order] = np.round(scene.header["north_pole"], 9) + 0.0
        assert len(scene.header["stages"]) == 3
    assert pole[0, 90].tolist() == [1, 0, 0]  # by hand: over y first, then over -x
    assert pole[90, 0].tolist() == [0, 1, 0]


def test_a_small_loop_turns_the_ball_by_its_area(lab: TestClient) -> None:
    loop = {"kind": "arc", "radius": "2 mm", "angle": "360 deg"}
    scene = unpack(ask(lab, "roll", radius="100 mm", curve=loop).content)
    area = np.pi * 0.002**2
    assert scene.header["enclosed_area"] == pytest.approx(area)
    assert scene.header["turned_about_normal"] == pytest.approx(-area / 0.1**2, rel=1e-3)
    assert scene.header["formula"]["source"] == "G4"
    about = next(row for row in scene.header["findings"] if row["symbol"] == r"\psi")
    assert abs(about["measured"] - about["predicted"]) == pytest.approx(about["difference"] * area / 0.1**2, rel=1e-2)
    assert 0 < about["difference"] < 1e-3
    still, moved = scene.columns["position"][[0, -1]]
    assert np.allclose(still, moved, atol=1e-7)
    speed = np.linalg.norm(scene.columns["velocity"], axis=1)
    assert np.allclose(speed, scene.header["length"] / scene.header["duration"], rtol=1e-5)


def test_a_path_scenario_is_simulated_too(lab: TestClient) -> None:
    scene = unpack(ask(lab, "simulate", scenario=shipped("roll-x-then-y")).content)
    assert scene.header["kind"] == "rolled"
    of_a_run = unpack(ask(lab, "simulate", scenario=shipped("tilted-turntable"), samples=50).content).header
    assert of_a_run.keys() <= scene.header.keys()
    assert of_a_run["support"].keys() == scene.header["support"].keys()
    assert of_a_run["body"].keys() == scene.header["body"].keys()
    rolled = tr.PathScenario.load("roll-x-then-y").run()
    assert np.allclose(scene.columns["orientation"][-1], rolled.stages.orientation[-1], atol=1e-6) or np.allclose(
        scene.columns["orientation"][-1], -rolled.stages.orientation[-1], atol=1e-6
    )
