"""`trundle run`: what it prints, what it leaves, how it ends."""

from __future__ import annotations

import json
import math
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import trundle as tr
from trundle.scenario import files

from .conftest import Command
from .test_cli_commands import on_a_terminal

THREE = {"run.nc", "path.png", "series.png"}


def in_folder(name: str, inside: set[str] = THREE) -> set[str]:
    return {name} | {f"{name}/{file}" for file in inside}


def strict_json(text: str) -> Any:
    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    return json.loads(text, parse_constant=refuse)


def test_a_run_leaves_three_files_and_says_where(trundle: Command, folder: Path) -> None:
    done = trundle("run", "tilted-turntable")
    assert (done.status, done.err) == (0, "")
    assert done.files == in_folder("tilted-turntable")
    last = done.out.splitlines()[-1]
    assert last == "Wrote " + ", ".join(f"tilted-turntable/{name}" for name in ("run.nc", "path.png", "series.png"))
    assert "\x1b" not in done.out
    for picture in ("path.png", "series.png"):
        assert (folder / "tilted-turntable" / picture).read_bytes().startswith(b"\x89PNG")


def test_the_card_on_screen_is_the_card_of_the_saved_run(here: Command, folder: Path) -> None:
    done = here("run", "level-turntable-nudged", "--no-figure")
    assert done.files == in_folder("level-turntable-nudged", {"run.nc"})
    saved = tr.Trajectory.load(folder / "level-turntable-nudged" / "run.nc")
    assert str(replace(saved.card(), origin="")).strip() in done.out
    assert "origin: of the run as it was saved in run.nc" in str(saved.card())
    # what is saved is what the closed form of the lecture says: a circle of 7/2 turns of the table
    period = 3.5 * 60 / 33.3
    assert saved.at([period]).data.position.values[0] == pytest.approx([0.2, 0.0, 0.025], abs=1e-12)


def test_the_saved_scenario_has_the_users_words(here: Command, folder: Path) -> None:
    here(
        "run",
        "tilted-turntable",
        "--no-figure",
        "--duration",
        "2 s",
        "--every",
        "50 ms",
        "--method",
        "runge-kutta",
        "--tolerance",
        "1e-10",
    )
    saved = tr.Trajectory.load(folder / "tilted-turntable" / "run.nc")
    tables = tomllib.loads(saved.scenario)
    assert tables["run"] == {"duration": "2 s", "every": "50 ms", "method": "runge-kutta"}
    assert tables["support"]["motion"]["rate"] == "33.3 rpm"
    assert (saved.method, saved.tolerance) == ("runge-kutta", 1e-10)
    assert "tolerance 1e-10" in saved.card().method
    assert saved.data.time.size == 41


def test_json_is_the_card_and_nothing_else(here: Command) -> None:
    done = here("run", "tilted-turntable", "--json", "--no-figure", "-o", "out")
    assert (done.status, done.err) == (0, "")
    assert strict_json(done.out) == tr.Scenario.load("tilted-turntable").run().card().as_dict()
    assert done.files == in_folder("out", {"run.nc"})


def test_quiet_prints_nothing(here: Command) -> None:
    done = here("run", "ball-under-force", "--quiet", "--output", "a/b")
    assert (done.status, done.out, done.err) == (0, "", "")
    assert done.files == {"a"} | {f"a/{path}" for path in in_folder("b")}


def test_a_second_run_replaces_the_first_and_leaves_the_rest(here: Command, folder: Path) -> None:
    here("run", "ball-under-force", "-q", "--no-figure", "--duration", "1 s")
    (folder / "ball-under-force" / "notes.txt").write_text("mine")
    here("run", "ball-under-force", "-q", "--no-figure", "--duration", "2 s")
    assert tr.Trajectory.load(folder / "ball-under-force" / "run.nc").data.time.values[-1] == 2.0
    assert (folder / "ball-under-force" / "notes.txt").read_text() == "mine"


def test_a_file_of_ones_own_runs_into_a_folder_of_its_name(here: Command, folder: Path) -> None:
    (folder / "elsewhere").mkdir()
    (folder / "elsewhere" / "my-table.toml").write_text(files.read("ball-under-torque"), encoding="utf-8")
    done = here("run", "elsewhere/my-table.toml", "--no-figure")
    assert done.status == 0
    assert {"my-table", "my-table/run.nc"} <= done.files


def test_running_off_the_rim_is_told(here: Command) -> None:
    done = here("run", "off-the-rim", "--no-figure")
    assert done.status == 0
    # |-0.25 + 0.35 e^{iκt}| = 0.5 with κ = 2/7 of 33.3 rpm
    leaves = math.acos((0.5**2 - 0.25**2 - 0.35**2) / (-2 * 0.25 * 0.35)) / (2 / 7 * 33.3 * math.pi / 30)
    (line,) = [line for line in done.out.splitlines() if "ran off the rim" in line]
    assert f"{leaves:.5f}" in line


@pytest.mark.parametrize("name", files.names())
def test_every_shipped_scenario_passes_its_card(here: Command, name: str) -> None:
    done = here("run", name, "--json", "--no-figure")
    assert (done.status, done.err) == (0, "")
    card = strict_json(done.out)
    assert card["passed"] is True


@pytest.fixture
def failing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let one figure of every card fail."""
    honest = tr.Trajectory.card

    def card(self: tr.Trajectory) -> tr.Card:
        true = honest(self)
        first, *rest = true.figures
        return replace(true, figures=(replace(first, passed=False, value=1.0), *rest))

    monkeypatch.setattr(tr.Trajectory, "card", card)


@pytest.mark.usefixtures("failing")
def test_a_failing_card_is_shown_and_the_files_are_there(here: Command) -> None:
    done = here("run", "ball-under-force")
    assert done.status == 3
    assert done.files == in_folder("ball-under-force")
    name = tr.Scenario.load("ball-under-force").run().card().figures[0].name
    assert done.err == f"trundle: the card fails: {name}\n"


@pytest.mark.usefixtures("failing")
def test_json_of_a_failing_card_is_json(here: Command) -> None:
    done = here("run", "ball-under-force", "--json", "--no-figure")
    assert done.status == 3
    assert strict_json(done.out)["passed"] is False


def test_a_table_on_a_terminal(folder: Path) -> None:
    shown = on_a_terminal(["run", "ball-under-force", "--no-figure"], folder)
    assert "\x1b[" in shown
    assert "rolling" not in shown  # no progress bar for so short a run
    assert "Wrote ball-under-force/run.nc" in shown


LONG = ["run", "level-turntable-nudged", "--method", "runge-kutta", "--every", "0.1 s", "--no-figure", "--duration"]


def hear_interrupts() -> None:
    """Undo what a shell does to a command that it starts in the background."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def start(folder: Path, words: list[str], **more: Any) -> subprocess.Popen[str]:
    return subprocess.Popen(  # noqa: S603
        [sys.executable, "-m", "trundle", *words],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **more,
    )


@pytest.mark.parametrize(
    ("number", "status", "said"),
    [(signal.SIGINT, 130, "trundle: interrupted; nothing written\n"), (signal.SIGTERM, 143, "")],
)
def test_interrupted_in_the_middle(folder: Path, number: signal.Signals, status: int, said: str) -> None:
    process = start(folder, [*LONG, "90000 s"], preexec_fn=hear_interrupts)
    time.sleep(4)
    assert process.poll() is None
    process.send_signal(number)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out, err) == (status, "", said)
    assert list(folder.iterdir()) == []


def test_killed_at_any_moment_leaves_whole_files_or_none(folder: Path) -> None:
    for delay in (1.5, 2.2, 3.0):
        process = start(folder, ["run", "ball-under-force", "-q"])
        time.sleep(delay)
        process.kill()
        process.communicate()
        out = folder / "ball-under-force"
        if (out / "run.nc").exists():
            assert tr.Trajectory.load(out / "run.nc").data.time.values[-1] == 5.0
        for picture in ("path.png", "series.png"):
            if (out / picture).exists():
                assert (out / picture).read_bytes().endswith(b"IEND\xaeB`\x82")


def test_a_progress_bar_for_a_long_run_on_a_terminal(folder: Path) -> None:
    bar = r"rolling.*%"
    assert re.search(bar, on_a_terminal([*LONG, "90000 s"], folder, until=bar))


def test_no_permission(here: Command, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    done = here("run", "ball-under-force", "-o", "out")
    assert (done.status, done.out, done.files) == (1, "", set())
    said = "may not be written to: name another folder by --output. Nothing was written."
    assert done.err == f"trundle: '{folder}' {said}\n"


def test_no_room_on_the_disk(folder: Path) -> None:
    resource = pytest.importorskip("resource")

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    process = start(folder, ["run", "ball-under-force"], preexec_fn=limit)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 1
    assert out == ""
    assert re.fullmatch(r"trundle: .*ball-under-force.*\. Nothing was written\.\n", err)
    assert list(folder.iterdir()) == []
