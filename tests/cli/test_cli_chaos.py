"""`trundle chaos`: what it prints and writes, and what it refuses."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from .conftest import Command

SWING = """
title = "A ball in a bowl"
[body]
kind = "sphere"
radius = "25 mm"
mass = "65 g"
inertia_ratio = 0.4
[support]
kind = "bowl"
radius = "0.5 m"
[start]
position = ["0.1 m", "0 m"]
velocity = ["0 m/s", "0.2 m/s"]
[run]
duration = "10 s"
every = "0.1 s"
"""


@pytest.fixture(autouse=True)
def _files(folder: Path) -> None:
    (folder / "swing.toml").write_text(SWING, encoding="utf-8")


def test_it_prints_the_exponents_and_draws_how_they_converged(here: Command) -> None:
    done = here("chaos", "swing.toml", "--duration", "4 s", "--json", "--quiet")
    assert (done.status, done.err) == (0, "")
    found = json.loads(done.out)
    assert len(found["exponents"]) == found["dimension"] == 8
    assert found["passed"]
    assert "swing/lyapunov.png" in done.files


def test_it_finds_a_section_and_writes_it(here: Command) -> None:
    done = here("chaos", "swing.toml", "--section", "position.y rising through 0", "--json")
    assert (done.status, done.err) == (0, "")
    assert {"swing/section.png", "swing/section.nc"} <= set(done.files)
    assert json.loads(done.out)["located"]


def test_it_follows_a_section_along_a_number_and_draws_where_it_settles(here: Command) -> None:
    """The harder a bowl is shaken, the farther out the ball is seen, once in each period."""
    shaken = SWING.replace(
        "[start]", '[support.motion]\nkind = "shake"\namplitude = ["1 mm", 0, 0]\nrate = 10\n[start]'
    )
    Path("shaken.toml").write_text(shaken + '[[loads]]\nkind = "drag"\ncoefficient = 0.5\n')
    seen = "--observe", "position.x", "--json"
    along = "--along", "support.motion.amplitude.x", "--from", "1 mm", "--to", "3 mm", "--values", "3"
    told = here("chaos", "shaken.toml", "--strobe", "0.62831853 s", *along, "--duration", "20 s", *seen)
    found = json.loads(told.out)
    assert found["values"] == pytest.approx([1e-3, 2e-3, 3e-3])
    assert found["periods"] == {"up": [1, 1, 1], "down": [1, 1, 1]}
    ends = [abs(points[-1]) for points in found["points"]["up"]]
    assert ends == pytest.approx([ends[0], 2 * ends[0], 3 * ends[0]], rel=0.01)  # it is all but linear
    assert Path("shaken/bifurcations.png").is_file()


def test_it_finds_the_orbit_next_to_the_start(here: Command) -> None:
    done = here("chaos", "swing.toml", "--orbit", "1.7 s", "--no-figure")
    assert (done.status, done.err) == (0, "")
    assert "periodic orbit" in done.out
    assert not math.isnan(float(done.out.partition("period: ")[2].split()[0]))


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["swing.toml", "--section", "position.w rising through 0"], "position.w"),
        (["swing.toml", "--section", "land", "--strobe", "1 s"], "must not stand beside"),
        (["swing.toml", "--along", "support.tilt"], "needs --orbit"),
        (["swing.toml", "--orbit", "1 s", "--duration", "3 s"], "has no meaning"),
        (["swing.toml", "--count", "9"], "from 1 to 8"),
        (["swing.toml", "--duration", "0.01 s"], "Follow it for longer"),
        (["roll-x-then-y"], "feels no forces"),
        (["swing.toml", "--strobe", "1 s", "--along", "support.tilt", "--from", "0", "--to", "3"], "with its unit"),
    ],
)
def test_bad_input_is_refused_and_nothing_written(here: Command, arguments: list[str], said: str) -> None:
    done = here("chaos", *arguments)
    assert done.status == 2
    assert said in done.err
    assert not any(name.endswith(".png") for name in done.files)
