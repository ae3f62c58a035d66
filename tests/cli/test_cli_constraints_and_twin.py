"""`trundle constraints` and `trundle twin`."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

from trundle.analysis.holonomy.names import NAMES

from .conftest import Command


def test_without_a_name_the_systems_are_listed(here: Command) -> None:
    done = here("constraints")
    assert (done.status, done.err, done.files) == (0, "", set())
    assert [line.split(maxsplit=1) for line in done.out.splitlines()] == [list(row) for row in NAMES.items()]


def test_listing_loads_no_sympy(folder: Path) -> None:
    code = "import sys; from trundle.cli import run; run(['constraints']); print('sympy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=folder)  # noqa: S603
    assert done.stdout.splitlines()[-1] == "False"


def test_the_sphere_in_the_lectures_words(here: Command) -> None:
    done = here("constraints", "sphere")
    said = " ".join(done.out.split())
    assert done.status == 0
    assert "growth (3, 5)" in said
    assert "NONHOLONOMIC" in said
    assert "Roll round a small square of side s" in said
    assert "comes back turned" in said


def test_the_cylinder_is_integrated(here: Command) -> None:
    assert "x − a φ = const." in here("constraints", "cylinder").out


def test_findings_as_json_and_latex(here: Command) -> None:
    told = json.loads(here("constraints", "cart", "--json").out)
    assert (told["verdict"], told["growth"], told["rank"]) == ("partly holonomic", [2, 3, 4], 3)
    assert here("constraints", "cylinder", "--latex").out.startswith("\\begin{align*}\n&dx - a\\,d\\phi = 0")


def test_wrong_words_about_constraints(here: Command) -> None:
    for words, said in (
        (["sphre"], "Did you mean 'sphere'?"),
        (["--json"], "`--json` must come with the name of a system"),
        (["sphere", "--json", "--latex"], "`--json` must not stand beside --latex"),
    ):
        done = here("constraints", *words)
        assert (done.status, done.out) == (2, "")
        assert said in done.err


def test_the_twin_of_a_scenario(here: Command) -> None:
    done = here("twin", "tilted-turntable", "-o", "out")
    assert (done.status, done.err) == (0, "")
    assert done.files == {"out", "out/twin.png"}
    assert "−QB/M            0.996334 rad/s" in done.out
    assert "(0, 0.0368116) m/s" in done.out
    assert "each by its own formulas" in done.out


def test_no_figure_no_file(here: Command) -> None:
    done = here("twin", "level-turntable-nudged", "--electron", "--no-figure")
    assert (done.status, done.files) == (0, set())
    assert "1 s of the ball is 1 µs of the charge" in done.out


def test_wrong_words_about_twins(here: Command, folder: Path) -> None:
    (folder / "taken").write_text("")
    for words, status, said in (
        (["tilted-turntble"], 2, "Did you mean 'tilted-turntable'?"),
        (["tilted-turntable", "--charge", "0"], 2, "`--charge` must not be zero"),
        (["tilted-turntable", "--mass", "1 m"], 2, "`--mass` must be a mass"),
        (["tilted-turntable", "--electron", "--slow-motion", "1e10"], 2, "`--slow-motion` must leave the charge below"),
        (["tilted-turntable", "-o", "taken"], 2, "`--output` must be a folder"),
        (["cylinder-in-cylinder"], 1, "Nothing corresponds to this"),
    ):
        done = here("twin", *words)
        assert (done.status, done.out, done.files) == (status, "", {"taken"})
        assert said in done.err
