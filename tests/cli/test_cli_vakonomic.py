"""`trundle vakonomic`: what it prints and writes, and what it refuses."""

from __future__ import annotations

import json

import pytest

from .conftest import Command


def test_it_says_that_it_is_wrong_and_draws_it(trundle: Command) -> None:
    done = trundle("vakonomic", "level-turntable-nudged")
    assert (done.status, done.err) == (0, "")
    assert "It is wrong: no ball moves so." in done.out
    assert "The ball runs a circle of radius 10.04 cm." in done.out
    assert done.files == {"level-turntable-nudged", "level-turntable-nudged/vakonomic.png"}


def test_as_json(here: Command) -> None:
    done = here("vakonomic", "tilted-turntable", "--multipliers", "0.1", "-0.2", "--json", "--no-figure")
    found = json.loads(done.out)
    assert (done.status, done.files) == (0, set())
    assert found["multipliers"] == [0.1, -0.2]
    assert "wrong" in found["warning"]
    assert found["rows"][-1]["apart"] > 0.1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["vakonomic", "roll-x-then-y"], "feels no forces"),
        (["vakonomic", "level-turntable-nudgd"], "Did you mean 'level-turntable-nudged'?"),
        (["vakonomic", "level-turntable-nudged", "--duration", "0 s"], "duration"),
        (["vakonomic", "level-turntable-nudged", "--multipliers", "nan", "0"], "multipliers"),
    ],
)
def test_what_it_refuses(here: Command, words: list[str], said: str) -> None:
    done = here(*words)
    assert (done.status, done.files) == (2, set())
    assert said in done.err
    assert done.err.count("\n") == 1


def test_it_says_what_it_is_not_for(here: Command) -> None:
    done = here("vakonomic", "loop-the-loop")
    assert (done.status, done.files) == (1, set())
    assert "the surface is no plane" in done.err
