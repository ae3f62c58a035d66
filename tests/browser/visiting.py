"""Somebody who opens pages of the lab."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, BrowserContext, Page

from .launching import PATIENCE, SMALL
from .watching import Watch

# Pages that are there as they are, beside those of the tour, one challenge, the bench and Measure.
PAGES = (
    "#/",
    "#/challenges",
    "#/report",
    "#/notes",
    "#/compare",
    "#/fields",
    "#/holonomy",
    "#/holonomy/orders",
    "#/holonomy/loop",
    "#/maps",
)
# Everything is made ready to be drawn, and nothing is: the page is told of no difference.
UNDRAWN = """
for (const way of ['drawArrays', 'drawArraysInstanced', 'drawElements', 'drawElementsInstanced'])
    WebGL2RenderingContext.prototype[way] = () => {}
"""
# The page waits for a card that never comes.
CARDLESS = """
const ask = window.fetch
window.fetch = (...given) => String(given[0]).endsWith('/api/card') ? new Promise(() => {}) : ask(...given)
"""


@dataclass
class Visitor:
    """Opens pages, each with a profile of its own: nothing kept, nothing cached."""

    browser: Browser
    lab: str
    watch: Watch
    contexts: list[BrowserContext] = field(default_factory=list)

    def open(
        self,
        route: str = "#/bench",
        *,
        size: Any = SMALL,
        reduced_motion: Any = "reduce",
        drawn: bool = True,
        cards: bool = True,
        **options: Any,
    ) -> Page:
        """Open a page of the lab: `open("#/tour", size=PHONE)`.

        It is small, and motion is reduced, unless asked for otherwise: a processor that draws by itself is not to be
        kept busy by tests that look at neither size nor motion. Where none looks at the stage's pixels either, it
        need not be `drawn`; and where none looks at `cards`, none need be computed.
        """
        context = self.browser.new_context(viewport=size, reduced_motion=reduced_motion, **options)
        self.contexts.append(context)
        context.set_default_timeout(PATIENCE)
        self.watch.over(context)
        if not drawn:
            context.add_init_script(UNDRAWN)
        if not cards:
            context.add_init_script(CARDLESS)
        page = context.new_page()
        page.goto(f"{self.lab}/{route}")
        return page

    def pictures(self, folder: Path) -> list[Path]:
        """What is seen in each page now."""
        pages = [context.pages[-1] for context in self.contexts if context.pages]
        paths = [folder / f"page-{at}.png" for at in range(len(pages))]
        for page, path in zip(pages, paths, strict=True):
            page.screenshot(path=path)
        return paths

    def leave(self) -> None:
        """Close everything."""
        for context in self.contexts:
            context.close()
        self.contexts.clear()
