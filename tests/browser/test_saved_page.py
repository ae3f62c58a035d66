"""A saved page, opened from its file: it plays, by itself, and asks nothing of anybody."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

import trundle as tr

from .axe import violations
from .bench import Stage, colours, eventually
from .launching import PATIENCE, PHONE, SMALL
from .watching import Watch

NAME = "level-turntable-nudged"
OpenPage = Callable[..., Page]


@pytest.fixture(scope="module")
def run() -> tr.Trajectory:
    return tr.Scenario.load(NAME).run()


@pytest.fixture(scope="module")
def file(run: tr.Trajectory, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return run.save_html(tmp_path_factory.mktemp("saved") / "scene.html")


@pytest.fixture
def opened(browser: Browser) -> Iterator[OpenPage]:
    """Open a file, cut off from every network; nothing may go wrong, and nothing else be asked for."""
    contexts, watches = [], []

    def open_file(path: Path, **options: Any) -> Page:
        context = browser.new_context(**{"viewport": SMALL, "reduced_motion": "reduce", "offline": True, **options})
        context.set_default_timeout(PATIENCE)
        watch = Watch((path.as_uri(),))
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
        assert len([address for address in watch.requests if address.startswith("file:")]) == 1


def stage_of(page: Page) -> Stage:
    stage = Stage(page, page)
    expect(stage.canvas).to_be_visible()
    expect(stage.host).to_have_attribute("data-bodies", "1")
    return stage


def test_it_plays_and_what_it_draws_is_the_run(file: Path, run: tr.Trajectory, opened: OpenPage) -> None:
    page = opened(file, reduced_motion="no-preference")
    stage = stage_of(page)
    before = stage.middle()
    assert colours(before) > 20, "nothing is drawn"

    def gone_on() -> None:
        assert stage.drawn().time > 0.3

    eventually(page, gone_on)
    assert np.abs(stage.middle() - before).max() > 40, "nothing moves"
    page.get_by_role("button", name="Pause").click()

    def stands() -> None:
        drawn = stage.drawn()
        assert not drawn.playing
        place = run.in_frame(drawn.frame).at([min(drawn.time, float(run.data.time[-1]))]).data.position[0]
        assert drawn.place == pytest.approx(tuple(place.values), abs=2e-4)

    eventually(page, stands)


def test_it_stands_still_for_who_wants_less_motion(file: Path, opened: OpenPage) -> None:
    page = opened(file)
    stage = stage_of(page)
    page.wait_for_timeout(400)
    assert (stage.drawn().time, stage.drawn().playing) == (0.0, False)
    page.get_by_role("button", name="Play").click()
    eventually(page, lambda: _assert(stage.drawn().time > 0.05))


def _assert(held: bool) -> None:
    assert held


def test_it_is_dark_where_the_system_is_and_light_at_a_press(file: Path, opened: OpenPage) -> None:
    page = opened(file, color_scheme="dark")
    stage_of(page)

    def brightness() -> int:
        colour = page.evaluate("getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)")
        return sum(colour)

    assert brightness() < 150
    expect(page.locator(".tr-viewer")).to_have_attribute("data-theme", "dark")
    page.get_by_role("button", name="Light", exact=True).click()
    assert brightness() > 600
    expect(page.locator(".tr-viewer")).to_have_attribute("data-theme", "light")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_grave(file: Path, opened: OpenPage, scheme: str) -> None:
    page = opened(file, color_scheme=scheme)
    stage_of(page)
    assert violations(page) == []


def test_on_a_phone_nothing_runs_over_the_edge(file: Path, opened: OpenPage) -> None:
    page = opened(file, viewport=PHONE)
    stage_of(page)
    assert page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth")


def test_without_scripts_the_figures_are_there(file: Path, opened: OpenPage) -> None:
    page = opened(file, java_script_enabled=False)
    expect(page.get_by_text("every check held")).to_be_visible()
    expect(page.get_by_text("The motion is drawn by JavaScript, which is off here.")).to_be_visible()
    expect(page.get_by_role("heading", name="Theory and motion")).to_be_visible()


def test_several_bodies_share_the_stage(run: tr.Trajectory, opened: OpenPage, tmp_path: Path) -> None:
    hollow = tr.Scenario.load(NAME).model_copy(update={"title": "A <b>hollow</b> ball"}).run(duration=2.0)
    page = opened(run.save_html(tmp_path / "two.html", hollow))
    expect(Stage(page, page).host).to_have_attribute("data-bodies", "2")
    expect(page.get_by_role("heading", level=1)).to_contain_text("and 1 more")
    assert page.locator("h1 b").count() == 0


def test_a_title_that_looks_like_a_script_is_only_a_title(opened: OpenPage, tmp_path: Path) -> None:
    title = "</script><script>document.body.remove()</script> 'quoted' & \"so\" 🎱"
    from trundle.scenario import files

    tables = files.parse(files.read(NAME), NAME)
    nasty = tr.Scenario.read({**tables, "title": title}).run(duration=1.0)
    page = opened(nasty.save_html(tmp_path / "nasty.html"))
    stage_of(page)
    expect(page.get_by_role("heading", level=1)).to_have_text(title)
    assert page.title() == title
