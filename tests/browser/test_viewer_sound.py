"""The sound of a run by its spectrum: rolling, slipping and landings, rendered by Chromium."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page
from tests.fields.systems import node

WEB = Path(__file__).parents[2] / "web"
RATE = 44_100  # Hz
BUILD = """
import { build } from 'vite'
const [entry, outDir] = process.argv.slice(1)
const lib = { entry, name: 'made', formats: ['iife'], fileName: () => 'sound.js' }
await build({ configFile: false, logLevel: 'error', build: { lib, outDir, minify: false } })
"""
# A film of balls of 10 cm; each plays from 0 on, a frame at a time, as the viewer plays it.
PLAY = """async ({runs, seconds, on, rate}) => {
    const context = new OfflineAudioContext(1, seconds * rate, rate)
    Object.defineProperty(context, 'state', {value: 'running'})
    window.AudioContext = function () { return context }
    const count = Math.round(seconds * 250) + 1
    const each = (value, side = 1) =>
        Array.from({length: count * side}, (_, i) => value(Math.floor(i / side), i % side))
    const scenes = runs.map((run) => {
        const time = each((i) => i / 250)
        const lands = run.lands ?? []
        const columns = {
            time: Float64Array.from(time),
            position: Float32Array.from(each((_, axis) => (axis === 2 ? 0.1 : 0), 3)),
            contact: new Float32Array(3 * count),
            angular_velocity: Float32Array.from(each((_, axis) => (axis === 1 ? 10 * (run.rolls ?? 0) : 0), 3)),
            velocity: Float32Array.from(each((i, axis) => {
                const up = lands.filter((land) => land.time < time[i]).reduce((sum, {speed}) => sum + speed, 0)
                return axis === 2 ? up : 0
            }, 3)),
            phase: Uint8Array.from(each(() => (run.flies ? 2 : run.slips ? 1 : 0))),
            curve_slip: Float32Array.from(each(() => run.slips ?? NaN)),
        }
        const events = lands.map(({time}) => ({time, kind: 'land', text: ''}))
        return {header: {body: {mass: 0.5}, events}, columns}
    })
    const sound = new made.Sound()
    sound.runs = scenes
    if (on) sound.on = true
    const frames = Math.floor(60 * (seconds - 0.1))
    for (let frame = 1; frame < frames; frame++) void context.suspend(frame / 60).then(() => {
        if (frame / 60 <= seconds - 0.6) sound.at(frame / 60)
        else sound.rest()
        void context.resume()
    })
    const buffer = await context.startRendering()
    return Array.from(buffer.getChannelData(0))
}"""


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory) -> str:
    if not (WEB / "node_modules" / "vite").is_dir():
        pytest.skip("the packages of web/ are not installed: python web/build.py test does it")
    folder = tmp_path_factory.mktemp("sound")
    command = [node(), "--input-type=module", "-e", BUILD, "src/viewer/sound.ts", folder]
    done = subprocess.run(command, cwd=WEB, capture_output=True, text=True, check=False)  # noqa: S603
    assert done.returncode == 0, done.stderr[-2000:]
    return (folder / "sound.js").read_text(encoding="utf-8")


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    context = browser.new_context()
    yield context.new_page()
    context.close()


def heard(page: Page, script: str, *runs: dict[str, Any], seconds: float = 2.0, on: bool = True) -> np.ndarray:
    page.add_script_tag(content=script)  # anew, with an audio context of its own
    return np.array(page.evaluate(PLAY, {"runs": runs, "seconds": seconds, "on": on, "rate": RATE}))


def between(sound: np.ndarray, begin: float, end: float) -> np.ndarray:
    return sound[round(begin * RATE) : round(end * RATE)]


def loudness(sound: np.ndarray) -> float:
    return float(np.sqrt(np.mean(sound**2)))


def pitch(sound: np.ndarray) -> float:
    """The middle of the power in the spectrum, Hz."""
    power = np.abs(np.fft.rfft(sound * np.hanning(sound.size))) ** 2
    shares = np.cumsum(power) / power.sum()
    return float(np.fft.rfftfreq(sound.size, 1 / RATE)[np.searchsorted(shares, 0.5)])


def test_rolling_is_heard_higher_and_louder_the_faster_it_is(page: Page, script: str) -> None:
    sounds = [between(heard(page, script, {"rolls": speed}), 0.4, 1.3) for speed in (0.1, 0.3, 1.0, 3.0)]
    assert all(np.diff([loudness(one) for one in sounds]) > 0)
    pitches = [pitch(one) for one in sounds]
    assert all(np.diff(pitches) > 0)
    assert pitches[-1] > 3 * pitches[0]


def test_slipping_hisses_above_rolling(page: Page, script: str) -> None:
    rolls, slips = (between(heard(page, script, run), 0.4, 1.3) for run in ({"rolls": 0.5}, {"slips": 0.5}))
    assert loudness(slips) > 0.01
    assert pitch(slips) > 4 * pitch(rolls)


def test_a_landing_knocks_once_when_it_lands(page: Page, script: str) -> None:
    sound = heard(page, script, {"flies": True, "lands": [{"time": 0.7, "speed": 2.0}]})
    assert loudness(between(sound, 0.0, 0.69)) == 0
    assert loudness(between(sound, 0.7, 0.8)) > 0.1
    assert pitch(between(sound, 0.7, 0.9)) < 450
    assert loudness(between(sound, 1.0, 2.0)) < 1e-6


@pytest.mark.parametrize("run", [{"rolls": 0.0}, {"rolls": 3.0, "flies": True}])
def test_rest_and_flight_are_silent(page: Page, script: str, run: dict[str, Any]) -> None:
    assert loudness(heard(page, script, run)) == 0


def test_a_film_that_stands_falls_silent(page: Page, script: str) -> None:
    sound = heard(page, script, {"rolls": 3.0}, {"slips": 3.0})
    assert loudness(between(sound, 0.4, 1.3)) > 0.05
    assert loudness(between(sound, 1.8, 2.0)) < 1e-3


def test_nothing_is_heard_until_it_is_asked_for(page: Page, script: str) -> None:
    assert loudness(heard(page, script, {"rolls": 3.0, "lands": [{"time": 0.7, "speed": 2.0}]}, on=False)) == 0


def test_nothing_clips_or_clicks(page: Page, script: str) -> None:
    """All at once: fast rolling and slipping, and several balls that land together, again and again."""
    lands = [{"time": 0.5 + 0.005 * i, "speed": 2.0} for i in range(40)]
    sound = heard(page, script, *[{"rolls": 50.0, "slips": 50.0, "lands": lands} for _ in range(5)])
    assert np.abs(sound).max() < 1
    start = between(heard(page, script, {"rolls": 3.0}), 0.0, 0.03)
    assert np.abs(start[:200]).max() < 0.02
