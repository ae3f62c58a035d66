"""A browser, the lab to look at in it, and pages that are watched.

Where there is no Chromium these tests are skipped, and say so; `.ci/chromium` installs it where it can.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from . import serving
from .launching import ARGUMENTS, LAPTOP, NAMES
from .watching import Watch

ROOT = Path(__file__).parents[2]
PATIENCE = 20_000  # ms, for anything on a busy machine

OpenPage = Callable[..., Page]
_report = pytest.StashKey[pytest.TestReport]()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Any:
    """Keep the outcome, so that a failure can leave a picture."""
    report = yield
    if call.when == "call":
        item.stash[_report] = report
    return report


@pytest.fixture(scope="session")
def chromium() -> str:
    """The browser's program; tests that need it are skipped where there is none."""
    named = os.environ.get("TRUNDLE_CHROMIUM")
    for name in (named,) if named else NAMES:
        if path := shutil.which(name):
            return path
    told = ROOT / ".venv" / "no-chromium"
    if told.is_file():
        pytest.skip(f"no browser: {told.read_text().strip()}")
    if os.environ.get("CI", "").lower() in ("1", "true") and not named and shutil.which("apt-get"):
        pytest.fail("there is no Chromium, and nobody tried to install it: run .ci/chromium first, as `make test` does")
    pytest.skip(
        "no browser: install Chromium or Chrome, or name it in TRUNDLE_CHROMIUM (.ci/chromium does it on Debian)"
    )


@pytest.fixture(scope="session")
def lab(chromium: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:  # noqa: ARG001  no browser, no server
    """The origin of a lab that runs as long as the tests of this worker do."""
    with serving.lab(tmp_path_factory.mktemp("lab")) as origin:
        yield origin


@pytest.fixture(scope="module")
def browser(chromium: str) -> Iterator[Browser]:
    """Chromium. Not for the whole session: while Playwright is on, other tests could not start an event loop."""
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=chromium, args=ARGUMENTS, timeout=4 * PATIENCE)
        yield launched
        launched.close()


@pytest.fixture
def watch(lab: str) -> Watch:
    """What goes wrong in the pages of this test."""
    return Watch((lab + "/",))


@pytest.fixture
def open_page(
    browser: Browser, lab: str, watch: Watch, request: pytest.FixtureRequest, tmp_path: Path
) -> Iterator[OpenPage]:
    """Open a page of the lab: `open_page("#/tour", size=PHONE)`. Each gets a profile of its own.

    Motion is reduced unless asked for otherwise, so that a processor that draws by itself is not kept busy by tests
    that do not look at motion.
    """
    contexts = []

    def opened(route: str = "", *, size: Any = LAPTOP, reduced_motion: Any = "reduce", **options: Any) -> Page:
        context = browser.new_context(viewport=size, reduced_motion=reduced_motion, **options)
        contexts.append(context)
        context.set_default_timeout(PATIENCE)
        watch.over(context)
        page = context.new_page()
        page.goto(f"{lab}/{route}")
        return page

    yield opened
    if request.node.stash.get(_report, None) and request.node.stash[_report].failed:
        pictures = [tmp_path / f"failed-{at}.png" for at in range(len(contexts))]
        for context, picture in zip(contexts, pictures, strict=True):
            if context.pages:
                context.pages[-1].screenshot(path=picture)
        print("What it looked like:", *pictures)
    for context in contexts:
        context.close()
    assert watch.left() == []


@pytest.fixture
def page(open_page: OpenPage) -> Page:
    """The front page at the size of a laptop."""
    return open_page()
