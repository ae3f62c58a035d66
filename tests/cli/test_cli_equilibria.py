"""`trundle equilibria`: what it prints and writes, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from .conftest import Command

TURNING = """
[body]
kind = "solid-sphere"
radius = "25 mm"
mass = "65 g"
[support]
kind = "plane"
[support.motion]
kind = "spin"
rate = "33.3 rpm"
[start]
position = ["0 m", "0 m"]
[run]
duration = "1 s"
every = "0.1 s"
"""


def test_it_prints_the_places_and_draws_them(trundle: Command) -> None:
    done = trundle("equilibria", "weighted-cylinder-on-incline")
    assert (done.status, done.err) == (0, "")
    lines = [line.strip() for line in done.out.splitlines()]
    assert lines[:2] == ["Weighted cylinder that stays on an incline", "2 equilibria"]
    assert {"1. stable", "2. unstable"} < set(lines)
    assert done.files == {"weighted-cylinder-on-incline", "weighted-cylinder-on-incline/equilibria.png"}


def test_as_json(here: Command) -> None:
    done = here("equilibria", "ball-in-a-trough", "--json", "--no-figure")
    found = json.loads(done.out)
    assert (done.status, done.files) == (0, set())
    assert [one["stability"] for one in found["equilibria"]] == ["stable"]
    assert found["equilibria"][0]["modes"][0]["frequency"] == pytest.approx((9.80665 / 0.14) ** 0.5, rel=1e-12)
    assert len(found["would_need_pull"]) == 1


def test_none_is_an_answer(here: Command) -> None:
    done = here("equilibria", "weighted-cylinder-too-steep", "--no-figure")
    assert done.status == 0
    assert "no equilibrium" in done.out
    assert "0.8156 N" in done.out  # 0.4 kg g sin(12°)


def test_friction_that_is_too_little_is_said(here: Command) -> None:
    text = here("show", "weighted-cylinder-on-incline").out.replace("friction = 0.3", "friction = 0.05")
    Path("mine.toml").write_text(text, encoding="utf-8")
    assert "the support has 0.05: it SLIPS" in here("equilibria", "mine.toml", "--no-figure").out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["equilibria", "turning.toml"], "must be at rest for equilibria"),
        (["equilibria", "roll-x-then-y"], "feels no forces"),
        (["equilibria", "ball-in-a-trough", "--turns", "3"], "belongs to a cylinder"),
        (["equilibria", "weighted-cylinder-on-incline", "--turns", "few"], "turns"),
        (["equilibria", "ball-in-a-through"], "Did you mean 'ball-in-a-trough'?"),
        (["equilibria", "ball-in-a-trough", "-o", "turning.toml"], "must be a folder"),
    ],
)
def test_what_it_refuses(here: Command, words: list[str], said: str) -> None:
    Path("turning.toml").write_text(TURNING, encoding="utf-8")
    done = here(*words)
    assert done.status == 2
    assert said in done.err
    assert done.err.count("\n") == 1
    assert done.files == {"turning.toml"}


def test_where_nothing_presses_the_body_on_only_the_places_are_printed(trundle: Command) -> None:
    """A weight that its own potential carries beside an upright wall: a first step was tried beyond all floats."""
    Path("carried.toml").write_text("""
loads = [{ kind = "potential", formula = "10*z**2" }]
body = { kind = "solid-sphere", radius = 0.05, mass = 1.7 }
support = { kind = "cylinder", radius = 0.28, friction = 0.5 }
start = { position = [0.0, 0.004] }
run = { duration = 0.1, every = 0.01 }
""")
    done = trundle("equilibria", "carried.toml")
    assert (done.status, done.err) == (0, "")
    assert "contact force N = 0 N, f = 0 N" in done.out
