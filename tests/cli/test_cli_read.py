"""`trundle read`: what it says, asks and draws."""

from __future__ import annotations

from pathlib import Path

import pytest

from .conftest import Command

TEXT = "\tmass A\t\t\nt\tu\tv\n0,00\t10,0\t0,0\n0,04\t10,2\t0,5\n0,08\tlost\t\n0,12\t10,5\t1,6\n"


def test_it_says_what_was_taken_and_what_was_left_out(here: Command, folder: Path) -> None:
    (folder / "track.txt").write_text(TEXT)
    done = here("read", "track.txt", "--columns", "x=u, y=v", "--unit", "cm", "--figure", "track.png")
    assert (done.status, done.err) == (0, "")
    assert "t from column `t`, x from `u`, y from `v` in cm, 3 rows, 1 gap (1 frame), 25 frames a second" in done.out
    assert "1 row was left out: line 5 (`u` must hold numbers: 'lost')." in done.out
    assert done.out.endswith("Wrote track.png\n")
    assert (folder / "track.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["read", "none.txt"], "`file` must exist"),
        (["read", "track.txt", "--columns", "x=u, y=v"], "Give units='cm' (`--unit cm`)"),
        (["read", "track.txt"], "no column but the time; others: u, v"),
        (["read", "track.txt", "--columns", "x"], "`--columns` must be pairs"),
        (["read", "track.txt", "--decimal", "dot"], "unknown decimal 'dot'"),
        (["read", "track.txt", "--columns", "x=u", "--unit", "m", "--figure", "a.doc"], "`--figure` must end in .png"),
        (["read", "track.txt", "--track", "mass B"], "unknown track of this file 'mass B'"),
    ],
)
def test_bad_input_leaves_with_2_and_one_message(here: Command, folder: Path, words: list[str], says: str) -> None:
    (folder / "track.txt").write_text(TEXT)
    done = here(*words)
    assert (done.status, done.out) == (2, "")
    assert says in done.err
    assert done.files == {"track.txt"}


def test_check_and_fit_take_the_same_words(here: Command) -> None:
    asked = ("--track", "--columns", "--unit", "--rate", "--pixel", "--decimal", "--y")
    for command in ("read", "check", "fit"):
        printed = here(command, "--help").out
        assert not [option for option in asked if option not in printed], command
