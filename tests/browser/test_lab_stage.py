"""What is done by hand on the stage: move the ball, draw its velocity, nudge it while it runs."""

from __future__ import annotations

import math
import re
import time
from typing import Any

import numpy as np
import pytest
import xarray as xr
from playwright.sync_api import Response, expect

import trundle as tr
from trundle.views.scene import unpack

from .bench import Bench, eventually, linked
from .visiting import Visitor

NAME = "level-turntable-nudged"


@pytest.fixture
def bench(visitor: Visitor) -> Bench:
    """A level turntable, seen from above: right on the screen is the first axis, up is the second."""
    return from_above(visitor, NAME)


def from_above(visitor: Visitor, name: str, **options: Any) -> Bench:
    shown = Bench(visitor.open(f"#/bench?name={name}", **options))
    shown.stage.canvas.focus()
    shown.page.keyboard.press("Home")
    shown.page.keyboard.press("t")
    shown.page.get_by_role("button", name="Path", exact=True).click()  # it has the ball's colour
    shown.stage.canvas.focus()
    shown.page.wait_for_timeout(200)
    return shown


def start(bench: Bench) -> tuple[np.ndarray, np.ndarray]:
    """Position and velocity, m and m/s, at the start of the scenario that the address holds."""
    state = tr.Scenario.read(bench.scenario()).start_state()
    return np.array(state.position[:2]), np.array(state.velocity[:2])


def is_nudged_along_x(bench: Bench, then: xr.Dataset) -> None:
    """The start is where a run was then, with some velocity along x more."""
    place, velocity = start(bench)
    assert place == pytest.approx(then.position.values[:2], abs=1e-6)
    added = velocity - then.velocity.values[:2]
    assert added[0] > 0.01
    assert abs(added[1]) < 0.1 * added[0]


def is_thrown_to_the_left(bench: Bench) -> None:
    """Left on the screen is down the first axis."""
    place, velocity = start(bench)
    assert place[0] < 0.19
    assert velocity[0] < -0.05
    assert abs(velocity[1]) < 0.1 * abs(velocity[0])


def test_the_ball_is_dragged_to_another_start(bench: Bench) -> None:
    bench.tool("Move it")
    x, y = bench.stage.ball()
    bench.stage.drag((-60.0, -40.0))

    def moved() -> None:
        place, velocity = start(bench)
        assert place[0] < 0.19, "left on the screen is down the first axis"
        assert place[1] > 0.01, "up on the screen is along the second axis"
        assert velocity == pytest.approx([0.0, 0.1], abs=1e-9), "the velocity stays"
        assert bench.stage.drawn().place[:2] == pytest.approx(place, abs=1e-3)
        now = bench.stage.ball()
        assert now == pytest.approx((x - 60, y - 40), abs=6), "the ball lies where it was let go"

    eventually(bench.page, moved)
    expect(bench.box("start.position.0")).not_to_have_value("20")


def test_the_ball_is_taken_with_the_pointer_that_turns_the_view_and_put_down(bench: Bench) -> None:
    expect(bench.page.get_by_text("Take the ball and let it go, or throw it.")).to_be_visible()
    x, y = bench.stage.ball()
    mouse = bench.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x - 40, y, steps=4)
    mouse.move(x - 60, y - 40, steps=4)
    bench.page.wait_for_timeout(200)  # held still: it is put down, not thrown
    mouse.up()

    def put_down() -> None:
        place, velocity = start(bench)
        assert place[0] < 0.19
        assert place[1] > 0.01
        assert velocity == pytest.approx([0.0, 0.1], abs=1e-9), "the velocity stays"
        assert bench.stage.ball() == pytest.approx((x - 60, y - 40), abs=6), "the ball lies where it was let go"

    eventually(bench.page, put_down)
    expect(bench.page.get_by_text("Take the ball and let it go, or throw it.")).to_be_hidden()


@pytest.mark.parametrize("pause", [10, 150])  # ms from move to move: also where the page is busy
def test_the_ball_is_thrown_as_the_hand_moves(bench: Bench, pause: int) -> None:
    """At about the speed of the hand."""
    bench.page.evaluate(FLING, [*bench.stage.ball(), -60, pause])
    eventually(bench.page, lambda: is_thrown_to_the_left(bench))


def test_the_ball_is_thrown_on_a_slow_machine(bench: Bench) -> None:
    """A hand moves on, and lets go, while the page is still busy with where it was."""
    browser = bench.page.context.new_cdp_session(bench.page)
    browser.send("Emulation.setCPUThrottlingRate", {"rate": 6})
    (x, y), now = bench.stage.ball(), time.time()

    def tell(kind: str, step: int) -> None:
        at = {"x": x - 8 * step, "y": y, "timestamp": now + 0.016 * step}
        browser.send("Input.dispatchMouseEvent", {"type": kind, "button": "left", "buttons": 1, "clickCount": 1, **at})

    tell("mousePressed", 0)
    for step in range(1, 13):
        tell("mouseMoved", step)
    tell("mouseReleased", 13)
    eventually(bench.page, lambda: is_thrown_to_the_left(bench))


def test_a_click_on_the_ball_changes_nothing(bench: Bench) -> None:
    before = bench.scenario()
    x, y = bench.stage.ball()
    bench.page.mouse.click(x, y)
    bench.page.wait_for_timeout(500)
    assert bench.scenario() == before


def test_what_is_thrown_starts_its_film(visitor: Visitor) -> None:
    """Also in the middle of a film: it begins anew from where the ball was let go."""
    bench = from_above(visitor, NAME, reduced_motion="no-preference")
    eventually(bench.page, lambda: runs(bench))
    bench.page.keyboard.press("Space")
    bench.page.evaluate("document.activeElement.blur()")  # the frame of the focus is as blue as the ball
    was = bench.scenario()
    bench.stage.drag((30, 10))

    def began() -> None:
        assert bench.scenario()["start"]["position"] != was["start"]["position"]
        place, _ = start(bench)
        drawn = bench.stage.drawn()
        assert drawn.playing or math.dist(drawn.place[:2], place) > 0.15, "it neither plays nor is over at the rim"

    eventually(bench.page, began)


def runs(bench: Bench) -> None:
    assert bench.stage.drawn().time > 0.3


# Within the page, so that the hand is no slower than a hand on a busy machine either.
FLING = """async ([x, y, by, pause]) => {
  const canvas = document.querySelector('[data-testid="stage"]')
  const tell = (name, clientX) => canvas.dispatchEvent(new PointerEvent(
    name, { clientX, clientY: y, pointerId: 1, button: 0, bubbles: true, cancelable: true }))
  tell('pointerdown', x)
  for (const share of [0.2, 0.4, 0.6, 0.8, 1]) {
    await new Promise(done => setTimeout(done, pause))
    tell('pointermove', x + share * by)
  }
  tell('pointerup', x + by)
}"""


def test_its_velocity_is_drawn_as_an_arrow(bench: Bench) -> None:
    bench.tool("Draw its velocity")
    bench.stage.drag((0.0, 70.0))

    def thrown() -> None:
        place, velocity = start(bench)
        assert place == pytest.approx([0.2, 0.0], abs=1e-9), "the start stays"
        assert velocity[1] < -0.01, "down on the screen is against the second axis"
        assert abs(velocity[0]) < 0.1 * abs(velocity[1])

    eventually(bench.page, thrown)
    run = bench.run()
    assert abs(run.data.velocity.sel(axis="y").values[0] - start(bench)[1][1]) < 1e-12


def test_a_nudge_restarts_from_the_state_that_is_shown(bench: Bench) -> None:
    """The state of the run at that time, and the nudge: where it is, how it lies and how it turns are the run's own."""
    before = bench.run()
    paused = bench.play_past(0.5)
    bench.tool("Nudge it")
    bench.stage.drag((50.0, 0.0))

    def nudged() -> None:
        tables = bench.scenario()
        then = before.data.sel(time=paused.time, method="nearest")
        is_nudged_along_x(bench, then)
        lies = np.array(tables["start"]["orientation"])
        assert abs(lies @ then.orientation.values) == pytest.approx(1.0, abs=1e-6)
        assert tables["start"]["spin"] == pytest.approx(float(then.angular_velocity.values[2]), abs=1e-5)

    eventually(bench.page, nudged)


def test_a_nudge_keeps_the_clock_and_the_turn_of_a_table_that_turns_freely(visitor: Visitor) -> None:
    bench = from_above(visitor, "free-turntable-ellipse")
    before = bench.run()
    paused = bench.play_past(0.5)
    bench.tool("Nudge it")
    bench.stage.drag((50.0, 0.0))

    def nudged() -> None:
        start = tr.Scenario.read(bench.scenario()).start_state()
        then = before.data.sel(time=paused.time, method="nearest")
        assert start.time == pytest.approx(float(then.time), abs=1e-9)
        turned = (float(then.support_angle), float(then.support_rate))
        assert start.support == pytest.approx(turned, abs=1e-8)
        assert start.position == pytest.approx(then.position.values, abs=1e-6)
        added = np.array(start.velocity) - then.velocity.values
        assert added[0] > 0.01
        assert abs(added[1]) < 0.1 * added[0]

    eventually(bench.page, nudged)


def test_what_cannot_be_nudged_says_why(visitor: Visitor) -> None:
    bench = Bench(visitor.open("#/bench?name=coin-rolling-upright", drawn=False))
    bench.page.get_by_role("radio", name="Nudge it").click()
    expect(bench.page.get_by_text("Nudging is for balls whose centre of mass is in the middle.")).to_be_visible()


def test_a_body_that_only_grows_is_not_sent_again(visitor: Visitor) -> None:
    page = visitor.open("#/bench?name=ball-in-a-trough")
    bench, answers = Bench(page), list[Response]()
    before = at_rest(bench)
    page.on("response", lambda one: answers.append(one) if one.url.endswith("/api/simulate") else None)
    bench.slide("body.radius", 0.9)
    eventually(page, lambda: _in_full(answers))
    scenes = [unpack(answer.body()) for answer in answers]
    assert len({scene.header["body"]["radius"] for scene in scenes}) > 1
    assert not any("body_vertices" in scene.columns for scene in scenes)
    grown, link = at_rest(bench), linked(bench.scenario())
    assert share(before, grown) > 0.02
    whole = Bench(visitor.open(link))
    assert share(at_rest(whole), grown) < 0.001, "it looks otherwise than one that was sent whole"


def _in_full(answers: list[Response]) -> None:
    assert answers
    assert "tolerance" not in answers[-1].request.post_data_json


def at_rest(bench: Bench) -> np.ndarray:
    """The middle of the picture once it is drawn in full, from the place that the camera is put at."""
    bench.settle()
    from_the_start(bench)
    return in_full(bench)


def in_full(bench: Bench) -> np.ndarray:
    """The middle of the picture once it is drawn in full."""

    def sharp() -> None:
        assert bench.stage.sharpness() == "1"

    bench.settle()
    eventually(bench.page, sharp)
    return bench.stage.middle()


def test_a_run_that_leaves_the_picture_is_shown_whole_once_the_numbers_rest(visitor: Visitor) -> None:
    bench = Bench(visitor.open("#/bench?name=bouncing-ball-with-backspin"))
    bench.slide("body.radius", 0.6)
    found = in_full(bench)
    assert share(found, at_rest(bench)) < 0.001, "the camera was not put where it shows the run"


def test_a_view_that_somebody_chose_stays(visitor: Visitor) -> None:
    bench = Bench(visitor.open("#/bench?name=bouncing-ball-with-backspin"))
    bench.stage.canvas.hover(position={"x": 150, "y": 220})
    bench.page.mouse.wheel(0, -300)
    bench.slide("body.radius", 0.6)
    found = in_full(bench)
    assert share(found, at_rest(bench)) > 0.02, "the camera was moved"


def test_the_view_turns_comes_near_and_is_put_back(bench: Bench) -> None:
    page, stage = bench.page, bench.stage
    first = from_the_start(bench)
    box = stage.canvas.bounding_box()
    assert box
    x, y = box["x"] + 0.3 * box["width"], box["y"] + 0.3 * box["height"]
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 90, y + 10, steps=4)
    page.mouse.up()
    eventually(page, lambda: differs(bench, first))
    page.mouse.wheel(0, -400)
    eventually(page, lambda: alike(bench, first))


def from_the_start(bench: Bench) -> tuple[np.ndarray, str]:
    """What is seen, and how sharp, once the camera is put back."""
    bench.stage.canvas.focus()
    return bench.stage.seen_after("r")


def share(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.mean(np.abs(one - other).max(axis=2) > 30))


def differs(bench: Bench, first: tuple[np.ndarray, str]) -> None:
    assert share(bench.stage.middle(), first[0]) > 0.005


def alike(bench: Bench, first: tuple[np.ndarray, str]) -> None:
    again = from_the_start(bench)
    assert again[1] == first[1], "one of the pictures is coarser than the other"
    assert share(again[0], first[0]) < 0.001


@pytest.fixture(scope="module")
def leaning(staying: Visitor) -> Bench:
    """A ball put down on a table that leans, where the three frames differ; one page for all of them."""
    return Bench(staying.open("#/bench?name=tilted-turntable-put-down", drawn=False))


@pytest.mark.parametrize(("name", "frame"), [("Support", "support"), ("Riding", "corotating"), ("World", "world")])
def test_each_frame_shows_the_place_as_the_package_does(name: str, frame: str, leaning: Bench) -> None:
    bench = leaning
    last = tr.Scenario.load("tilted-turntable-put-down").run().in_frame(frame).data.position.values[-1]
    bench.page.get_by_role("button", name=name, exact=True).click()
    bench.stage.canvas.focus()
    bench.page.keyboard.press("End")
    eventually(bench.page, lambda: stands_at(bench, last))
    assert bench.stage.drawn().frame == frame


def stands_at(bench: Bench, place: np.ndarray) -> None:
    assert bench.stage.drawn().place == pytest.approx(tuple(place), abs=2e-5)


NOUNS = [
    ("coin-in-a-circle", "en", "the disc"),
    ("rattleback", "en", "the ellipsoid"),
    ("coin-in-a-circle", "de", "die Scheibe"),
    ("rocking-half-cylinder", "de", "den Halbzylinder"),
    ("tilted-turntable", "de", "die Kugel"),
]


@pytest.mark.parametrize(("name", "language", "noun"), NOUNS)
def test_the_tools_say_what_lies_there(name: str, language: str, noun: str, visitor: Visitor) -> None:
    page = visitor.open(f"?lang={language}#/bench?name={name}", drawn=False, cards=False)
    Bench(page)
    hint = page.locator(".stage-hint")
    tools = page.locator(".stage-tools .tool")
    for tool in tools.all():
        if tool.get_attribute("data-tool") == "nudge" and "turntable" not in name:
            continue
        tool.click()
        expect(hint).to_contain_text(noun)
    if noun != "die Kugel":
        said = " ".join(
            [page.locator("section.stage").inner_text(), *(one.get_attribute("title") or "" for one in tools.all())]
        )
        assert not re.search(r"\bball\b|kugel", said, re.IGNORECASE), said
