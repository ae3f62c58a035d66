"""`trundle derive`, as a user types it."""

from __future__ import annotations

import json

import pytest
from tests.cli.conftest import Command


def test_without_a_name_it_lists_topics_and_scenarios(here: Command) -> None:
    shown = here("derive")
    assert shown.status == 0
    names = [line.split()[0] for line in shown.out.splitlines()]
    assert names[0] == "ball-on-plane"
    assert {"turntable", "tilted-turntable", "cylinder-in-cylinder", "off-the-rim"} <= set(names)
    assert "roll-home-turned" not in names  # no forces, nothing to derive


def test_the_derivation_on_screen(here: Command) -> None:
    shown = here("derive", "turntable")
    assert (shown.status, shown.err) == (0, "")
    assert shown.out.startswith("Ball on a level turntable\n")
    assert "V - a⋅Ω×n̂ = ω⋅n̂×r" in shown.out
    assert "is exactly 0." in shown.out


def test_each_form_in_a_file(here: Command) -> None:
    for option, sign in (("--latex", r"\section*{"), ("--markdown", "# Ball on"), ("--json", '{\n  "name"')):
        done = here("derive", "ball-on-plane", option, "-o", "derived.txt")
        assert done.status == 0
        assert done.out == "Wrote derived.txt\n"
        assert "derived.txt" in done.files
        shown = here("derive", "ball-on-plane", option)
        assert sign in shown.out


def test_json_is_json(here: Command) -> None:
    shown = json.loads(here("derive", "level-turntable-nudged", "--json", "--with-numbers").out)
    assert shown["title"] == "Steel ball nudged on a level turntable"
    kappa = next(number["value"] for number in shown["numbers"] if number["text"] == "κ")
    assert kappa == pytest.approx(2 / 7 * 33.3 * 2 * 3.141592653589793 / 60, rel=1e-14)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("turntabel",), "Did you mean 'turntable'?"),
        (("turntable", "--latex", "--markdown"), "must stand alone"),
        (("ball-on-plane", "--with-numbers"), "needs a scenario"),
        (("roll-home-turned",), "must have a body that forces act on"),
        (("turntable", "-o", "."), "must be a file"),
    ],
)
def test_bad_input_is_one_message_and_status_2(here: Command, words: tuple[str, ...], said: str) -> None:
    refused = here("derive", *words)
    assert refused.status == 2
    assert refused.out == ""
    assert said in refused.err
    assert refused.err.count("\n") == 1
    assert not refused.files
