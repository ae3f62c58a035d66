"""What has no derivative is refused in words that say why, and what there is instead."""

from __future__ import annotations

import math
from typing import Any

import pytest
from tests.additions import Ball

import trundle as tr


def refusal(wrt: Any, scenario: Any = "tilted-turntable", **given: Any) -> str:
    """Return the words with which derivatives are refused."""
    with pytest.raises(tr.TrundleError) as raised:
        tr.sensitivities(scenario, wrt, **given)
    return str(raised.value)


def level(**changed: Any) -> dict[str, Any]:
    """Return a scenario of a ball on a level table with some tables changed."""
    tables = {
        "body": {"kind": "solid-sphere", "radius": 0.025, "mass": 0.065},
        "support": {"kind": "plane", "motion": {"kind": "spin", "rate": 3.5}},
        "start": {"position": [0.1, 0.0], "velocity": [0.0, 0.2]},
        "run": {"duration": 4.0, "every": 0.1},
    }
    return {**tables, **changed}


def test_an_unknown_key_is_refused_with_those_that_there_are() -> None:
    said = refusal("support.tild")
    assert "Did you mean 'support.tilt'?" in said
    assert "body.radius" in said


def test_a_part_of_a_key_is_no_key() -> None:
    assert "There are:" in refusal("support")
    assert "There are:" in refusal("start.vel")


def test_nothing_to_differentiate_by_is_refused() -> None:
    assert "must name a number" in refusal([])
    assert "got 3" in refusal([3])


@pytest.mark.parametrize(
    ("wrt", "why"),
    [
        ("start.spin", "Write `start.spin` into the scenario first"),
        ("start.height", "cannot be a little lower"),
        ("support.kind", "There are:"),
    ],
)
def test_a_number_that_is_not_there_is_refused(wrt: str, why: str) -> None:
    assert why in refusal(wrt)


@pytest.mark.parametrize(
    ("wrt", "why"),
    [
        ("body.inertia_ratio", 'It belongs to [body] of kind "sphere" or'),
        ("support.ring_radius", 'It belongs to [support] of kind "torus-track".'),
        ("support.motion.angle", "It belongs to [support.motion] of kind"),
        ("loads.coefficient", 'It belongs to [loads] of kind "drag" or'),
    ],
)
def test_a_number_of_another_kind_is_told_where_it_is(wrt: str, why: str) -> None:
    said = refusal(wrt, tr.Scenario.read(level()))
    assert f"must name numbers that the scenario gives; got '{wrt}'" in said
    assert why in said


def test_a_formula_has_no_derivative() -> None:
    said = refusal("support.motion.rate", "turntable-starting-up")
    assert "a motion has no derivative by a text" in said


def test_a_word_has_no_derivative() -> None:
    assert 'start.velocity = "co-rotating"'.replace('"', "'") in refusal("start.velocity", "level-turntable-corotating")


def test_an_angular_velocity_that_must_agree_with_rolling_cannot_change_alone() -> None:
    start = {"position": [0.1, 0.0], "velocity": [0.1, 0.0], "angular_velocity": [0.0, 4.0, 1.0]}
    on_table = level(support={"kind": "plane"}, start=start)
    said = refusal("start.angular_velocity", tr.Scenario.read(on_table))
    assert "without making a body slip" in said
    assert "`spin`" in said
    # As it says: the velocity follows, and x grows by a·∂Ω_y.
    follows = tr.Scenario.read({**on_table, "start": {**start, "velocity": "rolling"}})
    slopes = tr.sensitivities(follows, "start.angular_velocity[1]")
    assert slopes.passed
    moved = slopes.data.position.sel(axis="x").values.squeeze()
    assert moved == pytest.approx(0.025 * slopes.data.time.values, abs=1e-12)


def test_turning_that_begins_against_a_resistance_has_no_derivative() -> None:
    loads = [{"kind": "rolling-resistance", "offset": 0.002}]
    start = {"position": [0.1, 0.0], "velocity": [1.0, 0.2], "angular_velocity": [0, 0, 0]}
    slides = level(support={"kind": "plane", "friction": 0.2}, loads=loads, start=start)
    assert "does not turn at the start" in refusal("start.angular_velocity", tr.Scenario.read(slides))
    rests = level(support={"kind": "plane"}, loads=loads, start={"position": [0.1, 0.0], "velocity": [0, 0]})
    assert "does not turn at the start" in refusal("start.velocity", tr.Scenario.read(rests))
    assert tr.sensitivities(tr.Scenario.read(rests), "start.position").passed


@pytest.mark.parametrize("phase", ["-90 deg", "90 deg"])
@pytest.mark.parametrize("rate", [-9.0, 20.0])
def test_nor_has_what_a_table_that_stands_for_an_instant_turns(phase: str, rate: float) -> None:
    """There cos 90° is a rounding and not 0: beside it the body does not turn, however little else moves."""
    rocks = {"kind": "rock", "amplitude": 1.4, "rate": rate, "phase": phase, "axis": [0.3, 0.2, 1.0]}
    support = {"kind": "plane", "friction": 0.27, "motion": rocks}
    loads = [{"kind": "rolling-resistance", "offset": 0.001}]
    run = {"duration": 0.05, "every": 0.01}
    begins = tr.Scenario.read(level(support=support, loads=loads, run=run, start={"position": [0.1, 0.02]}))
    assert "does not turn at the start" in refusal("support.motion.phase", begins)
    assert tr.sensitivities(begins, "support.motion.amplitude").passed


@pytest.mark.parametrize("friction", [None, 0.2, 0.0])
@pytest.mark.parametrize("velocity", [[0.3, 0.1, 0.0], [0.0, 0.0, 0.0]])
def test_a_velocity_off_the_support_has_no_derivative_where_a_body_touches(
    friction: float | None, velocity: list[float]
) -> None:
    """The least of it lifts the body off, or makes it strike; a body above the support has it."""
    support = {"kind": "plane"} if friction is None else {"kind": "plane", "friction": friction}
    rolls = [-velocity[1] / 0.025, velocity[0] / 0.025, 1.0]
    start = {"position": [0.1, 0.0], "velocity": velocity, "angular_velocity": [0, 0, 1.0] if friction else rolls}
    touches, flies = (
        tr.Scenario.read(level(support=support, start={**start, "height": height})) for height in (0.0, 0.01)
    )
    assert "change alone without" in refusal("start.velocity[2]", touches)
    assert tr.sensitivities(flies, "start.velocity[2]", duration=0.02, every=0.01).passed


def test_friction_with_nothing_to_spare_is_on_the_brink() -> None:
    alpha = 0.3
    exactly = 2 / 7 * math.tan(alpha)  # what a solid ball takes to roll down
    support = {"kind": "plane", "tilt": alpha, "friction": exactly}
    said = refusal("support.tilt", tr.Scenario.read(level(support=support, start={"position": [0, 0]})))
    assert "nothing to spare" in said


def test_an_event_that_is_only_just_reached_is_named() -> None:
    scenario = tr.Scenario.read(level())
    form = tr.simulate(scenario.system(), scenario.start_state(), 1.0, 0.5).closed_form
    x, y = form.guiding_centre(0.0)
    farthest = math.hypot(x, y) + form.circle_radius
    support = {"kind": "plane", "rim": farthest * (1 - 1e-13), "motion": {"kind": "spin", "rate": 3.5}}
    grazing = tr.Scenario.read(level(support=support, run={"duration": 20.0, "every": 0.1}))
    assert grazing.run("taylor").events
    assert "only just reached" in refusal("start.velocity", grazing, method="variational")


def test_a_run_has_its_own_samples() -> None:
    run = tr.Scenario.read(level()).run()
    assert "a run has its own samples" in refusal("body.mass", run, duration=1.0)


def test_a_run_of_a_part_of_ones_own_has_no_keys() -> None:
    support = tr.Support(Ball(0.5, -1.0))
    system = tr.RollingSystem(tr.Body.solid_sphere(radius=0.02, mass=0.1), support)
    start = tr.State((0.0, 0.0, -0.48), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    run = tr.simulate(system, start, duration=0.1, every=0.05)
    assert "its numbers have no keys" in refusal("body.mass", run)
