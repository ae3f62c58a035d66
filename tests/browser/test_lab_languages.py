"""The lab in another language: chosen by the link or by the browser, with the numbers of that language."""

from __future__ import annotations

from playwright.sync_api import expect

from .visiting import Visitor

# What of the page has vowels without marks: what is in no catalogue.
PLAIN = """() => {
    const unmarked = (word) => /^[A-Za-z]{3,}$/.test(word) && /[aeiou]/i.test(word)
    const plain = (text) => (text.match(/\\p{L}+/gu) ?? []).some(unmarked)
    const ours = 'noscript, script, [hreflang], .wordmark'
    const found = []
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT)
    for (let node = walk.nextNode(); node; node = walk.nextNode())
        if (!node.parentElement.closest(ours) && plain(node.data)) found.push(node.data)
    for (const element of document.querySelectorAll('[title], [aria-label]'))
        for (const name of ['title', 'aria-label'])
            if (plain(element.getAttribute(name) ?? '')) found.push(element.getAttribute(name))
    return found
}"""


def test_the_browser_chooses_the_language_and_a_link_overrules_it(visitor: Visitor) -> None:
    page = visitor.open("#/", locale="de-AT")
    expect(page.locator("html")).to_have_attribute("lang", "de")
    expect(page.get_by_role("link", name="Zum Rundgang")).to_be_visible()
    page.get_by_role("link", name="English").click()
    expect(page.get_by_role("link", name="Take the tour")).to_be_visible()
    expect(page.locator("html")).to_have_attribute("lang", "en")


def test_no_text_of_the_front_door_is_outside_the_catalogue_and_long_words_fit(visitor: Visitor) -> None:
    page = visitor.open("?lang=pseudo#/", size={"width": 390, "height": 844})
    expect(page.get_by_role("heading", level=1)).to_contain_text("⟦")
    assert page.evaluate(PLAIN) == []
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_a_decimal_comma_is_shown_and_understood(visitor: Visitor) -> None:
    page = visitor.open("?lang=de#/bench", drawn=False, cards=False)
    tilt = page.locator('[data-path="support.tilt"] input[type=text]')
    expect(tilt).to_have_value("0,3")
    expect(page.locator('[data-path="support.tilt"] label')).to_have_text("Neigung")
    tilt.fill("0,5")
    tilt.press("Enter")
    expect(tilt).to_have_value("0,5")
    expect(page.locator('[data-path="support.tilt"] .field-message')).to_be_hidden()
