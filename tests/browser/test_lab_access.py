"""Nobody is shut out: axe-core, the keyboard alone, less motion, no WebGL, no network."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import Page, expect

import trundle as tr
from trundle.scenario import files

from .axe import OF_COLOURS, violations
from .bench import Bench, Stage, as_shown, eventually
from .launching import ARGUMENTS, LAPTOP, PHONE
from .screenshots import OPENED, PAGES
from .visiting import Visitor

# The tour's steps are of one make: the first, one with choices, the guess, the one with two stages.
# The front door, the challenges and what is printed are judged where they are used.
STAGED = [name for name in PAGES if name not in ("start", "challenges", "challenge", "report", "notes")]
JUDGED = [name for name in STAGED if name not in ("tour-2", "tour-3", "tour-5", "bench-coin")]


# Where it opens, and what is in it once it is complete.
OPENED_PART = {
    "bench-numbers": (".tab-panels", ".katex"),
    "bench-curves": (".tab-panels", ".curve svg"),
    "bench-card": (".tab-panels", ".card-summary"),
    "bench-scenarios": ("dialog", "[data-scenario]"),
    "bench-help": ("dialog", ".help-row"),
    "bench-derivation": ("dialog", ".steps .katex"),
    "bench-downloads": (".bar", "[data-format]"),
}

STILL = """calm => new Promise((still, never) => {
    const begun = performance.now()
    let changed = begun
    const watcher = new MutationObserver(() => { changed = performance.now() })
    watcher.observe(document, { subtree: true, childList: true, attributes: true, characterData: true })
    const look = () => {
        const now = performance.now()
        if (document.getAnimations().some(({ playState }) => playState === 'running')) changed = now
        if (now - changed < calm && now - begun < 20000) return setTimeout(look, 20)
        watcher.disconnect()
        if (now - changed < calm) never(new Error('the page does not come to rest'))
        else requestAnimationFrame(() => requestAnimationFrame(still))
    }
    look()
})"""


def come_to_rest(page: Page, calm: float = 100.0) -> None:
    """Wait until nothing has changed in the page for so many ms, and no colour fades into another."""
    page.evaluate(STILL, calm)


def settle(page: Page) -> None:
    expect(page.get_by_test_id("stage").first).to_be_visible()
    expect(page.locator('[data-bodies]:not([data-bodies="0"])').first).to_be_attached()
    expect(page.locator('[data-bodies="0"], [data-busy]')).to_have_count(0)


def go(page: Page, route: str) -> None:
    """Go on to another page, and wait until it is complete."""
    page.evaluate("route => { location.hash = route }", route)
    expect(page.locator(f'[href="{route.split("?")[0]}"][aria-current]').first).to_be_attached()
    if "?name=" in route:
        title = files.title_of(route.split("?name=")[1])
        expect(page.locator("section.stage")).to_have_attribute("data-shown", title)
    settle(page)
    come_to_rest(page)


def judge(page: Page, part: str = "body", sizes: tuple[dict, ...] = (LAPTOP, PHONE)) -> None:
    """Light and dark; at none of the widths may the page have to be scrolled to the side.

    The schemes differ in nothing but colours: at each width one of them is judged by all rules, and the other by those
    that look at colours.
    """
    found = []
    schemes = ["light", "dark"]
    for size in sizes:
        page.set_viewport_size(size)  # type: ignore[arg-type]
        for scheme, rules in zip(schemes, ((), OF_COLOURS), strict=True):
            page.emulate_media(color_scheme=scheme, reduced_motion="reduce")  # type: ignore[arg-type]
            expect(page.locator("html")).to_have_attribute("data-theme", scheme)
            come_to_rest(page, calm=40.0)
            found += [f"{scheme}, {size['width']} wide: {one}" for one in violations(page, part, rules)]
        schemes.reverse()
        wide = page.evaluate(TOO_WIDE)
        if wide > 0:
            found.append(f"{size['width']} wide: {wide} pixels must be scrolled to the side")
    assert not found, "\n".join(found)


@pytest.fixture(scope="module")
def kept(staying: Visitor) -> Page:
    """A page that goes from one test to the next, so that scripts are read once; axe-core sees no stage."""
    return staying.open(drawn=False)


@pytest.mark.parametrize("name", JUDGED)
def test_axe_finds_nothing_grave(name: str, kept: Page) -> None:
    go(kept, PAGES[name])
    judge(kept)


@pytest.mark.parametrize("name", OPENED)
def test_axe_finds_nothing_grave_in_what_opens(name: str, kept: Page) -> None:
    kept.set_viewport_size(LAPTOP)  # type: ignore[arg-type]
    go(kept, "#/bench?name=level-turntable-nudged")
    OPENED[name](kept)
    part, complete = OPENED_PART[name]
    expect(kept.locator(part)).to_be_visible()
    expect(kept.locator(part).locator(complete).first).to_be_visible()
    come_to_rest(kept)
    judge(kept, part, (LAPTOP,))
    kept.keyboard.press("Escape")


def test_a_derivation_fits_a_phone(kept: Page) -> None:
    go(kept, "#/bench")
    kept.set_viewport_size(PHONE)  # type: ignore[arg-type]
    kept.get_by_role("tab", name="Numbers").click()
    kept.get_by_role("button", name="How does this follow?").click()
    kept.locator(".dialog-body .step").nth(3).wait_for()
    come_to_rest(kept)
    assert kept.evaluate(TOO_WIDE) <= 0
    kept.keyboard.press("Escape")
    kept.set_viewport_size(LAPTOP)  # type: ignore[arg-type]


def test_axe_finds_nothing_grave_in_an_error(visitor: Visitor) -> None:
    visitor.watch.allow("status of 422")
    bench = Bench(visitor.open("#/bench", drawn=False))
    box = bench.box("body.radius")
    box.fill("-25 mm")
    box.press("Enter")
    expect(box).to_have_attribute("aria-invalid", "true")
    judge(bench.page, ".bench", (LAPTOP,))


# By how many pixels the page, or a dialog in it, is wider than what is seen of it.
TOO_WIDE = """Math.max(...[document.documentElement, ...document.querySelectorAll('.dialog-body, .steps')]
    .map(element => element.scrollWidth - element.clientWidth))"""
ACTIVE = """() => {
    const one = document.activeElement
    const isMarked = (element) => {
        const style = getComputedStyle(element)
        return (style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) > 0) || style.boxShadow !== 'none'
    }
    const label = one.labels?.[0]?.textContent
    const name = one.getAttribute('aria-label') ?? label ?? one.textContent
    const box = one.getBoundingClientRect()
    return {
        name: name.trim(),
        tag: one.tagName,
        seen: box.width > 0 && box.height > 0,
        // A number and its unit share one frame, which then has the mark.
        marked: isMarked(one) || isMarked(one.parentElement),
    }
}"""


def tab_to(page: Page, name: str, tag: str = "", most: int = 120) -> None:
    """Press Tab until something of this name has the focus; whatever had it on the way must have shown it."""
    for _ in range(most):
        page.keyboard.press("Tab")
        now = page.evaluate(ACTIVE)
        if now["tag"] == "BODY":
            continue
        assert now["seen"], f"the focus went to something that cannot be seen: {now}"
        assert now["marked"], f"the focus on {now} is not shown"
        if now["name"].startswith(name) and tag in now["tag"]:
            return
    pytest.fail(f"no way by Tab to {name!r}")


def test_everything_by_keyboard_alone(visitor: Visitor) -> None:
    bench = Bench(visitor.open("#/bench?name=level-turntable-nudged", drawn=False))
    page, stage = bench.page, bench.stage
    page.keyboard.press("Tab")
    assert page.evaluate(ACTIVE)["name"] == "Skip to the page"

    tab_to(page, "Rate", "INPUT")
    page.keyboard.press("Control+A")
    page.keyboard.type("45 rpm")
    page.keyboard.press("Enter")
    eventually(page, lambda: predicted(bench, 2 / 7 * 4.71238898))
    page.keyboard.press("ArrowUp")
    eventually(page, lambda: predicted(bench, 2 / 7 * 4.81710874))  # 46 rpm
    page.keyboard.press("Tab")  # the unit
    page.keyboard.press("Tab")  # the slider
    page.keyboard.press("ArrowLeft")
    eventually(page, lambda: predicted(bench, 2 / 7 * 4.71238898))

    tab_to(page, "Play")
    page.keyboard.press("Enter")
    eventually(page, lambda: plays(stage, True))
    page.keyboard.press("Enter")
    eventually(page, lambda: plays(stage, False))
    tab_to(page, "Time", "INPUT")
    page.keyboard.press("End")
    eventually(page, lambda: at_time(stage, 20.0))

    while page.evaluate(ACTIVE)["name"] != "Tour":
        page.keyboard.press("Shift+Tab")
    page.keyboard.press("Enter")
    expect(page.get_by_text("Step 1 of 7")).to_be_visible()
    assert page.evaluate("document.querySelector('main').contains(document.activeElement)"), "the focus is lost"


def predicted(bench: Bench, rate: float) -> None:
    assert bench.found(r"\kappa")[0] == as_shown(rate)


def plays(stage: Stage, playing: bool) -> None:
    assert stage.drawn().playing is playing


def at_time(stage: Stage, time: float) -> None:
    assert stage.drawn().time == pytest.approx(time)


def test_the_keys_of_the_film(visitor: Visitor) -> None:
    bench = Bench(visitor.open("#/bench?name=level-turntable-nudged", drawn=False))
    page, stage = bench.page, bench.stage
    page.keyboard.press("Space")
    eventually(page, lambda: plays(stage, True))
    page.keyboard.press("Space")
    eventually(page, lambda: plays(stage, False))
    page.keyboard.press("Home")
    for _ in range(3):
        page.keyboard.press("ArrowRight")
    eventually(page, lambda: at_time(stage, 0.03))
    page.keyboard.press("ArrowLeft")
    eventually(page, lambda: at_time(stage, 0.02))
    page.keyboard.press("End")
    eventually(page, lambda: at_time(stage, 20.0))


# Of everything that is on or off, chosen or not: its kind, whether it is on, and how it looks.
STATES = """() => [...document.querySelectorAll('[aria-pressed], [aria-checked], [aria-selected], input[role=switch]')]
    .filter((one) => one.checkVisibility() && !one.disabled).map((one) => {
        const { backgroundColor, borderBottomColor, color } = getComputedStyle(one)
        const on = one.matches(':checked, [aria-pressed=true], [aria-checked=true], [aria-selected=true]')
        const kind = one.getAttribute('class') ?? one.getAttribute('role')
        return [kind, on, `${backgroundColor} ${borderBottomColor} ${color}`]
    })"""


def test_forced_colours_keep_every_state(visitor: Visitor) -> None:
    page = visitor.open("#/bench?name=level-turntable-nudged", cards=False, size=LAPTOP, forced_colors="active")
    settle(page)
    come_to_rest(page)
    looks: dict[str, dict[bool, set[str]]] = {}
    for kind, on, look in page.evaluate(STATES):
        looks.setdefault(kind, {True: set(), False: set()})[on].add(look)
    both = {kind: found for kind, found in looks.items() if found[True] and found[False]}
    assert {"tool", "tab", "tr-segment", "tr-switch", "switch"} <= set(both)
    for kind, found in both.items():
        assert not found[True] & found[False], f"{kind} looks the same on and off"
    for slider in (page.locator(".controls .slider").first, page.locator(".tr-slider")):
        box = slider.bounding_box()
        assert box
        middle = {"x": box["x"] + 12, "y": box["y"] + box["height"] / 2 - 1, "width": box["width"] - 24, "height": 2}
        row = Stage(page, page).picture(middle)[0]
        assert (np.abs(row - row[-1]).sum(axis=1) == 0).mean() > 0.1, "no track right of the thumb"
        beside = Stage(page, page).picture({**middle, "y": box["y"] - 3})[0]
        assert (row[-1] != beside[-1]).any(), "the track is of the colour of the page"
    current = page.locator(".nav [aria-current]").evaluate("one => getComputedStyle(one).backgroundColor")
    other = page.locator(".nav a:not([aria-current])").first.evaluate("one => getComputedStyle(one).backgroundColor")
    assert current != other
    assert violations(page) == []


def test_forced_colours_leave_the_letters_under_accents(visitor: Visitor) -> None:
    page = visitor.open("#/tour/4", drawn=False, cards=False, size=LAPTOP, forced_colors="active")
    accents = page.locator("p .katex-accent")
    expect(accents).to_have_count(3)  # the rate of r, and the normal twice
    come_to_rest(page)
    boxes = [accents.nth(i).bounding_box() for i in range(3)]

    def ink() -> list[float]:
        pictures = [Stage(page, page).picture(box).sum(axis=2) for box in boxes]
        return [np.abs(one - np.median(one)).mean() / np.ptp(one) for one in pictures]

    forced = ink()
    page.emulate_media(forced_colors="none")
    come_to_rest(page)
    assert forced == pytest.approx(ink(), rel=0.3)


def test_the_motion_is_told_in_words_at_a_pace_that_one_can_set(visitor: Visitor) -> None:
    bench = Bench(visitor.open("#/bench?name=level-turntable-nudged", drawn=False, cards=False))
    page = bench.page
    said = page.get_by_test_id("narration")
    page.keyboard.press("End")
    run = tr.Scenario.load("level-turntable-nudged").run()
    x, y, _ = run.data.position.values[-1]
    far = f"{float(f'{100 * np.hypot(x, y):.2g}'):g} cm from the axis"
    expect(said).to_contain_text(f"20.0 s: ball {far}")
    expect(said).to_contain_text("at an even speed")
    assert said.get_attribute("aria-live") == "polite"
    pace = page.get_by_role("combobox", name="Describe the motion")
    pace.focus()
    box = pace.bounding_box()
    assert box
    assert box["width"] > 20, "the choice is seen while it has the focus"
    pace.select_option("not at all")
    expect(said).to_have_text("")
    page.locator("[data-testid=stage]").first.focus()
    page.keyboard.press("Home")
    page.wait_for_timeout(700)
    expect(said).to_have_text("")
    page.reload()
    bench.settle()
    expect(pace).to_have_value("0")
    pace.select_option("every 3 seconds")
    expect(said).to_contain_text("0.0 s: ball 20 cm from the axis")


def test_a_challenge_by_keyboard_alone(visitor: Visitor) -> None:
    page = visitor.open("#/challenges", drawn=False, cards=False)
    expect(page.locator("[data-challenge]").first).to_be_visible()
    tab_to(page, "One round in five seconds", "A")
    page.keyboard.press("Enter")
    expect(page.get_by_role("heading", level=1)).to_have_text("One round in five seconds")
    tab_to(page, "Half as long", "INPUT")
    page.keyboard.press("ArrowDown")
    expect(page.get_by_role("radio", name="Just as long")).to_be_checked()
    tab_to(page, "Rate of the table", "INPUT")
    page.keyboard.press("End")
    for _ in range(4):
        page.keyboard.press("PageDown")
    expect(page.get_by_test_id("control-rate")).not_to_have_value("78")
    tab_to(page, "Check", "BUTTON")
    page.keyboard.press("Enter")
    expect(page.get_by_test_id("result")).to_contain_text("Direction has turned by")


@pytest.mark.parametrize("route", ["#/bench", "#/compare"])
def test_less_motion_is_respected_and_else_it_plays_by_itself(route: str, visitor: Visitor) -> None:
    lively = visitor.open(route, reduced_motion="no-preference")
    settle(lively)
    eventually(lively, lambda: runs(lively))
    lively.close()  # it keeps the processor busy
    calm = visitor.open(route)
    settle(calm)
    calm.wait_for_timeout(300)
    said = calm.locator("[data-playing]").first
    assert said.get_attribute("data-playing") == "false"
    before = said.get_attribute("data-time")
    calm.wait_for_timeout(300)
    assert said.get_attribute("data-time") == before


def runs(page: Page) -> None:
    said = page.locator("[data-playing]").first
    assert said.get_attribute("data-playing") == "true"
    assert float(said.get_attribute("data-time") or 0) > 0.05


def test_once_open_it_asks_nobody_but_the_lab(visitor: Visitor) -> None:
    """A walk through all pages: everything asked for is of the lab's origin (which every other test watches, too)."""
    page = visitor.open()
    for name in ("Tour", "Holonomy", "Compare", "Crossed fields", "Bench"):
        link = page.get_by_role("link", name=name, exact=True)
        link.click()
        expect(link).to_have_attribute("aria-current", "page")
        settle(page)
    own = [address for address in visitor.watch.requests if address.startswith(visitor.lab + "/")]
    assert len(own) > 10
    assert all(
        address.startswith((visitor.lab + "/", "blob:" + visitor.lab, "data:")) for address in visitor.watch.requests
    )


def test_without_webgl_the_path_is_drawn_and_the_reason_told(visitor: Visitor, chromium: str) -> None:
    kind = visitor.browser.browser_type
    plain = kind.launch(executable_path=chromium, args=[*ARGUMENTS[2:], "--disable-3d-apis"])
    try:
        page = plain.new_page(viewport=LAPTOP)  # type: ignore[arg-type]
        page.goto(f"{visitor.lab}/#/bench?name=level-turntable-nudged")
        expect(page.get_by_text("WebGL")).to_be_visible()
        expect(page.locator(".stage svg path, .stage svg polyline").first).to_be_visible()
    finally:
        plain.close()


def test_projector_mode_has_large_type(visitor: Visitor) -> None:
    bench = Bench(visitor.open("#/bench", drawn=False))
    page = bench.page
    before = page.evaluate("parseFloat(getComputedStyle(document.body).fontSize)")
    page.keyboard.press("p")
    expect(page.get_by_role("button", name="Projector mode")).to_have_attribute("aria-pressed", "true")
    assert page.evaluate("parseFloat(getComputedStyle(document.body).fontSize)") >= 1.25 * before
    page.reload()
    expect(page.get_by_role("button", name="Projector mode")).to_have_attribute("aria-pressed", "true")


def test_a_wall_of_4k_is_filled(kept: Page) -> None:
    """Nothing must be scrolled to the side, and the stage grows with the window."""
    kept.set_viewport_size({"width": 3840, "height": 2160})
    assert kept.evaluate("document.documentElement.scrollWidth - innerWidth") <= 0
    box = kept.get_by_test_id("stage").first.bounding_box()
    kept.set_viewport_size(LAPTOP)  # type: ignore[arg-type]
    assert box is not None
    assert box["width"] > 1200
