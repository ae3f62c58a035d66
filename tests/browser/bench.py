"""The bench as a person sees it: the stage, the controls, the numbers, and the scenario that the address holds."""

from __future__ import annotations

import base64
import json
import re
import time
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from io import BytesIO
from typing import Any, TypeVar
from urllib.parse import parse_qs, urlsplit

import numpy as np
from PIL import Image
from playwright.sync_api import Locator, Page, expect

import trundle as tr
from trundle.lab.links import encode

PATIENCE = 20.0  # s
T = TypeVar("T")


def eventually(page: Page, check: Callable[[], T], patience: float = PATIENCE) -> T:
    """Try a check until it holds; what it says at last is what is wrong."""
    until = time.monotonic() + patience
    while True:
        try:
            return check()
        except AssertionError:
            if time.monotonic() > until:
                raise
        page.wait_for_timeout(50)


def number(text: str) -> float:
    """Read a number as the lab writes it: "−1.07", "2.3 × 10⁻⁵"."""
    plain = text.translate(str.maketrans("−⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "--0123456789"))
    found = re.match(r"\s*(-?[\d.]+)(?:\s*×\s*10(-?\d+))?", plain)
    assert found, f"no number in {text!r}"
    return float(found[1]) * 10.0 ** int(found[2] or 0)


def as_shown(value: float) -> Any:
    """A number that is shown with four digits."""
    import pytest

    return pytest.approx(value, rel=6e-4, abs=1e-12)


def decoded(code: str) -> dict[str, Any]:
    """The scenario that a link holds."""
    padded = code + "=" * (-len(code) % 4)
    return json.loads(zlib.decompress(base64.urlsafe_b64decode(padded), wbits=-15))


def linked(scenario: dict[str, Any]) -> str:
    """The link to a scenario, made without the page."""
    return f"#/bench?s={encode(scenario)}"


def colours(picture: np.ndarray) -> int:
    """How many colours there are in a picture."""
    return len(np.unique(picture @ (1, 256, 65536)))


@dataclass(frozen=True)
class Drawn:
    """What the viewer says that it draws."""

    time: float
    playing: bool
    frame: str
    place: tuple[float, float, float]


@dataclass(frozen=True)
class Stage:
    """The first stage of a page, or one inside something."""

    page: Page
    within: Locator | Page

    @property
    def canvas(self) -> Locator:
        return self.within.get_by_test_id("stage").first

    @property
    def host(self) -> Locator:
        return self.within.locator("[data-time]").first

    def drawn(self) -> Drawn:
        said = self.host.evaluate("element => ({...element.dataset})")
        place = tuple(float(said.get(axis, "nan")) for axis in "xyz")
        return Drawn(float(said["time"]), said.get("playing") == "true", said.get("frame", ""), place)  # type: ignore[arg-type]

    def middle(self) -> np.ndarray:
        """The middle of the picture, where nothing is written over it; height, width, colour."""
        box = self.canvas.bounding_box()
        assert box, "the canvas is not shown"
        clip = {
            "x": box["x"] + 0.2 * box["width"],
            "y": box["y"] + 0.2 * box["height"],
            "width": 0.6 * box["width"],
            "height": 0.55 * box["height"],
        }
        return self.picture(clip)

    def picture(self, clip: Any) -> np.ndarray:
        """What is seen in a part of the page; height, width, colour."""
        # The caret as it is: to hide it, Playwright would have every element's style computed anew.
        shot = self.page.screenshot(clip=clip, caret="initial")
        return np.asarray(Image.open(BytesIO(shot)).convert("RGB"), dtype=int)

    def sharpness(self) -> str:
        """With which share of its pixels the picture is drawn: what changes may be drawn with fewer."""
        return self.host.get_attribute("data-sharp") or ""

    def two_frames(self) -> None:
        """Wait until what was asked for is drawn."""
        self.page.evaluate("() => new Promise(frame => requestAnimationFrame(() => requestAnimationFrame(frame)))")

    def seen_after(self, key: str) -> tuple[np.ndarray, str]:
        """The middle of the picture that a key leads to, and how sharp it is drawn."""
        self.page.keyboard.press(key)
        self.two_frames()
        sharp = self.sharpness()
        picture = self.middle()
        return picture, sharp if self.sharpness() == sharp else "both"

    def ball(self) -> tuple[float, float]:
        """Where the first body is on the screen: found as an eye finds it, by its blue stripes."""
        box = self.canvas.bounding_box()
        assert box, "the canvas is not shown"
        top = 70.0  # the tools stand above
        clip = {"x": box["x"], "y": box["y"] + top, "width": box["width"], "height": box["height"] - top}
        picture = self.picture(clip)
        red, green, blue = (picture[:, :, channel] for channel in range(3))
        y, x = np.nonzero((blue > red + 60) & (blue > green + 25))
        assert len(x) > 30, "no ball is seen"
        return clip["x"] + float(np.median(x)), clip["y"] + float(np.median(y))

    def drag(self, by: tuple[float, float]) -> None:
        """Drag from the ball by so many pixels."""
        x, y = self.ball()
        mouse = self.page.mouse
        mouse.move(x, y)
        mouse.down()
        for share in (0.25, 0.5, 0.75, 1.0):
            mouse.move(x + share * by[0], y + share * by[1])
            self.page.wait_for_timeout(30)
        mouse.up()


class Bench:
    """A page that shows the bench."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.stage = Stage(page, page)
        self.settle()

    def settle(self) -> None:
        """Wait until something is drawn, and nothing is being computed."""
        # `wait_for` looks again sooner than `expect` does, which comes to seconds over all tests.
        self.stage.canvas.wait_for()
        self.page.locator('[data-bodies]:not([data-bodies="0"])').first.wait_for(state="attached")
        self.page.locator("section.stage[data-busy]").wait_for(state="detached")

    def open(self, route: str) -> None:
        self.page.evaluate("route => { location.hash = route }", route)
        self.settle()

    def tool(self, name: str) -> None:
        """Choose what the pointer does on the stage."""
        button = self.page.get_by_role("radio", name=name)
        button.click()
        expect(button).to_be_checked()

    def play_past(self, seconds: float) -> Drawn:
        """Play until so much of the run has passed, and pause; what is drawn then."""
        self.page.keyboard.press("Space")

        def passed() -> None:
            assert self.stage.drawn().time > seconds

        def stands() -> None:
            assert not self.stage.drawn().playing

        eventually(self.page, passed)
        self.page.keyboard.press("Space")
        eventually(self.page, stands)
        return self.stage.drawn()

    def control(self, path: str) -> Locator:
        """The control of a key of the scenario: "support.tilt"."""
        return self.page.locator(f'.controls [data-path="{path}"]')

    def box(self, path: str) -> Locator:
        return self.control(path).get_by_role("textbox")

    def slider(self, path: str) -> Locator:
        return self.control(path).get_by_role("slider")

    def slide(self, path: str, share: float) -> None:
        """Drag a slider with the mouse to a share of its length."""
        slider = self.slider(path)
        slider.scroll_into_view_if_needed()
        box = slider.bounding_box()
        assert box, f"no slider for {path}"
        place = (float(slider.input_value()) / 1000) * (box["width"] - 16) + 8
        y = box["y"] + box["height"] / 2
        mouse = self.page.mouse
        mouse.move(box["x"] + place, y)
        mouse.down()
        for part in (0.3, 0.7, 1.0):
            mouse.move(box["x"] + place + part * (share * box["width"] - place), y)
            self.page.wait_for_timeout(60)
        mouse.up()

    def scenario(self) -> dict[str, Any]:
        """The scenario that the address holds now."""
        asked = parse_qs(urlsplit(urlsplit(self.page.url).fragment).query)
        if "name" in asked:
            import tomllib

            from trundle.scenario import files

            return tomllib.loads(files.read(asked["name"][0]))
        assert "s" in asked, f"the address holds no scenario: {self.page.url}"
        return decoded(asked["s"][0])

    def run(self) -> tr.Trajectory:
        return tr.Scenario.read(self.scenario()).run()

    def tab(self, name: str) -> None:
        self.page.get_by_role("tab", name=name).click()

    def row(self, symbol: str) -> Locator:
        """The line of a finding, by its symbol in LaTeX."""
        mark = self.page.locator("annotation").get_by_text(symbol, exact=True)
        return self.page.locator("tr").filter(has=mark)

    def found(self, symbol: str) -> tuple[float, float]:
        """What is predicted and what is measured of a finding."""
        cells = self.row(symbol).get_by_role("cell")
        return number(cells.nth(0).inner_text()), number(cells.nth(1).inner_text())


def circle_rate(run: tr.Trajectory) -> float:
    """By how much the direction of motion turns a second, rad/s, on a level table."""
    x, y = (run.data.velocity.sel(axis=axis).values for axis in "xy")
    heading = np.unwrap(np.arctan2(y, x))
    return float((heading[-1] - heading[0]) / (run.data.time.values[-1] - run.data.time.values[0]))


def drift(run: tr.Trajectory) -> float:
    """How fast the circle's centre goes across the slope, m/s: between the first instant and a whole circle later."""
    data = run.data
    x, y = (data.velocity.sel(axis=axis).values for axis in "xy")
    times = data.time.values
    ax, ay = np.gradient(x, times, edge_order=2), np.gradient(y, times, edge_order=2)
    heading = np.unwrap(np.arctan2(ay, ax))  # the acceleration goes round once a circle, whatever the drift
    turned = np.abs(heading - heading[0])
    whole = 2 * np.pi * np.floor(turned[-1] / (2 * np.pi))
    assert whole > 0, "not one whole circle"
    end = float(np.interp(whole, turned, times))
    way = [float(np.interp(end, times, data.position.sel(axis=axis).values)) for axis in "xy"]
    start = [float(data.position.sel(axis=axis).values[0]) for axis in "xy"]
    return float(np.hypot(way[0] - start[0], way[1] - start[1]) / end)
