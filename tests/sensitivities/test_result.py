"""What is returned: labels, units, the comparison that may fail, and its words."""

from __future__ import annotations

import json
import math
import re
from functools import cache
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.analysis.sensitivities import by_formula, following
from trundle.analysis.sensitivities.keys import keys
from trundle.solve import taylor


@cache
def found() -> tr.Sensitivities:
    return tr.sensitivities("off-the-rim", wrt=["support.tilt", "start.position", "support.rim"])


def test_it_is_a_labelled_dataset() -> None:
    data = found().data
    names = ["support.tilt", "start.position[0]", "start.position[1]", "support.rim"]
    assert data.parameter.values.tolist() == names
    assert data.unit.values.tolist() == ["rad", "m", "m", "m"]
    assert data.position.dims == ("time", "axis", "parameter")
    assert data.orientation.dims == ("time", "quaternion", "parameter")
    assert data.position.attrs["units"] == "m per unit of the parameter"
    assert found().position.sel(parameter="support.tilt").dims == ("time", "axis")
    assert found()["velocity"].identical(data.velocity)
    assert np.isfinite(data.position.values).all()


def test_an_unknown_variable_is_refused_with_those_that_there_are() -> None:
    with pytest.raises(tr.UnknownNameError, match="position"):
        _ = found().places


def test_when_the_ball_runs_off_depends_on_the_rim() -> None:
    # The ball reaches the rim at a speed towards it: dt*/d(rim) is one over that.
    run = tr.Scenario.load("off-the-rim").run("taylor")
    state = run.events[-1].before
    (x, y, _), (u, v, _) = state.position, state.velocity
    outwards = (x * u + y * v) / math.hypot(x, y)
    slope = float(found().event_time.sel(parameter="support.rim").values[-1])
    assert abs(slope - 1 / outwards) <= 1e-11 * abs(slope)


def test_rounding_is_not_shown_as_a_slope() -> None:
    """When a superball lands does not depend on its radius; nor does the speed with which it has come back."""
    ball = tr.sensitivities("superball", wrt=["body.radius", "start.height"], compared=False)
    assert 0 < np.abs(ball.event_time.values[:, 0]).max() < 1e-12
    lines = str(ball).splitlines()
    assert any(line.startswith("body.radius") and line.endswith("(0, 0, 0)") for line in lines)
    landings = [line for line in lines if line.startswith("land")]
    assert landings
    assert all("moves by 0 s per m of body.radius, " in line for line in landings)
    assert not any(" 0 s per m of start.height" in line for line in landings)


def test_a_slope_of_a_number_that_is_zero_is_shown() -> None:
    dropped = tr.sensitivities("turntable-drop", wrt="start.position[1]", duration="1 s", compared=False)
    assert "nan" not in str(dropped)
    small = tr.sensitivities("off-the-rim", wrt="start.position[1]", compared=False)
    assert float(small.data.value.values[0]) == 0
    assert "moves by 0 s" not in str(small)


def test_a_run_has_the_derivatives_of_its_scenario() -> None:
    scenario = tr.Scenario.load("tilted-turntable")
    run = scenario.run(duration=2.0, every=0.5)
    of_run = tr.sensitivities(run, "support.tilt", compared=False)
    of_scenario = tr.sensitivities(scenario, "support.tilt", duration=2.0, every=0.5, compared=False)
    assert np.array_equal(of_run.position, of_scenario.position)
    assert np.array_equal(of_run.data.time, run.data.time)


def test_a_system_made_in_python_is_differentiated_by_its_words() -> None:
    table = tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.02)
    system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.025, mass=0.065), table)
    run = tr.simulate(system, system.place(position=(0.1, 0.0), velocity=(0.0, 0.2)), duration=2.0, every=0.5)
    assert tr.sensitivities(run, ["support.tilt", "start.velocity"]).passed


def test_the_comparison_agrees_where_all_is_well() -> None:
    assert found().passed
    assert found().agreement.apart < 1e-8
    assert "agrees with differences of runs" in str(found())


@pytest.mark.parametrize("method", ["auto", "variational"])
def test_a_fault_in_the_derivatives_fails_the_comparison(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def off(slopes: Any) -> Any:
        return {name: values * (1 + 1e-4) for name, values in slopes.items()}

    for place, name in ((following, "slopes_of_samples"), (by_formula, "stacked_slopes")):
        right = getattr(place, name)
        monkeypatch.setattr(place, name, lambda *given, right=right: off(right(*given)))
    wrong = tr.sensitivities("tilted-turntable", "support.tilt", duration=1.0, method=method)
    assert wrong.passed is False
    assert "differs from differences of runs" in str(wrong)


def test_where_runs_part_as_far_as_they_can_there_is_no_verdict() -> None:
    """A derivative that grows by e³ a second is right for long after a difference of runs has ended in their size."""
    text = tr.Scenario.load("chaplygin-ball-on-turntable").to_toml()
    fast = tr.Scenario.loads(re.sub(r"(?m)^rate = .*$", "rate = 67.9", text))
    result = tr.sensitivities(fast, "body.mass", duration=10.0, every=0.05)
    assert float(abs(result.position[-1]).max()) > 1e6
    assert result.passed is None
    assert "the motion parts too fast" in str(result)


def test_numbers_at_a_limit_are_left_out_of_the_comparison_and_named() -> None:
    result = tr.sensitivities("superball", ["support.restitution", "start.velocity"], duration=1.0)
    assert result.agreement.left_out == ("support.restitution",)
    assert "support.restitution apart" in str(result)


def test_numbers_that_cannot_all_change_at_once_are_compared_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """A half-cylinder may be tilted, or pushed along its axis; with both it would not roll straight."""
    tables = {
        "body": {"kind": "half-cylinder", "radius": 0.1, "mass": 2.0},
        "support": {"kind": "plane"},
        "start": {"position": [0, 0], "velocity": [0, 0]},
        "run": {"duration": 0.5, "every": 0.1},
    }
    scenario, wanted = tr.Scenario.read(tables), ["support.tilt", "start.velocity[1]", "gravity"]
    result = tr.sensitivities(scenario, wanted)
    assert result.passed
    assert not result.agreement.left_out
    right = following.slopes_of_samples

    def off(*given: Any) -> Any:
        return {name: values * np.array([1.0, 1.0 + 1e-4, 1.0]) for name, values in right(*given).items()}

    monkeypatch.setattr(following, "slopes_of_samples", off)
    assert tr.sensitivities(scenario, wanted).passed is False


def test_without_anything_to_compare_there_is_no_verdict() -> None:
    result = tr.sensitivities("superball", "support.restitution", duration=1.0)
    assert result.passed is None
    assert "not compared" in str(result)


def test_json_holds_what_the_table_does() -> None:
    read = json.loads(json.dumps(found().as_dict()))
    assert [one["name"] for one in read["parameters"]] == found().data.parameter.values.tolist()
    assert read["events"][0]["kind"] == "rim"
    assert read["passed"] is True


def test_both_ways_are_the_same() -> None:
    for name in ("tilted-turntable", "ball-under-torque", "hollow-ball-turntable"):
        scenario = tr.Scenario.load(name)
        wrt = [key.name for key in keys(scenario)]
        exact, steps = (
            tr.sensitivities(scenario, wrt, duration=5.0, every=0.5, method=method, compared=False)
            for method in ("auto", "variational")
        )
        assert (exact.method, steps.method) == ("exact", "variational")
        for quantity in ("position", "velocity", "angular_velocity", "orientation", "contact_force", "contact"):
            size = np.abs(steps[quantity].values).max(axis=(0, 1))
            values = np.abs(exact.data[quantity].values).max()
            apart = np.abs(exact[quantity].values - steps[quantity].values).max(axis=(0, 1))
            assert (apart <= 1e-9 * size + 1e-12 * values).all(), (name, quantity)


def test_without_heyoka_they_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    given: Any = {"wrt": ["support.friction", "start.velocity"], "duration": 0.6, "every": 0.1}
    right = tr.sensitivities("billiard-draw", **given)
    monkeypatch.setattr(taylor, "available", lambda: False)
    found = tr.sensitivities("billiard-draw", **given)
    assert found.passed
    size = np.abs(right.velocity.values).max()
    assert np.abs(found.velocity.values - right.velocity.values).max() <= 1e-9 * size
