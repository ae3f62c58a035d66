"""Take a picture of every page of the lab, at three sizes, light and dark, for a person to look at.

python -m tests.browser.screenshots pictures/ [words that the name must hold, such as: phone dark tour]
"""

from __future__ import annotations

import argparse
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright
from playwright.sync_api import Error as BrowserError

from . import serving
from .launching import ARGUMENTS, NAMES

SIZES = {"phone": (390, 844), "sideways": (844, 390), "laptop": (1366, 768), "projector": (1920, 1080)}
SCHEMES = ("light", "dark")
PAGES = {
    "start": "#/",
    "challenges": "#/challenges",
    "challenge": "#/challenges/which-is-hollow",
    "report": "#/report",
    "notes": "#/notes",
    "bench": "#/bench",
    "bench-bowl": "#/bench?name=ball-in-a-turning-bowl",
    "bench-coin": "#/bench?name=coin-in-a-circle",
    **{f"tour-{step}": f"#/tour/{step}" for step in range(1, 8)},
    "holonomy-hand": "#/holonomy",
    "holonomy-orders": "#/holonomy/orders",
    "holonomy-loop": "#/holonomy/loop",
    "compare": "#/compare",
    "fields": "#/fields",
    "measure": "#/measure?example=ball-on-a-ramp",
    "maps": "#/maps?at=12,9&name=shaken-bowl",
}


def press(name: str) -> Callable[[Page], None]:
    return lambda page: page.get_by_role("button", name=name, exact=True).first.click()


def tab(name: str) -> Callable[[Page], None]:
    return lambda page: page.get_by_role("tab", name=name).click()


# What opens on the bench, and how.
OPENED: dict[str, Callable[[Page], None]] = {
    "bench-numbers": tab("Numbers"),
    "bench-curves": tab("Curves"),
    "bench-card": tab("Card"),
    "bench-scenarios": lambda page: page.keyboard.press("/"),
    "bench-help": press("Help"),
    "bench-downloads": press("Download"),
    "bench-derivation": lambda page: (tab("Numbers")(page), press("How does this follow?")(page))[0],
}
# Of the size of a window, and at its calm state.
SETTLE, OPENING = 3500, 2500  # ms


def names(words: list[str]) -> Iterator[tuple[str, str, str]]:
    """Yield the page, the size and the scheme of each picture asked for."""
    for size in SIZES:
        for scheme in SCHEMES:
            for page in (*PAGES, *OPENED):
                if all(word in f"{page} {size} {scheme}" for word in words):
                    yield page, size, scheme


def picture(browser: Browser, origin: str, name: tuple[str, str, str], folder: Path) -> Path:
    """Take one picture; the page at its full height as well, where that is more than the window's."""
    shown, size, scheme = name
    width, height = SIZES[size]
    context = browser.new_context(
        viewport={"width": width, "height": height}, color_scheme="dark" if scheme == "dark" else "light"
    )
    if size == "projector":
        context.add_init_script("localStorage.setItem('trundle.lab', JSON.stringify({projector: true}))")
    page = context.new_page()
    try:
        page.goto(f"{origin}/{PAGES.get(shown, '#/bench')}")
        page.wait_for_timeout(SETTLE)
        if shown in OPENED:
            OPENED[shown](page)
            page.wait_for_timeout(OPENING)
        path = folder / f"{shown}-{size}-{scheme}.png"
        page.screenshot(path=path)
        if page.evaluate("document.documentElement.scrollHeight > 1.05 * innerHeight"):
            page.screenshot(path=path.with_stem(path.stem + "-whole"), full_page=True)
        return path
    finally:
        context.close()


def main() -> None:
    parser = argparse.ArgumentParser(description="Pictures of every page of the lab.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("words", nargs="*", help="only pictures whose page, size and scheme hold all of these")
    asked = parser.parse_args()
    asked.folder.mkdir(parents=True, exist_ok=True)
    program = os.environ.get("TRUNDLE_CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)
    with tempfile.TemporaryDirectory() as logs, serving.lab(Path(logs)) as origin, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=ARGUMENTS)
        for name in names(asked.words):
            try:
                print(picture(browser, origin, name, asked.folder), flush=True)
            except BrowserError as error:
                print(f"{' '.join(name)}: {error.message.splitlines()[0]}", flush=True)
        browser.close()


if __name__ == "__main__":
    main()
