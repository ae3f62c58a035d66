"""`trundle sensitivity --by`: what it prints and writes, and what it refuses."""

from __future__ import annotations

import json

import pytest

from .conftest import Command


def test_it_prints_the_derivatives_and_writes_them(trundle: Command) -> None:
    done = trundle("sensitivity", "off-the-rim", "--by", "support.tilt", "--by", "start.position")
    assert (done.status, done.err) == (0, "")
    lines = done.out.splitlines()
    assert "agrees with differences of runs" in lines[1]
    assert [line.split()[0] for line in lines[3:6]] == ["support.tilt", "start.position[0]", "start.position[1]"]
    assert lines[6].startswith("rim at t = ")
    folder = "off-the-rim"
    assert done.files == {folder, f"{folder}/sensitivities.nc", f"{folder}/sensitivities.png"}


def test_as_json_and_without_a_figure(here: Command) -> None:
    done = here(
        "sensitivity", "level-turntable-nudged", "--by", "start.velocity", "--horizon", "1 s", "--json", "--no-figure"
    )
    found = json.loads(done.out)
    assert done.status == 0
    assert done.files == {"level-turntable-nudged", "level-turntable-nudged/sensitivities.nc"}
    assert [one["name"] for one in found["parameters"]] == ["start.velocity[0]", "start.velocity[1]"]
    assert found["time"] == 1.0
    assert found["passed"] is True


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--by", "support.tild"], "Did you mean 'support.tilt'?"),
        (["--by", "start.spin"], "`--by`"),
        (["--by", "support.tilt", "--tilt", "1 deg"], "`--tilt` must not stand beside --by"),
        (["--by", "support.tilt", "--horizon", "soon"], "`--horizon`"),
    ],
)
def test_what_it_cannot_do_is_refused(here: Command, arguments: list[str], said: str) -> None:
    done = here("sensitivity", "tilted-turntable", *arguments)
    assert (done.status, done.out, done.files) == (2, "", set())
    assert said in done.err
