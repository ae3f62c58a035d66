"""The samples of many stretches are completed together, by one evaluation of each law; that shows nowhere."""

from __future__ import annotations

from collections import Counter
from itertools import count
from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.solve import phases
from trundle.solve.creeping import CreepingLaw
from trundle.solve.laws import FlightLaw, RollingLaw, SlippingLaw

EGG = tr.Body.ellipsoid((0.02, 0.025, 0.03), 0.1)
SHAKEN = tr.Support(tr.Plane(), motion=tr.Shake(amplitude=(0.05, 0.02, 0.0), rate=20.0), friction=0.2)
BOUNCY = tr.Support(tr.Plane(), friction=0.2, restitution=0.8)
RUNS = {
    "rolls and slips": (SHAKEN, {}),
    "bounces": (BOUNCY, {"height": 0.05, "velocity": (0.3, 0.1), "angular_velocity": (2.0, -3.0, 5.0)}),
}


def run(which: str) -> tr.Trajectory:
    support, start = RUNS[which]
    system = tr.RollingSystem(EGG, support)
    return tr.simulate(system, system.place(**start), duration=1.6, every=1e-3, method="runge-kutta")


@pytest.mark.parametrize("which", RUNS)
def test_each_sample_is_what_its_own_stretch_makes_of_it(which: str, monkeypatch: pytest.MonkeyPatch) -> None:
    together = run(which)
    alone = count()
    monkeypatch.setattr(phases._Record, "_group", lambda *_: next(alone))
    by_itself = run(which)
    assert len(together.events) >= 4
    assert np.array_equal(together.data.phase, by_itself.data.phase)
    for name in ("time", "position", "velocity", "angular_velocity", "orientation", "contact", "contact_force"):
        here, there = together.data[name].values, by_itself.data[name].values
        assert np.abs(here - there).max() <= 1e-13 * np.abs(there).max()


@pytest.mark.parametrize("which", RUNS)
def test_a_law_is_evaluated_once_however_many_stretches_it_has(which: str, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = Counter[Any]()

    def counting(kind: type) -> None:
        plain = kind.record

        def record(law: Any, system: Any, time: Any, states: Any) -> Any:
            calls[type(law), time.size > 2] += 1
            return plain(law, system, time, states)

        monkeypatch.setattr(kind, "record", record)

    for kind in (RollingLaw, SlippingLaw, FlightLaw):
        counting(kind)
    events = len(run(which).events)
    many = [number for (_, many), number in calls.items() if many]
    assert events >= 4
    assert max(many) == 1


def test_stretches_whose_laws_have_other_numbers_keep_them() -> None:
    record = phases._Record(tr.RollingSystem(EGG, SHAKEN), 10)
    found = []

    class Watched(CreepingLaw):
        def record(self, system: Any, time: Any, states: Any) -> Any:  # noqa: ARG002
            found.append((self.step, self.since))
            return phases.Samples(time, *[np.zeros((time.size, 3))] * 4, np.zeros((time.size, 4)), states[:, :3])

    for step, rows in ((1e-6, 2), (2e-6, 3)):
        record.take(Watched(step=step), phases.Segment(np.full(rows, step), np.zeros((rows, 11)), None))
    samples = record.samples(())
    ((steps, since),) = found
    assert steps.tolist() == samples.time.tolist() == [1e-6] * 2 + [2e-6] * 3
    assert since == 0.0
