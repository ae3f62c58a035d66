"""A plugin of pytest: when the tests have run for so long, no other begins."""

from __future__ import annotations

import os
import time

import pytest

SECONDS = "TRUNDLE_CHECK_SECONDS"
_UNTIL = pytest.StashKey[float]()


@pytest.hookimpl(trylast=True)
def pytest_collection_finish(session: pytest.Session) -> None:
    """Count from the first test on: what it takes to collect them is the same for many and for few."""
    session.config.stash[_UNTIL] = time.monotonic() + float(os.environ[SECONDS])


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Leave a test out, before its fixtures are made; all that are left out are one line of the summary."""
    if time.monotonic() > item.config.stash[_UNTIL]:
        pytest.skip("the time is up: make test runs these, too")
