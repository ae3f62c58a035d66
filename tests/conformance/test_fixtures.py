"""The fixtures for engine developers, used as they would use them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from tests.conformance.conftest import good_answer

import trundle as tr

TEST = """
import json, pathlib

def engine(task):
    if task["case"] == "incline":
        return json.loads(pathlib.Path(__file__).with_name("answer").read_text())
    return {"time": []} if task["case"] == "dome" else {"cannot": "no " + task["case"]}

def test_rolling(rolling_case, rolling_errors):
    assert rolling_errors(engine(rolling_case.task(dt=1e-3))).worst < 1e-15
"""


def test_an_engine_is_tested_on_each_case(tmp_path: Path) -> None:
    """One has a good answer to one case and a bad one to another, and cannot run the others."""
    incline = next(case for case in tr.conformance.cases() if case.name == "incline")
    answer = {key: part for key, part in good_answer(incline).items() if key != "task"}
    (tmp_path / "answer").write_text(json.dumps(answer))
    (tmp_path / "conftest.py").write_text('pytest_plugins = ["trundle.conformance.fixtures"]\n')
    (tmp_path / "test_mine.py").write_text(TEST)
    source = str(Path(tr.__file__).parents[1])
    told = subprocess.run(  # noqa: S603  pytest itself
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-rs", str(tmp_path)],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": source},
        capture_output=True,
        text=True,
        check=False,
    ).stdout
    others = len(tr.conformance.cases()) - 2
    assert f"1 failed, 1 passed, {others} skipped" in told
    assert "no tippe-top" in told
    assert "bad answer: `position` is missing" in told
