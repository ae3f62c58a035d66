"""Changing numbers on the bench: by slider, by typing, by keys; what the page then shows is what the package says."""

from __future__ import annotations

import math
import re
import tomllib

import pytest
from playwright.sync_api import Page, expect

import trundle as tr
from trundle.scenario import files

from .bench import Bench, as_shown, circle_rate, drift, eventually, linked
from .visiting import Visitor

RATE = "support.motion.rate"
LABELS = {
    "body.radius": "Radius",
    "support.tilt": "Tilt",
    RATE: "Rate",
    "run.duration": "Duration",
}


@pytest.fixture(scope="module")
def page(staying: Visitor) -> Page:
    """One page for all: to make one anew takes longer than what is tried in it."""
    return staying.open(drawn=False)


def level(page: Page) -> Bench:
    return opened(page, "level-turntable-nudged")


def leaning(page: Page) -> Bench:
    """A table without a rim, which a ball does not leave however it is tilted."""
    tables = tomllib.loads(files.read("tilted-turntable"))
    del tables["support"]["rim"]
    return opened(page, "tilted-turntable", linked(tables))


def opened(page: Page, name: str, place: str = "") -> Bench:
    bench = Bench(page)
    bench.open("#/compare")
    bench.open(place or f"#/bench?name={name}")
    expect(page.locator("section.stage")).to_have_attribute("data-shown", files.title_of(name))
    bench.tab("Numbers")
    return bench


def end_of(run: tr.Trajectory) -> tuple[float, ...]:
    return tuple(float(value) for value in run.in_frame("world").data.position.values[-1])


def test_a_dragged_rate_shows_the_circle_that_the_package_computes(page: Page) -> None:
    bench = level(page)
    bench.slide(RATE, 0.9)

    def agrees() -> None:
        assert bench.scenario()["support"]["motion"]["rate"] != "33.3 rpm", "the address did not follow"
        predicted, measured = bench.found(r"\kappa")
        rate = circle_rate(bench.run())
        assert (predicted, measured) == (as_shown(rate), as_shown(rate))
        assert rate > 1.5, "the slider ends at 10 rad/s, and the circle has two sevenths of that"

    eventually(bench.page, agrees)


def test_a_dragged_tilt_shows_the_drift_that_the_package_computes(page: Page) -> None:
    bench = leaning(page)
    bench.slide("support.tilt", 0.3)

    def agrees() -> None:
        assert bench.scenario()["support"]["tilt"] != "0.3 deg", "the address did not follow"
        speed = drift(bench.run())
        predicted, measured = bench.found("|v_d|")
        assert (abs(predicted), abs(measured)) == (as_shown(speed), pytest.approx(speed, rel=2e-3))

    eventually(bench.page, agrees)


def test_what_moves_is_computed_quickly_and_what_rests_in_full(page: Page) -> None:
    pytest.importorskip("heyoka")
    bench, asked = opened(page, "rattleback"), []
    page.on("request", lambda one: asked.append(one.post_data_json) if one.url.endswith("/api/simulate") else None)
    bench.slide("body.mass", 0.6)

    def in_full() -> None:
        quick = [one for one in asked if "tolerance" in one]  # what was opened may be asked for in full, too, before
        assert quick
        assert (quick[-1]["tolerance"], quick[-1]["samples"]) == (1e-9, 1000)
        assert asked[-1]["scenario"] == quick[-1]["scenario"]
        assert "tolerance" not in asked[-1]
        assert "samples" not in asked[-1]
        bench.page.keyboard.press("End")
        assert bench.stage.drawn().place == pytest.approx(end_of(bench.run()), abs=2e-5)

    bench.stage.canvas.focus()
    eventually(bench.page, in_full)


def test_the_drawn_path_follows_a_slider(page: Page) -> None:
    bench = level(page)
    bench.slide("start.velocity.1", 0.62)
    bench.stage.canvas.focus()

    def agrees() -> None:
        bench.page.keyboard.press("End")
        assert bench.stage.drawn().place == pytest.approx(end_of(bench.run()), abs=2e-5)
        assert bench.scenario()["start"]["velocity"][1] != "0.1 m/s"

    eventually(bench.page, agrees)


@pytest.mark.parametrize(
    ("typed", "rate"), [("45 rpm", 1.5 * math.pi), ("2 rad/s", 2.0), ("0.5 turn/s", math.pi), ("-78", -2.6 * math.pi)]
)
def test_a_value_may_be_typed_with_its_unit(typed: str, rate: float, page: Page) -> None:
    bench = level(page)
    bench.control(RATE).get_by_role("combobox").select_option("rpm")  # what a bare number is in
    box = bench.box(RATE)
    box.fill(typed)
    box.press("Enter")

    def agrees() -> None:
        motion = tr.Scenario.read(bench.scenario()).system().support.motion
        assert motion.rate == pytest.approx(rate, rel=1e-12)
        assert bench.found(r"\kappa")[0] == as_shown(2 / 7 * rate)

    eventually(bench.page, agrees)


def test_a_unit_may_be_changed_and_the_motion_stays(page: Page) -> None:
    bench = level(page)
    bench.control(RATE).get_by_role("combobox").select_option("rad/s")
    expect(bench.box(RATE)).to_have_value("3.487")
    bench.box(RATE).focus()
    expect(bench.box(RATE)).to_have_value(re.compile(r"3\.4871[67]\d*"))

    def agrees() -> None:
        assert bench.found(r"\kappa")[0] == as_shown(2 / 7 * 1.11 * math.pi)

    eventually(bench.page, agrees)


@pytest.mark.parametrize(
    ("path", "typed", "said"),
    [
        ("body.radius", "-25 mm", "-25 mm"),
        ("body.radius", "25 kg", "25 kg"),
        ("support.tilt", "172 deg", "172 deg"),
        (RATE, "fast", "fast"),
        ("run.duration", "0 s", "0 s"),
    ],
)
def test_a_bad_value_is_answered_at_its_control_and_the_last_path_stays(
    path: str, typed: str, said: str, page: Page, staying: Visitor
) -> None:
    staying.watch.allow(r"status of 422")
    bench = level(page)
    before = end_of(bench.run())
    box = bench.box(path)
    good = f"{box.input_value()} {bench.control(path).get_by_role('combobox').input_value()}"
    box.fill(typed)
    box.press("Enter")

    expected = words_for(path, typed)
    assert said in expected
    expect(bench.control(path)).to_contain_text(expected)
    expect(box).to_have_attribute("aria-invalid", "true")
    expect(box).to_have_accessible_description(expected)
    expect(bench.page.get_by_text("The last path that could be computed")).to_be_visible()
    bench.stage.canvas.focus()
    bench.page.keyboard.press("End")
    eventually(bench.page, lambda: check(bench, before))

    box.fill(good)
    box.press("Enter")
    expect(box).not_to_have_attribute("aria-invalid", "true")
    expect(bench.control(path)).not_to_contain_text(expected)


def check(bench: Bench, place: tuple[float, ...]) -> None:
    assert bench.stage.drawn().place == pytest.approx(place, abs=2e-5)


def words_for(path: str, typed: str) -> str:
    """The package's own words for a bad value at a key of the scenario, and the label for the key."""
    import tomllib

    tables = tomllib.loads(files.read("level-turntable-nudged"))
    table = tables
    *way, key = path.split(".")
    for name in way:
        table = table[name]
    table[key] = typed
    with pytest.raises(tr.TrundleError) as caught:
        tr.Scenario.read(tables)
    # The page has the label of the control where the package has the key.
    return re.sub(r"`[^`]*`", f"“{LABELS[path]}”", str(caught.value).removeprefix("scenario: "))


def test_undo_and_redo_go_along_the_changes(visitor: Visitor) -> None:
    bench = Bench(visitor.open("#/bench?name=level-turntable-nudged", drawn=False))  # with no past
    box = bench.box(RATE)
    for rate in ("45", "78"):
        box.fill(rate)
        box.press("Enter")
    bench.page.get_by_role("button", name="Undo").click()
    expect(box).to_have_value("45")
    bench.page.get_by_role("button", name="Undo").click()
    expect(box).to_have_value("33.3")
    expect(bench.page.get_by_role("button", name="Undo")).to_be_disabled()
    bench.page.get_by_role("button", name="Redo").click()
    expect(box).to_have_value("45")
    eventually(bench.page, lambda: rate_shown(bench, 1.5 * math.pi))


def rate_shown(bench: Bench, rate: float) -> None:
    assert bench.found(r"\kappa")[0] == as_shown(2 / 7 * rate)


def test_the_card_is_the_packages_own(page: Page) -> None:
    bench = level(page)
    bench.tab("Card")
    panel = bench.page.get_by_role("tabpanel", name="Card")
    figures = tr.Scenario.load("level-turntable-nudged").run().card().figures
    judged = [figure for figure in figures if figure.passed is not None]
    expect(panel).to_contain_text(f"All {len(judged)} checks hold.", timeout=60_000)
    for figure in figures:
        expect(panel).to_contain_text(figure.name)


def test_the_derivation_ends_with_the_numbers_of_this_scenario(page: Page) -> None:
    bench = level(page)
    bench.tab("Numbers")
    bench.page.get_by_role("button", name="How does this follow?").click()
    dialog = bench.page.get_by_role("dialog")
    expect(dialog.locator(".katex").first).to_be_visible(timeout=60_000)
    expect(dialog).to_contain_text("0.9963")
    bench.page.keyboard.press("Escape")
    expect(dialog).to_be_hidden()
