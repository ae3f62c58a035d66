"""Slip that turns by right angles, and so is at its slowest again and again, but does not end."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.laws.test_compiled_steps import CURVED

import trundle as tr
from trundle.solve import runge_kutta, taylor

ROUND_AND_ROUND = """
body = {{ kind = "solid-sphere", radius = 0.02, mass = 0.1 }}
start = {{ position = [0.2, 0.0], velocity = [0.0, {}, 0.0], angular_velocity = [0, 0, 0] }}
run = {{ duration = 8.0, every = 0.02 }}
[support]
kind = "bowl"
radius = 0.5
friction = 0.05
motion = {{ kind = "move", position = ["0.05*(t - {})*abs(t - {})", 0.0, 0.0] }}
"""


@pytest.mark.parametrize(("speed", "kink"), [(2.0, 0.37), (-2.0, 0.37), (2.0, 1.1), (-2.0, 2.3), (2.0, 10.0)])
def test_it_is_one_stretch_whatever_it_turns_by(speed: float, kink: float, monkeypatch: pytest.MonkeyPatch) -> None:
    begun, begin = [], taylor._begun

    def counted(system: Any, now: Any, *given: Any) -> Any:
        begun.append(now.time)
        return begin(system, now, *given)

    monkeypatch.setattr(taylor, "_begun", counted)
    scenario = tr.Scenario.loads(ROUND_AND_ROUND.format(speed, kink, kink))
    run, other = scenario.run("taylor"), scenario.run("runge-kutta")
    slips = (run.data.phase.values == 1) & (run.data.time.values < 3.5)
    turned = np.unwrap(np.arctan2(*run.data.slip_velocity.values[slips, :2].T))
    assert np.ptp(turned) > 4 * np.pi  # it goes round twice, through eight right angles
    assert [event.kind for event in run.events] == [event.kind for event in other.events]
    assert {"grip", "slip"} <= {event.kind for event in run.events}
    times = [[event.time for event in one.events] for one in (run, other)]
    np.testing.assert_allclose(*times, rtol=0, atol=1e-10)
    assert len(begun) == 1 + (kink < 8.0) + len(run.events)
    assert run.card().passed


@pytest.mark.usefixtures("through_walls")
def test_a_law_that_grows_singular_is_taken_up_where_its_slip_was_last_at_its_slowest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    taken: list[tuple[str, float]] = []
    for name in ("integrate", "dense"):
        plain = getattr(runge_kutta, name)

        def noted(system: Any, now: Any, *given: Any, plain: Any = plain, name: str = name) -> Any:
            taken.append((name, now.time))
            return plain(system, now, *given)

        monkeypatch.setattr(runge_kutta, name, noted)
    run = tr.Scenario.loads(CURVED["slip whose steps grow before they shrink"]).run()
    assert run.card().passed
    last = max(event.time for event in run.events if event.kind == "slip")
    assert {name for name, time in taken if time > last + 0.01} == {"integrate", "dense"}
    assert np.diff(run.data.time.values).min() > 0
