"""The bench under a finger: the ball is moved and thrown, and a swipe beside it scrolls the page."""

from __future__ import annotations

import time

import numpy as np
import pytest
from playwright.sync_api import CDPSession

from .bench import Bench, Stage, eventually
from .launching import SMALL
from .test_lab_stage import from_above, is_nudged_along_x, start
from .visiting import Visitor


class Finger:
    """One that the browser takes for a real one, with what follows of it: pointers, clicks, scrolling."""

    def __init__(self, stage: Stage) -> None:
        self.page = stage.page
        self.session: CDPSession = stage.page.context.new_cdp_session(stage.page)

    def swipe(self, begin: tuple[float, float], by: tuple[float, float], *, held: float = 0.0) -> None:
        """Put it down, move it within a tenth of a second, hold it still for some seconds, and lift it.

        The events say themselves when they are, so that a busy machine makes no throw slow.
        """
        (x, y), now = begin, time.time()
        self._send("touchStart", now, (x, y))
        for share in np.linspace(0.1, 1.0, 8):
            self._send("touchMove", now + 0.1 * share, (x + share * by[0], y + share * by[1]))
            self.page.wait_for_timeout(20)
        self._send("touchEnd", now + 0.1 + held)

    def _send(self, kind: str, when: float, *at: tuple[float, float]) -> None:
        points = [{"x": x, "y": y} for x, y in at]
        self.session.send("Input.dispatchTouchEvent", {"type": kind, "timestamp": when, "touchPoints": points})


@pytest.fixture
def bench(visitor: Visitor) -> Bench:
    return from_above(visitor, "level-turntable-nudged", has_touch=True, size=SMALL)


def test_a_finger_puts_the_ball_down_elsewhere(bench: Bench) -> None:
    x, y = bench.stage.ball()
    Finger(bench.stage).swipe((x, y), (-60.0, -40.0), held=0.4)

    def put_down() -> None:
        place, velocity = start(bench)
        assert place[0] < 0.19
        assert place[1] > 0.01
        assert velocity == pytest.approx([0.0, 0.1], abs=1e-9), "the velocity stays"
        assert bench.stage.ball() == pytest.approx((x - 60, y - 40), abs=6)

    eventually(bench.page, put_down)


def test_a_finger_throws_the_ball(bench: Bench) -> None:
    Finger(bench.stage).swipe(bench.stage.ball(), (-70.0, 0.0))

    def thrown() -> None:
        place, velocity = start(bench)
        assert place[0] < 0.19
        assert velocity[0] < -0.02
        assert abs(velocity[1]) < 0.2 * abs(velocity[0])

    eventually(bench.page, thrown)


def test_a_swipe_beside_the_ball_scrolls_the_page(visitor: Visitor) -> None:
    page = visitor.open("#/tour/4", size={"width": 390, "height": 700}, has_touch=True, cards=False)
    stage = Stage(page, page)
    stage.canvas.wait_for()
    page.locator('[data-bodies]:not([data-bodies="0"])').first.wait_for(state="attached")
    stage.canvas.evaluate("canvas => canvas.scrollIntoView({block: 'end'})")
    box = stage.canvas.bounding_box()
    assert box
    before = page.evaluate("document.scrollingElement.scrollTop")
    Finger(stage).swipe((box["x"] + 12, box["y"] + box["height"] - 12), (0.0, -150.0))
    eventually(page, lambda: _scrolled(page.evaluate("document.scrollingElement.scrollTop"), before))


def _scrolled(now: float, before: float) -> None:
    assert now > before + 60


def test_a_finger_nudges_the_ball(bench: Bench) -> None:
    before = bench.run()
    paused = bench.play_past(0.5)
    bench.page.get_by_role("radio", name="Nudge it").tap()
    Finger(bench.stage).swipe(bench.stage.ball(), (50.0, 0.0))

    eventually(bench.page, lambda: is_nudged_along_x(bench, before.data.sel(time=paused.time, method="nearest")))
