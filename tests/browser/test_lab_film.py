"""A film on the page Measure: from the first picture to a ratio of inertia, and the fitted ball in the film."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Page, expect

import trundle as tr

from .axe import violations
from .bench import decoded, number
from .launching import LAPTOP, PATIENCE, PHONE
from .visiting import Visitor

pytest.importorskip("cv2", reason="the extra `video` is not installed")

from tests.tracks.studio import Studio, write

STUDIO = Studio(noise=3.0)
RATIO, LONG = 0.4, 8 * PATIENCE


def circling(t: Any) -> Any:
    """Without a push a ball goes round at k/(1 + k) of the table's rate: the truth owes nothing to this code."""
    angle = STUDIO.rate * RATIO / (1 + RATIO) * np.asarray(t)
    return 0.07 * np.column_stack([np.cos(angle), np.sin(angle)])


@pytest.fixture(scope="module")
def films(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The same film as browsers play it, and as they do not."""
    folder = tmp_path_factory.mktemp("films")
    codes = {"webm": "VP80", "avi": "MJPG"}
    pictures = list(STUDIO.pictures(circling, np.arange(75) / 30))
    return {ending: write(folder / f"table.{ending}", iter(pictures), code=code) for ending, code in codes.items()}


def drop(page: Page, film: Path) -> None:
    expect(page.get_by_role("button", name="A ball on a ramp")).to_be_visible()
    page.get_by_test_id("file").set_input_files(film)
    expect(page.get_by_test_id("film-picture")).to_have_attribute("data-shown", "320x240", timeout=LONG)


def click_at(page: Page, x: float, y: float, height: float = 0.0) -> None:
    """Click where the picture shows a place of the table."""
    seen = STUDIO.seen([[x, y, height]])[0]
    box = page.get_by_test_id("film-picture").locator("canvas").bounding_box()
    assert box is not None
    at = {axis: (seen[i] + 0.5) * box["width"] / STUDIO.width for i, axis in enumerate("xy")}
    page.get_by_test_id("film-picture").locator("canvas").click(position=at)


def follow(page: Page) -> None:
    page.get_by_test_id("film-follow").click()
    expect(page.get_by_test_id("said")).to_contain_text("75 frames of 75", timeout=LONG)


def fit(page: Page) -> tuple[float, float]:
    """Fit what is proposed; k and its error."""
    expect(page.get_by_test_id("moved")).to_have_value("(example)", timeout=LONG)
    expect(page.get_by_role("checkbox", name="Body: Inertia ratio k")).to_be_checked(timeout=LONG)
    page.get_by_test_id("fit").click()
    expect(page.get_by_test_id("verdict")).to_be_visible(timeout=LONG)
    row = page.get_by_test_id("fitted").get_by_role("row").filter(has_text="Body: Inertia ratio k")
    value, error = row.get_by_role("cell").first.inner_text().split("±")
    return number(value), number(error)


def apart(page: Page) -> float:
    said = page.get_by_test_id("film-apart")
    expect(said).to_contain_text("px apart")
    return float(re.findall(r"[\d.]+", said.inner_text())[0])


def test_the_truth_comes_out_of_a_film_that_is_dropped(visitor: Visitor, films: dict[str, Path]) -> None:
    page = visitor.open("#/measure", size=LAPTOP, drawn=False)
    drop(page, films["webm"])
    expect(page.get_by_test_id("film-about")).to_contain_text("320 × 240 pixels, 30 pictures a second, 2.5 s")
    expect(page.get_by_text("The rim is where the line is drawn.")).to_be_visible()
    page.get_by_label("Radius of the ball").fill("20 mm")
    page.get_by_label("Radius of the rim").fill("14 cm")
    click_at(page, 0.115, 0.0)
    green = int(page.get_by_label("Colour of the dot").input_value()[3:5], 16)
    assert abs(green - STUDIO.mark_colour[1]) < 16
    assert not violations(page)
    follow(page)
    value, error = fit(page)
    assert abs(value - RATIO) < min(0.01 * RATIO, 2 * error)
    expect(page.get_by_test_id("verdict")).to_contain_text("good fit")
    assert apart(page) < 0.5
    page.get_by_test_id("film-time").fill("700")
    assert apart(page) < 0.5
    expect(page.get_by_test_id("film-note")).to_be_hidden()  # the browser plays it by itself
    expect(page.get_by_role("cell", name="Mark on the support: Position x")).to_have_count(0)
    expect(page.get_by_role("rowheader", name="Mark on the support: Position x")).to_be_visible()
    before = page.get_by_label("Time of the film").input_value()
    page.get_by_role("button", name="Play the film").click()
    expect(page.get_by_label("Time of the film")).not_to_have_value(before)
    assert not violations(page)
    page.get_by_test_id("fit-bench").click()
    expect(page).to_have_url(re.compile(r"#/bench\?s="))
    sent = tr.Scenario.read(decoded(page.url.split("s=")[1]))
    assert sent.body.inertia_ratio == pytest.approx(value, abs=0.1 * error)


def test_by_keys_with_four_marks_a_film_that_browsers_do_not_play(visitor: Visitor, films: dict[str, Path]) -> None:
    page = visitor.open("#/measure", size=PHONE, drawn=False)
    drop(page, films["avi"])
    page.get_by_label("Radius of the ball").fill("20 mm")
    page.get_by_role("radio", name="four marks").check()
    page.get_by_test_id("film-follow").click()
    expect(page.get_by_test_id("wrong")).to_contain_text("Take at least four marks")
    cross = page.get_by_test_id("film-picture")
    at = [159.5, 119.5]  # where the cross begins
    for i, degrees in enumerate((20, 110, 200, 290), 1):
        angle = np.deg2rad(degrees)
        place = 0.14 * np.array([np.cos(angle), np.sin(angle), 0.0])
        wanted = STUDIO.seen([place])[0]
        cross.focus()
        for axis, keys in enumerate((("ArrowLeft", "ArrowRight"), ("ArrowUp", "ArrowDown"))):
            steps = round(wanted[axis] - at[axis])
            at[axis] += steps
            for _ in range(abs(steps) // 10):
                page.keyboard.press(f"Shift+{keys[steps > 0]}")
            for _ in range(abs(steps) % 10):
                page.keyboard.press(keys[steps > 0])
        page.keyboard.press("Enter")
        page.keyboard.type(f"{100 * place[0]:.3f} cm")  # the box has the focus
        page.keyboard.press("Tab")
        page.keyboard.type(f"{100 * place[1]:.3f} cm")
        expect(page.get_by_label(f"y of mark {i}")).to_have_value(f"{100 * place[1]:.3f} cm")
    page.get_by_label("Colour of the dot").fill("#0a500f")
    assert not violations(page)
    follow(page)
    expect(page.get_by_test_id("film-note")).to_contain_text("75 pictures of it stand for it", timeout=LONG)
    value, error = fit(page)
    assert abs(value - RATIO) < 0.01 * RATIO  # a mark is half a pixel off, as it was taken
    assert error < 0.004
    page.get_by_test_id("film-time").fill("600")
    assert apart(page) < 0.5
    shown = page.locator(".film-view img").evaluate("one => [one.naturalWidth, one.naturalHeight]")
    assert shown == [320, 240]
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    assert not violations(page)


def test_what_is_wrong_with_a_film_is_said_in_words(visitor: Visitor, films: dict[str, Path]) -> None:
    visitor.watch.allow("status of 422")
    page = visitor.open("#/measure", drawn=False)
    expect(page.get_by_role("button", name="A ball on a ramp")).to_be_visible()
    wrong = page.get_by_test_id("wrong")
    for name, content, said in (
        ("notes.mp4", b"so long, and thanks", "must be a film"),
        ("cut.avi", films["avi"].read_bytes()[:3000], "must be a film that can be read"),
    ):
        page.get_by_test_id("file").set_input_files({"name": name, "mimeType": "video/mp4", "buffer": content})
        expect(wrong).to_contain_text(said, timeout=LONG)
        expect(page.get_by_test_id("film-picture")).to_be_hidden()
    drop(page, films["avi"])
    expect(wrong).to_be_hidden()
    page.get_by_test_id("film-follow").click()
    expect(wrong).to_contain_text("Radius of the ball: say how large it is")
    expect(page.get_by_label("Radius of the ball")).to_be_focused()
    page.get_by_label("Radius of the ball").fill("60 mm")
    page.get_by_label("Radius of the rim").fill("14 cm")
    page.get_by_label("Colour of the dot").fill("#0a500f")
    page.get_by_test_id("film-follow").click()
    expect(wrong).to_contain_text("“Radius of the ball” must be of a ball that the film shows", timeout=LONG)
    expect(wrong).not_to_contain_text("--")
    expect(page.get_by_label("Radius of the ball")).to_have_attribute("aria-invalid", "true")
    page.get_by_label("Radius of the ball").fill("20 mm")
    page.get_by_test_id("film-follow").click()
    page.get_by_test_id("film-stop").click()
    expect(page.get_by_test_id("film-follow")).to_be_enabled()
    expect(wrong).to_be_hidden()
    page.get_by_role("button", name="A ball on a ramp").click()  # the film makes room for a track
    expect(page.get_by_test_id("said")).to_contain_text("180 rows")
    expect(page.get_by_test_id("film-picture")).to_be_hidden()


def test_a_film_that_is_too_large_is_not_sent(visitor: Visitor, films: dict[str, Path]) -> None:
    page = visitor.open("#/measure", drawn=False)
    expect(page.get_by_role("button", name="A ball on a ramp")).to_be_visible()
    page.route("**/api/film", lambda route: route.fulfill(json={"bytes": 1000, "kept": 1800, "followed": 240}))
    page.get_by_test_id("file").set_input_files(films["avi"])
    expect(page.get_by_test_id("wrong")).to_contain_text("the lab takes 0 MiB. Cut it")


def test_it_speaks_german(visitor: Visitor, films: dict[str, Path]) -> None:
    page = visitor.open("?lang=de#/measure", drawn=False)
    page.get_by_test_id("file").set_input_files(films["avi"])
    expect(page.get_by_test_id("film-picture")).to_have_attribute("data-shown", "320x240", timeout=LONG)
    expect(page.get_by_test_id("film-about")).to_contain_text("320 × 240 Pixel, 30 Bilder in der Sekunde, 2,5 s")
    shown = page.locator(".film").inner_text()
    for english in (" the ", "Radius of", "Colour", "Follow", "picture"):
        assert english not in shown
