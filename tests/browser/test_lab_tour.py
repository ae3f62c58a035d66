"""The tour from start to end, as a newcomer goes through it: each task done, each claim compared with the package."""

from __future__ import annotations

import math
import re
import tomllib

import numpy as np
import pytest
from playwright.sync_api import Locator, Page, expect

import trundle as tr
from trundle.scenario import files

from .bench import Bench, as_shown, eventually, number
from .visiting import Visitor

STEEL = tr.Body.solid_sphere(radius=0.025, mass=0.51)


def row(page: Page, name: str) -> tuple[str, str]:
    """What is predicted and measured in a line of the table, as it is written."""
    cells = line(page, name).get_by_role("cell")
    return cells.nth(0).inner_text(), cells.nth(1).inner_text()


def line(page: Page, name: str) -> Locator:
    return page.get_by_test_id("numbers").get_by_role("row").filter(has_text=name).first


def step(page: Page, at: int) -> None:
    expect(page.get_by_text(f"Step {at} of 7")).to_be_visible()
    expect(page.get_by_test_id("stage").first).to_be_visible()
    expect(page).to_have_title(f"{page.locator('h1').inner_text()} · Tour · trundle lab")
    assert page.locator(".tour-progress [aria-current=step]").inner_text().startswith(str(at))


def go_on(page: Page) -> None:
    page.get_by_test_id("next").click()


def test_the_tour_is_followed_from_start_to_end(visitor: Visitor) -> None:
    page = visitor.open("#/tour")
    for at, does in enumerate((cylinder, ball, push, turntable, nudge, tilt, fields), start=1):
        step(page, at)
        does(page)
        question = page.locator("details.question")
        question.locator("summary").click()
        expect(question.locator(".answer")).to_be_visible()
        if at < 7:
            go_on(page)
    page.get_by_role("link", name="Roll by hand").click()
    expect(page.get_by_role("heading", level=1)).to_have_text("Where is its pole now?")


def cylinder(page: Page) -> None:
    slider = page.get_by_test_id("roll-cylinder")

    def turned() -> float:
        predicted, measured = (number(text) for text in row(page, "angle turned"))
        assert measured == pytest.approx(predicted, abs=0.11)
        way = number(slider.get_attribute("aria-valuetext") or "") / 100  # told to a millimetre, which is 1.9 degrees
        assert measured == pytest.approx(math.degrees(way / 0.03), abs=1.0), "the angle is the way over the radius"
        return measured

    before = eventually(page, turned)
    slider.fill("0.9")
    after = eventually(page, turned)
    assert after > before + 90


def ball(page: Page) -> None:
    quarter = math.pi / 2
    ends = [
        tr.roll_along([tr.Straight(heading=a, turn=quarter), tr.Straight(heading=b, turn=quarter)], radius=0.025)
        for a, b in ((0.0, quarter), (quarter, 0.0))
    ]
    poles = [np.round(np.asarray(end.north_pole), 9) for end in ends]
    assert [pole.tolist() for pole in poles] == [[1, 0, 0], [0, 1, 0]]

    page.get_by_role("button", name="Roll both").click()

    def told() -> None:
        assert row(page, "pole, east then north") == ("east", "east")
        assert row(page, "pole, north then east") == ("north", "north")
        assert row(page, "turned against each other") == ("120.00°", "120.00°")

    eventually(page, told)


def push(page: Page) -> None:
    for share, remark in ((0.0, "Higher!"), (1.0, "Lower!"), (0.4, "Neither:")):
        page.get_by_test_id("push-height").fill(str(share))
        expect(page.get_by_text(remark)).to_be_visible()
        loads = (tr.Force((0.1, 0.0, 0.0)), tr.Torque((0.0, 0.1 * share * 0.025, 0.0)))
        system = tr.RollingSystem(STEEL, tr.Support(tr.Plane()), loads=loads)
        run = tr.simulate(system, system.place(position=(0.0, 0.0)), duration=2.0, every=0.1)
        reaction = 1000 * float(run.data.contact_force.sel(axis="x").values[0])
        gained = float(run.data.velocity.sel(axis="x").values[-1]) / 2.0

        def agrees(reaction: float = reaction, gained: float = gained) -> None:
            lines = page.get_by_test_id("numbers").locator("tbody tr")
            for at, value in enumerate((reaction, gained)):
                for text in lines.nth(at).get_by_role("cell").all_inner_texts():
                    assert number(text) == pytest.approx(value, rel=6e-4, abs=1e-6)

        eventually(page, agrees)


def turntable(page: Page) -> None:
    page.get_by_test_id("table-rate").fill("45")
    eventually(page, lambda: rates(page, 2 / 7 * 1.5 * math.pi, 2 / 7))
    page.get_by_role("radio", name="Hollow ball").check()
    eventually(page, lambda: rates(page, 2 / 5 * 1.5 * math.pi, 2 / 5))


def rates(page: Page, rate: float, share: float) -> None:
    lines = page.get_by_test_id("numbers").locator("tbody tr")
    assert [number(text) for text in lines.nth(0).get_by_role("cell").all_inner_texts()] == [as_shown(rate)] * 2
    assert number(lines.nth(1).get_by_role("cell").nth(1).inner_text()) == as_shown(share)


def nudge(page: Page) -> None:
    expect(page.get_by_text("It stays, spinning on the spot.")).to_be_visible()
    page.get_by_test_id("nudge-out").click()
    expect(page.get_by_text("It comes back to where it was nudged.")).to_be_visible()
    rate = 2 / 7 * 1.11 * math.pi

    def agrees() -> None:
        values = [
            number(text)
            for text in page.get_by_test_id("numbers").locator("tbody tr").nth(0).get_by_role("cell").all_inner_texts()
        ]
        assert values == [as_shown(5 / rate)] * 2, "the radius is the nudge over the rate, cm"

    eventually(page, agrees)


def tilt(page: Page) -> None:
    let_go = page.get_by_test_id("let-go")
    expect(let_go).to_be_disabled()
    page.get_by_test_id("guess-downhill").click()
    let_go.click()
    expect(page.get_by_test_id("judgement")).to_contain_text("You sent the ball downhill; it went sideways")
    omega, slope = 1.11 * math.pi, math.sin(math.radians(0.3))
    speed = 100 * 2.5 * 9.80665 * slope / omega  # cm/s
    values = [number(text) for text in row(page, "rift")]
    assert [abs(value) for value in values] == [as_shown(speed)] * 2
    page.get_by_test_id("guess-again").click()
    expect(let_go).to_be_disabled()
    expect(page.get_by_test_id("judgement")).to_be_hidden()
    page.get_by_test_id("guess-level").click()
    let_go.click()
    expect(page.get_by_test_id("judgement")).to_contain_text("You sent the ball sideways, as it goes")


def fields(page: Page) -> None:
    expect(page.get_by_test_id("stage")).to_have_count(2)
    expect(page.get_by_text("Ball and charge never part")).to_be_visible()
    page.get_by_test_id("fields-tilt").fill("0.2")
    speed = 100 * 2.5 * 9.80665 * math.sin(math.radians(0.2)) / (1.11 * math.pi)

    def agrees() -> None:
        texts = page.get_by_test_id("numbers").get_by_role("cell").all_inner_texts()
        values = [abs(number(text)) for text in texts if any(c.isdigit() for c in text)]
        assert len(values) >= 3
        assert values == [as_shown(speed)] * len(values)

    eventually(page, agrees)


def test_a_guess_is_drawn_by_hand(visitor: Visitor) -> None:
    page = visitor.open("#/tour/6")
    step(page, 6)
    stage = Bench(page).stage
    stage.drag((60.0, -30.0))
    page.get_by_test_id("let-go").click()
    expect(page.get_by_test_id("judgement")).to_contain_text("Your line and the path are")


def test_what_is_seen_on_the_tour_is_taken_to_the_bench(visitor: Visitor) -> None:
    page = visitor.open("#/tour/4", drawn=False)
    step(page, 4)
    page.get_by_test_id("table-rate").fill("45")
    page.get_by_test_id("make-it-yours").click()
    page.wait_for_url(re.compile(r"#/bench\?"))
    bench = Bench(page)
    assert tr.Scenario.read(bench.scenario()).system().support.motion.rate == pytest.approx(1.5 * math.pi)
    eventually(page, lambda: found(bench, 2 / 7 * 1.5 * math.pi))


def found(bench: Bench, rate: float) -> None:
    assert bench.found(r"\kappa") == (as_shown(rate), as_shown(rate))


@pytest.mark.parametrize(("key", "at"), [("n", 4), ("b", 2)])
def test_keys_go_on_and_back(key: str, at: int, visitor: Visitor) -> None:
    page = visitor.open("#/tour/3", drawn=False)
    step(page, 3)
    page.keyboard.press(key)
    step(page, at)


def test_the_tour_shows_the_scenario_that_ships() -> None:
    """The sixth step and the front page put the ball down as `tilted-turntable-put-down` does."""
    shipped = tomllib.loads(files.read("tilted-turntable-put-down"))
    assert shipped["start"]["position"] == ["-4 cm", "-45 cm"]
    assert shipped["support"]["tilt"] == "0.3 deg"
