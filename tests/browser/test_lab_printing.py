"""The bench on paper: title, picture, what was found and the numbers, on any printer and from any window."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from .bench import Bench, Stage, colours
from .launching import LAPTOP, PHONE
from .visiting import Visitor

PAPER: Any = {"width": 718, "height": 1000}  # A4 between margins of 1 cm
NOT_THERE = (
    ".head",
    ".bar-tools",
    ".stage-tools",
    ".tr-controls",
    ".tabs",
    ".fold",
    ".sheet-handle",
    "input[type=range]",
)


def print_of(page: Page) -> None:
    """Bring the page to where a browser has it while it prints."""
    page.emulate_media(media="print")
    page.set_viewport_size(PAPER)
    page.evaluate("dispatchEvent(new Event('beforeprint'))")


@pytest.mark.parametrize("size", [LAPTOP, PHONE])
def test_the_bench_is_printed_light_and_whole(size: Any, visitor: Visitor) -> None:
    page = visitor.open("#/bench?name=tilted-turntable", size=size, color_scheme="dark", cards=False)
    Bench(page)
    root, picture = page.locator(":root"), page.locator(".tr-printed")
    expect(root).to_have_attribute("data-theme", "dark")
    expect(picture).to_have_count(0)
    print_of(page)
    expect(root).to_have_attribute("data-theme", "light")
    for hidden in NOT_THERE:
        expect(page.locator(hidden).first).to_be_hidden()
    for shown in (
        ".bar-title",
        ".stage-headline",
        ".tr-printed",
        ".findings-table",
        '.controls [data-path="support.tilt"]',
    ):
        expect(page.locator(shown).first).to_be_visible()
    page.set_viewport_size({"width": PAPER["width"], "height": 3000})
    assert colours(Stage(page, page).picture(picture.bounding_box())) > 100, "the picture is blank"
    boxes = [page.locator(part).first.bounding_box() for part in (".bar", ".stage", ".panel-right", ".panel-left")]
    tops = [part["y"] for part in boxes if part]
    ends = [part["y"] + part["height"] for part in boxes if part]
    assert len(tops) == 4
    assert all(end <= top + 1 for end, top in zip(ends, tops[1:], strict=False)), (tops, ends)
    assert page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.emulate_media(media="screen")
    page.set_viewport_size(size)
    expect(picture).to_have_count(0)
    expect(root).to_have_attribute("data-theme", "dark")
    expect(page.locator(".tr-controls")).to_be_visible()


def test_an_open_card_is_printed(visitor: Visitor) -> None:
    page = visitor.open("#/bench?name=tilted-turntable", size=LAPTOP)
    Bench(page)
    page.get_by_role("tab", name="Card").click()
    expect(page.locator(".card-summary")).to_be_visible()
    print_of(page)
    expect(page.locator(".card-summary")).to_be_visible()
    expect(page.locator(".findings-table")).to_be_hidden()


def test_a_stage_of_the_tour_is_printed(visitor: Visitor) -> None:
    page = visitor.open("#/tour", size=LAPTOP)
    expect(page.get_by_test_id("stage").first).to_be_visible()
    print_of(page)
    expect(page.locator(".tr-printed").first).to_be_visible()
    expect(page.get_by_test_id("stage").first).to_be_hidden()
