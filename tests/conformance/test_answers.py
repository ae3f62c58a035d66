"""Adapters that answer badly: each fault is named in the answer, and none is raised."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from trundle.conformance import cases, running
from trundle.conformance.answers import read_answer
from trundle.conformance.case import in_body_axes
from trundle.conformance.measuring import errors_of
from trundle.conformance.running import Adapter

from .conftest import Make, good_answer

CASES = {case.name: case for case in cases()}
DRAW, COIN, TABLE = CASES["billiard-draw"], CASES["coin-in-a-circle"], CASES["hinged-turntable"]

Told = dict[str, Any]
Change = Callable[[Told], Any]


def altered(name: str, change: Callable[[Any], Any]) -> Change:
    """What replaces one array of an answer."""
    return lambda told: told | {name: change(np.array(told[name])).tolist()}


def with_nan(x: Any) -> Any:
    x[5, 0, 1] = np.nan
    return x


FAULTS: list[tuple[Change, str, str]] = [
    (altered("position", with_nan), "not finite", "`position` is not a finite number from t = 0.05 s on"),
    (lambda told: {k: v for k, v in told.items() if k != "velocity"}, "bad answer", "`velocity` is missing"),
    (altered("velocity", lambda x: x[:-1]), "bad answer", "`velocity` must have the shape (201, 1, 3)"),
    (lambda told: told | {"position": "here"}, "bad answer", "`position` must be an array of numbers"),
    (altered("orientation", lambda q: 2 * q), "bad answer", "unit quaternions; a length is off by 1"),
    (altered("time", lambda t: 2 * t), "bad answer", "`time` must be 0 to 2 s by 0.01 s"),
    (altered("velocity", lambda x: x[..., [1, 0, 2]]), "bad answer", "`velocity` at the start is off by 2"),
    (altered("position", lambda x: x + np.array([0, 0, 1])), "bad answer", "`position` at the start is off by 1"),
    (altered("angular_velocity", lambda x: -x), "bad answer", "`angular_velocity` at the start is off"),
    (lambda _: {"task": 1, "cannot": "it has no balls"}, "cannot", "it has no balls"),
    (lambda _: {"task": 1, "failed": "it fell over"}, "failed", "it fell over"),
    (lambda _: [1, 2], "bad answer", "not an object of JSON"),
    (lambda told: told | {"seconds": "long"}, "bad answer", "`seconds` must be an array of numbers"),
]


@pytest.mark.parametrize(("change", "outcome", "words"), FAULTS, ids=[words for _, _, words in FAULTS])
def test_a_fault_is_named(change: Change, outcome: str, words: str) -> None:
    answer = read_answer(json.dumps(change(good_answer(DRAW))), DRAW, 1)
    assert answer.outcome == outcome
    assert words in answer.message
    assert answer.motion is None


def to_body(told: Told) -> Told:
    turned = in_body_axes(np.array(told["orientation"]), np.array(told["angular_velocity"]))
    return told | {"angular_velocity": turned.tolist()}


# The coin starts turned, so that its axes and those of space can be told apart.
AXES: list[tuple[Change, str]] = [
    (altered("orientation", lambda q: q[..., [1, 2, 3, 0]]), "it is (x, y, z, w)"),
    (altered("orientation", lambda q: q * [1, -1, -1, -1]), "it turns from space to body"),
    (to_body, "is in the axes of the body"),
]


@pytest.mark.parametrize(("change", "words"), AXES, ids=[words for _, words in AXES])
def test_wrong_axes_are_named(change: Change, words: str) -> None:
    answer = read_answer(json.dumps(change(good_answer(COIN))), COIN, 1)
    assert answer.outcome == "bad answer"
    assert words in answer.message


def test_turning_that_the_orientations_contradict_is_named() -> None:
    """A ball starts with its axes those of space, so that only the motion tells."""
    answer = read_answer(json.dumps(to_body(good_answer(TABLE))), TABLE, 1)
    assert answer.outcome == "bad answer"
    assert "is not how the body turns: it is in the axes of the body" in answer.message


@pytest.mark.parametrize("name", ["billiard-draw", "coin-in-a-circle", "hinged-turntable", "pushed-box"])
def test_a_good_answer_is_taken_and_measured(name: str) -> None:
    case = CASES[name]
    answer = read_answer(json.dumps(good_answer(case)), case, 1)
    assert (answer.outcome, answer.message, answer.engine, answer.seconds) == ("ok", "", "mine 1.0", 0.5)
    assert answer.motion is not None
    assert errors_of(case, case.exact(), answer.motion).worst == pytest.approx(0.0, abs=1e-15)


ENDINGS = {
    'print("Welcome to my engine!", flush=True)': ("bad answer", "not JSON: 'Welcome to my engine!'"),
    "sys.exit(7)": ("failed", "no answer: it ended with status 7"),
    "os.kill(os.getpid(), signal.SIGKILL)": ("failed", "no answer: it was killed by signal 9"),
    'raise ValueError("no ground")': ("failed", "no answer: it ended with status 1 (ValueError: no ground)"),
    'sys.stdout.write(json.dumps({"task": task["task"], "cannot": "end a line"})); sys.exit()': (
        "cannot",
        "end a line",
    ),
    'print(json.dumps({"cannot": "count"}), flush=True)': ("bad answer", "`task` must be that of the task, "),
    'say(**{"task": [7], "cannot": "count"})': ("bad answer", "it is [7]"),
    "print(flush=True)": ("bad answer", "not JSON: ''"),
    "sys.stdout.buffer.write(b'\\xff\\xfe\\n'); sys.stdout.flush()": ("bad answer", "not JSON"),
}


@pytest.mark.parametrize("body", ENDINGS)
def test_however_a_program_ends_it_is_said(body: str, program: Make) -> None:
    outcome, words = ENDINGS[body]
    with Adapter(program(body)) as adapter:
        for _ in range(2):  # it is started again
            answer = adapter.answer(DRAW, 1e-2)
            assert answer.outcome == outcome
            assert words in answer.message


SAYS = """say(cannot=f"step {task['dt']}")"""
TWICE = f"{SAYS}; {SAYS}"
BANNER = f'print("Welcome", flush=True); {SAYS}'
FIRST = f'("begun" in globals()) or print("Welcome", flush=True); begun = True; {SAYS}'


@pytest.mark.parametrize("body", [TWICE, BANNER, FIRST], ids=["twice", "before each", "before all"])
def test_no_answer_is_taken_for_that_to_another_task(body: str, program: Make) -> None:
    """A program that says more than it was asked would be one task behind for good, and nobody would see it."""
    with Adapter(program(body)) as adapter:
        for dt in (1e-2, 1e-3, 1e-4):
            answer = adapter.answer(DRAW, dt)
            assert (answer.outcome, answer.message) in (
                ("cannot", f"step {dt}"),
                ("bad answer", "not JSON: 'Welcome'"),
                *(("bad answer", f"`task` must be that of the task, {n + 1}; it is {n}") for n in (1, 2)),
            )


def test_a_program_may_end_after_its_answer(program: Make) -> None:
    """Soon after it, or late: whether it has ended when the next task comes is chance."""
    with Adapter(program(f"{SAYS}; time.sleep(task['dt']); sys.exit()")) as adapter:
        for dt in (1e-3, 1e-2, 5e-2, 1e-1, 2e-1):
            answer = adapter.answer(DRAW, dt)
            assert (answer.outcome, answer.message) == ("cannot", f"step {dt}")


def test_one_that_is_late_is_killed_and_started_again(
    program: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It waits for ever on the first task, and answers any later one."""
    mark = tmp_path / "mark"
    body = (
        f"late = pathlib.Path({str(mark)!r}); there = late.exists(); late.touch()\n"
        "    time.sleep(0 if there else 3600)\n"
        '    say(cannot="it is tired")'
    )
    monkeypatch.setattr(running, "STARTING", 0.0)
    with Adapter(program(body), limit=0.01) as adapter:
        while not mark.exists():  # it may be ended before it has begun to wait
            late = adapter.answer(DRAW, 1e-2)
            assert late.outcome == "too slow"
            assert late.message == f"no answer within {adapter.limit:g} s"
            adapter.limit *= 2
        monkeypatch.setattr(running, "STARTING", 60.0)
        assert adapter.answer(DRAW, 1e-2).outcome == "cannot"


def test_a_program_that_is_not_there() -> None:
    with Adapter(["no-such-program"]) as adapter:
        assert "cannot be started" in adapter.answer(DRAW, 1e-2).message
