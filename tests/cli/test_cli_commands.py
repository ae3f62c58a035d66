"""`list`, `show`, `schema`, `--version`, help and completion."""

from __future__ import annotations

import json
import os
import pty
import re
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest

from trundle.scenario import ScenarioFile, files

from .conftest import Command

HEAVY = ("heyoka", "xarray", "matplotlib", "sympy", "scipy", "pint", "rich")


def on_a_terminal(words: list[str], folder: Path, columns: int = 100, until: str = "", patience: float = 1.0) -> str:
    """Return what the command prints when its output is a terminal; `until`: it is ended once it has printed this."""
    code = f"from trundle.cli import run, screen; screen.PATIENCE = {patience}; run({words})"
    leader, follower = pty.openpty()
    env = {**os.environ, "TERM": "xterm-256color", "COLUMNS": str(columns)}
    env.pop("NO_COLOR", None)
    process = subprocess.Popen(  # noqa: S603
        [sys.executable, "-c", code],
        cwd=folder,
        env=env,
        stdout=follower,
        stderr=follower,
        stdin=follower,
    )
    os.close(follower)
    pieces = []
    while True:
        try:
            piece = os.read(leader, 65536)
        except OSError:  # the other end has closed
            break
        if not piece:
            break
        pieces.append(piece)
        if until and re.search(until, b"".join(pieces).decode(errors="replace")):
            process.terminate()
    os.close(leader)
    process.wait()
    return b"".join(pieces).decode()


def test_list_in_a_pipe(trundle: Command) -> None:
    done = trundle("list")
    assert (done.status, done.err, done.files) == (0, "", set())
    rows = [line.split(maxsplit=1) for line in done.out.splitlines()]
    assert rows == [[name, files.title_of(name)] for name in files.names()]


@pytest.mark.parametrize("words", [["list"], ["--help"], ["run", "--help"], ["--version"]])
def test_quick_commands_load_nothing_heavy(words: list[str], folder: Path) -> None:
    code = f"import sys; from trundle.cli import run; run({words})"
    code += f"; print([name for name in {HEAVY} if name in sys.modules])"
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=folder
    )
    assert done.stdout.splitlines()[-1] == "[]"


@pytest.mark.parametrize("words", [["list"], ["show", "tilted-turntable"], ["--help"], ["run", "--help"], ["lst"]])
def test_no_colours_and_no_boxes_in_a_pipe(trundle: Command, words: list[str]) -> None:
    done = trundle(*words, env={"TERM": "xterm-256color"})
    assert "\x1b" not in done.out + done.err
    assert not re.search("[\u2500-\u257f]", done.out + done.err)


@pytest.mark.parametrize("more", [[], ["--quiet"]])
def test_a_card_that_takes_long_is_waited_for_in_sight(more: list[str], folder: Path) -> None:
    """The run had its bar, and then nothing moved for as long again."""
    printed = on_a_terminal(["run", "rattleback", "--no-figure", *more], folder, patience=0.01)
    assert [said in printed for said in ("rolling", "checking")] == [not more, not more]
    assert (folder / "rattleback" / "run.nc").exists()


def test_colours_and_tables_on_a_terminal(folder: Path) -> None:
    listed = on_a_terminal(["list"], folder)
    assert "\x1b[" in listed
    assert all(name in listed for name in files.names())
    shown = on_a_terminal(["show", "tilted-turntable"], folder)
    assert "0.0368116 m/s" in shown  # g sin(0.3 deg) / (0.4 · 33.3 rpm), read off the closed form
    plain = re.sub(r"\x1b\[[0-9;]*m", "", shown)
    assert 'rate = "33.3 rpm"' in plain


def test_show_in_a_pipe_is_the_file_to_the_byte(trundle: Command, folder: Path) -> None:
    done = trundle("show", "tilted-turntable")
    assert done.out == files.read("tilted-turntable")
    (folder / "mine.toml").write_text(done.out, encoding="utf-8")
    assert trundle("show", "mine.toml").out == done.out
    assert ScenarioFile.load(folder / "mine.toml") == ScenarioFile.load("tilted-turntable")


def test_show_says_what_is_wrong_with_a_file(here: Command, folder: Path) -> None:
    (folder / "mine.toml").write_text("title = 'x'")
    done = here("show", "mine.toml")
    assert (done.status, done.out) == (2, "")
    assert "mine.toml: `body` must be given" in done.err


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("level-turntable-nudged", "6.30631 s"),  # 7/2 turns of 60/33.3 s
        ("hollow-ball-turntable", "4.5045 s"),  # 5/2 turns
        ("ball-under-force", "(0.140056, 0) m/s²"),  # 5F/(7m)
    ],
)
def test_what_to_expect(name: str, expected: str) -> None:
    from trundle.cli.expectations import expectations

    assert any(expected in value for _, value in expectations(ScenarioFile.load(name)))


@pytest.mark.parametrize("name", files.names())
def test_every_scenario_says_what_to_expect(name: str) -> None:
    from trundle.cli.expectations import expectations

    if files.rolls_along_path(files.parse(files.read(name), name)):
        return
    rows = expectations(ScenarioFile.load(name))
    assert rows[0][0] == "closed form"
    assert all(key and not {"nan", "inf"} & set(value.replace(",", " ").split()) for key, value in rows)


def test_schema(here: Command) -> None:
    assert json.loads(here("schema").out) == ScenarioFile.schema()


def test_version(here: Command) -> None:
    assert here("--version").out == f"trundle {version('trundle')}\n"


def test_nothing_asked_for_is_help(here: Command) -> None:
    alone, helped = here(), here("--help")
    assert (alone.status, helped.status) == (0, 0)
    assert alone.out == helped.out
    assert "Usage: trundle" in alone.out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["lst"], "Did you mean 'list'?"),
        (["tilted-turntable"], "Did you mean `trundle run tilted-turntable`?"),
        (["run"], "Missing argument 'SCENARIO'"),
        (["run", "tilted-turntable", "--methd", "exact"], "--method"),
        (["run", "tilted-turntable", "--method"], "requires an argument"),
        (["run", "tilted-turntable", "and", "more"], "unexpected extra argument"),
        (["list", "--all"], "No such option"),
    ],
)
def test_usage_errors(here: Command, words: list[str], said: str) -> None:
    done = here(*words)
    assert (done.status, done.out, done.files) == (2, "", set())
    assert said in done.err
    assert "Traceback" not in done.err


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_script(trundle: Command, shell: str) -> None:
    done = trundle(env={"_TRUNDLE_COMPLETE": f"source_{shell}"})
    assert done.status == 0
    assert f"complete_{shell}" in done.out


def test_completion_offers_scenarios_and_files(trundle: Command, folder: Path) -> None:
    (folder / "tiny.toml").write_text("")
    (folder / "tiny.nc").write_text("")
    (folder / "tables").mkdir()
    (folder / "tables" / "mine.toml").write_text("")

    def offered(line: str) -> list[str]:
        words = {"_TRUNDLE_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(line.count(" "))}
        return trundle(env=words).out.split()

    assert offered("trundle run ti") == [
        "tilted-turntable",
        "tilted-turntable-put-down",
        "tilted-turntable-straight",
        "tippe-top",
        "tiny.toml",
    ]
    assert offered("trundle run tab") == ["tables/"]
    assert offered("trundle run tables/") == ["tables/mine.toml"]
    assert offered("trundle show level-turntable-n") == ["level-turntable-nudged"]
    assert offered("trundle run x --method ru") == ["runge-kutta"]
    assert offered("trundle ru") == ["run"]


def test_a_reader_that_stops_reading(folder: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "trundle", "show", "tilted-turntable"],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdout is not None
    process.stdout.close()  # before anything is written
    assert process.stderr is not None
    assert process.stderr.read() == b""
    process.stderr.close()
    process.wait()


def test_a_full_disk_behind_the_output() -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no such device here")
    done = subprocess.run(  # noqa: S602
        f"{sys.executable} -m trundle list > /dev/full",
        shell=True,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr == "trundle: the system says: No space left on device\n"


def test_a_terminal_without_greek_letters(trundle: Command) -> None:
    done = trundle("show", "ball-under-torque", env={"PYTHONIOENCODING": "ascii"})
    assert done.status == 0
    assert tomllib.loads(done.out)["title"] == files.title_of("ball-under-torque")
