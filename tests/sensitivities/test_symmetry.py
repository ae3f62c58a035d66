"""Numbers that break the symmetry by which a law is short are followed apart, and nothing changes but the time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.sensitivities.differences import check

import trundle as tr
from trundle.analysis.sensitivities import api

pytest.importorskip("heyoka")

COIN: dict[str, Any] = {
    "gravity": 9.8,
    "body": {"kind": "disc", "radius": 1.2, "mass": 8.0, "moments": [3.0, 3.0, 5.8]},
    "support": {"kind": "plane", "tilt": 0.05},
    "start": {"position": [0, 0], "velocity": [2.0, 0.0], "attitude": [0.0, 1.3, 0.0], "spin": 1.0},
    "run": {"duration": 0.3, "every": 0.1},
}
KEYS = ["body.moments[1]", "body.radius", "body.moments[0]", "start.spin"]


@pytest.fixture
def followed(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """Keep by what each run is differentiated."""
    calls: list[list[str]] = []
    follow = api.follow

    def kept(*given: Any) -> Any:
        calls.append(given[4])
        return follow(*given)

    monkeypatch.setattr(api, "follow", kept)
    return calls


def test_both_parts_have_the_derivatives_of_the_runs(followed: list[list[str]]) -> None:
    check(COIN, KEYS, np.array([0.1, 0.3]))
    assert followed == [["body.radius", "start.spin"], ["body.moments[1]", "body.moments[0]"]]


def test_they_are_those_of_all_together(followed: list[list[str]], monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = tr.Scenario.read(COIN)
    apart = tr.sensitivities(scenario, KEYS, compared=False)
    monkeypatch.setattr(api, "keeps_charts", lambda *_: True)
    together = tr.sensitivities(scenario, KEYS, compared=False)
    assert [len(names) for names in followed] == [2, 2, 4]
    for name in ("position", "orientation", "contact_force"):
        ours, reference = apart[name].values, together[name].values
        assert np.abs(ours - reference).max(initial=0) <= 1e-9 * np.abs(reference).max()
        assert np.allclose(ours, reference, rtol=1e-8, atol=1e-10 * np.abs(reference).max(axis=(0, 1)))


def test_where_no_symmetry_makes_it_short_there_is_one_run(followed: list[list[str]]) -> None:
    tr.sensitivities("rattleback", ["body.moments[0]", "gravity"], duration=0.1, every=0.1, compared=False)
    assert len(followed) == 1
