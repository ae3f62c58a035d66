"""The lab fits windows of every size: measured as boxes, from a phone to a wall, at 200 % and 400 %."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from trundle.lab.challenges import names

from .bench import Bench, eventually
from .launching import LAPTOP, PHONE, SMALL
from .screenshots import PAGES
from .test_lab_access import STAGED, come_to_rest, settle
from .visiting import Visitor

SIDEWAYS = {"width": 844, "height": 390}
TABLET = {"width": 768, "height": 1024}
HALL = {"width": 1920, "height": 1080}
# A laptop's window as its page sees it when it is magnified: to the page a zoom is a smaller window.
TWICE = {"width": 683, "height": 384}
TWICE_HALL = {"width": 960, "height": 540}
FOUR_TIMES = {"width": 341, "height": 192}
NARROW: tuple[Any, ...] = (PHONE, SIDEWAYS, TABLET, TWICE_HALL, FOUR_TIMES)
SLIM = {"width": 1100, "height": 640}  # its panels are the narrowest
LOW: tuple[Any, ...] = (SIDEWAYS, TWICE, TWICE_HALL)

# What reaches beyond the window's right edge, unless something that scrolls or clips holds it; and each table that is
# wider than what is seen of it.
TOO_WIDE = """() => {
    const wide = document.documentElement.clientWidth
    const root = document.documentElement.scrollWidth - wide
    const cut = [...document.querySelectorAll('main table')].filter((table) => {
        const seen = table.checkVisibility() && table.getBoundingClientRect()
        if (!seen || !seen.width) return false
        let right = wide
        for (let at = table.parentElement; at; at = at.parentElement) {
            if (getComputedStyle(at).overflowX !== 'visible') right = Math.min(right, at.getBoundingClientRect().right)
        }
        return seen.right > right + 1
    })
    return [root, cut.map((table) => table.className)]
}"""

# Buttons of the viewer's bar that lie over each other.
OVERLAPPING = """() => {
    const shown = [...document.querySelectorAll('.tr-row :is(button, select)')].filter((one) => one.checkVisibility())
    const boxes = shown.map((one) => [one.getAttribute('aria-label') ?? one.textContent, one.getBoundingClientRect()])
    const over = ([, a], [, b]) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1.5
        && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1.5
    return boxes.flatMap((one, i) => boxes.slice(i + 1).filter((two) => over(one, two)).map(([name]) => [one[0], name]))
}"""


@pytest.fixture(scope="module")
def kept(staying: Visitor) -> Page:
    return staying.open(drawn=False, cards=False)


def at(page: Page, route: str, size: Any) -> None:
    page.set_viewport_size(size)
    page.evaluate("route => { location.hash = route }", route)
    page.evaluate("window.scrollTo(0, 0)")
    if route in [PAGES[name] for name in STAGED]:
        settle(page)
    expect(page.locator("main > *").first).to_be_visible()
    come_to_rest(page, calm=60.0)


def box(page: Page, selector: str) -> dict[str, float]:
    found = page.locator(selector).first.bounding_box()
    assert found, f"{selector} is not shown"
    return {**found, "right": found["x"] + found["width"], "bottom": found["y"] + found["height"]}


@pytest.mark.parametrize("step", range(1, 8))
def test_a_step_of_the_tour_is_seen_at_once_on_a_laptop(step: int, kept: Page) -> None:
    for size in (LAPTOP, HALL) if step == 3 else (LAPTOP,):
        at(kept, f"#/tour/{step}", size)
        high = size["height"]
        stage, onward = box(kept, "[data-testid=stage]"), box(kept, ".tour-nav :is(.primary, .button):last-child")
        assert stage["y"] >= 0
        assert stage["height"] >= 0.2 * high
        assert onward["bottom"] <= high
        nav = box(kept, ".tour-nav")
        # Before the guess of step 6 there are no numbers; else they stand between the stage and the way on.
        last = ".tour-do" if step == 6 else "[data-testid=numbers]"
        numbers = box(kept, last)
        assert numbers["y"] >= stage["bottom"] - 1
        assert numbers["bottom"] <= nav["y"] + 1


@pytest.mark.parametrize(
    "route", [*(f"#/tour/{step}" for step in range(1, 8)), *map("#/challenges/{}".format, names())]
)
def test_in_a_window_too_low_for_all_the_picture_stays_and_the_rest_is_scrolled(route: str, kept: Page) -> None:
    kept.set_viewport_size(SMALL)
    kept.evaluate("route => { location.hash = route }", route)
    kept.locator("[data-testid=stage]").first.wait_for(state="attached")
    least = 7 * 16 if kept.locator(".tour-stage .side").count() else 9.5 * 16
    assert box(kept, "[data-testid=stage]")["height"] >= least, "while nothing is drawn yet"
    at(kept, route, SMALL)
    stage = box(kept, "[data-testid=stage]")
    assert stage["height"] >= least
    assert stage["bottom"] <= box(kept, ".tour-nav")["y"]
    kept.mouse.move(stage["x"] + stage["width"] + 10, 0.5 * SMALL["height"])
    kept.mouse.wheel(0, 5000)

    def reached() -> None:
        assert box(kept, ".tour-do")["bottom"] <= box(kept, ".tour-nav")["y"] + 1

    eventually(kept, reached)


@pytest.mark.parametrize("size", LOW, ids=str)
def test_the_stage_keeps_half_of_a_low_window(size: Any, kept: Page) -> None:
    at(kept, "#/bench", size)
    canvas, results = box(kept, "[data-testid=stage]"), box(kept, ".panel-right")
    assert canvas["height"] >= 0.6 * size["height"]
    assert canvas["width"] >= 0.55 * size["width"]
    assert results["x"] >= canvas["right"] - 1
    assert results["bottom"] <= size["height"] + 1
    kept.get_by_role("tab", name="Controls").click()
    assert box(kept, ".controls")["y"] < size["height"]
    for step in (1, 4, 6):
        at(kept, f"#/tour/{step}", size)
        before = box(kept, "[data-testid=stage]")
        assert before["height"] >= 0.5 * size["height"]
        assert before["width"] >= 0.45 * size["width"]
        kept.locator(".tour-do").scroll_into_view_if_needed()
        assert box(kept, "[data-testid=stage]")["y"] >= -1, "the stage stays while the rest is scrolled"


def test_at_four_times_the_size_everything_is_reached(kept: Page) -> None:
    at(kept, "#/bench", FOUR_TIMES)
    canvas = box(kept, "[data-testid=stage]")
    assert canvas["height"] >= 0.5 * FOUR_TIMES["height"]
    kept.get_by_role("tab", name="Controls").click()
    field = kept.locator('.controls [data-path="body.radius"]')
    field.scroll_into_view_if_needed()
    shown = box(kept, '.controls [data-path="body.radius"]')
    assert 0 <= shown["y"] < FOUR_TIMES["height"]


# Formulas that are wider than what holds them, or are cut by it.
CUT_FORMULAS = """() => [...document.querySelectorAll('.math-block, .math')].filter((one) => {
    if (!one.checkVisibility()) return false
    const drawn = one.querySelector('.katex-html')
    const parts = drawn ? [drawn, ...drawn.querySelectorAll('.katex-base')] : [one]
    let [left, right] = [0, document.documentElement.clientWidth]
    for (let at = one; at; at = at.parentElement) {
        if (getComputedStyle(at).overflowX === 'visible') continue
        left = Math.max(left, at.getBoundingClientRect().left)
        right = Math.min(right, at.getBoundingClientRect().right)
    }
    const boxes = parts.map((part) => part.getBoundingClientRect())
    return boxes.some((box) => box.right > right + 1 || box.left < left - 1)
}).map((one) => one.querySelector('annotation')?.textContent)"""
# The law that is computed by, and closed forms with long ones.
LAWS = ("rattleback", "tilted-turntable", "loop-the-loop", "roll-off-a-sphere-slipping", "roll-small-loop")


@pytest.mark.parametrize("size", [PHONE, LAPTOP, HALL], ids=["phone", "laptop", "projector"])
def test_a_long_law_goes_on_in_a_new_line(size: Any, visitor: Visitor) -> None:
    page = visitor.open(size=size, drawn=False, cards=False)
    bench = Bench(page)
    if size == HALL:
        page.keyboard.press("p")
        expect(page.locator(":root[data-projector]")).to_be_attached()
        page.keyboard.press(".")
    page.get_by_role("tab", name="Numbers").click()
    cut, lines = {}, []
    for name in LAWS:
        bench.open(f"#/bench?name={name}")
        expect(page.locator(".formula-card")).to_be_visible()
        page.wait_for_timeout(300)
        if found := page.evaluate(CUT_FORMULAS):
            cut[name] = found
        tops = page.locator(".formula-lines .math-block").first.locator(".katex-base")
        lines.append(
            len(set(tops.evaluate_all("all => all.map(one => Math.round(one.getBoundingClientRect().bottom / 12))")))
        )
    assert cut == {}
    assert max(lines) > 1, "no law was long enough to try it"


FITTED = [name for name in PAGES if name not in ("bench-bowl", "bench-coin", "tour-1", "tour-2", "tour-5", "tour-6")]


@pytest.mark.parametrize("name", FITTED)
def test_nothing_must_be_scrolled_to_the_side_tables_keep_their_last_column_and_buttons_their_places(
    name: str, kept: Page
) -> None:
    found = []
    for size in NARROW:
        at(kept, PAGES[name], size)
        root, cut = kept.evaluate(TOO_WIDE)
        over = kept.evaluate(OVERLAPPING)
        if root > 0 or cut or over:
            found.append(f"{size}: {root} pixels to the side, tables {cut}, buttons over each other {over}")
    assert not found, "\n".join(found)


# The widest numbers that the table shows, and how near those of a row then come to each other, CSS pixels.
LONG_NUMBERS = """() => {
    const rows = [...document.querySelectorAll('.findings-rows tbody tr')].map((row) => [...row.querySelectorAll('td')])
    const box = (cell) => {
        const inside = document.createRange()
        inside.selectNodeContents(cell)
        return inside.getBoundingClientRect()
    }
    return rows.flatMap((cells) => {
        ;['-4.025×10⁻¹⁴', '-1.602×10⁻¹⁵', '1.1×10⁻¹⁶'].forEach((text, i) => { cells[i].textContent = text })
        return cells.slice(1).map((cell, i) => box(cell).left - box(cells[i]).right)
    })
}"""


@pytest.mark.parametrize("size", [PHONE, TABLET, TWICE_HALL, SLIM, LAPTOP], ids=lambda size: str(size["width"]))
def test_long_numbers_keep_apart(size: Any, kept: Page) -> None:
    at(kept, "#/bench?name=tilted-turntable-straight", size)
    kept.get_by_role("tab", name="Numbers").click()
    expect(kept.locator(".findings-rows td").first).to_be_visible()
    gaps = kept.evaluate(LONG_NUMBERS)
    assert len(gaps) > 2
    assert min(gaps) > 4
