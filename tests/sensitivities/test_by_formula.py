"""Derivatives by closed forms: those of the variational equations, or left to these; never others, in silence."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from tests.contracts.test_every_closed_form import case_of, one_by_one

import trundle as tr
from trundle.analysis.sensitivities.by_formula import follow_formula
from trundle.analysis.sensitivities.keys import keys, varied
from trundle.errors import InvalidValueError
from trundle.mechanics.duals import NoSlopeError, duals, strictly
from trundle.solve.exact import (
    BallInUprightCylinder,
    ClosedForm,
    CylinderOnCylinder,
    SphereInFlight,
    SphereOnPlane,
    SphereOnSphere,
)

AGREES = 1e-9
# What they have slopes by, of their own cases; what leads out of the domain of the form is left out.
BY_FORMULA: dict[type[ClosedForm], tuple[str, ...]] = {
    SphereOnPlane: ("gravity", "body.radius", "body.mass", "support.tilt", "support.motion.rate", "start.velocity[0]"),
    SphereInFlight: ("gravity", "body.mass", "support.tilt", "start.velocity[0]", "start.height"),
    BallInUprightCylinder: ("gravity", "body.radius", "support.radius", "start.velocity[0]", "start.spin"),
    CylinderOnCylinder: ("gravity", "body.radius", "body.mass", "support.radius", "start.position[0]"),
    SphereOnSphere: ("gravity", "body.radius", "support.radius", "start.position[0]", "start.velocity[0]"),
}
BALL = {"kind": "solid-sphere", "radius": 0.02, "mass": 0.1}


def both(scenario: Any, names: Sequence[str]) -> tuple[tr.Sensitivities, tr.Sensitivities]:
    found = tr.sensitivities(scenario, names, compared=False)
    return found, tr.sensitivities(scenario, names, compared=False, method="variational")


def assert_alike(found: tr.Sensitivities, other: tr.Sensitivities) -> None:
    for name, slopes in other.data.items():
        size = max(1.0, float(np.nanmax(np.abs(slopes.values), initial=0.0)))
        assert np.allclose(found[str(name)].values, slopes.values, rtol=0, atol=AGREES * size, equal_nan=True), name


@one_by_one()
def test_a_formula_has_the_derivatives_of_the_variational_equations(form: type[ClosedForm]) -> None:
    """By each number alone, as one that leads out of the domain leaves all to the variational equations."""
    scenario = tr.Scenario.describe(*case_of(form), duration=0.1, every=0.05)
    system, start, times = scenario.system(), scenario.start_state(), np.array([0.0, 0.05, 0.1])
    found = []
    for key in keys(scenario):
        with suppress(InvalidValueError):  # there is none
            if follow_formula(system, start, times, varied(scenario, [key]), [key.name]) is not None:
                found.append(key.name)
    assert set(found) >= set(BY_FORMULA.get(form, ()))
    if found:
        assert_alike(*both(scenario, found))


PLANE = {
    "body": BALL,
    "support": {"kind": "plane", "tilt": 0.0, "motion": {"kind": "spin", "rate": 0.0}},
    "loads": [{"kind": "drag", "coefficient": 0.0, "air": 0.0}],
    "start": {"position": [0.1, 0.02], "velocity": [0.1, 0.2], "spin": 0.0},
}
LEVEL = {
    "body": BALL,
    "support": {"kind": "cylinder", "radius": 0.2, "tilt": "90 deg"},
    "start": {"position": [0.0, 0.0], "velocity": [0.0, 0.0], "spin": 0.0},
}
BOWL = {
    "body": BALL,
    "support": {"kind": "bowl", "radius": 0.2},
    "start": {"position": [0.05, 0.0], "velocity": [0, 0]},
}
# A number whose value is that of a case of the formula, or of a condition of its domain, and by which way it goes then.
AT_A_CASE = (
    (PLANE, "support.motion.rate", "exact"),
    (PLANE, "support.tilt", "exact"),
    (PLANE, "loads[0].coefficient", "exact"),
    (PLANE, "start.spin", "exact"),
    (PLANE, "loads[0].air", "variational"),  # T5 is of air that is still
    (LEVEL, "support.tilt", "variational"),  # T6 is of a level axis
    (LEVEL, "start.velocity[0]", "exact"),  # from rest in the middle
    (LEVEL, "start.velocity[1]", "variational"),  # along the axis
    (LEVEL, "start.spin", "variational"),
    (LEVEL, "start.position[0]", "exact"),
    (BOWL, "start.velocity[1]", "variational"),  # out of the great circle
    (BOWL, "support.radius", "exact"),
)


@pytest.mark.parametrize(("tables", "name", "method"), AT_A_CASE)
def test_a_number_at_a_case_of_the_formula_has_its_derivatives(tables: Any, name: str, method: str) -> None:
    scenario = tr.Scenario.read({**tables, "gravity": 9.80665, "run": {"duration": 0.2, "every": 0.1}})
    found, other = both(scenario, [name])
    assert found.method == method
    assert_alike(found, other)


def test_a_decision_that_a_slope_would_turn_is_refused() -> None:
    x, y = duals((0.0, 2.0))
    for decide in (lambda: bool(x), lambda: x == 0, lambda: x < 0, lambda: y >= 2.0, lambda: abs(x), lambda: x != 0):
        decide()
        with strictly(), pytest.raises(NoSlopeError, match="none beside"):
            decide()
    with strictly():
        assert bool(y)
        assert x < y
        assert x == x + 0.0  # has the same slopes
        assert x != "turning"
