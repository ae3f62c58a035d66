"""Derivatives of the final state: the exact ones, what an adapter is told and answers, and differences of its runs."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.conformance.conftest import Make, good_answer
from tests.conformance.test_score import rows

from trundle.conformance import Case, Entrant, Score, cases, score
from trundle.conformance.answers import read_answer
from trundle.conformance.case import END, Input
from trundle.conformance.derivatives import compared
from trundle.simulation.netcdf import write_dataset

CASES = {case.name: case for case in cases()}
DRAW = CASES["billiard-draw"]


def answered(inputs: tuple[Input, ...], factor: float = 1.0) -> list[Any]:
    """What an adapter would answer whose derivatives are the exact ones times a factor."""
    each = (np.split(factor * one.exact, 3, axis=1) for one in inputs)
    return [{part: array.tolist() for part, array in zip(END, arrays, strict=True)} for arrays in each]


def by(case: Case) -> dict[str, Input]:
    return {each.name: each for each in case.inputs()}


def test_a_ball_that_is_drawn_back() -> None:
    """It slips by s = V - Ω_y a under μ g for the time t = 2 s/(7 μ g), and rolls on at V - (2/7) s."""
    V, Omega, mu, g, a, T = 2.0, -60.0, 0.2, 9.80665, 0.025, 2.0
    s = V - Omega * a
    t = 2 * s / (7 * mu * g)
    # x(T) = V t - μ g t²/2 + (V - 2 s/7) (T - t) = V T - (2 s/7) T + (s/7) t, with t as 1/μ and as s
    found = by(DRAW)
    assert found["start.velocity[0]"].exact[0, [0, 3]] == pytest.approx([5 / 7 * T + 2 / 7 * t, 5 / 7], rel=1e-12)
    assert found["support.friction"].exact[0, 0] == pytest.approx(-s / 7 * t / mu, rel=1e-12)
    assert found["start.position[1]"].exact == pytest.approx(np.eye(9)[1:2], abs=1e-14)


def test_a_box_that_is_pushed() -> None:
    """By differences of the equations of all bodies, which know nothing of the formula."""
    for name in ("pushed-box", "diagonal-box"):
        found = by(CASES[name])
        assert list(found) == ["force", "direction", "friction", "gravity"]
        for each in found.values():
            h = 1e-4 * each.size
            ends = [each.moved(way * h).exact("runge-kutta") for way in (-1, 1)]
            below, above = (np.concatenate([getattr(end, part)[-1] for part in END], axis=1) for end in ends)
            assert (above - below) / (2 * h) == pytest.approx(each.exact, rel=1e-6, abs=1e-6)
        # dv/dF = T/(M + n m k/(1 + k)), by hand
        assert np.linalg.norm(found["force"].exact[0, 3:6]) == pytest.approx(1.0 / (10 + 25 * 2 / 7), rel=1e-12)


@pytest.mark.parametrize("name", ["hinged-turntable-tilted", "coin-in-a-circle", "billiard-swerve", "pushed-box"])
def test_a_direction_is_how_the_task_changes(name: str) -> None:
    """Every number of the task, by differences of tasks."""

    def numbers(told: Any) -> list[float]:
        if isinstance(told, (dict, list)):
            return [x for part in (told.values() if isinstance(told, dict) else told) for x in numbers(part)]
        return [] if isinstance(told, str) else [told]

    for each in CASES[name].inputs():
        h = 1e-5 * each.size
        below, above = (np.array(numbers(each.moved(way * h).situation())) for way in (-1, 1))
        slopes = np.array(numbers(each.direction))
        assert (above - below) / (2 * h) == pytest.approx(slopes, rel=1e-6, abs=1e-6)
        assert np.abs(slopes).max() > 0


def test_a_body_that_leaves_its_support_has_none() -> None:
    assert CASES["bounce-with-spin"].inputs() == ()


def test_our_own_derivatives_are_at_rounding() -> None:
    """From the task alone; the exact one of the incline comes of its formula. Differences are as good as their step."""
    ours = Entrant.of_engine("trundle")
    found = score([replace(ours, settings=ours.settings[:1])], [DRAW, CASES["incline"]], [1e-2], derivatives=True)
    own = {(cell.setting, cell.case, cell.way): cell.finest.worst for cell in found.derivatives}
    assert len(own) == 2 * 3
    assert max(error for (*_, way), error in own.items() if way == "variational equations") < 1e-12
    assert max(error for (*_, way), error in own.items() if way.endswith("1e-05")) < 1e-8
    assert {cell.name for cell in found.motions} == {"exact"}


def test_an_adapter_says_which_it_has(program: Make, tmp_path: Path) -> None:
    inputs = DRAW.inputs()
    off = [answered(inputs, 1.01), ["no"] * len(inputs)]
    off[0][0] = "none by gravity"
    motion = {key: part for key, part in good_answer(DRAW).items() if key != "task"}
    both = motion | {"derivatives": dict(zip(("forward", "reverse"), off, strict=True))}
    for name, told in (("motion", motion), ("both", both)):
        (tmp_path / name).write_text(json.dumps(told))
    files = f"open(r'{tmp_path}/' + ('both' if 'derivatives' in task else 'motion'))"
    command = program(f"say(**json.load({files}))")
    found = score([Entrant.of_command(" ".join(command))], [DRAW], [1e-2], derivatives=True)
    cells = {cell.way: cell for cell in found.profiles if cell.setting == "best"}
    assert list(cells) == ["", "forward", "reverse", "differences of runs by 0.001", "differences of runs by 1e-05"]
    assert cells["forward"].finest.worst == pytest.approx(0.01)
    assert cells["forward"].finest.message == "gravity: none by gravity"
    assert cells["reverse"].name == "cannot"


def test_an_adapter_without_derivatives_cannot(program: Make, tmp_path: Path) -> None:
    (tmp_path / "motion").write_text(
        json.dumps({k: v for k, v in good_answer(CASES["incline"]).items() if k != "task"})
    )
    command = program(f"say(**json.load(open(r'{tmp_path}/motion')))")
    found = score([Entrant.of_command(" ".join(command))], [CASES["incline"]], [1e-2], derivatives=True)
    first = found.derivatives[0]
    assert (first.name, first.finest.message) == ("cannot", "it gives no derivatives of its own")


@pytest.mark.parametrize(
    ("told", "words"),
    [
        ([], "must be an object"),
        ({"forward": []}, "a list of 6"),
        ({"forward": [3.0] * 6}, "forward, gravity: must be an object, or a text"),
        ({"forward": [{"position": [[0.0] * 3]}] * 6}, "`velocity` is missing"),
        ({"forward": [{part: [[0.0] * 4] for part in END}] * 6}, r"`position` must have the shape \(1, 3\)"),
    ],
)
def test_bad_derivatives_are_named(told: Any, words: str) -> None:
    case = CASES["incline"]
    answer = read_answer(json.dumps(good_answer(case) | {"derivatives": told}), case, 1, case.inputs())
    assert answer.outcome == "bad answer"
    assert re.search(words, answer.message)


def test_what_is_not_finite_counts_as_missing() -> None:
    case = CASES["incline"]
    inputs = case.inputs()
    told = answered(inputs)
    told[0]["velocity"] = [[math.nan] * 3]
    answer = read_answer(json.dumps(good_answer(case) | {"derivatives": {"forward": told}}), case, 1, inputs)
    result = compared(case, inputs, answer.derivatives["forward"])
    assert (result.outcome, result.message) == ("ok", "gravity: they are not finite")
    assert result.error < 1e-15


def test_an_older_file_is_read(tmp_path: Path) -> None:
    write_dataset(Score(rows(1e-2, 1e-3)).data.drop_vars(["way", "derivative", "friction"]), tmp_path / "score.nc")
    assert [row.way for row in Score.load(tmp_path / "score.nc").rows] == ["", ""]
