"""The front door, the challenges and the report, as a pupil goes through them; the notes, as a teacher prints them."""

from __future__ import annotations

import math

import pytest
from playwright.sync_api import Page, expect

from trundle.lab.challenges import challenge, names
from trundle.scenario import files

from .axe import violations
from .bench import eventually
from .launching import PHONE
from .visiting import Visitor


@pytest.fixture(scope="module")
def kept(staying: Visitor) -> Page:
    return staying.open("#/", drawn=False, cards=False)


def test_the_front_door_leads_on(kept: Page) -> None:
    kept.evaluate("location.hash = '#/'")
    pictures = kept.locator(".start-picture img")
    expect(pictures).to_have_count(6)

    def seen() -> None:
        assert all(pictures.evaluate_all("all => all.map(one => one.complete && one.naturalWidth > 0)"))

    eventually(kept, seen)
    assert violations(kept) == []
    kept.locator(".start-picture").first.click()
    expect(kept.locator("section.stage")).to_have_attribute("data-shown", files.title_of("tilted-turntable-put-down"))
    kept.get_by_role("link", name="trundle lab").click()
    kept.get_by_role("link", name="Take the tour").click()
    expect(kept.get_by_text("Step 1 of 7")).to_be_visible()


def open_one(page: Page, name: str) -> None:
    page.evaluate("name => { location.hash = '#/challenges' }", name)
    page.locator(f"[data-challenge={name}]").click()
    expect(page.get_by_role("heading", level=1)).to_have_text(challenge(name).title)
    page.locator('[data-bodies]:not([data-bodies="0"])').first.wait_for(state="attached")


def predict(page: Page, which: int = 0) -> None:
    expect(page.get_by_test_id("check")).to_be_disabled()
    page.get_by_test_id("predict").get_by_role("radio").nth(which).check()
    expect(page.get_by_test_id("check")).to_be_enabled()


def test_predict_do_explain_and_hand_in(visitor: Visitor) -> None:
    page = visitor.open("#/challenges", drawn=False)
    open_one(page, "still-above-the-slope")
    predict(page, 2)
    check, result, verdict = (page.get_by_test_id(name) for name in ("check", "result", "verdict"))
    check.click()
    expect(verdict).to_have_text("Not yet.")
    expect(result).to_contain_text("at most 5 mm")
    expect(page.get_by_test_id("explanation")).to_be_hidden()
    page.get_by_test_id("hint").click()
    expect(page.locator(".hints li")).to_have_count(1)
    growth = 2.5 * 9.80665 * math.sin(math.radians(0.3)) / 0.2  # a m g sin = (2/5) m a^2 (growth r / a)
    page.get_by_test_id("control-growth").fill(str(round(growth, 2)))
    check.click()
    expect(verdict).to_have_text("Right.")
    expect(page.get_by_test_id("explanation")).to_contain_text("(5/2) g sin α / r")
    page.locator("textarea").fill("Friction holds it, and turns it.")
    page.locator("textarea").blur()
    assert violations(page) == []

    page.get_by_role("link", name="Your report").click()
    part = page.locator('[data-challenge="still-above-the-slope"]')
    for said in ("Yes, if the rate of the table grows", "Right. (checked 2 times, one hint)", "0.64 rad/s"):
        expect(part).to_contain_text(said)
    expect(part).to_contain_text("Friction holds it, and turns it.")
    expect(part.locator("img")).to_be_visible()
    page.get_by_label("Name").fill("Emmy N.")
    page.get_by_label("Name").blur()
    page.reload()
    expect(page.get_by_label("Name")).to_have_value("Emmy N.")
    assert violations(page) == []
    page.emulate_media(media="print")
    expect(page.get_by_role("banner")).to_be_hidden()
    expect(page.get_by_role("button", name="Print")).to_be_hidden()
    expect(part).to_contain_text("Friction holds it")
    assert len(page.pdf()) > 10_000
    page.emulate_media(media="screen")
    part.get_by_role("link").click()
    expect(page.locator("section.stage")).to_have_attribute("data-shown", challenge("still-above-the-slope").title)


def test_a_mystery_is_measured_and_an_answer_typed(kept: Page) -> None:
    open_one(kept, "mystery-ball")
    predict(kept)
    check, verdict = kept.get_by_test_id("check"), kept.get_by_test_id("verdict")
    check.click()
    expect(verdict).to_contain_text("Type a number")
    kept.get_by_role("textbox", name="k of the mystery ball").fill("0.4")
    check.click()
    expect(verdict).to_have_text("Not yet.")
    kept.get_by_role("textbox", name="k of the mystery ball").fill("0,52")
    check.click()
    expect(verdict).to_have_text("Right.")
    expect(kept.get_by_test_id("reading")).to_contain_text("t = 0.00 s")


def test_one_of_two_is_chosen(kept: Page) -> None:
    kept.set_viewport_size(PHONE)  # type: ignore[arg-type]
    open_one(kept, "which-is-hollow")
    predict(kept, 1)
    kept.get_by_test_id("check").click()
    expect(kept.get_by_test_id("verdict")).to_contain_text("Choose one")
    kept.get_by_role("radio", name="Ball A").check(force=True)
    kept.get_by_test_id("check").click()
    expect(kept.get_by_test_id("verdict")).to_have_text("Right.")
    assert violations(kept) == []
    assert kept.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0


def test_there_are_notes_for_every_step_and_challenge(kept: Page) -> None:
    kept.evaluate("location.hash = '#/notes'")
    expect(kept.locator(".sheet-part")).to_have_count(7 + len(names()))
    for name in names():
        expect(kept.locator(".sheet-part", has_text=challenge(name).title)).to_contain_text(challenge(name).teacher.aim)
    assert violations(kept) == []
