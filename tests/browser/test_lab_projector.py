"""The headline over the stage of a projector: nothing lies over it, and it lies over no body."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from .bench import Bench
from .visiting import Visitor

HALL: Any = {"width": 1920, "height": 1080}
# A headline of one line and of two, with a law and without, bodies small and large, high up and at the side.
SHOWN = ["tilted-turntable", "rattleback", "chaplygin-ball", "billiard-draw", "roll-off-a-sphere", "roll-small-loop"]

# What else is seen on or beside the stage, and shares pixels with the headline.
OVER = """() => {
    const headline = document.querySelector('.stage-headline')
    const own = headline.getBoundingClientRect()
    const stage = ['.stage-tools', '.stage-took', '.stage-hint', '.stage-stale', '.tr-legend', '.tr-bar', '.tr-row']
    const others = [...stage, '.fold', '.tabs', '.tab-panels', '.controls', '.bar'].join()
    const shares = (box) => Math.min(own.right, box.right) - Math.max(own.left, box.left) > 1
        && Math.min(own.bottom, box.bottom) - Math.max(own.top, box.top) > 1
    return [...document.querySelectorAll(others)]
        .filter((one) => one.checkVisibility({visibilityProperty: true, opacityProperty: true}))
        .filter((one) => !headline.contains(one) && shares(one.getBoundingClientRect()))
        .map((one) => one.className)
}"""


@pytest.fixture(params=["light", "dark"])
def page(request: pytest.FixtureRequest, visitor: Visitor) -> Page:
    page = visitor.open("#/bench", size=HALL, color_scheme=request.param, cards=False)
    Bench(page)
    page.keyboard.press("p")
    expect(page.locator(":root[data-projector]")).to_be_attached()
    return page


def test_the_headline_is_clear_of_all_else_with_and_without_the_panels(page: Page) -> None:
    bench = Bench(page)
    found = []
    for folded in (True, False):
        for name in SHOWN:
            bench.open(f"#/bench?name={name}")
            is_folded = page.locator(".bench[data-right-folded]").count() == 1
            if is_folded != folded:
                page.keyboard.press(".")
            expect(page.locator(".bench[data-right-folded]")).to_have_count(int(folded))
            expect(page.locator(".stage-headline")).to_be_visible()
            page.wait_for_timeout(300)  # the panel has come to rest, and the picture with it
            bench.stage.two_frames()
            over = page.evaluate(OVER)
            body = bodily(bench, page)
            if over or body > 0.01:
                found.append(f"{name}, {folded=}: {over} over it, and a body under {body:.0%} of it")
    assert not found, "\n".join(found)


def bodily(bench: Bench, page: Page) -> float:
    """Which share of the place of the headline shows a body, by its blue stripes."""
    headline = page.locator(".stage-headline")
    clip = headline.bounding_box()
    assert clip
    headline.evaluate("element => { element.style.visibility = 'hidden' }")
    picture = bench.stage.picture(clip)
    headline.evaluate("element => { element.style.visibility = '' }")
    red, green, blue = (picture[:, :, channel] for channel in range(3))
    return float(np.mean((blue > red + 60) & (blue > green + 25)))
