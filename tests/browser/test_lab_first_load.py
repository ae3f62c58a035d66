"""What a page sends before it is there: a school's network may be slow, and thirty pupils open it at once."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from .launching import LAPTOP, PATIENCE
from .visiting import PAGES, Visitor

MOST = 700_000  # bytes as sent
ROUTES = [
    *PAGES,
    "#/tour/1",
    "#/tour/4",
    "#/bench",
    "#/challenges/which-is-hollow",
    "#/measure?example=ball-on-a-ramp",
]


@pytest.mark.parametrize("route", ROUTES)
def test_a_first_load_is_small_in_the_language_with_the_largest_catalogue(visitor: Visitor, route: str) -> None:
    """English has no catalogue, and sends less."""
    page = visitor.open("", size=LAPTOP)
    page.goto("about:blank")
    counting = page.context.new_cdp_session(page)
    sent: dict[str, int] = {}
    counting.on("Network.loadingFinished", lambda one: sent.update({one["requestId"]: one["encodedDataLength"]}))
    counting.send("Network.enable")
    counting.send("Network.setCacheDisabled", {"cacheDisabled": True})
    page.goto(f"{visitor.lab}/?lang=de{route}")
    expect(page.locator("html")).to_have_attribute("lang", "de")
    expect(page.locator("main h1").first).to_be_visible(timeout=3 * PATIENCE)
    known = -1
    while known < sum(sent.values()) <= MOST:  # until nothing more comes
        known = sum(sent.values())
        page.wait_for_timeout(2000)
    assert 100_000 < sum(sent.values()) <= MOST
