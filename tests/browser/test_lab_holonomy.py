"""Rolling by hand in the lab: where the pole points is where the package says."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from playwright.sync_api import Page, Route, expect

import trundle as tr

from .bench import Stage, eventually, number
from .visiting import Visitor

QUARTER = math.pi / 2
HEADINGS = {"E": 0.0, "N": QUARTER, "W": 2 * QUARTER, "S": 3 * QUARTER}
NAMED = {
    "up": (0, 0, 1),
    "down": (0, 0, -1),
    "east": (1, 0, 0),
    "west": (-1, 0, 0),
    "north": (0, 1, 0),
    "south": (0, -1, 0),
}


def rolled(turns: str) -> tr.RolledPath:
    return tr.roll_along([tr.Straight(heading=HEADINGS[turn], turn=QUARTER) for turn in turns], radius=0.025)


def pole(page: Page, at: int = 0) -> np.ndarray:
    """The north pole as the page tells it."""
    said = page.get_by_test_id("pole").nth(at).inner_text()
    if said in NAMED:
        return np.array(NAMED[said], dtype=float)
    parts = re.findall(r"[−-]?[\d.]+", said)
    assert len(parts) == 3, f"no direction in {said!r}"
    return np.array([number(part) for part in parts])


def points(page: Page, direction: object, at: int = 0) -> None:
    assert pole(page, at) == pytest.approx(np.asarray(direction), abs=1e-3)


def test_the_order_of_two_quarter_turns_counts(visitor: Visitor) -> None:
    page = visitor.open("#/holonomy")
    for turns, name in (("EN", "east"), ("NE", "north")):
        page.get_by_role("button", name="Start again").click()
        expect(page.get_by_test_id("where")).to_contain_text("At home")
        for turn in turns:
            page.get_by_test_id(f"roll-{turn}").click()
        end = rolled(turns)
        eventually(page, lambda end=end: points(page, end.north_pole))
        expect(page.get_by_test_id("pole")).to_have_text(name)
        expect(page.get_by_test_id("where")).to_contain_text("1.571 east, 1.571 north")


def test_home_by_a_square_the_ball_is_turned(visitor: Visitor) -> None:
    """By arrow keys. The angle against the package's: 120 degrees about a diagonal."""
    page = visitor.open("#/holonomy")
    expect(page.get_by_test_id("where")).to_contain_text("At home")
    for key, turn in (("ArrowRight", "E"), ("ArrowUp", "EN"), ("ArrowLeft", "ENW"), ("ArrowDown", "ENWS")):
        page.keyboard.press(key)
        end = rolled(turn)
        eventually(page, lambda end=end: points(page, end.north_pole))
    expect(page.get_by_test_id("where")).to_have_text("Home again.")
    end = rolled("ENWS")
    expect(page.get_by_test_id("pole")).to_have_text("south")
    turned = page.get_by_test_id("numbers").get_by_role("row").filter(has_text="turned since the start")
    assert number(turned.get_by_role("cell").nth(1).inner_text()) == pytest.approx(
        math.degrees(end.rotation.angle), abs=0.01
    )
    assert math.degrees(end.rotation.angle) == pytest.approx(120.0, abs=1e-9)


def test_the_ball_is_dragged_along_the_plane(visitor: Visitor) -> None:
    """Along whichever way the hand went, the pole is where rolling along the way that was sent takes it."""
    page = visitor.open("#/holonomy")
    expect(page.get_by_test_id("where")).to_contain_text("At home")
    sent: list[dict] = []
    page.on(
        "request", lambda request: sent.append(request.post_data_json) if request.url.endswith("/api/roll") else None
    )
    Stage(page, page).drag((70.0, -50.0))

    def agrees() -> None:
        assert sent, "nothing was rolled"
        curve = sent[-1]["curve"]
        assert len(curve["path"]) >= 2
        end = tr.PathScenario.read({"body": {"radius": sent[-1]["radius"]}, **curve}).run()
        assert np.hypot(*end.stages.position[-1, :2]) > 0.005
        points(page, end.north_pole)

    eventually(page, agrees)


def test_two_orders_side_by_side(visitor: Visitor) -> None:
    page = visitor.open("#/holonomy/orders")
    expect(page.get_by_test_id("stage")).to_have_count(2)
    for name, turns in (("One east, one north", ("EN", "NE")), ("Two east, one north", ("EEN", "NEE"))):
        page.get_by_role("radio", name=name).check()
        page.get_by_role("button", name="Roll both").click()
        for at, way in enumerate(turns):
            end = rolled(way)
            eventually(page, lambda end=end, at=at: points(page, end.north_pole, at))


@pytest.mark.parametrize(("shape", "size"), [("Circle", 0.4), ("Circle", 0.1), ("Square", 1.2)])
def test_a_loop_turns_by_the_angle_that_the_package_says(shape: str, size: float, visitor: Visitor) -> None:
    page = visitor.open("#/holonomy/loop", drawn=False)
    page.get_by_role("radio", name=shape).check()
    page.get_by_test_id("loop-size").fill(str(size))
    length = size * 0.025
    if shape == "Circle":
        way: list = [tr.Arc(radius=length, angle=2 * math.pi, heading=0.0)]
        area = math.pi * length**2
    else:
        way = [tr.Straight(heading=HEADINGS[turn], length=length) for turn in "ENWS"]
        area = length**2
    end = tr.roll_along(way, radius=0.025)

    def agrees() -> None:
        lines = page.get_by_test_id("numbers").get_by_role("row")
        angle = lines.filter(has_text="angle turned").get_by_role("cell")
        assert number(angle.nth(1).inner_text()) == pytest.approx(math.degrees(end.rotation.angle), abs=0.011)
        assert number(angle.nth(0).inner_text()) == pytest.approx(math.degrees(area / 0.025**2), abs=0.011)
        enclosed = lines.filter(has_text="area enclosed").get_by_role("cell").nth(1).inner_text()
        assert number(enclosed) == pytest.approx(area * 1e4, rel=6e-4)

    eventually(page, agrees)
    if size == 0.1:  # for a small loop the two are all but the same
        assert end.rotation.angle == pytest.approx(area / 0.025**2, rel=0.01)


LATE = """() => {
    const ask = window.fetch
    window.fetch = async (...what) => {
        await new Promise((soon) => setTimeout(soon, 1500))
        return ask(...what)
    }
}"""


def test_the_balls_may_be_told_to_roll_before_their_ways_are_computed(visitor: Visitor) -> None:
    page = visitor.open("#/holonomy/orders")
    expect(page.get_by_test_id("pole").first).to_have_text("up")
    page.evaluate(LATE)
    page.get_by_role("radio", name="Two east, one north").check()
    page.get_by_role("button", name="Roll both").click()
    eventually(page, lambda: points(page, rolled("EEN").north_pole))


COUNTING = """() => {
    const create = document.createElement.bind(document)
    window.canvases = 0
    document.createElement = (tag, ...rest) => { canvases += tag === 'canvas'; return create(tag, ...rest) }
}"""


def test_there_and_back_while_a_page_is_fetched_builds_it_once(visitor: Visitor) -> None:
    def canvases(*routes: str) -> int:
        page = visitor.open("#/", drawn=False)
        page.evaluate(COUNTING)
        fetched: list[Route] = []
        page.route("**/assets/*.js", lambda route: fetched.append(route))
        for route in routes:
            page.evaluate("route => { location.hash = route }", route)
            page.wait_for_function("route => document.body.dataset.page === (route.slice(2) || 'start')", arg=route)
        page.wait_for_timeout(500)
        assert fetched
        page.route("**/assets/*.js", lambda route: route.continue_())  # they come when all have gone there and back
        for one in fetched:
            one.continue_()
        expect(page.locator(".holonomy-view canvas")).not_to_have_count(0)
        page.wait_for_timeout(500)
        return int(page.evaluate("canvases"))

    assert canvases("#/holonomy", "#/", "#/holonomy") == canvases("#/holonomy") > 0
