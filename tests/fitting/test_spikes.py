"""A row that is far off, as a dropped bit or a hand makes it: no loss that bears it is drawn away, and it is named."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.fitting.test_gyroscope import NOISE, K, T, circle, inside, table

import trundle as tr
from trundle.analysis.fit.observations import observe
from trundle.analysis.fit.spikes import spikes


@pytest.mark.parametrize("row", [0, 5, 300, 599])
def test_a_gyroscope_with_one_wild_row_is_fitted_by_a_loss_that_bears_it(row: int) -> None:
    data = inside(3.487)
    data["gyro_y"] = data["gyro_y"].copy()
    data["gyro_y"][row] = 500.0
    found = tr.fit(data, table(3.487), [K, "start.spin"], noise=NOISE, loss="soft_l1")
    assert found.answer == "good"
    assert abs(found[K].value - 0.4) < 4 * found[K].sigma < 1e-3
    assert any(f"row {row + 1} (gyro_y" in remark for remark in found.remarks)


@pytest.mark.parametrize("size", [0.5, -5.0])
@pytest.mark.parametrize("row", [0, 5, 50, 333, 599])
def test_a_film_with_one_wild_row_is_fitted_by_a_loss_that_bears_it(row: int, size: float) -> None:
    data = {"t": T, **circle(3.487)}
    data["x"][row] += size
    found = tr.fit(data, table(3.487, spin=0.0), [K], noise="0.5 mm", loss="soft_l1")
    assert found.answer == "good"
    assert abs(found[K].value - 0.4) < 4 * found[K].sigma < 1e-3


@pytest.mark.parametrize("row", [5, 333])
def test_least_squares_are_drawn_away_and_the_row_is_named(row: int) -> None:
    data = {"t": T, **circle(3.487)}
    data["x"][row] += 5.0
    found = tr.fit(data, table(3.487, spin=0.0), [K], noise="0.5 mm")
    assert found.answer == "bad"
    assert any(f"row {row + 1} (x)" in remark and "soft_l1" in remark for remark in found.remarks)


def clean() -> list[tuple[str, Any]]:
    """Data that are rough and have no spike: noise, bounces, jumps, turns of few rows, gaps."""
    draw = np.random.default_rng(2)
    t = np.arange(400) / 50.0
    return [
        ("noise", draw.normal(size=400)),
        ("bounces", np.abs(np.sin(2 * t)) + draw.normal(scale=1e-3, size=400)),
        ("a jump", np.where(t < 3.0, 0.0, 5.0) + draw.normal(scale=1e-3, size=400)),
        ("turns of few rows", np.sin(2 * np.pi * 12.0 * t)),
        ("a gap", np.where((t > 2) & (t < 4), np.nan, np.sin(t))),
    ]


@pytest.mark.parametrize(("what", "x"), clean())
def test_what_is_only_rough_has_no_spikes(what: str, x: Any) -> None:
    seen = observe({"t": np.arange(400) / 50.0, "x": x})
    assert not spikes(seen, np.full(seen.values.shape, 1e-3)).any(), what
