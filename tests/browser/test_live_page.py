"""A live page, opened from its file without a network: a moved slider gives the motion that `simulate` gives."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Locator, Page, expect

import trundle as tr
from trundle.analysis.sensitivities.keys import moved
from trundle.lab.challenges import on_site
from trundle.live import live_page, site_of

from .axe import violations
from .bench import Stage, colours, eventually
from .launching import PATIENCE, PHONE, SMALL
from .watching import Watch

OpenPage = Callable[..., Page]
SCENARIO = "off-the-rim"


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("live") / "page.html"
    path.write_bytes(live_page(tr.Scenario.load(SCENARIO), ["support.motion.rate=10 rpm..80 rpm", "body.radius"]))
    return path


@pytest.fixture
def opened(browser: Browser) -> Iterator[OpenPage]:
    """Open a file, cut off from every network; nothing may go wrong, and only files beside it be asked for."""
    contexts, watches = [], []

    def open_file(path: Path, **options: Any) -> Page:
        context = browser.new_context(**{"viewport": SMALL, "reduced_motion": "reduce", "offline": True, **options})
        context.set_default_timeout(PATIENCE)
        watch = Watch((path.parent.as_uri(), "blob:"))
        watch.over(context)
        contexts.append(context)
        watches.append(watch)
        page = context.new_page()
        page.goto(path.as_uri())
        return page

    yield open_file
    for context in contexts:
        context.close()
    for watch in watches:
        assert watch.left() == []


def headline(page: Page) -> Locator:
    return page.locator(".live-headline")


def test_a_slider_moves_the_motion_of_the_law(file: Path, opened: OpenPage) -> None:
    page = opened(file)
    expect(headline(page)).to_contain_text("Ran off the rim")
    stage = Stage(page, page)
    scenario = tr.Scenario.load(SCENARIO)
    name, low = "support.motion.rate", 2 * np.pi * 10 / 60
    system, start = moved(scenario, {name: low})
    run = tr.simulate(system, start, float(scenario.timing.duration), float(scenario.timing.every))
    first = headline(page).text_content() or ""
    slider = page.get_by_role("slider", name="Rate")
    slider.press("Home")
    expect(headline(page)).not_to_have_text(first)
    expect(page.get_by_label("Rate, rpm")).to_have_value("10")
    page.get_by_role("slider", name="Time").press("End")

    def ended() -> None:
        drawn = stage.drawn()
        place = run.in_frame(drawn.frame).at([min(drawn.time, float(run.data.time[-1]))]).data.position[0]
        assert drawn.time == pytest.approx(float(run.data.time[-1]), abs=1e-3)
        assert drawn.place == pytest.approx(tuple(place.values), abs=2e-4)

    eventually(page, ended)
    page.get_by_role("button", name="As in the file").click()
    expect(headline(page)).to_have_text(first)


def test_a_number_is_typed_and_kept_within_the_slider(file: Path, opened: OpenPage) -> None:
    page = opened(file)
    expect(headline(page)).to_contain_text("Ran off")
    field = page.get_by_label("Rate, rpm")
    field.fill("200")
    field.press("Enter")
    expect(field).to_have_value("80")
    told = page.get_by_role("alert").filter(has_text="Rate")
    expect(told).to_have_text("“Rate” goes from 10 to 80 rpm: 200 rpm is too large, and the most is taken.")
    field.fill("1")
    field.press("Enter")
    expect(field).to_have_value("10")
    expect(told).to_have_text("“Rate” goes from 10 to 80 rpm: 1 rpm is too small, and the least is taken.")
    for within in ("80", "20 rpm", "10"):  # both ends, too, as they are shown
        field.fill(within)
        field.press("Enter")
        expect(field).to_have_value(within.removesuffix(" rpm"))
        expect(told).to_have_count(0)


RATE = "Winkel\u00adgeschwindigkeit"
WRONG = {
    "en": {
        "banana": "“Rate” needs a number in rpm, and “banana” is none. It stays at 33.3 rpm.",
        "": "“Rate” needs a number; the box was empty. It stays at 33.3 rpm.",
        "99.5": "“Rate” goes from 10 to 80 rpm: 99.5 rpm is too large, and the most is taken.",
    },
    "de": {
        "1.000,5": f"„{RATE}“ braucht eine Zahl in U/min, und „1.000,5“ ist keine. Es bleibt bei 33,3 U/min.",
        "": f"„{RATE}“ braucht eine Zahl; das Feld war leer. Es bleibt bei 33,3 U/min.",
        "99,5": f"„{RATE}“ geht von 10 bis 80 U/min: 99,5 U/min ist zu groß, es gilt der größte Wert.",
    },
}


@pytest.mark.parametrize("language", WRONG)
def test_what_is_no_number_is_said_in_the_words_of_its_label(file: Path, opened: OpenPage, language: str) -> None:
    page = opened(file, locale=language)
    expect(page.locator(".live-happens")).to_contain_text("m/s")
    for typed, said in WRONG[language].items():
        field = page.locator(".live-value input").first
        field.fill(typed)
        field.press("Enter")
        told = page.get_by_role("alert").first
        expect(told).to_have_text(said)
        expect(field).to_have_attribute("aria-describedby", told.get_attribute("id") or "")
        assert violations(page) == []
        page.locator('.live-slider input[type="range"]').first.press("ArrowLeft")
        expect(page.locator(".live-message").first).to_be_empty()
        page.locator(".live-back").click()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_grave(file: Path, opened: OpenPage, scheme: str) -> None:
    page = opened(file, color_scheme=scheme)
    expect(headline(page)).to_contain_text("Ran off")
    assert violations(page) == []


def test_on_a_phone_nothing_runs_over_the_edge(file: Path, opened: OpenPage) -> None:
    page = opened(file, viewport=PHONE)
    expect(headline(page)).to_contain_text("Ran off")
    assert page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth")


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A page whose numbers need powers of ten."""
    path = tmp_path_factory.mktemp("live") / "page.html"
    path.write_bytes(live_page(tr.Scenario.load("rattleback-with-losses")))
    return path


@pytest.mark.parametrize("language", ["en", "de"])
def test_every_number_fits_its_box_and_is_read_again(small: Path, opened: OpenPage, language: str) -> None:
    page = opened(small, viewport=PHONE, locale=language)
    expect(page.locator(".live-happens")).to_contain_text("m/s")
    boxes = page.locator(".live-value input")
    assert any("10⁻" in one.input_value() for one in boxes.all())
    for one in boxes.all():
        assert one.evaluate("element => element.scrollWidth <= element.clientWidth"), one.input_value()
        written = one.input_value()
        one.fill(f"{written} ")
        one.press("Enter")
        expect(one).to_have_value(written)
    assert "".join(page.locator(".live-message").all_inner_texts()) == ""
    assert page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth")


def test_on_paper_it_is_light_and_has_a_picture_of_the_stage(file: Path, opened: OpenPage) -> None:
    page = opened(file, color_scheme="dark")
    expect(headline(page)).to_contain_text("Ran off")
    printed, root = page.locator(".tr-printed"), page.locator(":root")
    expect(printed).to_have_count(0)
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    expect(printed).to_be_visible()
    expect(root).to_have_attribute("data-theme", "light")
    box = printed.bounding_box()
    assert box
    assert colours(Stage(page, page).picture(box)) > 100, "the picture is blank"
    for hidden in (".tr-host", ".live-back", ".page-theme"):
        expect(page.locator(hidden)).to_be_hidden()
    assert page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.emulate_media(media="screen")
    expect(printed).to_have_count(0)
    expect(root).to_have_attribute("data-theme", "dark")


def test_a_site_is_walked_from_the_gallery_through_the_tour(opened: OpenPage, tmp_path: Path) -> None:
    names = ["cylinder-on-incline", "level-turntable-put-down", "roll-x-then-y", "billiard-draw"]
    for name, content in site_of(names, challenges=on_site()).items():
        (tmp_path / name).write_bytes(content)
    page = opened(tmp_path / "index.html")
    expect(page.get_by_role("listitem")).to_have_count(4)
    page.get_by_text("Embed").first.click()
    code = page.locator("textarea").first
    address = (tmp_path / "cylinder-on-incline.html").as_uri()
    assert f'src="{address}"' in code.input_value()
    assert violations(page) == []
    page.get_by_role("link", name="Tour").click()
    frame = page.frame_locator("iframe")
    expect(frame.locator(".live-headline")).to_contain_text("Goes on for all of")
    page.get_by_role("link", name="On: ").click()
    expect(page.get_by_role("heading", level=1)).to_have_text(tr.Scenario.load("level-turntable-put-down").title)
    page.get_by_role("link", name="Gallery").click()
    page.get_by_role("link", name="Challenges").click()
    expect(page.get_by_text("have your answer checked")).to_be_visible()
    assert violations(page) == []
    expect(page.get_by_text("can be done in the lab only").first).to_be_visible()
    page.get_by_role("link", name=tr.Scenario.load("billiard-draw").title).click()
    expect(headline(page)).to_contain_text("Path")
