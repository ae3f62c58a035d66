"""Classes, thresholds and the file of a score; the command."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.conformance.conftest import Make, good_answer

import trundle as tr
from trundle.conformance import Entrant, Row, Score, cases, engines, score
from trundle.conformance.measuring import classify, cut_off, errors_of, order
from trundle.conformance.results import Cell

CASES = {case.name: case for case in cases()}


@pytest.mark.parametrize(
    ("errors", "name"),
    [
        ((3e-2, 3e-3, 3e-4), "converges"),
        ((3e-2, 3e-4, 3e-6), "converges"),
        ((3e-2, 1e-2, 4e-3), "converges slowly"),
        ((3e-2, 2.9e-2, 2.9e-2), "plateaus"),
        ((3e-2, 3e-3, 3e-1), "diverges"),
        ((3e-2, 3e-3, math.inf), "diverges"),
        ((3e-15, 1e-15, 2e-15), "exact"),
        ((3e-6, 3e-8, 2e-11), "converges"),
        ((math.nan, math.nan, math.nan), "no result"),
        ((3e-2, math.nan, math.nan), "one step"),
        ((3e-2, 3e-3, math.nan), "converges"),
    ],
)
def test_one_word_for_the_errors(errors: tuple[float, ...], name: str) -> None:
    assert classify(dict(zip((1e-2, 1e-3, 1e-4), errors, strict=True))) == name


def test_the_order_is_that_of_the_two_finest_steps() -> None:
    assert order(np.array([1e-2, 1e-3, 1e-4]), np.array([1.0, 1e-2, 1e-3])) == pytest.approx(1.0)
    assert order(np.array([1e-2, 1e-3, 1e-4]), np.array([1.0, 1e-2, math.nan])) == pytest.approx(2.0)


def test_a_rate_that_is_cut_off_is_found() -> None:
    exact = CASES["hinged-turntable-tilted"].exact()
    cut = replace(exact, angular_velocity=np.clip(exact.angular_velocity, -100.0, 100.0))
    assert cut_off(exact, cut) == pytest.approx(100.0)
    assert cut_off(exact, exact) is None
    draw = CASES["billiard-draw"].exact()  # it rolls evenly at the end, and nothing is cut off
    assert cut_off(draw, replace(draw, angular_velocity=0.9 * draw.angular_velocity)) is None


ROW = Row("E", "E 1", "as shipped", "", "incline", 1e-2, "ok", "", 1e-2, 0.1, 1e-2, 0.0, 0.0, 0.1, math.nan)


def rows(*errors: float, **changes: object) -> tuple[Row, ...]:
    steps = (1e-2, 1e-3, 1e-4)
    made = (replace(ROW, step=h, position=e, turning=e) for h, e in zip(steps, errors, strict=False))
    return tuple(replace(row, **changes) for row in made)


def test_the_cause_is_the_ablation_that_leaves_least() -> None:
    plateau = rows(1e-1, 1e-1)
    little = rows(1e-1, 1e-2, setting="no damping", of="as shipped")
    nothing = rows(1e-1, 0.9e-1, setting="other", of="as shipped")
    cell = Score(plateau + little + nothing).profiles[0]
    assert (cell.name, cell.cause) == ("plateaus", "no damping")
    assert Score(plateau + nothing).profiles[0].cause == ""
    less = rows(1e-1, 5e-3, setting="no limit", of="as shipped")
    for order_of in (little + less, less + little):
        assert Score(plateau + order_of).profiles[0].cause == "no limit"
    double = rows(1e-1, 1e-2, setting="double precision", of="as shipped")
    assert Score(plateau + double).profiles[0].name == "float32 floor"


def test_a_limit_is_silent_where_it_recurs() -> None:
    first, second = rows(1e-1, 1e-1, limit=100.0)
    assert Score((first, second)).profiles[0].name == "silent limit"
    assert Score((first, replace(second, limit=97.3))).profiles[0].name == "plateaus"


def test_half_a_turn_off_is_astray_and_no_plateau() -> None:
    def cell(*positions: float, angle: float = 3.13, reach: float = math.nan, more: tuple[Row, ...] = ()) -> Cell:
        made = (
            replace(row, position=e, turning=2e-3, angle=angle, reach=reach)
            for row, e in zip(rows(*positions), positions, strict=True)
        )
        return Score((*made, *more)).profiles[0]

    assert cell(1e-3, 1e-4).name == "astray"  # the position falls, and the turning may
    assert cell(1e-3, 1e-3, reach=0.9).name == "astray"  # a stone that stays where it is
    assert cell(1e-3, 1e-3, reach=0.01).name == "plateaus"  # the position could grow, and stays
    assert cell(1e-3, 1e-3, angle=2.0, reach=0.9).name == "plateaus"
    assert cell(1e-2, 1e-2, reach=0.9).name == "plateaus"  # classes go by the position there
    found = rows(2e-3, 1.5e-3, setting="stiff", of="as shipped", angle=1.0)
    assert cell(1e-3, 1e-4, more=found).cause == "stiff"
    assert cell(1e-3, 1e-4, more=tuple(replace(row, angle=3.13, position=0.0) for row in found)).cause == ""


def test_the_reach_of_an_error_is_that_of_the_path() -> None:
    case = CASES["driven-turntable"]
    exact = case.exact()  # a circle: a body that stays at its middle is off by its radius
    middle = np.broadcast_to(exact.position.mean(0), exact.position.shape)
    assert errors_of(case, exact, replace(exact, position=middle)).reach == pytest.approx(1.0, rel=1e-12)


def test_the_spin_that_is_left_is_told_where_a_body_turns_round() -> None:
    case = CASES["rattleback"]
    exact = case.exact()
    assert errors_of(case, exact, exact).spin == 1.0
    half = replace(exact, angular_velocity=exact.angular_velocity * [1.0, 1.0, -0.5])
    assert errors_of(case, exact, half).spin == -0.5
    for name in ("tippe-top", "driven-turntable", "incline"):
        still = CASES[name].exact()
        assert math.isnan(errors_of(CASES[name], still, still).spin)


def test_slipping_is_measured_where_the_centre_rests() -> None:
    case = CASES["eulers-disc"]
    exact = case.exact()
    slid = replace(exact, velocity=exact.velocity + np.array([0.1, 0.0, 0.0]))
    speed = math.sqrt(2 * case.kinetic_energy(exact).max() / 0.4)
    assert errors_of(case, exact, slid).slip == pytest.approx(0.1 / speed, rel=1e-9)


def test_thresholds() -> None:
    falling, flat = rows(1e-2, 1e-3, 1e-4), rows(1e-2, 1e-2, 1e-2, engine="F")
    broken = tuple(
        replace(row, engine="G", position=math.nan, turning=math.nan, outcome="failed", message="it fell over")
        for row in falling
    )
    cannot = tuple(replace(row, engine="H", outcome="cannot") for row in broken)
    found = Score(falling + flat + broken + cannot)
    assert found.failures() == []
    assert [line[0] for line in found.failures(at_most=1e-3)] == ["F", "G"]
    assert [line[0] for line in found.failures(least_order=0.9)] == ["F", "G"]
    assert found.failures(at_most=1e-5)[0] == "E, as shipped, incline: the error is 0.0001 at 0.0001 s, more than 1e-05"


def test_rows_are_read_back_and_compared(tmp_path) -> None:
    old = Score(rows(1e-2, 1e-3) + rows(1e-2, 1e-2, case="dome"))
    old.save(tmp_path / "score.nc")
    read = Score.load(tmp_path / "score.nc")
    plain = dict.fromkeys(
        ("limit", "derivative", "friction", "own", "mesh", "reach", "spin"), 0.0
    )  # no number is equal to nan
    assert [replace(row, **plain) for row in read.rows] == [replace(row, **plain) for row in old.rows]
    new = Score(rows(1e-2, 1e-2))
    assert new.changes_from(read) == ["E, as shipped, incline: converges, now plateaus"]
    assert len(new.with_rows_of(read).rows) == 4
    tr.simulate(
        (system := tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))), system.place(), 1.0, 0.5
    ).save(tmp_path / "run.nc")
    with pytest.raises(tr.TrundleError, match="must hold a score"):
        Score.load(tmp_path / "run.nc")


def test_an_engine_that_cannot_be_installed_is_rows() -> None:
    chosen = [CASES["incline"], CASES["dome"]]
    found = score([Entrant.of_engine("chrono")], chosen, [1e-2, 1e-3])
    assert len(found.rows) == 4
    assert {row.outcome for row in found.rows} == {"not installed"}
    assert "wheel" in str(found)
    assert len(str(found).splitlines()) == 2  # one line for all of it


def test_a_failing_installer_is_said(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The package's own name is no release of anything; --no-index keeps pip off the network."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    engine = engines.Engine("mine", "Mine", ("not-a-package-of-anybody==0.0.1",))
    with pytest.raises(engines.CannotInstallError, match="not-a-package-of-anybody"):
        engine.install()
    assert not engine.installed


def test_every_engine_says_what_it_needs() -> None:
    for name in engines.names():
        engine = engines.engine(name)
        assert engine.cannot or {"as shipped"} <= {each.name for each in engine.profiles}
        assert all("==" in package for package in engine.packages)
        known = {each.name for each in engine.settings}
        assert all(each.of in known for each in engine.ablations)
        assert all(each.source for each in engine.settings if each.name != "as shipped")


def test_our_own_row_is_at_rounding() -> None:
    """By DOP853 here, from the task alone, against the closed form."""
    chosen = [case for name, case in CASES.items() if name.startswith(("billiard", "hinged-turntable", "incline"))]
    found = score([Entrant.of_engine("trundle")], chosen, [1e-2])
    assert {row.outcome for row in found.rows} == {"ok"}
    assert max(row.worst for row in found.rows) <= 1e-12
    assert {cell.name for cell in found.profiles} == {"exact"}


def test_the_cost_is_the_median_of_runs(program: Make, tmp_path: Path) -> None:
    """The program says that each run takes as many seconds as its task has in its number, squared."""
    case = CASES["billiard-draw"]
    motion = {key: part for key, part in good_answer(case).items() if key not in ("task", "seconds")}
    (tmp_path / "motion").write_text(json.dumps(motion))
    command = program(f"say(seconds=task['task']**2, **json.load(open(r'{tmp_path}/motion')))")
    entrant = Entrant.of_command(" ".join(command))
    found = score([entrant], [case], [1e-2], repeat=5).rows[0]
    assert found.seconds == pytest.approx(9 / case.duration)
    assert score([entrant], [case], [1e-2]).rows[0].seconds == pytest.approx(1 / case.duration)
