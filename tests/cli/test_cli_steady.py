"""`trundle steady`: what it prints and writes, and what it refuses."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from .conftest import Command

COIN = """
title = "A coin"
[body]
kind = "disc"
radius = "12 mm"
mass = "8 g"
[support]
kind = "plane"
[start]
position = ["0 m", "0 m"]
velocity = ["0.3 m/s", "0 m/s"]
orientation = [0.7071067811865476, 0.7071067811865476, 0, 0]
[run]
duration = "1 s"
every = "0.1 s"
"""
WAGGING = COIN + '[[loads]]\nkind = "force"\nvalue = ["0.001*sin(3*t)", "0 N", "0 N"]\n'
SLOPE = COIN.replace('kind = "plane"', 'kind = "plane"\ntilt = "3 deg"')


@pytest.fixture(autouse=True)
def _files(folder: Path) -> None:
    for name, text in (("coin", COIN), ("wagging", WAGGING), ("slope", SLOPE)):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")


def test_it_prints_the_motion_its_limit_and_draws_it(trundle: Command) -> None:
    done = trundle("steady", "coin.toml")
    assert (done.status, done.err) == (0, "")
    assert "1. rolls straight, stable to first order" in done.out
    assert "stability changes at speed 0.198057 m/s" in done.out  # sqrt(g a/3)
    assert "coin/steady.png" in done.files


def test_a_slow_coin_falls(here: Command) -> None:
    Path("slow.toml").write_text(COIN.replace("0.3 m/s", "0.1 m/s"), encoding="utf-8")
    done = here("steady", "slow.toml", "--no-figure")
    assert (done.status, done.err) == (0, "")
    assert "1. rolls straight, unstable" in done.out
    growth = math.sqrt((9.80665 / 0.012 - 3 * (0.1 / 0.012) ** 2) / 1.25)  # λ² by hand
    assert f"a nudge grows at {growth:.6g} 1/s, by e in {1 / growth:.6g} s" in done.out


def test_a_coin_that_nods_repeats(here: Command) -> None:
    nods = COIN.replace("0.7071067811865476, 0.7071067811865476", "0.76, 0.65")
    Path("nods.toml").write_text(nods, encoding="utf-8")
    done = here("steady", "nods.toml", "--periodic")
    assert (done.status, done.err) == (0, "")
    assert "periodic, neutral" in done.out
    assert "steady motion" in here("steady", "coin.toml", "--periodic").err


def test_as_json_with_a_value_held(here: Command) -> None:
    done = here(
        "steady", "coin.toml", "--hold", "lean=20 deg", "--from", "0.2 m/s", "--to", "0.4 m/s", "--json", "--no-figure"
    )
    assert done.status == 0
    found = json.loads(done.out)
    (one,) = found["steady_motions"]
    assert one["quantities"]["lean"] == pytest.approx(math.radians(20), abs=1e-12)
    assert (one["kind"], one["family"]) == ("circles", 2)
    assert found["sweep"]["along"] == "speed"
    assert "coin/steady.png" not in done.files


def test_none_is_an_answer(here: Command) -> None:
    done = here("steady", "slope.toml", "--no-figure")
    assert done.status == 0
    assert "no steady motion" in done.out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["steady", "wagging.toml"], "must look the same at all times"),
        (["steady", "roll-x-then-y"], "feels no forces"),
        (["steady", "coin.toml", "--hold", "sped"], "Did you mean 'speed'?"),
        (["steady", "coin.toml", "--hold", "lean="], "must have a value behind the ="),
        (["steady", "coin.toml", "--hold", "lean=3 kg"], "holding[lean]"),
        (["steady", "coin.toml", "--along", "rate", "--no-figure"], "support at rest"),
        (["steady", "coin.toml", "--from", "2 m/s", "--to", "1 m/s", "--no-figure"], "must be above the lowest"),
        (["steady", "coin.toml", "-o", "slope.toml"], "must be a folder"),
        (["steady", "coin.toml", "--starts", "-3"], "--starts"),
        (["steady", "ball-in-a-through"], "Did you mean 'ball-in-a-trough'?"),
    ],
)
def test_what_it_refuses(here: Command, words: list[str], said: str) -> None:
    done = here(*words)
    assert done.status == 2
    assert said in done.err
    assert "Traceback" not in done.err
    assert not {name for name in done.files if name.endswith(".png")}
