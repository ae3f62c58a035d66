"""Every scenario that ships is drawn in the lab, and moves."""

from __future__ import annotations

import json
import re

import numpy as np
import pytest
from playwright.sync_api import expect

import trundle as tr
from trundle.scenario import files

from .bench import Bench, Stage, colours, decoded, eventually
from .visiting import Visitor

TOLD = 2e-5  # m: what is drawn has single precision and is told to a hundredth of a millimetre
SEEN = 30  # a difference in colour that an eye sees; the channels go to 255


@pytest.fixture(scope="module")
def bench(staying: Visitor) -> Bench:
    return Bench(staying.open(cards=False))  # that each scenario's card passes, the command line's tests ask


def end_of(name: str) -> tuple[float, ...]:
    """Where the body's centre is at last, seen by somebody who stands beside the support."""
    tables = files.parse(files.read(name), name)
    if files.rolls_along_path(tables):
        from trundle.analysis.geometry import PathScenario

        rolled = PathScenario.read(tables).run()
        return tuple(float(value) for value in rolled.stages.position[-1])
    scenario = tr.Scenario.load(name)
    run = scenario.run(every=float(scenario.timing.duration)).in_frame("world")
    return tuple(float(value) for value in run.data.position.values[-1])


@pytest.mark.parametrize("name", files.names())
def test_a_scenario_is_drawn_as_it_is_computed(name: str, bench: Bench) -> None:
    bench.open(f"#/bench?name={name}")
    stage, page = bench.stage, bench.page
    title = files.title_of(name)
    page.locator(f"section.stage[data-shown={json.dumps(title)}]").wait_for()
    expect(page.locator(".bar-title")).to_have_text(title)
    expected = end_of(name)

    def moved() -> None:
        last, sharp = stage.seen_after("End")
        assert stage.drawn().place[: len(expected)] == pytest.approx(expected, abs=TOLD)
        first, as_sharp = stage.seen_after("Home")
        assert as_sharp == sharp, "one of the pictures is coarser than the other"
        assert colours(first) > 100, "the stage is blank"
        assert np.mean(np.abs(last - first).max(axis=2) > SEEN) > 1e-4, "nothing has moved on the stage"
        starts(stage)

    eventually(page, moved)
    assert page.locator(".toast-error").all_inner_texts() == []


def starts(stage: Stage) -> None:
    assert stage.drawn().time == 0.0


@pytest.mark.parametrize("name", [name for name in files.names() if files.rolls_along_path(files.tables_of(name))])
def test_a_number_of_a_rolled_path_is_changed_though_it_has_no_start(name: str, bench: Bench) -> None:
    bench.open(f"#/bench?name={name}")
    page = bench.page
    page.locator(f"section.stage[data-shown={json.dumps(files.title_of(name))}]").wait_for()
    radius = bench.box("body.radius")
    radius.fill("31 mm")
    radius.press("Enter")
    radius.blur()  # the page stays for other tests, whose keys are not for this box
    expect(page).to_have_url(re.compile(r"s="))

    def told() -> None:
        assert decoded(page.url.split("s=")[1])["body"]["radius"] == "31 mm"

    eventually(page, told)
    expect(page.locator(".controls")).to_have_attribute("data-ends", files.title_of(name), timeout=60_000)
    assert page.locator(".toast-error").all_inner_texts() == []


@pytest.mark.parametrize("name", ["roll-figure-eight", "bouncing-ball-with-backspin", "ball-in-a-turning-bowl"])
def test_it_plays(name: str, bench: Bench) -> None:
    """A path that is rolled, a body that flies, one that stays: the film is the same for all."""
    bench.open(f"#/bench?name={name}")
    stage, page = bench.stage, bench.page
    page.locator(f"section.stage[data-shown={json.dumps(files.title_of(name))}]").wait_for()
    page.keyboard.press("Home")
    page.keyboard.press("Space")
    eventually(page, lambda: runs(stage))
    page.keyboard.press("Space")


def runs(stage: Stage) -> None:
    drawn = stage.drawn()
    assert drawn.playing
    assert drawn.time > 0.0
