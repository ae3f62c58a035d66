"""What a notebook shows of a result, as a browser draws it: legible on light paper and on dark."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

import trundle as tr

from .launching import SMALL

LEGIBLE = 4.5  # contrast of text that WCAG 2.2 asks for at level AA
PAPERS = {"light": ("#ffffff", "#1a1a1a"), "dark": ("#111111", "#e0e0e0")}
COLOURS = """() => [...document.querySelectorAll('.trundle-shown *')]
  .filter(one => [...one.childNodes].some(part => part.nodeType === 3 && part.data.trim()))
  .filter(one => one.getClientRects().length)
  .map(one => [one.className || one.tagName, getComputedStyle(one).color])"""


@pytest.fixture(scope="module")
def results() -> list[Any]:
    scenario = tr.Scenario.load("tilted-turntable")
    run = scenario.run(duration=2.0)
    card = run.card()
    failed = replace(card, figures=(replace(card.figures[0], passed=False), *card.figures[1:]))
    return [
        scenario,
        run,
        failed,
        tr.twin(scenario),
        tr.PfaffianSystem.load("cylinder").analyse(),
        tr.derive("turntable"),
    ]


@pytest.fixture(params=list(PAPERS))
def page(request: pytest.FixtureRequest, browser: Browser, results: list[Any]) -> Iterator[Page]:
    paper, ink = PAPERS[request.param]
    context = browser.new_context(viewport=SMALL, java_script_enabled=True, offline=True)
    page = context.new_page()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    shown = "".join(result._repr_html_() for result in results)
    page.set_content(f'<meta charset="utf-8"><body style="background: {paper}; color: {ink}">{shown}')
    yield page
    assert asked == []
    context.close()


def luminance(colour: str) -> float:
    """Relative luminance, as WCAG defines it, of `#rrggbb`, `rgb(…)` or `color(srgb …)`."""
    if colour.startswith("#"):
        parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    else:
        parts = [float(part) for part in re.findall(r"[\d.]+", colour.replace("color(srgb", ""))]
        parts = parts if colour.startswith("color") else [part / 255 for part in parts]
    assert len(parts) in (3, 4)
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts[:3]]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def on(paper: str, colour: str) -> str:
    """A colour that lets the paper through, as it is seen."""
    found = re.fullmatch(r"color\(srgb ([\d.]+) ([\d.]+) ([\d.]+) / ([\d.]+)\)", colour)
    if not found:
        return colour
    *parts, share = map(float, found.groups())
    below = [int(paper[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    seen = [part * share + under * (1 - share) for part, under in zip(parts, below, strict=True)]
    return f"color(srgb {seen[0]} {seen[1]} {seen[2]})"


def test_every_word_is_legible(page: Page) -> None:
    paper = page.evaluate("getComputedStyle(document.body).backgroundColor")
    paper = next(one for one, _ in PAPERS.values() if abs(luminance(one) - luminance(paper)) < 1e-6)
    found = {(name, colour) for name, colour in page.evaluate(COLOURS)}
    assert {"trundle-good", "trundle-bad", "SMALL", "TH", "TD"} <= {name for name, _ in found}
    for name, colour in found:
        light, dark = sorted((luminance(on(paper, colour)), luminance(paper)), reverse=True)
        assert (light + 0.05) / (dark + 0.05) >= LEGIBLE, (name, colour)


def test_formulas_are_drawn_and_nothing_is_wider_than_the_page(page: Page) -> None:
    fraction = page.locator("mfrac").first.bounding_box()
    assert fraction
    assert fraction["height"] > 18, "a fraction on one line"
    assert page.locator(".trundle-plain").count() > 20
    assert not page.locator(".trundle-plain").first.is_visible()
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    page.set_viewport_size({"width": 390, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), "only tables may scroll, by themselves"
