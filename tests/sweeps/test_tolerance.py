"""Shares of the variance against a sum that can be written down; maps of classes against each of their fields."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.sweeps.refined import refine

import trundle as tr
from trundle.analysis.sweep.api import run_plan
from trundle.analysis.sweep.engine import Engine
from trundle.analysis.sweep.plan import read_plan

pytest.importorskip("heyoka")

ROLLING = {
    "body": {"kind": "solid-sphere", "radius": 0.02, "mass": 0.1},
    "support": {"kind": "plane"},
    "start": {"position": [0, 0], "velocity": [1, 0]},
    "run": {"duration": 2, "every": 1},
}


@pytest.mark.parametrize("normal", [False, True])
def test_shares_of_a_sum(*, normal: bool) -> None:
    """x = x₀ + 2 V: the variances are those of x₀ and 4 times that of V, and nothing works together."""
    scenario = tr.Scenario.read(ROLLING)
    limits = {"start.position[0]": "0 ± 30 cm", "start.velocity[0]": "1 ± 0.2 m/s", "body.mass": "100 ± 1 g"}
    found = tr.tolerance(scenario, limits, "end x", members=512, normal=normal)
    wanted = np.array([0.09, 0.16, 0.0]) / 0.25
    for share, own in zip(wanted, found.shares.values(), strict=True):
        assert own == pytest.approx((share, share), abs=0.02)
    assert found.spread["median"] == pytest.approx(2.0, abs=0.02)
    if not normal:
        assert 1.3 < found.spread["least"] < 1.35
        assert 2.65 < found.spread["largest"] < 2.7


def test_one_number_has_all_of_it_and_what_does_not_matter_nothing() -> None:
    scenario = tr.Scenario.read(ROLLING)
    alone = tr.tolerance(scenario, {"start.velocity[0]": "1 ± 0.2 m/s"}, "end x", members=64)
    assert alone.shares["start.velocity[0]"] == pytest.approx((1.0, 1.0), abs=0.05)
    still = tr.tolerance(scenario, {"body.mass": "100 ± 1 g"}, "end x", members=8)
    assert all(np.isnan(still.shares["body.mass"]))
    with pytest.raises(tr.InvalidValueError, match="must be a number, not a class"):
        tr.tolerance(scenario, {"body.mass": "100 ± 1 g"}, "ending", members=8)


SHAPES = [(100, 100), (300, 300), (17, 33), (40, 7), (2, 2), (100, 63)]


@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_a_map_near_the_boundary_is_the_map(shape: tuple[int, int]) -> None:
    """Three classes with curved boundaries that meet: each field as if it had been run."""

    def classes(places: Any) -> Any:
        x, y = (part / count for part, count in zip(np.unravel_index(places, shape), shape, strict=True))
        return (np.sin(5 * x + 3 * y) + 0.5 * np.cos(7 * y) > 0.2).astype(int) + (x + y > 1.5)

    asked: list[int] = []

    def noted(places: Any) -> Any:
        asked.extend(places.tolist())
        return classes(places)

    run, found = refine(shape, noted)
    assert np.array_equal(found.ravel(), classes(np.arange(found.size)))
    assert len(asked) == len(set(asked)) == run.sum()
    if shape == (300, 300):
        assert run.mean() < 0.15


def test_the_boundary_of_a_sweep_is_that_of_its_grid() -> None:
    over = {
        "start.position[0]": {"from": "5 cm", "to": "35 cm", "count": 40},
        "support.motion.rate": {"from": "20 rpm", "to": "45 rpm", "count": 36},
    }
    given: dict[str, Any] = {"measure": ["ending", "end x"], "duration": "2 s", "every": "0.5 s"}
    whole, near = (tr.sweep("tilted-turntable", over, design=design, **given) for design in ("grid", "boundary"))
    assert np.array_equal(whole.ending, near.ending)
    run = near.dataset.status == 1
    assert near.counts["inferred"] == (near.dataset.status == 4).sum() > 200
    assert np.abs(near["end x"] - whole["end x"]).where(run).max() < 1e-12
    with pytest.raises(tr.InvalidValueError, match="must begin with a figure that has classes"):
        tr.sweep("tilted-turntable", over, "end x", design="boundary")
    plan = read_plan({"scenario": "tilted-turntable", "over": over, "measure": "ending", "design": "boundary"})
    with pytest.raises(tr.InvalidValueError, match="must be run whole"):
        run_plan(plan, Engine(), part=(1, 2))
