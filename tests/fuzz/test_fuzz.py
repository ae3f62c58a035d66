"""The fuzz itself: it draws what it says, it tells one ending from another, and a few of its scenarios run."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.fuzz import drawing, report
from tests.fuzz.classes import CLASSES, candidate, shipped
from tests.fuzz.commands import COMMANDS, status_of
from tests.fuzz.leaves import Leaf, kind_of, leaves, tables_of, times
from tests.fuzz.running import OUTCOMES, Outcome

import trundle as tr
from trundle.cli import CANNOT_DECIDE
from trundle.scenario import ScenarioFile
from trundle.scenario.tables import KINDS

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="each scenario runs in a copy of a process")


def command(*words: str) -> subprocess.CompletedProcess[str]:
    """Run the command, or some code, in a process that has no threads, as copies are made of it."""
    first = ["-m", "tests.fuzz"] if words[0] != "-c" else []
    return subprocess.run(  # noqa: S603
        [sys.executable, *first, *words], cwd=ROOT, capture_output=True, text=True, timeout=300, check=False
    )


# --- what it draws --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CLASSES)
def test_a_seed_gives_the_same_scenario_again(name: str) -> None:
    drawn = [[candidate(name, drawing.seeded(seed)) for seed in range(10)] for _ in range(2)]
    assert drawn[0] == drawn[1]
    assert len({str(one) for one in drawn[0]}) == 10


@pytest.fixture(scope="module")
def three(tmp_path_factory: pytest.TempPathFactory) -> tuple[subprocess.CompletedProcess[str], Path]:
    """Three of each class, tried by one command: to start it takes as long as to try some of them."""
    folder = tmp_path_factory.mktemp("fuzz")
    return command("--count", "3", "--folder", str(folder)), folder


def outcomes_in(folder: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (folder / "outcomes.jsonl").read_text(encoding="utf-8").splitlines()]


@pytest.mark.parametrize("name", CLASSES)
def test_what_it_draws_runs_mostly_as_it_is_or_when_it_is_mended(name: str, three: Any) -> None:
    found = [one for one in outcomes_in(three[1]) if one["name"] == name]
    assert sorted(one["seed"] for one in found) == [0, 1, 2]
    assert all(one["outcome"] in OUTCOMES for one in found)
    assert sum(one["outcome"] == "refused" for one in found) <= 1
    assert f"| {name} | 3 |" in (three[1] / "table.md").read_text(encoding="utf-8")


def test_it_ends_with_1_where_something_ended_badly_and_has_tried_nothing_else(three: Any) -> None:
    done, found = three[0], outcomes_in(three[1])
    assert done.returncode in (0, 1), done.stderr
    assert {one["name"] for one in found} == set(CLASSES)
    assert done.returncode == any(one["outcome"] in report.BAD for one in found)


@pytest.mark.parametrize("family", KINDS)
def test_it_draws_every_kind_that_the_format_has(family: str) -> None:
    part = {"body": "body", "support": "support", "loads": "loads"}.get(family, "motion")
    for kind, table in KINDS[family].items():
        drawn = [drawing.Draw(drawing.seeded(seed), part).table([table]) for seed in range(3)]
        assert {one["kind"] for one in drawn} == {kind}
        assert len({str(one) for one in drawn}) > (1 if len(table.model_fields) > 1 else 0)


def test_it_leaves_no_key_of_the_format_out() -> None:
    for family, kinds in KINDS.items():
        part = {"body": "body", "support": "support", "loads": "loads"}.get(family, "motion")
        for kind, table in kinds.items():
            missing = set(table.model_fields)
            for seed in range(200):
                missing -= set(drawing.Draw(drawing.seeded(seed), part).table([table]))
                if not missing:
                    break
            assert not missing, kind


def numbers(tables: Any) -> Iterator[str]:
    """Return every number, and every text with one, in nested tables: found without the format's classes."""
    parts = tables.values() if isinstance(tables, dict) else tables
    for part in parts:
        if isinstance(part, (dict, list)):
            yield from numbers(part)
        elif not isinstance(part, bool) and any(letter.isdigit() for letter in str(part)):
            yield str(part)


@pytest.mark.parametrize("name", list(shipped()))
def test_it_finds_every_number_of_a_scenario(name: str) -> None:
    tables = {key: value for key, value in shipped()[name].items() if key not in ("title", "notes")}
    assert sorted(str(leaf.value) for leaf in leaves(ScenarioFile, tables)) == sorted(numbers(tables))
    assert all(leaf.allows(leaf.value) for leaf in leaves(ScenarioFile, tables))


@pytest.mark.parametrize(
    ("value", "wanted"),
    [
        (0.25, 0.5),
        (3, 6.0),
        ("25 mm", "50.0 mm"),
        ("-3.5 deg", "-7.0 deg"),
        ("0.5*3*(x**2 + y**2)", "1.0*3*(x**2 + y**2)"),
        ("x**2", "x**2"),
        ("co-rotating", "co-rotating"),
        ("1e-3*sin(2*t)", "0.002*sin(2*t)"),
    ],
)
def test_a_value_times_a_factor(value: Any, wanted: Any) -> None:
    assert times(value, 2.0) == wanted


def test_what_the_format_refuses_is_not_put_there() -> None:
    tables = tomllib.loads('[body]\nkind = "sphere"\nradius = "1 cm"\nmass = 1\ninertia_ratio = 0.4')
    (ratio,) = (leaf for leaf in leaves(ScenarioFile, tables) if leaf.key == "inertia_ratio")
    assert isinstance(ratio, Leaf)
    assert [ratio.allows(value) for value in (0.4, 0.7, -0.4, 0.0)] == [True, False, False, False]


def test_kinds_are_those_of_the_tables() -> None:
    for kind, table in KINDS["body"].items():
        assert kind_of(table) == kind
    assert set(tables_of(ScenarioFile.model_fields["support"].annotation)) == set(KINDS["support"].values())


# --- how it tells one ending from another ---------------------------------------------------------------

ENDINGS = """
import json, os, pathlib, sys, time, warnings
from trundle.solve import frames
from tests.fuzz.running import Child

def hangs(say):
    while True:
        sum(range(1000))

def asks_for_too_much(say):
    say(text="large")
    bytearray(1 << 40)

def warns(say):
    warnings.warn("3 things look odd", RuntimeWarning)
    say(outcome="passed")

def begins_again(say):
    for _ in range(4):
        say(begins=True)
        until = time.process_time() + 0.2
        while time.process_time() < until:
            pass
    say(outcome="passed")

endings = {
    "hangs": hangs,
    "breaks": lambda say: {}["nothing"],
    "breaks inside": lambda say: frames.change(None, None, "support", "world"),
    "asks for too much": asks_for_too_much,
    "warns": warns,
    "dies": lambda say: os.abort(),
    "sleeps": lambda say: time.sleep(1000),
    "begins again": begins_again,
}
found = {}
for name, work in endings.items():
    child = Child(work, pathlib.Path(sys.argv[1]) / "work", 0.5)
    if name == "sleeps":
        child.began -= 1000
        time.sleep(0.3)
        child.check()
    _, status, usage = os.wait4(child.process, 0)
    found[name] = child.ended(status, usage.ru_utime)
print(json.dumps(found))
"""


def test_endings_are_told_apart(tmp_path: Path) -> None:
    done = command("-c", ENDINGS, str(tmp_path))
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    outcomes = {name: one.get("outcome") for name, one in found.items()}
    assert outcomes == {
        "hangs": "hang",
        "breaks": "traceback",
        "breaks inside": "traceback",
        "asks for too much": "traceback",
        "warns": "passed",
        "dies": "crash",
        "sleeps": "hang",
        "begins again": "passed",
    }
    assert "hangs" in found["hangs"]["detail"]  # the stack says where
    assert found["breaks"]["cause"].startswith("KeyError in outside")
    assert found["breaks inside"]["cause"].startswith("AttributeError in solve/frames.py:change")
    assert found["asks for too much"]["cause"].startswith("MemoryError")
    assert found["asks for too much"]["text"] == "large"
    assert "# things look odd" in found["warns"]["warned"]


BESIDE_OTHERS = """
import json, pathlib, sys
from tests.fuzz import running

folder = pathlib.Path(sys.argv[1])
running._warm_up = lambda: None

def try_out(name, seed, say, limit, commands):
    tries = folder / f"{seed}"
    with tries.open("a") as stream:
        stream.write(".")
    late = name == "slow" or (name == "disturbed" and tries.read_text() == ".")
    say(outcome="hang" if late else "passed")

running.try_out = try_out
cases = [("slow", 0), ("disturbed", 1), ("quick", 2)]
found = list(running.outcomes(iter(cases), folder / "files", int(sys.argv[2])))
tries = {path.name: len(path.read_text()) for path in folder.iterdir() if path.is_file()}
print(json.dumps([[(one.name, one.outcome) for one in found], tries]))
"""


def test_what_is_late_beside_others_is_tried_alone(tmp_path: Path) -> None:
    for workers, tries in (2, {"0": 2, "1": 2, "2": 1}), (1, {"0": 1, "1": 1, "2": 1}):
        folder = tmp_path / f"{workers}"
        folder.mkdir()
        done = command("-c", BESIDE_OTHERS, str(folder), f"{workers}")
        assert done.returncode == 0, done.stderr
        found, tried = json.loads(done.stdout)
        assert tried == tries
        alone = "passed" if workers == 2 else "hang"
        assert sorted(found) == [["disturbed", alone], ["quick", "passed"], ["slow", "hang"]]


SCENARIO = """
[body]
kind = "solid-sphere"
radius = "25 mm"
mass = "65 g"
[support]
kind = "plane"
{support}
[start]
position = [0.1, 0]
{start}
[run]
duration = 1
every = 0.1
"""


def test_a_run_is_judged_as_its_user_would(monkeypatch: pytest.MonkeyPatch) -> None:
    from tests.fuzz.running import run_as_a_user_does

    said: dict[str, Any] = {}
    run_as_a_user_does(SCENARIO.format(support="", start=""), said.update)
    assert said == {"outcome": "passed"}
    with pytest.raises(tr.ScenarioError, match="rim"):
        run_as_a_user_does(SCENARIO.format(support="rim = 0.05", start=""), said.update)
    late: dict[str, Any] = {}
    run_as_a_user_does(SCENARIO.format(support="", start=""), late.update, limit=0.0)
    assert (late["outcome"], late["cause"]) == ("hang", "exact: passed, but late")

    def broken(*_: Any) -> None:
        raise tr.SolverError("At t = 0.25 s nothing goes on.")

    with monkeypatch.context() as planted:
        planted.setattr("trundle.solve.methods.run", broken)
        run_as_a_user_does(SCENARIO.format(support="", start=""), said.update)
        run_as_a_user_does(SCENARIO.format(support="", start=""), late.update, limit=0.0)
    assert (late["outcome"], late["cause"]) == ("hang", "late: SolverError: At t = # s nothing goes on.")
    assert said["outcome"] == "gave up in words"
    assert said["cause"] == "SolverError: At t = # s nothing goes on."
    from trundle import verify

    monkeypatch.setattr(verify.figures, "_events", lambda _: [verify.CardFigure("planted", 2.0, "", 1.0, False)])
    run_as_a_user_does(SCENARIO.format(support="", start=""), said.update, limit=0.0)  # late, and wrong
    assert said["outcome"] == "card failed"
    assert said["cause"] == "exact: planted"
    assert said["detail"].startswith("FAIL planted 2 at most 1 (phases r;")


def tried(command: str) -> dict[str, Any]:
    """Return what is said of a command on a shipped scenario."""
    from tests.fuzz.running import run_as_a_user_does

    said: dict[str, Any] = {}
    text = tr.Scenario.load("tilted-turntable").to_toml()
    run_as_a_user_does(text, lambda *, begins=False, **known: said.update(known), command=command)  # noqa: ARG005
    return said


REFUSED = {
    "equilibria": "must be at rest",
    "export S run.": "`support.friction` must be given",
    "steady S --periodic": "Nothing came back",
}


@pytest.mark.parametrize("command", COMMANDS)
def test_each_command_is_one_that_there_is(command: str) -> None:
    scenario = tr.Scenario.load("tilted-turntable")
    run = scenario.run(duration=2.0)
    why = [words for begins, words in REFUSED.items() if command.startswith(begins) and "fmu" not in command]
    try:
        assert status_of(command, scenario.to_toml(), run) in (0, CANNOT_DECIDE)
    except tr.TrundleError as error:
        assert [words in str(error) for words in why] == [True]  # noqa: PT017
    else:
        assert not why


def test_a_command_that_breaks_or_finds_a_run_wrong_is_no_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: Any, **__: Any) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("trundle.analysis.statics.equilibria", broken)
    with pytest.raises(ZeroDivisionError):
        tried("equilibria S")
    monkeypatch.setattr("trundle.analysis.checking.result.Check.answer", "fails")
    said = tried("check R")
    assert (said["outcome"], said["cause"]) == ("card failed", "trundle check R")
    assert said["text"].startswith("# trundle check R\n")


# --- what it reports ------------------------------------------------------------------------------------

FOUND = [
    Outcome("gentle", 0, "passed", seconds=1.0),
    Outcome("gentle", 1, "refused", refusals={"ScenarioError": 60}),
    Outcome("gentle", 2, "hang", "run, solve/a.py:f", "stack", text='title = "a"', seconds=6.0),
    Outcome("gentle", 3, "card failed", "exact: energy", text='title = "b"', warned="odd"),
    Outcome("harsh", 0, "gave up in words", "SolverError: no"),
]


def test_the_table_counts_what_came_of_those_that_ran(tmp_path: Path) -> None:
    text = report.table(FOUND, markdown=True)
    assert "| gentle | 4 | 3 | 1 | 1 | 0 | 1 | 0 | 0 | 1 | 2 (67 %) | 1 | 60 | 7 |" in text.splitlines()
    assert "| all | 5 | 4 | 1 | 1 | 1 | 1 | 0 | 0 | 1 | 2 (50 %) | 1 | 60 | 7 |" in text.splitlines()
    assert len({len(line) for line in report.table(FOUND).splitlines()}) == 1
    causes = report.causes(FOUND)
    for line in ("hang, 1: run, solve/a.py:f (gentle 2)", "warned, 1: odd (gentle 3)"):
        assert line in causes.splitlines()
    kept = [report.keep(one, tmp_path) for one in FOUND]
    assert [path.name for path in kept if path] == ["hang-gentle-2.toml", "card-failed-gentle-3.toml"]
    assert tomllib.loads((tmp_path / "hang-gentle-2.toml").read_text(encoding="utf-8")) == {"title": "a"}


def test_one_seed_is_run_alone() -> None:
    done = command("--class", "gentle", "--seed", "2", "--one")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "outcome: passed" in done.stdout
    assert '[body]\nkind = "solid-sphere"' in done.stdout
    assert command("--seed", "2", "--one").returncode == 2
