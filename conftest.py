"""Execute every code block of the documents, and run each doctest in a folder of its own.

- `python` blocks run in order, in one namespace per document;
- `toml` blocks are parsed, and whole scenarios and sweeps loaded;
- in `console` blocks each `$ command` runs, must exit as its comment says (`# exit status 3`; else 0),
  and must print the lines shown, in that order, with `...` for what varies;
- `text` blocks are not run.
"""

from __future__ import annotations

import gc
import io
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import tomllib
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import pytest
from sybil import Example, Sybil
from sybil.evaluators.python import PythonEvaluator
from sybil.integration.pytest import SybilItem
from sybil.parsers.markdown import CodeBlockParser

ROOT = Path(__file__).parent
WHOLE_SCENARIO = {"body", "support", "start", "run"}
WHOLE_PATH = {"body", "path"}
WHOLE_SWEEP = {"scenario", "over", "measure"}
# What a reader types to install or change trundle; a test must not.
NOT_RUN = {"cd", "git", "pip", "python3"}
SHELL = frozenset("|<>&;$*?~")  # what only a shell understands
PLAIN = {"NO_COLOR": "1", "COLUMNS": "120"}
TIME_LIMIT = 120  # s, for one command of a document

os.environ["MPLBACKEND"] = "Agg"  # no window, here and in every command that a document runs
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as in what a script starts with `&`: tests of Ctrl-C would wait
    signal.signal(signal.SIGINT, signal.default_int_handler)
gc.disable()  # while the tests are collected, nothing that is made is thrown away


def pytest_collection_finish() -> None:
    """Leave the half million objects that every test module together makes out of all further looks for garbage."""
    gc.collect()
    gc.freeze()
    gc.enable()


def run_toml(example: Example) -> None:
    """Parse a TOML block; load it as a scenario when it is a whole one."""
    tables = tomllib.loads(example.parsed)
    if tables.keys() >= WHOLE_SCENARIO:
        from trundle.scenario import ScenarioFile

        ScenarioFile.read(tables).start_state()
    elif tables.keys() >= WHOLE_PATH:
        from trundle.analysis.geometry import PathScenario

        PathScenario.read(tables).run()
    elif tables.keys() >= WHOLE_SWEEP:
        from trundle.analysis.sweep.plan import read_plan

        read_plan(tables)


def run_console(example: Example) -> str | None:
    """Run the commands of a console block in order; return what is wrong with the first that is wrong."""
    problems = (check(*command) for command in commands(example.parsed))
    return next((problem for problem in problems if problem), None)


def commands(block: str) -> list[tuple[str, int, list[str]]]:
    """Split a console block into commands, the exit status each must have, and the lines shown under each."""
    found: list[tuple[str, int, list[str]]] = []
    status = 0
    for line in block.splitlines():
        if line.startswith("$ "):
            found.append((line[2:], status, []))
            status = 0
        elif stated := re.match(r"#.*exit status (\d+)", line):
            status = int(stated[1])
        elif line.strip() and not line.startswith("#"):
            found[-1][2].append(line.strip())
    return found


def check(command: str, status: int, shown: list[str]) -> str | None:
    """Return what is wrong with one command of a document, or None."""
    words = shlex.split(command, comments=True)
    if words[0] == "make":
        makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
        unknown = [word for word in words[1:] if not re.search(rf"^{re.escape(word)}:", makefile, re.MULTILINE)]
        return f"the Makefile has no target {unknown}" if unknown else None
    if words[0] in NOT_RUN:
        return None
    in_process = words[0] == "trundle" and SHELL.isdisjoint(command)
    ended, printed = run_here(words[1:]) if in_process else run_in_shell(command)
    if ended != status:
        return f"$ {command}\nexited with {ended}, not {status}, and printed:\n{printed}"
    rest = iter(printed.splitlines())
    for line in shown:
        pattern = re.escape(line).replace(re.escape("..."), ".*")
        if not any(re.fullmatch(pattern, candidate.strip()) for candidate in rest):
            return f"$ {command}\ndid not print, in its place:\n{line}\nbut:\n{printed}"
    return None


def run_here(words: list[str]) -> tuple[int, str]:
    """Run trundle's command in this process, where all is loaded; return its exit status and what it printed."""
    from trundle.cli import run

    printed = io.StringIO()
    with pytest.MonkeyPatch.context() as here, redirect_stdout(printed), redirect_stderr(printed):
        for name, value in PLAIN.items():
            here.setenv(name, value)
        status = run(words)
    return status, printed.getvalue()


def run_in_shell(command: str) -> tuple[int, str]:
    """Run one command of a document as a reader's shell would, the environment's own scripts first."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(  # noqa: S602  a shell, because documents show redirections
        command,
        shell=True,
        env=os.environ | {"PATH": path} | PLAIN,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=TIME_LIMIT,
        check=False,
    )
    return done.returncode, done.stdout + done.stderr


def enter_folder(namespace: dict[str, Any]) -> None:
    """Give a document an empty working folder."""
    namespace["_came_from"] = Path.cwd()
    namespace["_folder"] = tempfile.mkdtemp(prefix="document-")
    os.chdir(namespace["_folder"])


def leave_folder(namespace: dict[str, Any]) -> None:
    """Remove a document's working folder, and close the figures it left open."""
    os.chdir(namespace["_came_from"])
    shutil.rmtree(namespace["_folder"])
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


# Sybil's own filter breaks on a failure outside a block, such as a warning at the deletion of its objects.
SybilItem._traceback_filter = pytest.Item._traceback_filter  # type: ignore[method-assign]

pytest_collect_file = Sybil(
    parsers=[
        CodeBlockParser("python", PythonEvaluator()),
        CodeBlockParser("toml", run_toml),
        CodeBlockParser("console", run_console),
    ],
    patterns=["README.md", "CONTRIBUTING.md", "docs/*.md"],
    path=str(ROOT),
    setup=enter_folder,
    teardown=leave_folder,
).pytest()


@pytest.fixture(autouse=True)
def _doctest_folder(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Run a doctest in an empty folder, so that an example may save a file."""
    if isinstance(request.node, pytest.DoctestItem):
        monkeypatch.chdir(tmp_path_factory.mktemp("doctest"))
