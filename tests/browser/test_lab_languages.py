"""The lab in another language: chosen by the link or by the browser, with the numbers of that language."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Page, expect

from .launching import PATIENCE, PHONE
from .test_lab_access import come_to_rest, settle
from .test_lab_fit import FOUR_TIMES, TOO_WIDE
from .visiting import PAGES, Visitor

# What of the page has vowels without marks: what is in no catalogue. Formulas, files, citations and units are no words.
PLAIN = """() => {
    const units = /^(rad|deg|min|rpm|const|sin|arg)$/
    const unmarked = (word) => /^[A-Z]?[a-z]{2,}$/.test(word) && /[aeiou]/.test(word) && !units.test(word)
    const key = /^[\\w-]+([.:] ?[\\w\\[\\]-]+)+$/  // support.tilt, turned: turned-over
    const words = (text) => (key.test(text.trim()) ? [] : (text.match(/\\p{L}+/gu) ?? []))
    const plain = (text) => words(text).some((word) => word.length > 2 && unmarked(word))
    const ours = 'noscript, script, style, pre, code, datalist, textarea, math, .katex, .formula, [hreflang], '
        + '.wordmark, .card-method, [translate=no], [data-trundle-cited]'
    const found = []
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT)
    for (let node = walk.nextNode(); node; node = walk.nextNode())
        if (!node.parentElement.closest(ours) && plain(node.data)) found.push(node.data)
    for (const element of document.querySelectorAll('[title], [aria-label], [aria-valuetext], [placeholder], [alt]'))
        for (const name of ['title', 'aria-label', 'aria-valuetext', 'placeholder', 'alt'])
            if (!element.closest(ours) && plain((element.getAttribute(name) ?? '').replace(/\\\\[a-z]+/g, '')))
                found.push(element.getAttribute(name))
    return found
}"""


# Words of tables that begin on one line and end on another.
BROKEN = """() => {
    const lines = (range) => new Set([...range.getClientRects()].map(({bottom}) => Math.round(bottom))).size
    const found = []
    for (const cell of document.querySelectorAll('main table :is(th, td)')) {
        const walk = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT)
        for (let text = walk.nextNode(); text; text = walk.nextNode()) {
            if (text.parentElement.closest('.sr-only, math, .katex')) continue
            for (const word of text.data.matchAll(/[\\p{L}\\p{N}.,]{2,}/gu)) {
                const range = document.createRange()
                range.setStart(text, word.index)
                range.setEnd(text, word.index + word[0].length)
                if (lines(range) > 1) found.push(word[0])
            }
        }
    }
    return found
}"""


def test_the_browser_chooses_the_language_and_a_link_overrules_it(visitor: Visitor) -> None:
    page = visitor.open("#/", locale="de-AT")
    expect(page.locator("html")).to_have_attribute("lang", "de")
    expect(page.get_by_role("link", name="Zum Rundgang")).to_be_visible()
    page.get_by_role("link", name="English").click()
    expect(page.get_by_role("link", name="Take the tour")).to_be_visible()
    expect(page.locator("html")).to_have_attribute("lang", "en")


SLOW = 3 * PATIENCE  # ms, for all that a page asks for: pictures of runs, sweeps


def ready(visitor: Visitor, route: str, **options: Any) -> Page:
    """Open a page in the pseudo-language, and wait until it has asked for all that it needs."""
    page = visitor.open(f"?lang=pseudo{route}", drawn=False, **options)
    expect(page.locator("main h1").first).to_contain_text("⟦", timeout=SLOW)
    if route.startswith("#/maps"):  # a map is computed for as long as it is looked at
        expect(page.locator(".map-notes")).to_contain_text("⟦", timeout=SLOW)
    else:
        page.wait_for_load_state("networkidle", timeout=SLOW)
    return page


ROUTES = [
    *PAGES,
    *(f"#/tour/{step}" for step in range(1, 8)),
    "#/challenges/one-round-in-five-seconds",
    "#/measure",
]


@pytest.mark.parametrize("route", ROUTES)
def test_no_text_of_a_page_is_outside_the_catalogue_and_long_words_fit(visitor: Visitor, route: str) -> None:
    page = ready(visitor, route, size=PHONE)
    page.evaluate("document.querySelectorAll('main details').forEach(one => { one.open = true })")
    assert page.evaluate(PLAIN) == []
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_a_text_outside_the_catalogue_is_found(visitor: Visitor) -> None:
    page = ready(visitor, "#/")
    page.evaluate("document.querySelector('main').append(Object.assign(new Text('Nobody has said this before')))")
    assert page.evaluate(PLAIN) == ["Nobody has said this before"]


def test_no_text_of_the_bench_and_its_dialogs_is_outside_the_catalogue(visitor: Visitor) -> None:
    page = ready(visitor, "#/bench")
    expect(page.locator(".card-lines")).to_have_count(1)
    for tab in page.get_by_role("tab").all():
        tab.click()
        assert page.evaluate(PLAIN) == []
    for opener in (".bar-scenario", ".formula-card .link", ".head [title*='?']"):
        if opener == ".formula-card .link":
            page.get_by_role("tab").nth(0).click()
        page.locator(opener).first.click()
        dialog = page.locator("dialog[open]")
        expect(dialog.locator(".working")).to_have_count(0)
        assert page.evaluate(PLAIN) == [], opener
        page.keyboard.press("Escape")
        expect(dialog).to_have_count(0)


def test_a_decimal_comma_is_shown_and_understood(visitor: Visitor) -> None:
    page = visitor.open("?lang=de#/bench", drawn=False, cards=False)
    tilt = page.locator('[data-path="support.tilt"] input[type=text]')
    expect(tilt).to_have_value("0,3")
    expect(page.locator('[data-path="support.tilt"] label')).to_have_text("Neigung")
    tilt.fill("0,5")
    tilt.press("Enter")
    expect(tilt).to_have_value("0,5")
    expect(page.locator('[data-path="support.tilt"] .field-message')).to_be_hidden()


@pytest.mark.parametrize("projector", [False, True])
def test_the_header_and_the_tabs_fit_at_every_width_in_long_words(visitor: Visitor, projector: bool) -> None:
    page = visitor.open("?lang=de#/bench", drawn=False, cards=False)
    expect(page.get_by_role("tab", name="Zahlen")).to_be_visible()
    if projector:
        page.evaluate("document.documentElement.dataset.projector = ''")
    for width in (390, 683, 844, 900, 930, 960, 1024, 1088, 1100, 1280, 1366, 1920):
        page.set_viewport_size({"width": width, "height": 640})
        for row in (".head", "[role=tablist]"):
            wide = page.locator(row).first.evaluate("row => row.scrollWidth - row.clientWidth")
            assert wide <= 1, (row, width)


@pytest.mark.parametrize("route", ["#/compare", "#/tour/4", "#/tour/7", "#/fields"])
def test_a_table_on_a_telephone_breaks_no_long_word_and_keeps_its_last_column(visitor: Visitor, route: str) -> None:
    page = visitor.open(f"?lang=de{route}", drawn=False, cards=False)
    settle(page)
    expect(page.locator("main table tbody tr").first).to_be_visible(timeout=SLOW)
    page.set_viewport_size(PHONE)
    come_to_rest(page)
    assert page.evaluate(BROKEN) == []
    assert page.evaluate(TOO_WIDE) == [0, []]
    page.set_viewport_size(FOUR_TIMES)
    assert page.evaluate(TOO_WIDE) == [0, []]


def test_an_arrow_bears_its_symbol_in_any_language_and_a_point_of_the_compass_its_letter(visitor: Visitor) -> None:
    """E is the electric field, and east."""
    page = visitor.open("?lang=de#/fields", drawn=False, cards=False)
    arrows = page.locator(".tr-label[data-kind=arrow]:not([hidden])")
    expect(arrows).to_have_text(["E", "B"], timeout=SLOW)
    page = visitor.open("?lang=de#/holonomy", drawn=False, cards=False)
    expect(page.locator(".tr-label[data-kind=axis]:not([hidden])")).to_have_text(["O", "N"], timeout=SLOW)
