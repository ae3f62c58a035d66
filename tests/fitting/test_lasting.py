"""Errors that do not average out: the errors of a fit are as large as the scatter of its values, over many draws."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.fitting.measured import on_turntable, scenario, turntable

import trundle as tr

K, RATE = "body.inertia_ratio", 3.487
T = np.arange(240) / 30.0
PATH = on_turntable(T, RATE)
TABLE = scenario(support=turntable(RATE))


def seen(path: Any, draw: Any, noise: float) -> dict[str, Any]:
    return {"t": T, "x": path.real + draw.normal(0, noise, T.size), "y": path.imag + draw.normal(0, noise, T.size)}


def remembering(draw: Any, size: float, memory: float) -> Any:
    """Noise of which each value keeps a share of the one before (AR 1), as large throughout."""
    found = draw.normal(0, size, (T.size, 2)) @ [1, 1j]
    for i in range(1, T.size):
        found[i] = memory * found[i - 1] + np.sqrt(1 - memory**2) * found[i]
    return found


def pulls(fits: list[tr.Fit]) -> Any:
    """Return how many of its own standard deviations each is off the truth."""
    return np.array([(one[K].value - 0.4) / one[K].sigma for one in fits])


def test_noise_with_a_memory_makes_larger_errors_and_no_bad_fit_where_the_camera_is_no_better() -> None:
    fits, plain = [], []
    for seed in range(30):
        draw = np.random.default_rng(seed)
        data = seen(PATH + remembering(draw, 2e-4, 0.8), draw, 1e-5)
        fits.append(tr.fit(data, TABLE, [K], camera={"accuracy": "0.5 mm"}))
        if seed < 4:
            plain.append(tr.fit(data, TABLE, [K]))
    assert all(one.answer == "good" for one in fits)
    assert all("no larger than the camera is accurate" in " ".join(one.remarks) for one in fits)
    assert {one.answer for one in plain} == {"bad"}  # somebody who says nothing of the camera hears of it
    assert np.sqrt((pulls(fits) ** 2).mean()) < 1.4  # 3 for whoever takes each row for a new one


def test_a_memory_alone_is_seen_in_the_residuals() -> None:
    # One value in five counts at a memory of 0.67: (1 + 0.67)/(1 − 0.67), by the textbook, so √5 times the error.
    fits = []
    for seed in range(60):
        draw = np.random.default_rng(100 + seed)
        fits.append(tr.fit(seen(PATH + remembering(draw, 2e-4, 2 / 3), draw, 1e-6), TABLE, [K]))
    spread = float(np.sqrt((pulls(fits) ** 2).mean()))
    assert 0.7 < spread < 1.5  # 2.2 for whoever takes each row for a new one


@pytest.mark.parametrize("noise", ["0.05 mm", None])
def test_a_camera_that_is_off_by_a_smooth_field(noise: str | None) -> None:
    """A slant, another scale and a lens, each by chance: the errors are as large as what they do to the ratio."""
    size, fits, blind = 2e-4, [], []
    middle, reach = PATH.mean(), np.abs(PATH - PATH.mean()).max()
    u, v = ((PATH - middle) / reach).real, ((PATH - middle) / reach).imag
    terms = np.array([1 + 0 * u, u, v, u * u, u * v, v * v]) / np.sqrt(6)
    for seed in range(60):
        draw = np.random.default_rng(200 + seed)
        shift = draw.normal(0, size, (2, 6)) @ terms
        data = seen(PATH + shift[0] + 1j * shift[1], draw, 5e-5)
        fits.append(tr.fit(data, TABLE, [K], noise=noise, camera={"accuracy": size}))
        if seed < 10:
            blind.append(tr.fit(data, TABLE, [K], noise=noise))
    assert all(one.answer == "good" for one in fits)
    spread = float(np.sqrt((pulls(fits) ** 2).mean()))
    assert 0.75 < spread < 1.3 if noise else 0.3 < spread < 1.3  # noise that is estimated has some of the shift in it
    assert not noise or np.abs(pulls(blind)).max() > 4


def test_a_wrong_law_is_still_told() -> None:
    draw = np.random.default_rng(1)
    data = seen(on_turntable(T, RATE, drag=5e-3), draw, 5e-5)
    assert tr.fit(data, TABLE, [K], camera={"accuracy": "0.2 mm"}).answer == "bad"
    with pytest.raises(tr.InvalidValueError, match=r"camera\.accuracy"):
        tr.fit(data, TABLE, [K], camera={"accuracy": -1e-3})
