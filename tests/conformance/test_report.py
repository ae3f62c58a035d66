"""The report, the files for elsewhere, and the command."""

from __future__ import annotations

import base64
import json
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from tests.conformance.conftest import Make
from tests.conformance.test_score import rows

from trundle.cli import run as trundle
from trundle.conformance import Score, cases, engines, portable
from trundle.conformance.animation import path_of
from trundle.conformance.answers import Answer
from trundle.conformance.measuring import Errors, errors_of
from trundle.conformance.report import markdown, page

CASES = {case.name: case for case in cases()}
MIXED = Score(
    rows(1e-2, 1e-3, 1e-4)
    + rows(1e-2, 1e-2, 1e-2, case="dome", engine="<b>Other</b>")
    + rows(1e-2, 1e-3, 1e-4, case="dome", engine="<b>Other</b>", setting="double precision", of="as shipped")
    + tuple(
        replace(row, engine="None", outcome="not installed", message="no wheel", position=np.nan, turning=np.nan)
        for row in rows(1e-2, 1e-3)
    )
)


class _Checker(HTMLParser):
    """Notes addresses outside the page, and tags that are not closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.outside: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag not in ("meta", "br", "use", "path", "rect", "circle", "input"):
            self.open.append(tag)
        self.outside += [v for k, v in attrs if k in ("src", "href") and v and not v.startswith("#")]

    def handle_endtag(self, tag: str) -> None:
        if tag in self.open:
            while self.open.pop() != tag:
                pass


def test_the_page_needs_nothing_but_itself() -> None:
    text = page(MIXED, list(CASES.values()))
    checker = _Checker()
    checker.feed(text)
    assert checker.open == []
    assert checker.outside == []
    assert "<b>Other</b>" not in text  # it is escaped
    assert text.count("<svg") == 2
    for words in ("Ball rolling down an incline", "float32 floor", "falls with: double precision", "no wheel", "E 1"):
        assert words in text


def test_the_page_plays_the_motion_of_an_engine_beside_the_exact_one() -> None:
    """What the page holds is read back: the exact motion of the case, and the engine's own."""
    case = CASES["incline"]
    exact = case.exact()
    moved = replace(exact, position=exact.position + np.array([0.0, 0.25, 0.0]))
    score = Score(tuple(replace(row, path=path_of(moved)) for row in rows(1e-2, 1e-3)))
    text = page(score, [case])
    told = json.loads(text.partition('<script type="application/json">')[2].partition("</script>")[0])
    for words, motion in ((told["exact"], exact), (told["runs"][0]["path"], moved)):
        seen = np.frombuffer(base64.b64decode(words), "<f4").reshape(told["frames"], 1, 7)
        for k, sample in ((0, 0), (-1, -1)):
            assert np.allclose(seen[k, 0, :3], motion.position[sample, 0], rtol=0, atol=1e-6)
            assert np.allclose(seen[k, 0, 3:], motion.orientation[sample, 0], rtol=0, atol=1e-6)
    assert "<option>E, as shipped, 1 ms</option>" in text
    hostile = page(Score(tuple(replace(row, path="</script><b>") for row in rows(1e-2))), [case])
    assert "</script><b>" not in hostile


def test_the_table_has_a_row_for_each_profile() -> None:
    lines = markdown(MIXED).splitlines()
    assert lines[0] == "| engine | setting | incline | dome |"
    assert lines[2] == "| E | as shipped | converges, 1.0e-4 |  |"
    assert len(lines) == 5


def test_junit_says_what_fails_and_what_cannot() -> None:
    cannot = tuple(replace(row, engine="H", outcome="cannot", position=np.nan, turning=np.nan) for row in rows(1e-2))
    suite = ET.fromstring(portable.junit(Score(MIXED.rows + cannot), 1e-3, None))  # noqa: S314  our own
    assert suite.attrib == {"name": "trundle score", "tests": "4", "failures": "2", "skipped": "1"}


def test_the_one_file_scorer_measures_as_we_do(tmp_path: Path) -> None:
    case = CASES["coin-in-a-circle"]
    exact = case.exact()
    moved = replace(exact, position=exact.position + np.array([0.0, 1e-3, 0.0]))
    for name, text in portable.case_files([case]).items():
        (tmp_path / name).write_text(text)
    (tmp_path / "mine.csv").write_text(portable.table(moved))
    command = [sys.executable, "-I", "-S", str(tmp_path / "score.py"), case.name]

    def scored(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(  # noqa: S603  our own program
            [*command, *arguments], capture_output=True, text=True, check=False, cwd=tmp_path
        )

    found = scored("mine.csv", "1e-6")
    assert found.returncode == 1
    assert f"position {errors_of(case, exact, moved).position:.2e}" in found.stdout
    assert scored("mine.csv", "1").returncode == 0
    (tmp_path / "mine.csv").write_text(portable.table(moved).replace("0.01,0", "0.011,0", 1))
    assert scored("mine.csv").returncode == 2
    task = json.loads((tmp_path / f"{case.name}.json").read_text())
    assert task["bodies"][0]["shape"] == {"kind": "disc", "radius": 0.012}


def test_every_script_stands_alone_and_is_short() -> None:
    for engine, case in portable.scripts():
        text = portable.script(engine, case)
        assert len(text.splitlines()) <= 40, (engine, case)
        assert "trundle" not in text
        assert case in CASES
        assert engine in engines.names()
        compile(text, case, "exec")


def test_a_program_is_scored_reported_and_compared(
    program: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    mine = " ".join(program('say(cannot="no balls")'))
    options = ["--case", "incline", "--step", "10 ms", "--step", "1 ms"]
    assert trundle(["score", "--adapter", mine, *options, "--report", "--junit", "junit.xml", "--at-most", "1"]) == 0
    printed = capsys.readouterr()
    assert "no balls" in printed.out
    assert "Wrote score/score.nc, score/score.md, score/score.html" in printed.out
    assert {path.name for path in Path("score").iterdir()} == {"score.nc", "score.md", "score.html"}
    assert "skipped" in Path("junit.xml").read_text()
    worse = " ".join(program("print('what?', flush=True)"))
    assert trundle(["score", "--adapter", worse, *options, "--at-most", "1", "-q"]) == 3
    assert "bad answer, not JSON: 'what?'" in capsys.readouterr().err
    assert trundle(["score", "--report", "--json"]) == 0
    assert {row["outcome"] for row in json.loads(capsys.readouterr().out)} == {"bad answer"}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "`--engine` must name what is to be scored"),
        (["--engine", "mujoko"], "Did you mean 'mujoco'?"),
        (["--engine", "mujoco", "--case", "inclin"], "Did you mean 'incline'?"),
        (["--adapter", "x", "--step", "-1 ms"], "`--step` must be"),
        (["--repro", "mujoco", "dome"], "There are: "),
        (["--report"], "`--engine` must name what is to be scored"),
        (["--adapter", ""], "`--adapter` must be a command"),
        (["--adapter", "'x"], "`--adapter` must be a command"),
    ],
)
def test_what_is_wrong_is_said(
    arguments: list[str],
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert trundle(["score", *arguments]) == 2
    assert words in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_lists_scripts_and_cases_are_printed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert trundle(["score", "--engine", "list"]) == 0
    assert "MuJoCo" in capsys.readouterr().out
    assert trundle(["score", "--case", "list"]) == 0
    assert "incline" in capsys.readouterr().out
    assert trundle(["score", "--repro", "mujoco", "diagonal-box"]) == 0
    assert capsys.readouterr().out.startswith('"""MuJoCo 4.0.0')
    assert trundle(["score", "--cases", "cases", "--case", "dome"]) == 0
    assert {path.name for path in Path("cases").iterdir()} == {"README.txt", "score.py", "dome.csv", "dome.json"}


INSTALLED = [name for name in engines.names() if (engine := engines.engine(name)).packages and engine.installed]


@pytest.mark.parametrize("of", portable.scripts(), ids=" ".join)
def test_a_script_of_a_finding_is_short_and_needs_its_engine_only(of: tuple[str, str]) -> None:
    text = portable.script(*of)
    assert len(text.splitlines()) <= 40
    assert "trundle" not in text
    assert f"{of[0]} {of[1]}" in (Path(__file__).parents[2] / "docs" / "engines.md").read_text(encoding="utf-8")
    engine = engines.engine(of[0])
    if not engine.installed:
        pytest.skip(f"{of[0]} is not installed: `trundle score --engine {of[0]}` does it")
    ran = subprocess.run(  # noqa: S603  our own text
        [engine.python, "-c", text], capture_output=True, text=True, check=False, timeout=300
    )
    assert ran.returncode == 0, ran.stderr
    assert "exact" in text or "exact" in ran.stdout
    assert ran.stdout.count("\n") >= 2


def answered(name: str, of: str, step: float, *settings: str) -> list[Answer]:
    """What an installed engine answers about a case, in each of these settings."""
    engine = engines.engine(name)
    chosen = {each.name: dict(each.values) for each in engine.settings}
    with engine.adapter(60.0) as adapter:
        return [adapter.answer(CASES[of], step, chosen[setting]) for setting in settings]


def error_of(of: str, answer: Answer) -> Errors:
    """How far an answer is from the exact motion."""
    assert answer.motion is not None, answer.message
    return errors_of(CASES[of], CASES[of].exact(), answer.motion)


@pytest.mark.skipif(not INSTALLED, reason="no engine is installed: `trundle score --engine NAME` does it")
@pytest.mark.parametrize("name", INSTALLED)
def test_an_engine_that_is_installed_rolls_down_an_incline(name: str) -> None:
    """Every engine there is gets that within a fiftieth, once its documentation is followed."""
    (answer,) = answered(name, "incline", 1e-3, "best")
    assert (answer.outcome, answer.message) == ("ok", "")
    assert answer.engine.startswith(engines.engine(name).title)
    assert error_of("incline", answer).position < 0.02


@pytest.mark.parametrize("name", [name for name in INSTALLED if name != "mjx"])  # which compiles the box for minutes
def test_an_engine_that_is_installed_is_pushed(name: str) -> None:
    """Every engine that has boxes and balls takes the force at each of its steps."""
    case, (answer,) = CASES["pushed-box"], answered(name, "pushed-box", 1e-2, "best")
    if answer.outcome == "cannot":
        pytest.skip(answer.message)
    assert answer.motion is not None, answer.message
    assert answer.motion.position[-1, 0, 0] > 0.5 * case.exact().position[-1, 0, 0]  # how well, is another question


@pytest.mark.skipif(
    "newton" not in INSTALLED, reason="newton is not installed: `trundle score --engine newton` does it"
)
def test_a_solver_without_restitution_is_given_no_bounce() -> None:
    shipped, *others = answered("newton", "bounce-with-spin", 1e-2, "as shipped", "best", "SolverSemiImplicit")
    assert shipped.outcome == "ok"
    for answer in others:
        assert answer.outcome == "cannot"
        assert "has no coefficient of restitution" in answer.message


@pytest.mark.parametrize("name", [name for name in INSTALLED if name in ("ode", "pybullet", "rapier")])
def test_an_engine_keeps_its_name_in_each_of_its_settings(name: str) -> None:
    engine = engines.engine(name)
    for answer in answered(name, "incline", 1e-2, *(setting.name for setting in engine.settings)):
        assert answer.outcome == "ok", answer.message
        assert answer.engine.startswith(engine.title)


@pytest.mark.skipif("ode" not in INSTALLED, reason="ode is not installed: `trundle score --engine ode` does it")
def test_what_double_precision_has_no_words_for_is_said() -> None:
    (answer,) = answered("ode", "bowl-mesh-coarse", 1e-2, "double precision")
    assert (answer.outcome, answer.message) == ("cannot", "this adapter has no triangles in double precision")


CAUSES = [  # engine, case, step, the setting that has an error, the one that takes it away
    ("dart", "billiard-swerve", 1e-3, "as shipped", "a round cone of friction"),
    ("dart", "billiard-swerve", 1e-3, "friction pyramid", "best"),
    ("ode", "billiard-swerve", 1e-3, "best", "friction along the slip"),
    ("ode", "diagonal-box", 1e-3, "best", "friction along the slip"),
    ("ode", "bounce-with-spin", 1e-4, "best", "contacts that do not yield"),
    ("ode", "hinged-turntable-tilted", 1e-4, "best", "double precision"),
    ("rapier", "pushed-box", 1e-3, "best", "friction of all points at once, else best"),
    ("rapier", "coin-in-a-circle", 1e-4, "best", "stiff contacts, one substep, else best"),
    ("rapier", "bounce-with-spin", 1e-4, "as shipped", "contacts as they touch"),
    ("mujoco", "billiard-swerve", 1e-4, "contacts as stiff as the step allows", "stiff contacts, friction that yields"),
    ("drake", "tippe-top", 1e-3, "best", "TAMSI"),
    ("pybullet", "incline", 1e-3, "as shipped", "no damping"),
    ("newton", "pushed-box", 1e-2, "as shipped", "corrections of contacts not shared out"),
]


@pytest.mark.parametrize(("name", "of", "step", "with_it", "without"), CAUSES)
def test_a_cause_that_the_docs_name_makes_an_error_that_goes_with_it(
    name: str, of: str, step: float, with_it: str, without: str
) -> None:
    if name not in INSTALLED:
        pytest.skip(f"{name} is not installed: `trundle score --engine {name}` does it")
    there, gone = (error_of(of, answer).worst for answer in answered(name, of, step, with_it, without))
    assert gone < there / 10


@pytest.mark.skipif("ode" not in INSTALLED, reason="ode is not installed: `trundle score --engine ode` does it")
def test_what_single_precision_leaves_is_called_its_floor() -> None:
    single, double = "as shipped", "double precision, else as shipped"
    answers = [answered("ode", "hinged-turntable", step, single, double) for step in (1e-2, 1e-3, 1e-4)]
    errors = [[error_of("hinged-turntable", answer).worst for answer in pair] for pair in answers]
    of_one, of_other = zip(*errors, strict=True)
    (cell,) = Score(rows(*of_one) + rows(*of_other, setting=double, of=single)).profiles
    assert (cell.name, cell.cause) == ("float32 floor", double)


@pytest.mark.parametrize("name", [name for name in INSTALLED if name in ("dart", "pybullet")])
def test_a_coin_rolls_on_its_rim(name: str) -> None:
    """Of a prism, as Bullet makes one from a URDF file, the orientation is half a turn off."""
    (answer,) = answered(name, "coin-in-a-circle", 1e-3, "best")
    assert error_of("coin-in-a-circle", answer).angle < 2.0


def test_what_is_done_is_kept_when_it_is_interrupted(
    program: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The program answers the first task, and sends the signal with the second."""
    monkeypatch.chdir(tmp_path)
    mine = program(
        "mark = pathlib.Path('mark'); there = mark.exists(); mark.touch()\n"
        "    if there:\n"
        "        os.kill(os.getppid(), signal.SIGINT); time.sleep(3600)\n"
        '    say(cannot="no balls")'
    )
    arguments = ["--case", "incline", "--case", "dome", "--step", "1 ms"]
    with pytest.raises(SystemExit, match="130"):
        trundle(["score", "--adapter", " ".join(mine), *arguments])
    assert "trundle: interrupted; 1 of the runs written" in capsys.readouterr().err
    assert [row.case for row in Score.load("score/score.nc").rows] == ["incline"]
