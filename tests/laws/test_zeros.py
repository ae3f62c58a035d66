"""A number of a state that happens to be 0 is no case of its own: a law has the rates there that it has beside it."""

from __future__ import annotations

import numpy as np
import pytest
from tests.fields.systems import DYNAMIC, shipped
from tests.tolerances import EXACT

import trundle as tr
from trundle.mechanics.algebra import E_X, E_Y, ZERO, Quaternion, Vector
from trundle.mechanics.slipping import fly
from trundle.solve.laws import Law

ALL_BUT_NOTHING = 1e-30
PHASES = ("rolling", "slipping", "flight")


@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("name", DYNAMIC)
def test_the_rates_and_event_functions_are_those_beside_it(name: str, phase: str) -> None:
    if phase not in tr.Scenario.load(name).system().vector_field().phases:
        pytest.skip("not a phase of this system")
    field, (t, y, _, _) = shipped(name, "numpy", phase)
    y[:2] += 0.01, 0.02  # off the apex of a cone
    law: Law = field._routines.law
    given = field.event_parameters(t, y, field.parameters, field.inputs).tolist() if field.event_parameters else ()
    for i in range(y.size):
        found = []
        for value in (0.0, ALL_BUT_NOTHING, -ALL_BUT_NOTHING):
            state = [*y[:i].tolist(), value, *y[i + 1 :].tolist()]
            stops = law.event_functions(field.system, t, state, given)
            found.append(np.array([*law.rates(field.system, t, state), *stops.values()], dtype=float))
        for beside in found[1:]:
            assert found[0] == pytest.approx(beside, rel=EXACT(64, 1.0), abs=EXACT(64, np.abs(beside).max()))


def test_the_nearest_point_of_a_falling_ball_moves_along_the_table_where_it_strikes() -> None:
    """At the very instant of a landing the gap is 0, and the ball still comes down: p keeps below its centre."""
    table = tr.RollingSystem(tr.Body.solid_sphere(0.1, 7.0), tr.Support(tr.Plane()))
    still, down = Quaternion(1.0, 0.0, 0.0, 0.0), Vector(0.3, -0.2, -2.0)
    now = fly(table, 0.0, ZERO, 0.0, Vector(0.0, 0.0, 0.1), still, E_X * 5.0 + E_Y * 3.0, down)
    assert tuple(now.point_rate) == pytest.approx((0.3, -0.2, 0.0), abs=1e-15)
