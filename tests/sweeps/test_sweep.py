"""What a sweep measures, against what is known of each motion; and that neither workers nor chunks change a bit."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.analysis.sweep.engine import Engine
from trundle.analysis.sweep.measures import FAILED, REFUSED, VARIABLES
from trundle.analysis.sweep.plan import read_plan
from trundle.analysis.sweep.varying import DRAWN, Design, read_axes

pytest.importorskip("heyoka")

TABLE = "tilted-turntable"


def measured(run: Any) -> float:
    return float(run.position[-1, 0])


def refusing(run: Any) -> str:
    return str(run)


# --- figures --------------------------------------------------------------------------------------------------------


def test_the_lyapunov_exponent_of_a_ball_on_top_of_a_dome_is_that_of_its_fall() -> None:
    """It falls as exp λt, λ² = 5g/7(R + a); in a finite time λ is that but for a part of 1/λt."""
    tables = {
        "body": {"kind": "solid-sphere", "radius": "2 cm", "mass": "100 g"},
        "support": {"kind": "dome", "radius": "0.5 m"},
        "start": {"position": [0, 0], "velocity": [0, 0]},
        "run": {"duration": "4 s", "every": "50 ms"},
    }
    radii = np.array([0.4, 0.6])
    found = tr.sweep(tr.Scenario.read(tables), {"support.radius": radii}, "lyapunov")
    assert np.allclose(found.lyapunov, np.sqrt(5 / 7 * 9.80665 / (radii + 0.02)), rtol=5e-3)
    assert found.lyapunov.attrs["units"] == "s-1"


def test_the_period_on_a_level_turntable_is_three_and_a_half_turns() -> None:
    """A solid ball's guiding circle: ω = 2Ω/7, theory (T1); found between samples."""
    rates = [2.0, 3.0, 4.5]
    found = tr.sweep("level-turntable-nudged", {"support.motion.rate": rates}, "period x", duration=40.0, every=0.05)
    wanted = 2 * math.pi * 3.5 / np.array(rates)
    assert np.abs(found.dataset["period x"].values - wanted).max() <= 1e-5  # (ω Δt)⁴ of the cubic


@pytest.mark.parametrize("formula", ["x - 0.3", "0.3 - x", "2*x - 0.6"])
def test_a_ball_on_a_level_plane_passes_a_line_at_distance_over_speed(formula: str) -> None:
    ball = {"kind": "solid-sphere", "radius": 0.02, "mass": 0.1}
    scenario = tr.Scenario.read(
        {
            "body": ball,
            "support": {"kind": "plane"},
            "start": {"position": [0, 0], "velocity": [1, 0]},
            "run": {"duration": 2, "every": 0.1},
        }
    )
    speeds = np.array([0.2, 0.4, 0.17, 0.1])
    found = tr.sweep(scenario, {"start.velocity[0]": speeds}, {"when": f"first {formula}", "mean": "mean x"})
    reached = speeds * 2 > 0.3
    assert np.array_equal(np.isfinite(found.when.values), reached)
    assert np.abs(found.when.values - 0.3 / speeds)[reached].max() <= EXACT(64, 2.0)
    assert np.abs(found.mean.values - speeds).max() <= EXACT(64, 1.0)


def test_a_sliding_ball_grips_when_two_sevenths_of_its_speed_are_gone() -> None:
    """Coulomb: t = 2V/(7 μ g), and 1/7 m V² is lost."""
    V, mu = np.array([0.5, 1.0]), np.array([0.1, 0.2, 0.4])
    scenario = tr.Scenario.read(
        {
            "body": {"kind": "solid-sphere", "radius": 0.02, "mass": 0.1},
            "support": {"kind": "plane", "friction": 0.3},
            "start": {"position": [0, 0], "velocity": [1, 0], "angular_velocity": [0, 0, 0]},
            "run": {"duration": 1, "every": 0.01},
        }
    )
    found = tr.sweep(
        scenario,
        {"start.velocity[0]": V, "support.friction": mu},
        {"grips": "count grip", "when": "time grip", "lost": "energy-lost", "slips": "count slip"},
    ).dataset
    assert found.when.dims == ("start.velocity[0]", "support.friction")
    wanted = 2 * V[:, None] / (7 * mu * 9.80665)
    assert np.abs(found.when - wanted).max() <= SOLVER(100, 1e-15, 1.0)
    assert (found.grips == 1).all()
    assert (found.slips == 0).all()
    assert np.abs(found.lost - (0.1 * V**2 / 7)[:, None]).max() <= SOLVER(1000, 1e-15, 0.1)
    assert found.when.attrs["units"] == "s"
    assert found.lost.attrs["units"] == "J"


def test_a_member_is_the_run_of_its_scenario() -> None:
    over = {"support.tilt": [0.0, 0.01], "start.position[0]": [0.05, 0.1], "body.radius": [0.02, 0.03]}
    every = {f"end {name}": name for name in VARIABLES}
    found = tr.sweep(TABLE, over, list(every), duration=1.0, every=0.1, keep="samples")
    base = tr.Scenario.load(TABLE).model_dump(exclude_unset=True, by_alias=True)
    for place in np.ndindex(2, 2, 2):
        tilt, x, a = (float(values[i]) for values, i in zip(over.values(), place, strict=True))
        tables = {**base, "support": {**base["support"], "tilt": tilt}, "body": {**base["body"], "radius": a}}
        tables["start"] = {**base["start"], "position": [x, base["start"]["position"][1]]}
        run = tr.Scenario.read(tables).run(duration=1.0, every=0.1)
        mine = found.dataset.isel(dict(zip(over, place, strict=True)))
        for name in ("position", "velocity", "angular_velocity", "orientation", "contact_force"):
            assert np.abs(mine[name].values - run.data[name].values).max() <= SOLVER(1000, 1e-15, 10.0), name
        samples = run.samples
        from trundle.verify.energy import energy

        assert abs(float(mine["end energy"]) - energy(run.system, samples)[-1]) <= 1e-13
        assert float(mine["end y"]) == float(mine.position[-1, 1])


def test_the_tilt_is_that_of_the_attitude() -> None:
    leans = [0.05, 0.3, 1.2]
    found = tr.sweep(
        "tippe-top", {"start.attitude[1]": leans}, ["start tilt", "turned-over"], duration=0.01, every=0.01
    )
    assert np.abs(found.dataset["start tilt"].values - leans).max() <= EXACT(8, 1.0)
    assert (found.dataset["turned-over"] == 0).all()
    assert found.dataset["turned-over"].attrs["flag_meanings"] == "- no yes"


def test_a_function_of_the_users_sees_one_run() -> None:
    found = tr.sweep(TABLE, {"gravity": [9.8, 9.9]}, [measured, "end x"], duration=1.0, every=0.5)
    assert np.array_equal(found.dataset.measured, found.dataset["end x"])
    with pytest.raises(tr.TrundleError, match="must return a number"):
        tr.sweep(TABLE, {"gravity": [9.8]}, refusing, duration=1.0, every=0.5)


def test_a_member_that_cannot_be_is_a_row_that_says_why() -> None:
    """One off the table, and one whose load has no value on its way; the others are what they are alone."""
    found = tr.sweep(TABLE, {"start.position[0]": [0.1, 0.9]}, ["end x", "ending"], duration=1.0, every=0.5).dataset
    assert found.status.values.tolist() == [1, REFUSED]
    assert "rim" in str(found.reason.values[1])
    assert np.isnan(found["end x"].values[1])
    assert found.ending.values[1] == -1
    alone = tr.sweep(TABLE, {"start.position[0]": [0.1]}, ["end x"], duration=1.0, every=0.5).dataset
    assert alone["end x"].values[0] == found["end x"].values[0]
    assert FAILED == 3


# --- designs --------------------------------------------------------------------------------------------------------


def test_draws_fill_what_they_are_drawn_from() -> None:
    axes = read_axes(
        {"gravity": {"uniform": [9, 10]}, "body.mass": {"normal": [0.1, 0.01]}, "support.tilt": "1 ± 0.5 deg"},
        tr.Scenario.load(TABLE),
    )
    for name in DRAWN:
        table = Design(name, 1024, 3).table(axes)[:1024]
        g, m, tilt = table.T
        assert 9 < g.min() < 9.05 < 9.95 < g.max() < 10
        assert abs(m.mean() - 0.1) < 0.001
        assert abs(m.std() - 0.01) < 0.001
        assert abs(np.degrees(tilt).mean() - 1) < 0.05
        assert np.array_equal(table, Design(name, 1024, 3).table(axes)[:1024])
        assert not np.array_equal(table, Design(name, 1024, 4).table(axes)[:1024])


def test_together_takes_the_first_of_each_and_a_table_is_read(tmp_path: Path) -> None:
    table = tmp_path / "members.csv"
    table.write_text("support.tilt (deg),start.position[0]\n1,5 cm\n2 deg,0.1 m\n")
    one = tr.sweep(TABLE, measure="end x", table=table, duration=1.0, every=0.5)
    over = {"support.tilt": ["1 deg", "2 deg"], "start.position[0]": [0.05, 0.1]}
    other = tr.sweep(TABLE, over, "end x", design="together", duration=1.0, every=0.5)
    assert one.data["end x"].dims == ("member",)
    assert np.array_equal(one.data["end x"], other.data["end x"])
    assert np.allclose(one.data["support.tilt"], np.radians([1, 2]), rtol=1e-15)


def test_text_without_a_unit_is_never_si_in_silence(tmp_path: Path) -> None:
    """In a table a cell without a unit is refused; a unit that stands once in a range stands for both of its ends."""
    table = tmp_path / "members.csv"
    table.write_text("support.tilt,body.mass\n1,1 kg\n2 deg,2\n")
    with pytest.raises(
        tr.InvalidValueError, match=r"`table.support.tilt` must have a unit.*support.tilt \(rad\)"
    ) as told:
        tr.sweep(TABLE, measure="end x", table=table)
    assert "table.body.mass" in str([str(one) for one in told.value.others])
    table.write_text("support.friction,support.tilt\n0.1,1 deg\n0.2,2 deg\n")
    document = tr.Scenario.load("incline-with-slip")
    assert read_plan({"measure": "end x", "table": table}, document=document).table[:, 0].tolist() == [0.1, 0.2]
    for spec in ({"from": "1", "to": "2 deg", "count": 2}, {"from": "1 deg", "to": "2", "count": 2}):
        plan = read_plan({"scenario": TABLE, "measure": "end x", "over": {"support.tilt": spec}})
        assert np.allclose(plan.table[:, 0], np.radians([1, 2]), rtol=1e-15)
    for spec in ({"from": "1", "to": "2", "count": 2}, ["1", "2 deg"]):
        with pytest.raises(tr.InvalidValueError, match="with its unit"):
            tr.sweep(TABLE, {"support.tilt": spec}, "end x")


# --- the same to the last bit ---------------------------------------------------------------------------------------


def test_neither_chunks_nor_company_change_a_bit() -> None:
    """Zeros among the numbers, members that end at the rim, and a last block that is not full."""
    over = {"support.tilt": [0.0, 0.01, 0.02], "start.position[0]": np.linspace(0.05, 0.3, 60)}
    given: dict[str, Any] = {"duration": 2.0, "every": 0.1, "keep": 5}
    runs = [tr.sweep(TABLE, over, ["end x", "energy-lost"], chunk=chunk, **given).data for chunk in (1, 100, 10_000)]
    assert len({run.attrs["chunk"] for run in runs}) == 3
    for run in runs[1:]:
        for name in run.data_vars:
            assert run[name].equals(runs[0][name]), name


def test_two_processes_give_the_same_bits() -> None:
    over = {"start.position[0]": np.linspace(0.05, 0.3, 24)}
    runs = [tr.sweep(TABLE, over, "end x", duration=1.0, every=0.5, workers=count).data for count in (1, 2)]
    assert runs[0].equals(runs[1])


# --- what is refused before anything runs ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tables", "says"),
    [
        ({"over": {"support.tlit": [1]}}, "Did you mean 'support.tilt'"),
        ({"over": {"support.tilt": ["1 m"]}}, r"`over.support.tilt\[0\]` must be an angle"),
        ({"over": {"support.tilt": {"from": 0}}}, "`over.support.tilt.to` must be given"),
        ({"over": {"support.tilt": {"from": 0, "to": 1, "cuont": 3}}}, "cuont"),
        ({"over": {"support.tilt": {"from": 0, "to": 1, "count": 3, "scale": "log"}}}, "logarithmic"),
        ({"over": {"support.tilt": {"from": 0, "to": 1}}}, "how many values"),
        ({"over": {"support.friction": [-0.1, 0.3]}}, "`over.support.friction` must not be negative; got -0.1"),
        ({"over": {"start.attitude[1]": [0.1]}}, "Write `start.attitude` into the scenario first"),
        ({"over": {}}, "must be a table of what varies"),
        ({"measure": "max hypot(x, t)"}, "m and s come together"),
        ({"measure": "max q"}, "must be a formula in t, x"),
        ({"measure": "mxa x"}, "Did you mean 'max'"),
        ({"measure": "count slips"}, "Did you mean 'slip'"),
        ({"measure": "max"}, "must have a formula"),
        ({"measure": {}}, "must name what is measured"),
        ({"measure": {"status": "max x"}}, "taken"),
        ({"design": "sobl"}, "Did you mean 'sobol'"),
        ({"design": "sobol"}, "`members` must be a whole number"),
        ({"design": "sobol", "members": 100}, "power of 2"),
        ({"members": 5}, "`members` must not be given"),
        ({"seed": -1}, "`seed`"),
        ({"keep": "all"}, "`keep`"),
        ({"chunk": 0}, "`chunk`"),
        ({"scenrio": 1}, "Did you mean 'scenario'"),
        ({"scenario": "tilted-turntabel"}, "Did you mean 'tilted-turntable'"),
        ({"run": {"every": "0.1 m"}}, "`run.every`"),
    ],
)
def test_what_is_wrong_is_told_before_anything_runs(tables: dict[str, Any], says: str) -> None:
    good = {"scenario": TABLE, "over": {"gravity": [9.8]}, "measure": "end x"}
    assert read_plan(good).members == 1
    with pytest.raises((tr.InvalidValueError, tr.UnknownNameError), match=says):
        read_plan({**good, **tables}, "my.toml")


def test_all_that_is_wrong_is_told_at_once() -> None:
    tables = {"scenario": TABLE, "over": {"gravity": ["1 m"], "body.mas": [1]}, "measure": ["mxa x"], "keep": -1}
    with pytest.raises(tr.ScenarioError) as told:
        read_plan(tables, "my.toml")
    assert str(told.value).count("my.toml: `") == 4


def test_it_reads_back_what_it_writes() -> None:
    """Tables and lists in one order, keys with brackets, and all kinds of values."""
    over = {
        "support.tilt": {"from": "0 deg", "to": "1 deg", "count": 2},
        "start.position[0]": np.array([0.1, 0.2]),
        "gravity": (9.8, 9.9),
    }
    plan = read_plan({"scenario": TABLE, "over": over, "measure": {"a": "max x", 'b "b"': "end t"}})
    again = read_plan(tomllib.loads(plan.text))
    assert [axis.key for axis in again.axes] == list(over)
    assert np.array_equal(again.table, plan.table)
    assert again.measures == plan.measures
    assert again.text == plan.text


def test_a_function_that_cannot_travel_is_refused_where_it_has_to() -> None:
    with pytest.raises(tr.InvalidValueError, match="must be a function of a module"):
        tr.sweep(TABLE, {"gravity": [9.8]}, lambda _: 1.0, workers=2)
    assert Engine(1).processes == 1


def test_it_shows_itself_and_draws() -> None:
    over = {"start.position[0]": [0.1, 0.2, 0.9], "support.tilt": [0.0, 0.01]}
    found = tr.sweep(TABLE, over, ["max x", "ending"], duration=1.0, every=0.5)
    assert "6 members, 2 refused" in str(found)
    assert "max x" in found._repr_html_()
    assert len(found.plot("max x").axes) == 2
    assert found.plot("ending").legends[0].get_texts()[0].get_text() == "none"
    with pytest.raises(tr.UnknownNameError, match="unknown measure"):
        found.plot("min x")
    with pytest.raises(tr.UnknownNameError, match="unknown variable of the sweep"):
        _ = found.nothing
