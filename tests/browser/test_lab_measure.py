"""From a track to numbers in the lab: what is found is the truth, what cannot be is said, what has to be is asked."""

from __future__ import annotations

import re
import zipfile
from io import BytesIO

import numpy as np
import pytest
from playwright.sync_api import Page, Route, expect
from tests.fitting.test_gyroscope import inside
from tests.tracks.examples import EXAMPLES, Example

import trundle as tr
from trundle.lab.links import encode

from .axe import violations
from .bench import decoded, number
from .launching import LAPTOP, PATIENCE, PHONE
from .visiting import Visitor


def take(page: Page, name: str, text: str, kind: str = "text/plain") -> None:
    """Give the page a file."""
    page.get_by_test_id("file").set_input_files({"name": name, "mimeType": kind, "buffer": text.encode()})


def table(columns: str, rows: np.ndarray) -> str:
    return "\n".join([columns, *(";".join(f"{value:.6g}" for value in row) for row in rows)]) + "\n"


def fit(page: Page) -> None:
    expect(page.get_by_test_id("fit")).to_be_enabled(timeout=4 * PATIENCE)
    page.get_by_test_id("fit").click()
    expect(page.get_by_test_id("verdict")).to_be_visible(timeout=4 * PATIENCE)


def found(page: Page, name: str) -> tuple[float, float]:
    """Value and error of a number, as the page has them."""
    row = page.get_by_test_id("fitted").get_by_role("row").filter(has_text=name)
    value, error = row.get_by_role("cell").first.inner_text().split("±")
    return number(value), number(error)


def test_the_truth_is_found_and_goes_to_the_bench(visitor: Visitor) -> None:
    truth = tr.tracks.example("ball-on-a-turntable").truth
    page = visitor.open("#/measure", size=LAPTOP, drawn=False)
    page.get_by_role("button", name="A ball on a record player").click()
    expect(page.get_by_test_id("said")).to_contain_text("597 rows")
    fit(page)
    expect(page.get_by_test_id("verdict")).to_contain_text("good fit")
    value, error = found(page, "Body: Inertia ratio k")
    assert 0 < error < 1e-4
    assert abs(value - truth["body.inertia_ratio"]) < 4 * error
    expect(page.get_by_test_id("fit-said")).to_contain_text("the end")
    page.get_by_test_id("fit-step").fill("0")
    expect(page.get_by_test_id("fit-said")).to_contain_text("1 of")
    expect(page.get_by_test_id("fit-said")).to_contain_text("of the first")
    assert not violations(page)
    page.get_by_test_id("fit-bench").click()
    expect(page).to_have_url(re.compile(r"#/bench\?s="))
    sent = tr.Scenario.read(decoded(page.url.split("s=")[1]))
    assert sent.body.inertia_ratio == pytest.approx(value, abs=1e-6)


def test_what_cannot_be_known_is_said_with_the_cure(visitor: Visitor) -> None:
    page = visitor.open("#/measure?example=ball-on-a-turntable", drawn=False)
    expect(page.get_by_test_id("said")).to_contain_text("597 rows")
    page.get_by_role("checkbox", name="Motion of the support: Rate").check()
    fit(page)
    expect(page.get_by_test_id("verdict")).to_contain_text("cannot decide")
    expect(page.get_by_test_id("unknown")).to_contain_text("rate·body.inertia_ratio/(1 + body.inertia_ratio)")
    expect(page.get_by_test_id("unknown")).to_contain_text("film a mark on the support")
    assert not violations(page, ".measure")


def test_what_the_file_does_not_say_is_asked(visitor: Visitor) -> None:
    """Which track, which unit, and how an angle grows."""
    page = visitor.open("#/measure", drawn=False)
    expect(page.get_by_role("button", name="A ball on a ramp")).to_be_visible()
    t = np.arange(60) / 30
    body = np.column_stack([t, 10 * t, 0 * t, t, 20 * t, 0 * t])
    take(page, "two balls.txt", "red;;;blue;;\n" + table("t;x;y;t;x;y", body))
    asked = page.get_by_test_id("question")
    expect(asked).to_contain_text("several tracks. Which one?")
    assert not violations(page, ".measure")
    asked.get_by_role("button", name="blue").click()
    expect(asked).to_contain_text("In which unit are the places?")
    asked.get_by_role("button", name="cm", exact=True).click()
    expect(asked).to_be_hidden()
    expect(page.get_by_test_id("said")).to_contain_text("x, y in cm, 60 rows")
    page.get_by_text("How the file is read").click()
    expect(page.get_by_label("Unit of places")).to_have_value("cm")
    page.get_by_label("Unit of places").fill("px")
    page.get_by_label("Unit of places").press("Tab")
    expect(asked).to_contain_text("How large is a pixel?")
    asked.get_by_role("textbox").fill("0.5 mm")
    asked.get_by_role("textbox").press("Enter")
    expect(page.get_by_test_id("said")).to_contain_text("a pixel of 0.5 mm")


def test_a_track_is_told_in_the_language_of_the_page(visitor: Visitor) -> None:
    page = visitor.open("?lang=de#/measure", drawn=False)
    content = b"time (ms),x (cm),place\n0,1.5,\n1,\n2,2,\n3,3,\n"
    file = {"name": "time.csv", "mimeType": "", "buffer": content}
    page.get_by_test_id("file").set_input_files(file, timeout=PATIENCE)
    said = page.get_by_test_id("said").locator("p")
    expect(said.nth(0)).to_have_text(
        "time.csv: t aus Spalte time (ms) in ms, x in cm, 3 Zeilen, 1 Lücke (1 Bild), 1000 Bilder pro Sekunde."
    )
    expect(said.nth(1)).to_have_text("1 Zeile wurde weggelassen: Zeile 3 (2 Zellen bei 3 Überschriften).")
    expect(said.nth(2)).to_have_text("place wurde weggelassen: nicht gebraucht.")


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda one: one.id)
def test_each_format_is_read_or_asked_about(example: Example, page_of_files: Page, staying: Visitor) -> None:
    """A file of each format: what has to be known is asked for in the words of the page, until it is read."""
    page = page_of_files
    staying.watch.allow("status of 422")
    asked, wrong = page.get_by_test_id("question"), page.get_by_test_id("wrong")
    page.get_by_test_id("file").set_input_files(
        {"name": example.file, "mimeType": "", "buffer": example.content}, timeout=PATIENCE
    )
    units = example.options.get("units", {})
    known = example.options | (units if isinstance(units, dict) else {"length": units})
    answers = {"Which one?": "track", "unit are the places": "length", "a pixel": "pixel", "frames were": "rate"}
    for _ in range(5):
        told = asked.or_(wrong).or_(page.get_by_test_id("said").locator("p"))
        expect(told.filter(visible=True).first).to_be_visible()
        if not asked.is_visible():
            break
        question = asked.locator(".measure-asked").inner_text()
        answer = str(known[next(key for words, key in answers.items() if words in question)])
        button = asked.get_by_role("button", name=answer, exact=True)
        if button.count():
            button.click()
        else:
            asked.get_by_role("textbox").fill(answer)
            asked.get_by_role("textbox").press("Enter")
        expect(asked.get_by_text(question)).to_be_hidden()
    if example.format == "NetCDF":  # along axes that turn
        expect(wrong).to_contain_text("along axes that do not turn")
        return
    expect(wrong).to_be_hidden()
    rows = len(next(iter(example.truth.values())))
    expect(page.get_by_test_id("said")).to_contain_text(f"{rows} rows")
    expect(page.get_by_test_id("said")).not_to_contain_text("--")
    expect(page.get_by_test_id("fit")).to_be_enabled()


@pytest.fixture(scope="module")
def page_of_files(staying: Visitor) -> Page:
    page = staying.open("#/measure", drawn=False)
    expect(page.get_by_role("button", name="A ball on a ramp")).to_be_visible()
    return page


def test_a_gyroscope_inside_a_ball_shows_its_inertia(visitor: Visitor) -> None:
    """As a telephone exports it; how the ball spins is no more known than how the telephone lies in it."""
    tables = {
        "body": {"kind": "sphere", "radius": "20 mm", "mass": "90 g", "inertia_ratio": 0.5},
        "support": {"kind": "plane", "motion": {"kind": "spin", "rate": "3.487 rad/s"}},
        "start": {"position": [0.1, 0.0]},
        "run": {"duration": "6 s", "every": "20 ms"},
    }
    page = visitor.open(f"#/bench?s={encode(tables)}", drawn=False, cards=False)
    expect(page.locator('[data-bodies="1"]')).to_be_attached()
    page.get_by_role("link", name="Measure").click()
    columns = np.column_stack(list(inside(3.487).values()))
    heading = ",".join(['"Time (s)"', *(f'"Gyroscope {axis} (rad/s)"' for axis in "xyz")])
    packed = BytesIO()
    with zipfile.ZipFile(packed, "w") as file:
        file.writestr("Gyroscope.csv", table(heading, columns).replace(";", ","))
    given = {"name": "rolling.zip", "mimeType": "application/zip", "buffer": packed.getvalue()}
    page.get_by_test_id("file").set_input_files(given)
    expect(page.get_by_test_id("said")).to_contain_text("100 samples a second")
    page.get_by_role("checkbox", name="Body: Inertia ratio k").check()
    fit(page)
    expect(page.get_by_test_id("verdict")).to_contain_text("good fit")
    for name, truth in (("Body: Inertia ratio k", 0.4), ("Start: Spin about the normal", 2.0)):
        value, error = found(page, name)
        assert abs(value - truth) < 4 * error < 0.05
    assert not violations(page, ".measure")


def test_a_ball_of_ones_own_on_the_scenario_of_the_bench(visitor: Visitor) -> None:
    """Down an incline by hand: x = 5/7 g sin(tilt) t²/2."""
    tables = {
        "body": {"kind": "solid-sphere", "radius": "20 mm", "mass": "100 g"},
        "support": {"kind": "plane", "tilt": "1 deg"},
        "start": {"position": [0, 0], "velocity": [0, 0]},
        "run": {"duration": "1 s", "every": "20 ms"},
    }
    page = visitor.open(f"#/bench?s={encode(tables)}", drawn=False, cards=False)
    expect(page.locator('[data-bodies="1"]')).to_be_attached()
    page.get_by_role("link", name="Measure").click()
    page.get_by_role("heading", name="Measure", level=1).wait_for()  # before that nobody takes what is dropped
    t = np.arange(120) / 60
    draw = np.random.default_rng(5).normal(scale=0.05, size=t.size)  # cm
    x = 100 * 5 / 7 * 9.80665 * np.sin(0.04) * t**2 / 2
    transfer = page.evaluate_handle(
        """text => {
            const transfer = new DataTransfer()
            transfer.items.add(new File([text], 'incline.csv'))
            return transfer
        }""",
        table("t (s);x (cm)", np.column_stack([t, x + draw])),
    )
    page.dispatch_event("main", "drop", {"dataTransfer": transfer})
    expect(page.get_by_test_id("said")).to_contain_text("120 rows")
    page.get_by_role("checkbox", name="Support: Tilt").check()
    page.get_by_test_id("noise").fill("0.5 kg")
    visitor.watch.allow("status of 422")
    page.get_by_test_id("fit").click()
    expect(page.get_by_test_id("wrong")).to_contain_text("noise")
    page.get_by_test_id("noise").fill("0.5 mm")
    fit(page)
    value, error = found(page, "Support: Tilt")
    assert abs(value - 0.04) < 4 * error < 4e-3
    expect(page.get_by_test_id("wrong")).to_be_hidden()


def test_what_is_no_track_is_refused_in_words(visitor: Visitor) -> None:
    visitor.watch.allow("status of 422")
    page = visitor.open("#/measure", drawn=False)
    expect(page.get_by_role("button", name="A ball on a ramp")).to_be_visible()
    take(page, "notes.doc", "x")
    expect(page.get_by_test_id("wrong")).to_contain_text("'notes.doc'. Export it as CSV.")
    take(page, "film.mov", "x" * 1_000_000, "video/quicktime")
    expect(page.get_by_test_id("wrong")).to_contain_text("must be a film")
    take(page, "sheet.xlsx", "so long, and thanks")
    expect(page.get_by_test_id("wrong")).to_contain_text("sheet.xlsx")
    expect(page.get_by_test_id("wrong")).not_to_contain_text("/")  # no folder of the server's
    take(page, "words.csv", "so long\nand thanks\n")
    expect(page.get_by_test_id("question")).to_contain_text("Which column is which?")
    expect(page.get_by_test_id("wrong")).to_be_hidden()
    expect(page.get_by_test_id("fit")).to_be_disabled()


def test_a_fit_waits_for_what_moved_and_ends_with_its_track(visitor: Visitor) -> None:
    """The numbers of the example before are not fitted to this one, and an answer to it is shown to nobody."""
    page = visitor.open("#/measure?example=ball-in-a-bowl", drawn=False)
    expect(page.get_by_role("checkbox", name="Support: Radius")).to_be_checked()
    expect(page.get_by_test_id("fit-stop")).to_be_hidden()
    page.route("**/api/fit", lambda _: None)
    page.get_by_test_id("fit").click()
    page.get_by_test_id("fit-stop").click()
    expect(page.get_by_test_id("fit")).to_be_enabled()
    expect(page.get_by_test_id("fit")).to_be_focused()
    page.get_by_test_id("fit").click()
    expect(page.get_by_test_id("fit-stop")).to_be_visible()
    numbers: list[Route] = []
    page.route("**/api/map/numbers", lambda route: numbers.append(route))
    page.get_by_role("button", name="A ball on a ramp").click()
    expect(page.get_by_test_id("said")).to_contain_text("180 rows")
    expect(page.get_by_test_id("fit-stop")).to_be_hidden()
    expect(page.get_by_test_id("fit")).to_be_disabled()
    for one in numbers:
        one.continue_()
    expect(page.get_by_role("checkbox", name="Body: Inertia ratio k")).to_be_checked()
    page.unroute_all()
    fit(page)
    expect(page.get_by_test_id("fitted")).to_contain_text("Inertia ratio")


@pytest.mark.parametrize("size", [LAPTOP, PHONE], ids=["laptop", "phone"])
def test_it_fits_and_axe_finds_nothing(size: dict[str, int], visitor: Visitor) -> None:
    page = visitor.open("#/measure?example=ball-on-a-ramp", size=size, drawn=False)
    expect(page.get_by_test_id("said")).to_contain_text("180 rows")
    fit(page)
    assert page.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    assert not violations(page)


def press(page: Page, name: str) -> None:
    """Go to a control by Tab, each stop of which is seen, and press Enter there."""
    goal = page.get_by_role("button", name=name, exact=True)
    for _ in range(60):
        page.keyboard.press("Tab")
        assert page.evaluate(SEEN), page.evaluate("document.activeElement.outerHTML.slice(0, 200)")
        if goal.evaluate("goal => goal === document.activeElement"):
            page.keyboard.press("Enter")
            return
    pytest.fail(f"60 stops, and none is {name!r}")


# A ring about what has the focus, or about the label that stands for it, within the window.
SEEN = """() => {
    const at = document.activeElement
    if (at === document.body) return false
    const about = [at, at.closest('label')].filter(part => part && part.getBoundingClientRect().width > 2)
    return about.some(part => {
        const {top, bottom} = part.getBoundingClientRect()
        const {outlineStyle, outlineWidth} = getComputedStyle(part)
        return bottom > 0 && top < innerHeight && outlineStyle !== 'none' && parseFloat(outlineWidth) >= 2
    })
}"""


def test_by_keys_alone(visitor: Visitor) -> None:
    """An example is chosen, its fit stopped and begun again, and what was found goes to the bench: no focus is lost."""
    page = visitor.open("#/measure", size=LAPTOP, drawn=False)
    expect(page.get_by_role("button", name="A ball on a ramp")).to_be_visible()
    press(page, "A ball on a ramp")
    expect(page.get_by_role("status").filter(has_text="180 rows")).to_be_visible()
    expect(page.get_by_role("button", name="A ball on a ramp")).to_be_focused()
    expect(page.get_by_test_id("fit")).to_be_enabled(timeout=4 * PATIENCE)
    page.route("**/api/fit", lambda _: None)
    press(page, "Fit")
    expect(page.get_by_test_id("fit-stop")).to_be_focused()
    page.keyboard.press("Space")
    expect(page.get_by_test_id("fit")).to_be_focused()
    page.unroute_all()
    page.keyboard.press("Space")
    expect(page.get_by_test_id("verdict")).to_be_visible(timeout=4 * PATIENCE)
    found_there = page.get_by_role("status", name="What was found")
    expect(found_there).to_be_focused()
    expect(found_there).to_contain_text("good fit")
    assert page.evaluate(SEEN)
    value, _ = found(page, "Body: Inertia ratio k")
    press(page, "Open the fitted scenario on the bench")
    expect(page.get_by_role("main")).to_be_focused()
    expect(page.get_by_label("Inertia ratio k").first).to_have_value(re.compile(f"^{value:.2f}"))


def test_an_answer_by_keys_keeps_the_focus(visitor: Visitor) -> None:
    page = visitor.open("#/measure", drawn=False)
    expect(page.get_by_role("button", name="A ball on a ramp")).to_be_visible()
    t = np.arange(60) / 30
    take(page, "ball.csv", table("t (s);x;y", np.column_stack([t, 10 * t, 0 * t])))
    expect(page.get_by_test_id("question").get_by_role("button", name="m", exact=True)).to_be_focused()
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    expect(page.get_by_test_id("said")).to_contain_text("60 rows")
    expect(page.get_by_text("How the file is read")).to_be_focused()


def test_a_last_step_that_is_undone_keeps_the_focus(visitor: Visitor) -> None:
    page = visitor.open("#/bench?name=level-turntable-nudged", drawn=False, cards=False)
    page.get_by_role("slider", name="Rate").first.focus()
    page.keyboard.press("ArrowRight")
    undo = page.get_by_role("button", name="Undo")
    expect(undo).to_be_enabled()
    undo.focus()
    page.keyboard.press("Enter")
    expect(undo).to_be_disabled()
    expect(page.get_by_role("button", name="Redo")).to_be_focused()
