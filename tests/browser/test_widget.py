"""The notebook's widget in a real JupyterLab: it is drawn, it moves, and Python and mouse hear each other."""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from .bench import Stage, colours, eventually
from .launching import LAPTOP
from .notebooks import jupyterlab, write_notebook
from .watching import Watch

CELLS = (
    'import trundle as tr\nrun = tr.Scenario.load("level-turntable-nudged").run()',
    "widget = run.view(height=320)\nwidget",
    'widget.playing = False\nwidget.frame = "corotating"\nwidget.seek(1.5)',
    'print("at", widget.time, widget.frame, widget.playing)',
)
STARTING = 60_000  # ms, for JupyterLab and its kernel on a busy machine


@pytest.fixture(scope="module")
def notebook(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """A notebook whose first two cells have run."""
    folder = tmp_path_factory.mktemp("notebook")
    write_notebook(folder / "scene.ipynb", *CELLS)
    with jupyterlab(folder) as (origin, token):
        context = browser.new_context(viewport=LAPTOP)
        watch = Watch((origin, origin.replace("http", "ws", 1)))
        watch.over(context)
        page = context.new_page()
        page.goto(f"{origin}/lab/tree/scene.ipynb?token={token}", timeout=STARTING)
        expect(page.get_by_text("Python 3 (ipykernel) | Idle")).to_be_visible(timeout=STARTING)
        run_cell(page, 0)
        run_cell(page, 1)
        expect(page.get_by_test_id("stage")).to_be_visible(timeout=STARTING)
        yield page
        context.close()
    assert watch.left() == []


def run_cell(page: Page, at: int) -> None:
    """Run a cell and wait until it has run."""
    cell = page.locator(".jp-Notebook .jp-CodeCell").nth(at)
    prompt = cell.locator(".jp-InputPrompt")
    cell.locator(".cm-content").click()
    page.keyboard.press("Shift+Enter")
    expect(prompt).to_have_text(re.compile(r"\[\d+\]"), timeout=STARTING)


def test_it_is_drawn_and_it_moves(notebook: Page) -> None:
    stage = Stage(notebook, notebook)
    expect(stage.host).to_have_attribute("data-bodies", "1")
    before = stage.middle()
    assert colours(before) > 20, "nothing is drawn"
    begun = stage.drawn().time

    def gone_on() -> None:
        assert stage.drawn().time > begun + 0.2

    eventually(notebook, gone_on)
    assert np.abs(stage.middle() - before).max() > 40, "nothing moves"
    box = stage.canvas.bounding_box()
    assert box
    assert 200 < box["height"] < 320


def test_python_and_the_mouse_hear_each_other(notebook: Page) -> None:
    stage = Stage(notebook, notebook)
    run_cell(notebook, 2)

    def heard() -> None:
        drawn = stage.drawn()
        assert (drawn.time, drawn.frame, drawn.playing) == (1.5, "corotating", False)

    eventually(notebook, heard)
    notebook.locator(".tr-viewer").get_by_role("button", name="World").click()
    stage.canvas.focus()
    notebook.keyboard.press("Home")
    eventually(notebook, lambda: _assert(stage.drawn().time == 0.0))
    run_cell(notebook, 3)
    expect(notebook.get_by_text("at 0.0 world False")).to_be_visible()


def _assert(held: bool) -> None:
    assert held
