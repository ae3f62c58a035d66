"""`trundle fit`: what it prints and writes, its exit status, and what it refuses."""

from __future__ import annotations

import json
import signal
import tomllib
from pathlib import Path

import numpy as np
import pytest
from tests.fitting.measured import on_turntable, seen

import trundle as tr

from .conftest import Command

TABLE = """
title = "My table"
[body]
kind = "sphere"
radius = "25 mm"
mass = "65 g"
inertia_ratio = 0.5
[support]
kind = "plane"
rim = "50 cm"
[support.motion]
kind = "spin"
rate = 3.487
[start]
position = [0, 0]
[run]
duration = "10 s"
every = "50 ms"
"""
T = np.arange(200) / 20.0
ASKED = ("-s", "table.toml", "-f", "body.inertia_ratio")
RATE = "support.motion.rate"
RATED = ("track.csv", *ASKED, "-f", RATE)


@pytest.fixture(autouse=True)
def _files(folder: Path) -> None:
    (folder / "table.toml").write_text(TABLE, encoding="utf-8")
    for name, path, noise in (
        ("track", on_turntable(T, 3.487), 5e-4),
        ("puck", 0.1 + 0.05j * T * (1 - 0.2 * T), 5e-4),
        ("noise", on_turntable(T, 3.487), 5.0),
    ):
        table = seen(T, noise, 1, z=path)
        rows = np.column_stack([table["t"], 1e3 * table["x"], 1e3 * table["y"]])[: 60 if name == "puck" else None]
        np.savetxt(folder / f"{name}.csv", rows, header="t,x [mm],y [mm]", comments="", delimiter=",")


def test_it_prints_the_numbers_and_writes_all_of_it(trundle: Command) -> None:
    done = trundle("fit", "track.csv", *ASKED, "--noise", "0.5 mm", "--table", "latex")
    assert (done.status, done.err) == (0, "")
    assert "good fit, χ²/dof = " in done.out
    assert "t from column `t`, x, y in mm, 200 rows, no gaps, 20 frames a second." in done.out
    assert {f"track/fit.{end}" for end in ("toml", "nc", "png", "html", "tex")} <= done.files
    text = Path("track/fit.toml").read_text(encoding="utf-8")
    assert abs(tomllib.loads(text)["body"]["inertia_ratio"] - 0.4) < 5e-4
    assert "# ± " in text
    assert tomllib.loads(text)["support"]["rim"] == "50 cm"
    assert "http" not in Path("track/fit.html").read_text(encoding="utf-8").replace("http://www.w3.org", "")


@pytest.mark.parametrize(("form", "ending"), [("latex", "tex"), ("markdown", "md"), ("csv", "csv")])
def test_the_last_line_of_a_table_ends(here: Command, form: str, ending: str) -> None:
    others = [one for other in ("latex", "csv", form) for one in ("--table", other)]
    here("fit", "track.csv", *ASKED, "--no-figure", "--table", form, *others)
    assert Path("track/fit.tex").is_file()
    assert Path("track/fit.csv").is_file()
    text = Path(f"track/fit.{ending}").read_bytes()
    assert text.endswith(b"\n")
    assert not text.endswith(b"\n\n")


def test_a_bad_fit_says_what_may_be_missing_and_leaves_with_3(here: Command) -> None:
    done = here("fit", "puck.csv", *ASKED[:2], "--noise", "0.5 mm", "--no-figure", "-o", "out")
    assert done.status == 3
    assert "bad fit: " in done.err
    assert "what is added" in done.out
    assert "out/fit.toml" in done.files
    assert "out/fit.png" not in done.files


def test_an_interrupt_after_the_files_says_that_they_are_there(here: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tr.Fit, "compare", lambda _: signal.raise_signal(signal.SIGINT))
    done = here("fit", "track.csv", *ASKED, "--no-figure", "--compare")
    assert (done.status, done.err) == (130, "trundle: interrupted; the files are written\n")
    assert done.out.endswith("Wrote track/fit.toml, track/fit.nc\n")
    assert "track/fit.toml" in done.files


def test_what_cannot_be_decided_leaves_with_4(here: Command) -> None:
    done = here("fit", "noise.csv", *ASKED, "--no-figure", "-q")
    assert (done.status, done.out) == (4, "")
    assert "cannot decide: the noise is larger than the motion" in done.err
    together = here("fit", "track.csv", *ASKED, "-f", "support.motion.rate", "--no-figure", "--json")
    assert together.status == 4
    said = json.loads(together.out)
    assert said["answer"] == "cannot decide"
    assert all(one["sigma"] is None for one in said["numbers"][:2])
    assert "support.motion.rate·body.inertia_ratio/(1 + body.inertia_ratio)" in said["undetermined"][0]["text"]


def test_a_prior_a_camera_and_a_plan(here: Command) -> None:
    words = ("--prior", "support.motion.rate=3.487±0.001 rad/s", "--camera", "height=2 m", "--given-start")
    done = here("fit", "track.csv", *ASKED, "-f", "support.motion.rate", *words[:4], "--no-figure", "--noise", "0.5 mm")
    assert done.status == 0
    plan = here("fit", "--plan", *ASKED, "--noise", "0.5 mm, 1 mm", "--json")
    assert plan.status == 0
    fine, coarse = json.loads(plan.out)["sigma"][0][-1][-1]
    assert coarse is None or coarse == pytest.approx(2 * fine)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("track.csv",), "`--scenario` must say what moves"),
        (("-s", "table.toml"), "`TRACK` must name a file"),
        (("absent.csv", *ASKED), "must exist"),
        (("track.csv", *ASKED, "-f", "body.inertia"), "Did you mean 'body.inertia_ratio'"),
        (("track.csv", *ASKED, "--noise", "0 mm"), "`noise` must be positive"),
        ((*RATED, "--prior", f"{RATE}=3.4±0.1"), "must be an angular velocity with its unit"),
        (("track.csv", *ASKED, "--prior", "body.inertia_ratio=0.4"), "`--prior` must be KEY=VALUE±SIGMA"),
        (("track.csv", *ASKED, "--camera", "scale"), "`--camera` must be pairs KEY=VALUE"),
        (("track.csv", *ASKED, "--table", "word"), "unknown form of table"),
    ],
)
def test_bad_input_leaves_with_2(here: Command, words: tuple[str, ...], says: str) -> None:
    done = here("fit", *words)
    assert done.status == 2
    assert says in done.err
    assert not [name for name in done.files if "fit." in name]
