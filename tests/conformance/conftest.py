"""A good answer to a case, and small programs that answer tasks."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from trundle.conformance import Case
from trundle.conformance.case import PARTS

Make = Callable[[str], list[str]]
_HEAD = """import json, os, pathlib, signal, sys, time
def say(**words):
    print(json.dumps({"task": task["task"]} | words), flush=True)
"""


def good_answer(case: Case) -> dict[str, Any]:
    """What an adapter would answer that makes no error."""
    motion = case.exact()
    answer: dict[str, Any] = {name: getattr(motion, name).tolist() for name in ("time", *PARTS)}
    answer["support"] = None if motion.support is None else motion.support.tolist()
    return answer | {"task": 1, "seconds": 0.5, "engine": "mine 1.0"}


@pytest.fixture
def program(tmp_path: Path) -> Make:
    """Makes a program that does this with each task: `say(cannot="...")` answers it."""

    def make(body: str) -> list[str]:
        path = tmp_path / "mine.py"
        path.write_text(f"{_HEAD}for line in sys.stdin:\n    task = json.loads(line)\n    {body}\n")
        return [sys.executable, "-I", "-S", str(path)]

    return make
