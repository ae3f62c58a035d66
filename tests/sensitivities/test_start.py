"""Derivatives of a start by all numbers of its scenario, against differences of starts."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.analysis.sensitivities.keys import Key, chosen, keys, moved, varied
from trundle.errors import TrundleError
from trundle.mechanics.duals import slopes_of, value_of
from trundle.mechanics.system import State

# At rest a half cylinder has no way across which it could lie: a push to either side lays it another way.
NO_SLOPE = {("rocking-half-cylinder", "start.velocity[1]")}


def parts(start: State) -> list[Any]:
    """Return all numbers of a start."""
    return [*start.position, *start.velocity, *start.angular_velocity, *start.orientation, *start.support]


def difference(scenario: tr.Scenario, key: Key) -> Any:
    """Return the derivative of a start by a number, by three central differences."""
    rows: list[Any] = []
    for level in range(3):
        h = 1e-3 * max(abs(key.value), 0.03) / 2**level
        up, down = (np.array(parts(moved(scenario, {key.name: key.value + way * h})[1])) for way in (1, -1))
        rows.append((up - down) / (2 * h))
    wide, narrow = ((4 * rows[i + 1] - rows[i]) / 3 for i in range(2))
    return (16 * narrow - wide) / 15


@pytest.mark.parametrize("name", tr.Scenario.names())
def test_a_start_has_the_derivatives_of_its_differences(name: str) -> None:
    scenario = tr.Scenario.load(name)
    every = [*keys(scenario), *chosen(scenario, ["start.time"])]
    wanted = [key for key in every if (name, key.name) not in NO_SLOPE]
    _, start = varied(scenario, wanted)
    slopes = np.array([slopes_of(part, len(wanted)) for part in parts(start)], dtype=float)
    compared = 0
    for j, key in enumerate(wanted):
        try:
            found = difference(scenario, key)
        except TrundleError:  # at a limit, or the body would slip
            continue
        assert np.abs(found - slopes[:, j]).max() <= 1e-9 * max(1.0, np.abs(found).max()), key.name
        compared += 1
    assert compared > 3


def test_a_start_in_duals_has_the_values_of_the_start() -> None:
    for name in tr.Scenario.names():
        scenario = tr.Scenario.load(name)
        assert [value_of(part) for part in parts(varied(scenario, keys(scenario))[1])] == parts(scenario.start_state())
