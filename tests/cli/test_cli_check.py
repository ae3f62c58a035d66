"""`trundle check`: what it prints, writes and leaves with."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from .conftest import Command

NUDGED = ("--scenario", "level-turntable-nudged")


def write(folder: Path, share: float = 2 / 7, headings: str = "t,x,y", name: str = "theirs.csv") -> None:
    """Write the circle of a ball on the shipped turntable, from 20 cm out with 0.1 m/s, at a share of its rate."""
    kappa = share * 33.3 * np.pi / 30
    t = np.arange(0.0, 4.0, 0.01)
    place = 0.2 - 0.1 / kappa * (1 - np.exp(1j * kappa * t))
    rows = np.column_stack([t, place.real, place.imag])
    np.savetxt(folder / name, rows, header=headings, comments="", delimiter=",")


def test_a_right_circle_holds(here: Command, folder: Path) -> None:
    write(folder)
    done = here("check", "theirs.csv", *NUDGED)
    assert (done.status, done.err) == (0, "")
    assert "every check held" in done.out
    assert done.files == {"theirs.csv", "theirs", "theirs/check.png"}
    assert (folder / "theirs/check.png").read_bytes().startswith(b"\x89PNG")


def test_a_wrong_one_leaves_with_3_and_names_the_mistake(here: Command, folder: Path) -> None:
    write(folder, share=2 / 5)
    done = here("check", "theirs.csv", *NUDGED, "-o", "out")
    assert done.status == 3
    assert "k = 0.666667 fits (a thin shell has 2/3), for 0.4" in done.out
    assert "first goes wrong at t = 0 s" in done.out
    assert done.err.startswith("trundle: it does not hold: law of motion, acceleration")
    assert "out/check.png" in done.files


def test_data_that_cannot_decide_leave_with_4(here: Command, folder: Path) -> None:
    noise = np.random.default_rng(1).normal(scale=0.05, size=(200, 2))
    rows = np.column_stack([np.arange(200) / 60, noise])
    np.savetxt(folder / "theirs.csv", rows, header="t,x,y", comments="", delimiter=",")
    done = here("check", "theirs.csv", *NUDGED)
    assert (done.status, done.err) == (4, "trundle: these data cannot decide\n")
    assert "every check held" not in done.out
    assert "They would look the same with" in done.out
    assert "theirs/check.png" in done.files
    told = json.loads(here("check", "theirs.csv", *NUDGED, "--json", "--no-figure").out)
    assert (told["passed"], told["answer"], bool(told["could_not_show"])) == (False, "cannot decide", True)


def test_the_help_says_what_each_status_means(here: Command) -> None:
    assert "4, these data cannot decide" in " ".join(here("check", "--help").out.split())


def test_json_and_nothing_else(here: Command, folder: Path) -> None:
    write(folder, share=2 / 5)
    done = here("check", "theirs.csv", *NUDGED, "--json", "--no-figure")
    found = json.loads(done.out)
    assert (done.status, found["passed"], found["first_failure"]) == (3, False, 0.0)
    assert found["likely"][0]["name"] == "wrong-inertia-ratio"
    assert done.files == {"theirs.csv"}


def test_columns_and_units(here: Command, folder: Path) -> None:
    write(folder, headings="frame,u,v")
    done = here("check", "theirs.csv", *NUDGED, "--no-figure", "-q", "--columns", "t=frame, x=u, y=v")
    assert (done.status, done.out, done.err) == (0, "", "")
    write(folder, headings="t,x [mm],y [mm]")
    done = here("check", "theirs.csv", *NUDGED, "--no-figure")
    assert done.status == 0  # a circle a thousand times smaller is as good a one
    assert "start, from that of the scenario          0.1998 m" in done.out


def test_a_run_of_our_own_brings_its_scenario(here: Command) -> None:
    assert here("run", "level-turntable-nudged", "-q", "--no-figure").status == 0
    done = here("check", "level-turntable-nudged/run.nc", "--no-figure")
    assert done.status == 0, done.err
    assert "their position, velocity, Ω and orientation" in done.out


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["check", "none.csv", *NUDGED], "`file` must exist"),
        (["check", "theirs.csv"], "`--scenario` must say what moves"),
        (["check", "theirs.csv", "-s", "level-turntable"], "level-turntable"),
        (["check", "theirs.csv", *NUDGED, "--columns", "t"], "`--columns` must be pairs"),
        (["check", "theirs.csv", *NUDGED, "--columns", "q=x"], "unknown column of trundle's 'q'"),
        (["check", "theirs.csv", *NUDGED, "--axes", "bodies"], "Did you mean 'body'?"),
        (["check", "theirs.csv", *NUDGED, "--tolerance", "-1"], "`tolerance` must be a share"),
    ],
)
def test_bad_input_leaves_with_2_and_one_message(here: Command, folder: Path, words: list[str], says: str) -> None:
    write(folder)
    done = here(*words)
    assert done.status == 2
    assert says in done.err
    assert done.files == {"theirs.csv"}
