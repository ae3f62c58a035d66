"""Challenges: what a page is told, what is kept from it, and answers that are right by formulas of textbooks."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

import trundle as tr
from trundle.lab.challenges import ByChoice, ByNumber, ByRun, challenge, names
from trundle.lab.errors import RefusedError
from trundle.lab.judging import QUANTITIES, judge, run
from trundle.scenario import files
from trundle.views.scene import unpack

G = 9.80665
ALL = names()


def solid_drift(tilt: float, rate: float) -> float:
    """How fast a solid ball drifts over a turntable that leans, m/s: g sin(tilt) / (k omega)."""
    return G * math.sin(math.radians(tilt)) / (0.4 * rate)


# What solves each challenge that is solved by a run, from closed formulas.
RATE = 33.3 * math.pi / 30
SOLVED: dict[str, dict[str, float]] = {
    "stay-on-the-turntable": {"outwards": 0.0, "along": 0.0},  # a circle of radius v/kappa = 0
    "still-above-the-slope": {"growth": 2.5 * G * math.sin(math.radians(0.3)) / 0.2},  # a m g sin = I (omega' r / a)
    "straight-across": {"level": 100 * solid_drift(1.0, RATE)},
    "stop-the-cue-ball": {"backspin": 2.5 * 0.3 / 0.028575 / (2 * math.pi)},  # no angular momentum about the cloth
    "just-over-the-top": {"speed": 0.005 * math.ceil(math.sqrt(27 / 7 * G * 0.19) / 0.005)},
    "one-round-in-five-seconds": {"rate": 12 * 3.5},
    "steepest-slope": {"slope": math.floor(10 * math.degrees(math.atan(3.5 * 0.1))) / 10},
}
# A square of sides s, as turns of the ball: cos(theta/2) = 1 - 2 sin^4(s/2).
SIDE = 2 * math.degrees(math.asin((0.5 * (1 - math.cos(math.radians(45)))) ** 0.25))
SOLVED["home-turned"] = {"east": SIDE, "north": SIDE}


def test_there_are_ten_to_begin_with() -> None:
    assert len(ALL) >= 10
    by_run = {name for name in ALL if isinstance(challenge(name).answer, ByRun)}
    assert by_run == set(SOLVED)


@pytest.mark.parametrize("name", ALL)
def test_a_challenge_is_whole(name: str) -> None:
    one = challenge(name)
    assert one.scenario in files.names()
    assert len(one.hints) >= 2
    assert one.teacher.wrong
    known = {control.name for control in one.controls}
    for control in one.controls:
        assert control.least <= control.first <= control.most
    for text in (one.title, one.task, one.summary, one.explain, one.explanation, *one.hints):
        assert "`" not in text, "no backticks"
        assert "'" not in text, "apostrophes as they are printed"
        assert not any(path in text for control in one.controls for path in control.paths), "no keys of files"
    if isinstance(one.answer, ByRun):
        for condition in one.answer.conditions:
            assert condition.quantity in QUANTITIES or condition.control in known
            assert (condition.least, condition.most) != (None, None)
    for body in [body.name for body in one.bodies] or [""]:
        assert run(one, {}, body, 20).columns["time"].size >= 2


@pytest.mark.parametrize("name", sorted(SOLVED))
def test_what_a_textbook_says_is_right_and_the_first_setting_is_not(name: str) -> None:
    one = challenge(name)
    before = judge(one, {}, None)
    assert not before["right"]
    assert before["explanation"] == ""
    after = judge(one, SOLVED[name], None)
    assert after["right"], after["found"]
    assert after["explanation"] == one.explanation


@pytest.mark.parametrize("name", sorted(SOLVED))
def test_a_little_beside_it_is_not_right(name: str) -> None:
    """The condition tells: five steps off the formula by a tenth of the range the answer is wrong."""
    one = challenge(name)
    for control in one.controls:
        if control.name not in SOLVED[name] or control.name == "push":
            continue
        for way in (-0.12, 0.12):
            value = SOLVED[name][control.name] + way * (control.most - control.least)
            if control.least <= value <= control.most:
                assert not judge(one, SOLVED[name] | {control.name: value}, None)["right"], (control.name, value)


def test_a_number_is_right_within_its_bounds() -> None:
    """Measured as a pupil does: the time of a circle on the film, and k = kappa / (omega - kappa)."""
    one = challenge("mystery-ball")
    assert isinstance(one.answer, ByNumber)
    scene = run(one, {}, "Mystery ball")
    heading = QUANTITIES["heading"](scene)
    kappa = heading[-1] / scene.columns["time"][-1]
    measured = kappa / (RATE - kappa)
    assert judge(one, {}, measured)["right"]
    assert not judge(one, {}, 0.4)["right"]
    for nonsense in ("round", None, math.nan):
        with pytest.raises(RefusedError, match="must be a number"):
            judge(one, {}, nonsense)


def test_the_hollow_ball_falls_behind() -> None:
    one = challenge("which-is-hollow")
    assert isinstance(one.answer, ByChoice)
    ways = {body.name: float(QUANTITIES["way"](run(one, {}, body.name))[-1]) for body in one.bodies}
    slow = min(ways, key=lambda name: ways[name])
    assert judge(one, {}, slow)["right"]
    assert ways["Ball B"] / ways["Ball A"] == pytest.approx((1 + 2 / 3) / (1 + 2 / 5), rel=1e-6)
    with pytest.raises(RefusedError, match="Choose one of"):
        judge(one, {}, "Ball C")


def test_what_a_run_shows_is_what_the_package_says() -> None:
    ball = tr.Scenario.load("level-turntable-nudged").run()
    scene = run(challenge("one-round-in-five-seconds"), {})
    speed = float(np.linalg.norm(ball.data.velocity.values[0]))
    assert QUANTITIES["speed"](scene) == pytest.approx(speed, rel=1e-5)
    assert QUANTITIES["heading"](scene)[-1] == pytest.approx(2 / 7 * RATE * 5, rel=1e-5)
    assert math.degrees(QUANTITIES["turned"](run(challenge("home-turned"), {}))[-1]) == pytest.approx(120, abs=1e-3)


def ask(lab: TestClient, name: str, what: str, **asked: Any) -> Any:
    return lab.post(f"/api/challenges/{name}/{what}", json=asked)


def test_the_page_is_not_told_what_is_hidden(lab: TestClient) -> None:
    listed = {one["name"]: one for one in lab.get("/api/challenges").json()}
    assert list(listed) == ALL
    assert [one["level"] for one in listed.values()] == sorted(one["level"] for one in listed.values())
    for name, told in listed.items():
        one = challenge(name)
        text = json.dumps(told, ensure_ascii=False)
        assert one.explanation not in text
        assert not {"value", "within", "right", "conditions"} & set(told["answer"])
        assert not any(path in text for control in one.controls for path in control.paths)
    mystery = unpack(ask(lab, "mystery-ball", "run", body="Mystery ball", samples=100).content)
    said = json.dumps(mystery.header)
    assert "0.52" not in said
    assert not any(mystery.header[key] for key in ("findings", "headline", "formula", "curves", "events", "scenario"))
    assert not np.any(mystery.columns["contact_force"])
    moved = {"time", "position", "contact", "velocity", "angular_velocity", "orientation", "phase", "contact_force"}
    rest = {name for name in mystery.columns if not name.startswith(("body_", "support_"))} - moved
    assert rest <= {"guiding_centre"}, "it may tell what the ball is"
    a, b = (unpack(ask(lab, "which-is-hollow", "run", body=body).content) for body in ("Ball A", "Ball B"))
    for scene in (a, b):
        del scene.header["support"]  # which is as large as the path
    said_of = [json.dumps(scene.header) for scene in (a, b)]
    assert said_of[0].replace("Ball A", "Ball B") == said_of[1]
    for name in (name for name in a.columns if name.startswith("body_")):
        assert np.array_equal(a.columns[name], b.columns[name]), name


def test_answers_come_over_the_wire(lab: TestClient) -> None:
    right = ask(lab, "one-round-in-five-seconds", "answer", values={"rate": 42.0}).json()
    assert right["right"]
    assert right["found"][0]["value"] == pytest.approx(360, abs=0.01)
    assert ask(lab, "which-is-hollow", "answer", answer="Ball B").json()["right"] is False


@pytest.mark.parametrize(
    ("name", "what", "asked", "status", "said"),
    [
        ("no-such", "run", {}, 404, "no such challenge"),
        ("home-turned", "run", {"values": {"east": 500.0}}, 422, "East and back west must lie from 10 to 180 deg"),
        ("home-turned", "run", {"values": {"gravity": 0.0}}, 422, "no such control"),
        ("home-turned", "answer", {"values": {"east": "far"}}, 422, "valid number"),
        ("which-is-hollow", "run", {"body": "Ball C"}, 422, "Ball A, Ball B"),
        ("mystery-ball", "answer", {"answer": "big"}, 422, "must be a number"),
    ],
)
def test_what_cannot_be_asked_is_refused_in_words(
    lab: TestClient, name: str, what: str, asked: dict[str, Any], status: int, said: str
) -> None:
    answer = ask(lab, name, what, **asked)
    assert answer.status_code == status
    assert said in answer.json()["error"]["message"]


def test_every_scenario_has_a_picture_and_a_level(lab: TestClient) -> None:
    levels = [entry["level"] for entry in lab.get("/api/scenarios").json()]
    assert set(levels) == {1, 2, 3}
    answer = lab.get("/api/scenarios/tilted-turntable/picture")
    assert answer.headers["content-type"].startswith("image/svg+xml")
    assert answer.text.count('class="p"') == 1
    assert len(answer.content) < 20_000
    assert lab.get("/api/scenarios/no-such/picture").status_code == 404
