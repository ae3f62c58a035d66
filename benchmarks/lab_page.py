"""The lab's page: how soon a change is seen, and what a picture costs while it plays."""

from __future__ import annotations

import shutil
import statistics
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from lab_load import served
from measure import BrokenBenchmarkError, Row, check, seconds

CLOSED, NUMERICAL = 0.1, 0.3  # s from a change to its picture
FRAME = 1 / 60  # s
ROUNDS, CHANGES, PAUSE = 2, 13, 80  # changes of a number that is dragged, in each round, and ms between them
PLAYING = 5.0  # s
SETTLING = 8.0  # s, in which the server's workers load what they need
POINTS = 10_000

TITLE = "The lab's page: from a change to its picture, while a number is dragged; and playing a path of 10 000 points"


class Drag(NamedTuple):
    """A number that is dragged, from which of its slider's thousand steps on, and within what its pictures come."""

    name: str
    path: str
    most: float
    first: int = 300


# A light rattleback rocks more slowly: the steps taken are those about its own mass. The ball that bounces does so 38
# times, each of them a closed form. Chaplygin's ball has one while its momentum is upright, which another mass ends.
DRAGS = (
    Drag("level-turntable-nudged", "support.motion.rate", CLOSED),
    Drag("tilted-turntable", "support.tilt", CLOSED),
    Drag("ball-in-a-trough", "body.radius", CLOSED),
    Drag("free-turntable-ellipse", "support.motion.rate", CLOSED),
    Drag("turntable-starting-up", "body.radius", CLOSED),
    Drag("chaplygin-ball", "gravity", CLOSED),
    Drag("incline-with-slip", "support.tilt", CLOSED),
    Drag("bouncing-ball-with-backspin", "body.radius", CLOSED),
    Drag("chaplygin-ball", "body.mass", NUMERICAL),
    Drag("ball-in-a-turning-bowl", "support.motion.rate", NUMERICAL),
    Drag("turntable-drop", "support.motion.rate", NUMERICAL),
    Drag("rattleback", "body.mass", NUMERICAL, 640),
)
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
# The processor draws the stage, and the rest of the page by the quicker way for one; no name is resolved.
SOFTWARE = (
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-rasterization",
    "--disable-gpu-compositing",
    "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1",
)

# Every drawing call is counted, and carried out only where the pixels are to be filled; a picture is there when the
# graphics processor, or who stands in for it, has finished it.
WATCH = """
window.calls = 0; window.corners = 0; window.drawn = null
const gl = WebGL2RenderingContext.prototype, pixel = new Uint8Array(4)
for (const way of ['drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced']) {
    const draw = gl[way]
    gl[way] = function (...given) {
        window.calls += 1
        window.corners += (way.startsWith('drawArrays') ? given[2] : given[1]) * (given[4] ?? 1)
        if (%(filled)s) draw.apply(this, given)
        const told = window.drawn
        window.drawn = null
        if (told) queueMicrotask(() => { this.readPixels(0, 0, 1, 1, this.RGBA, this.UNSIGNED_BYTE, pixel); told() })
    }
}
const ask = window.requestAnimationFrame
window.busy = 0
window.requestAnimationFrame = (step) => ask((now) => {
    const begun = performance.now()
    step(now)
    window.busy += performance.now() - begun
})
"""
CHANGE = """async ([path, to]) => {
    const slider = document.querySelector(`.controls [data-path="${path}"] input[type=range]`)
    const begun = performance.now()
    const seen = new Promise((told, not) => {
        window.drawn = told
        setTimeout(() => not(new Error('nothing was drawn')), 10000)
    })
    slider.value = String(to)
    slider.dispatchEvent(new Event('input', {bubbles: true}))
    await seen
    return (performance.now() - begun) / 1000
}"""
PLAY = """async (seconds) => {
    const before = [window.busy, window.calls, window.corners]
    const begun = performance.now()
    let frames = 0
    await new Promise((ended) => {
        const next = () => { frames += 1; performance.now() - begun < 1000 * seconds ? setTimeout(ask) : ended() }
        const ask = () => requestAnimationFrame(next)
        ask()
    })
    const taken = (performance.now() - begun) / 1000
    return [frames / taken, (window.busy - before[0]) / 1000 / frames, (window.calls - before[1]) / frames,
        (window.corners - before[2]) / frames]
}"""


def rows() -> Iterator[Row]:
    """Drag a number of each scenario, then play."""
    with served() as (_, port), browser() as launched:
        time.sleep(SETTLING)
        # A machine's speed changes for seconds at a time: all are asked before any is asked again.
        each = [(drag, filled) for drag in DRAGS for filled in (True, False)]
        rounds = [{which: _dragged(launched, port, *which, turn) for which in each} for turn in range(ROUNDS)]
        best = min(loop for one in rounds for pairs in one.values() for loop, _ in pairs)
        for drag, filled in each:
            pairs = [pair for one in rounds for pair in one[drag, filled]]
            times = sorted(time for _, time in pairs)
            speed = best / statistics.median(loop for loop, _ in pairs)
            what = f"{drag.name}, {drag.path}: 9 of 10 within" if filled else "  with no pixel filled"
            raw = f"half within {seconds(statistics.median(times))}; the machine at {speed:.2f} of its best"
            most = drag.most if filled else None
            yield Row(what, times[int(0.9 * len(times))], most=most, raw=raw, kind="time")
        yield from _played(launched, port)


def _dragged(launched: Any, port: int, drag: Drag, filled: bool, turn: int) -> list[tuple[float, float]]:
    """Of each change the time of a loop just before, which tells how fast the machine is then, and its own, s."""
    page = opened(launched, port, drag.name, filled)
    # What was asked for before would come from the cache.
    first = drag.first + (0 if filled else 4) + 9 * turn * CHANGES
    pairs = [(_loop(), page.evaluate(CHANGE, [drag.path, first + 9 * i])) for i in paused(page, CHANGES)]
    page.context.close()
    return pairs


def _loop() -> float:
    begun, total = time.perf_counter(), 0
    for i in range(50_000):
        total += i * i % 7
    return time.perf_counter() - begun


def _played(launched: Any, port: int) -> Iterator[Row]:
    page = opened(launched, port, "level-turntable-nudged", filled=False)
    box = page.locator('.controls [data-path="run.every"] input:not([type=range])').first
    box.fill(f"{20 / POINTS * 1000:g} ms")
    box.press("Enter")
    page.wait_for_timeout(3000)
    page.get_by_role("button", name="Play (space)").first.click()
    page.wait_for_timeout(500)
    rate, busy, calls, corners = page.evaluate(PLAY, PLAYING)
    check(page.locator("[data-playing=true]").count() == 1 and calls > 1, "the run must play")
    page.context.close()
    raw = f"{calls:.0f} drawing calls with {corners:.0f} corners a frame"
    yield Row("playing: frames a second, no pixel filled", rate, least=0.95 / FRAME, raw=raw, kind="count")
    yield Row("  of the page's own work in a frame", busy, most=0.5 * FRAME, kind="time")


@contextmanager
def browser() -> Iterator[Any]:
    """A browser without windows, in which the processor draws."""
    from playwright.sync_api import sync_playwright

    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    if program is None:
        raise BrokenBenchmarkError("there is no Chromium here")
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=program, args=SOFTWARE)
        yield launched
        launched.close()


def opened(launched: Any, port: int, name: str, filled: bool) -> Any:
    """A page of the bench, at rest."""
    page = launched.new_page(viewport={"width": 1366, "height": 768}, reduced_motion="reduce")
    page.add_init_script(WATCH % {"filled": str(filled).lower()})
    page.goto(f"http://127.0.0.1:{port}/#/bench?name={name}")
    page.locator("section.stage[data-shown]").wait_for()
    page.wait_for_timeout(4000)
    return page


def paused(page: Any, count: int) -> Iterator[int]:
    """Count, with pauses as between two movements of a hand."""
    for i in range(count):
        yield i
        page.wait_for_timeout(PAUSE)
