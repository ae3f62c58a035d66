"""A browser, the lab to look at in it, and pages that are watched.

Where there is no Chromium these tests are skipped, and say so; `.ci/chromium` installs it where it can.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, expect, sync_playwright

from . import serving
from .launching import ARGUMENTS, NAMES, PATIENCE
from .visiting import Visitor
from .watching import Watch

ROOT = Path(__file__).parents[2]
expect.set_options(timeout=PATIENCE)
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
    pytest.skip("no browser: install Chromium or Chrome, or name it in TRUNDLE_CHROMIUM (on Debian, .ci/chromium does)")


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
def visitor(
    browser: Browser, lab: str, watch: Watch, request: pytest.FixtureRequest, tmp_path: Path
) -> Iterator[Visitor]:
    """Opens pages of the lab, which close with the test; nothing may have gone wrong in them."""
    visiting = Visitor(browser, lab, watch)
    yield visiting
    report = request.node.stash.get(_report, None)
    if report is not None and report.failed:
        print("What it looked like:", *visiting.pictures(tmp_path))
    visiting.leave()
    assert watch.left() == []


@pytest.fixture(scope="module")
def staying(browser: Browser, lab: str) -> Iterator[Visitor]:
    """A visitor who stays for all tests of a module."""
    visiting = Visitor(browser, lab, Watch((lab + "/",)))
    yield visiting
    visiting.leave()


@pytest.fixture(autouse=True)
def unhurt(request: pytest.FixtureRequest) -> Iterator[None]:
    """Nothing may have gone wrong in the pages of who stays; what one test provokes, the next may not."""
    if "staying" not in request.fixturenames:
        yield
        return
    watch: Watch = request.getfixturevalue("staying").watch
    yield
    left = watch.left()
    watch.faults.clear()
    watch.allowed.clear()
    assert left == []
