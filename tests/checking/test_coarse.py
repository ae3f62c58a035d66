"""Right motions whose samples hardly follow them are not condemned, and wrong ones are, as soon as samples can tell."""

from __future__ import annotations

from typing import Any

import pytest

import trundle as tr

NEAR_APEX = {
    "body": {"kind": "solid-sphere", "radius": 0.01, "mass": 0.0327},
    "support": {"kind": "cone", "half_angle": "45 deg", "rim": 0.4},
    "start": {"position": [0.108405, -0.0986772], "velocity": [0.3, 0]},
}
MOTIONS: dict[str, tuple[dict[str, Any], float, float]] = {
    "a disc that wobbles once in ten samples": (
        {
            "body": {"kind": "disc", "radius": 0.012, "mass": 0.008},
            "support": {"kind": "plane"},
            "start": {
                "position": [0, 0],
                "velocity": [0.0306366, 0],
                "spin": -10.934,
                "attitude": [0, "147.74 deg", 0],
            },
        },
        0.0093,
        2.0,
    ),
    "a disc that wobbles once in three": (
        {
            "body": {"kind": "disc", "radius": 0.0375, "mass": 0.4},
            "support": {"kind": "paraboloid", "radius": 0.806},
            "start": {"position": [0, 0], "velocity": [0, 0], "spin": 4.26, "attitude": [0, "15 deg", 0]},
        },
        0.0407,
        6.0,
    ),
    "a half-cylinder that rocks once in ten": (
        {
            "body": {"kind": "half-cylinder", "radius": 0.1, "mass": 2.0},
            "support": {"kind": "plane"},
            "start": {"position": [0, 0], "velocity": [0, 0], "roll": "60 deg"},
        },
        0.0926,
        5.0,
    ),
    "a ball that turns about next to the apex of a cone": (NEAR_APEX, 0.0102, 4.0),
}


def scenario_of(tables: dict[str, Any], every: float, duration: float) -> tr.Scenario:
    """Return a scenario."""
    return tr.Scenario.read(tables | {"run": {"duration": duration, "every": every}})


@pytest.mark.parametrize("spacing", [0.7, 1.0, 1.2])
@pytest.mark.parametrize("name", MOTIONS)
def test_what_hardly_follows_a_motion_does_not_condemn_it(name: str, spacing: float) -> None:
    tables, every, duration = MOTIONS[name]
    scenario = scenario_of(tables, spacing * every, duration)
    found = tr.check(scenario.run(), scenario)
    assert not found.failures, str(found)


@pytest.mark.parametrize(
    "change", [{"gravity": 9.0}, {"body": {"kind": "hollow-sphere", "radius": 0.01, "mass": 0.03}}]
)
def test_what_is_wrong_by_more_than_the_samples_leave_open_is_seen(change: dict[str, Any]) -> None:
    run = scenario_of(NEAR_APEX, 0.0102, 4.0).run()
    found = tr.check(run, scenario_of(NEAR_APEX | change, 0.0102, 4.0))
    assert found.failures, str(found)


def test_our_own_run_begins_as_they_wrote_where_no_noise_is_to_be_smoothed() -> None:
    tables, every, duration = MOTIONS["a half-cylinder that rocks once in ten"]
    scenario = scenario_of(tables, every, duration)
    found = tr.check(scenario.run(), scenario)
    assert found["our own run from the same start"].value < 1e-12
