"""Adapters that answer badly: each fault is named in the answer, and none is raised."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from trundle.conformance import cases
from trundle.conformance.answers import read_answer
from trundle.conformance.case import PARTS, in_body_axes
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


def flipped() -> list[Any]:
    """All ways but the right one to take three axes for another, each to the left or to the right."""
    signs = [np.diag(row) for row in itertools.product((1, -1), repeat=3)]
    return [each[list(axes)] for each in signs for axes in itertools.permutations(range(3))][1:]


@pytest.mark.parametrize("name", ["billiard-swerve", "dome", "incline", "tippe-top"])
def test_no_array_in_other_axes_is_taken(name: str) -> None:
    """Alone, or all of them together where the start tells it not, because everything is at rest."""
    good = good_answer(CASES[name])
    for axes in flipped():
        moved = {part: np.array(good[part]) @ axes for part in ("position", "velocity", "angular_velocity")}
        pseudo = np.linalg.det(axes) * axes
        turned = Rotation.from_quat(np.array(good["orientation"])[:, 0], scalar_first=True).as_matrix()
        turned = Rotation.from_matrix(axes.T @ turned @ axes).as_quat(scalar_first=True)[:, None]
        together = {**moved, "angular_velocity": moved["angular_velocity"] @ axes.T @ pseudo, "orientation": turned}
        for change in (*({part: array} for part, array in moved.items()), together):
            if all(close(part, array, good[part]) for part, array in change.items()):
                continue  # it looks the same from there
            told = good | {part: array.tolist() for part, array in change.items()}
            answer = read_answer(json.dumps(told), CASES[name], 1)
            assert answer.outcome == "bad answer", (axes, list(change))


def close(part: str, array: Any, wanted: Any) -> bool:
    apart = [np.abs(array - way * np.array(wanted)).max(-1) for way in ((1, -1) if part == "orientation" else (1,))]
    return bool((np.min(apart, axis=0) < 1e-6).all())


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (altered("velocity", lambda v: 1e3 * v), "`velocity` is not how the position changes: it is in mm/s"),
        (altered("velocity", lambda v: 0 * v), "`velocity` is not how the position changes: it is zero"),
        (altered("angular_velocity", np.degrees), "it is in degrees/s"),
        (altered("angular_velocity", lambda w: 0 * w), "it is zero"),
        (altered("orientation", lambda q: 0 * q + [1, 0, 0, 0]), "is not how the body turns: nothing changes"),
        (
            altered("orientation", lambda q: q * [1, -1, -1, -1]),
            "is not how the body turns: `orientation` turns from space to body",
        ),
        (altered("position", lambda x: x[..., [1, 0, 2]]), "is not how the position changes: it is (y, x, z)"),
        (
            lambda told: {**told, **{k: np.array(told[k])[..., [1, 0, 2]].tolist() for k in ("position", "velocity")}},
            "`position` is in other axes or units: it is (y, x, z)",
        ),
    ],
)
def test_what_a_start_at_rest_does_not_tell_is_named(change: Change, words: str) -> None:
    answer = read_answer(json.dumps(change(good_answer(CASES["incline"]))), CASES["incline"], 1)
    assert answer.outcome == "bad answer"
    assert words in answer.message


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize(("unit", "words"), [(1e3, "it is in mm"), (1e2, "it is in cm"), (1e-3, "it is in km")])
def test_lengths_in_another_unit_are_named(name: str, unit: float, words: str) -> None:
    good = good_answer(CASES[name])
    told = good | {part: (unit * np.array(good[part])).tolist() for part in ("position", "velocity")}
    answer = read_answer(json.dumps(told), CASES[name], 1)
    assert answer.outcome == "bad answer"
    assert words in answer.message or "velocity` at the start" in answer.message


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("far", [1e-4, 1.0, 1e3])
def test_a_motion_that_goes_astray_is_an_answer(name: str, far: float) -> None:
    """It drifts away, and its rates with it: what is wrong is no bad answer, however far it is."""
    good = good_answer(CASES[name])
    t = np.array(good["time"])[:, None, None]
    drift, rate = far * t**3 * [0.3, -0.8, 0.5], far * 3 * t**2 * [0.3, -0.8, 0.5]
    told = {"position": np.array(good["position"]) + drift, "velocity": np.array(good["velocity"]) + rate}
    answer = read_answer(json.dumps(good | {part: array.tolist() for part, array in told.items()}), CASES[name], 1)
    assert (answer.outcome, answer.message) == ("ok", "")


def test_a_body_that_stays_is_an_answer() -> None:
    """An engine may find that nothing moves: it is wrong, and no bad answer."""
    good = good_answer(CASES["incline"])
    stays = {part: np.repeat(np.array(good[part])[:1], 201, axis=0).tolist() for part in PARTS}
    stays["orientation"] = np.float32([[[1.0, 1e-7 * (i % 3), 0.0, 0.0]] for i in range(201)]).tolist()  # it trembles
    assert read_answer(json.dumps(good | stays), CASES["incline"], 1).outcome == "ok"


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


def test_one_that_is_late_is_killed_and_started_again(program: Make, tmp_path: Path) -> None:
    """It waits for ever on the first task, and answers any later one."""
    mark = tmp_path / "mark"
    body = (
        f"late = pathlib.Path({str(mark)!r}); there = late.exists(); late.touch()\n"
        "    time.sleep(0 if there else 3600)\n"
        '    say(cannot="it is tired")'
    )
    with Adapter(program(body), limit=0.01, starting=0.0) as adapter:
        while not mark.exists():  # it may be ended before it has begun to wait
            late = adapter.answer(DRAW, 1e-2)
            assert late.outcome == "too slow"
            assert late.message == f"no answer within {adapter.limit:g} s"
            adapter.limit *= 2
        adapter.limit = 60.0
        assert adapter.answer(DRAW, 1e-2).outcome == "cannot"


def test_a_program_that_is_not_there() -> None:
    with Adapter(["no-such-program"]) as adapter:
        assert "cannot be started" in adapter.answer(DRAW, 1e-2).message
