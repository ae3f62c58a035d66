"""By keyboard alone: the start is moved, the velocity changed, the ball thrown; and a page keeps its swipes."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import Page, expect

import trundle as tr

from .bench import Bench, eventually
from .visiting import Visitor

NAME = "level-turntable-nudged"


@pytest.fixture(scope="module")
def page(staying: Visitor) -> Page:
    return staying.open(f"#/bench?name={NAME}", drawn=False, cards=False)


def start(bench: Bench) -> tuple[np.ndarray, np.ndarray]:
    state = tr.Scenario.read(bench.scenario()).start_state()
    return np.array(state.position[:2]), np.array(state.velocity[:2])


def test_the_arrow_keys_move_the_start_and_change_its_velocity_and_enter_throws(page: Page) -> None:
    bench = Bench(page)
    place, velocity = start(bench)
    radius = float(tr.Scenario.load(NAME).system().body.radius)
    bench.tool("Move it")
    bench.stage.canvas.focus()
    for _ in range(3):
        page.keyboard.press("ArrowLeft")
    page.keyboard.press("Shift+ArrowUp")

    def moved() -> None:
        now, as_before = start(bench)
        assert now - place == pytest.approx([-0.6 * radius, radius], abs=2e-5)
        assert as_before == pytest.approx(velocity, abs=1e-9)

    eventually(page, moved)
    bench.tool("Draw its velocity")
    bench.stage.canvas.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")

    def faster() -> None:
        assert start(bench)[1] - velocity == pytest.approx([0.04, 0.0], abs=1e-5)

    eventually(page, faster)
    bench.settle()
    page.keyboard.press("Enter")
    expect(page.locator("[data-playing]").first).to_have_attribute("data-playing", "true")
    page.keyboard.press("Space")


def test_an_arrow_key_nudges_while_it_runs(page: Page) -> None:
    bench = Bench(page)
    bench.stage.canvas.focus()
    page.keyboard.press("End")
    bench.tool("Nudge it")
    bench.stage.canvas.focus()
    before = bench.run().data.velocity.values[-1]
    page.keyboard.press("ArrowUp")

    def nudged() -> None:
        assert start(bench)[1] - before[:2] == pytest.approx([0.0, 0.05], abs=1e-4)

    eventually(page, nudged)


def test_keys_of_other_controls_stay_theirs(page: Page) -> None:
    bench = Bench(page)
    bench.tool("Move it")
    place, _ = start(bench)
    film = page.get_by_role("slider", name="Time", exact=True)
    film.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    assert start(bench)[0] == pytest.approx(place)


def test_a_finger_beside_a_ball_scrolls_a_page_that_scrolls(visitor: Visitor) -> None:
    """Whether a touch is kept from the page is all that a page can say of it."""
    page = visitor.open("#/tour/4", size={"width": 390, "height": 700}, has_touch=True, drawn=False, cards=False)
    canvas = page.get_by_test_id("stage").first
    canvas.wait_for()
    touched = """canvas => {
        const box = canvas.getBoundingClientRect()
        const at = new Touch({identifier: 1, target: canvas, clientX: box.left + 4, clientY: box.top + 4})
        const said = {touches: [at], targetTouches: [at], changedTouches: [at], bubbles: true, cancelable: true}
        const kept = !canvas.dispatchEvent(new TouchEvent('touchstart', said))
        return [kept, canvas.style.touchAction]
    }"""
    assert canvas.evaluate(touched) == [False, "pan-y"]
