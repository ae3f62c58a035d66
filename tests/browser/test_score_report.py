"""The report of a score, in a browser: motions beside each other, by the mouse, the keyboard, and as stills."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect
from tests.conformance.test_score import rows

from trundle.conformance import Score, cases
from trundle.conformance.animation import path_of
from trundle.conformance.report import page

Open = Callable[[Literal["no-preference", "reduce"]], Page]


@pytest.fixture
def opened(browser: Browser, tmp_path: Path) -> Iterator[Open]:
    """Opens a report with an engine whose ball leaves the exact path by 0.3 m, evenly in time."""
    case = next(each for each in cases() if each.name == "incline")
    motion = case.exact()
    motion.position[..., 1] += 0.3 * (motion.time / motion.time[-1])[:, None]
    path = tmp_path / "score.html"
    score = Score(tuple(replace(row, path=path_of(motion)) for row in rows(1e-2)))
    path.write_text(page(score, [case]), encoding="utf-8")
    contexts = []
    wrong: list[str] = []

    def visit(motion: Literal["no-preference", "reduce"]) -> Page:
        context = browser.new_context(reduced_motion=motion, offline=True)
        contexts.append(context)
        opened = context.new_page()
        opened.on("pageerror", lambda error: wrong.append(str(error)))
        opened.on("console", lambda said: wrong.append(said.text) if said.type == "error" else None)
        opened.goto(path.as_uri())
        return opened

    yield visit
    for context in contexts:
        context.close()
    assert wrong == []


def test_the_keyboard_leads_through_the_motion(opened: Open) -> None:
    page = opened("no-preference")
    slider, said = page.get_by_label("Time"), page.locator("output")
    expect(said).to_have_text("0.00 s, 0.00 mm apart")
    slider.press("End")
    expect(said).to_have_text("2.00 s, 300 mm apart")
    slider.press("ArrowLeft")
    expect(said).to_have_text("1.99 s, 299 mm apart")
    expect(slider).to_have_attribute("aria-valuetext", "1.99 s, 299 mm apart")
    left, right = (_inked(page, side) for side in (0, 1))
    assert left > 100
    assert right > 100


def test_it_plays_to_its_end_and_again(opened: Open) -> None:
    page = opened("no-preference")
    page.get_by_label("Time").press("End")
    page.get_by_label("Time").press("PageDown")
    page.get_by_role("button", name="Play").press("Enter")
    expect(page.get_by_role("button", name="Pause")).to_be_visible()
    expect(page.locator("output")).to_have_text(re.compile("^2.00 s"))
    expect(page.get_by_role("button", name="Play")).to_be_visible()


def test_who_wants_no_motion_gets_stills(opened: Open) -> None:
    page = opened("reduce")
    page.get_by_role("button", name="Next still").click()
    expect(page.locator("output")).to_have_text("0.17 s, 25.5 mm apart")
    expect(page.get_by_role("button", name="Next still")).to_be_visible()


def _inked(page: Page, side: int) -> int:
    """Return how many pixels of one half of the picture have a colour of their own."""
    data = page.locator("canvas").evaluate(
        "(c, side) => Array.from(c.getContext('2d').getImageData(side * c.width / 2, 0, c.width / 2, c.height).data)",
        side,
    )
    pixels = np.array(data).reshape(-1, 4).astype(int)
    return int((np.ptp(pixels[:, :3], axis=1) > 60).sum())
