"""What the tests of the command share."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest


@dataclass(frozen=True)
class Result:
    """What a command did: its status, what it printed, and every file and folder there is afterwards."""

    status: int
    out: str
    err: str
    files: set[str]


Command = Callable[..., Result]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def below(folder: Path) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*")}


@pytest.fixture
def trundle(folder: Path) -> Command:
    """The command in a process of its own, in the working folder, its output in pipes."""

    def call(*words: str, env: dict[str, str] | None = None) -> Result:
        done = subprocess.run(  # noqa: S603
            [sys.executable, "-m", "trundle", *words],
            cwd=folder,
            env=os.environ | (env or {}),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            timeout=120,
            check=False,
        )
        return Result(done.returncode, done.stdout, done.stderr, below(folder))

    return call


@pytest.fixture
def here(folder: Path, capfd: pytest.CaptureFixture[str]) -> Command:
    """The command in this process: quicker, for what needs no process of its own."""
    from trundle.cli import run

    def call(*words: str) -> Result:
        status = run(list(words))
        printed = capfd.readouterr()
        return Result(status, printed.out, printed.err, below(folder))

    return call
