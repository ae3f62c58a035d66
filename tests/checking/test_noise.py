"""Right data with noise are not condemned, wrong data under it are, and noise alone decides nothing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.signal import savgol_filter

import trundle as tr
from trundle.analysis.checking.noise import noise_of
from trundle.analysis.checking.slopes import derivative

from .textbook import data, shaken, system

LAW = "law of motion, acceleration"
TABLES = [(3.49, 0.02), (-3.49, 0.02), (-3.49, 0.0), (-8.0, 0.01), (1.0, -0.03)]


def filmed(omega: float, tilt: float, *mistakes: str, parts: str = "") -> dict[str, Any]:
    return data(omega, tilt, *mistakes, duration=5.0, every=1 / 60, parts=parts)


@pytest.mark.parametrize("parts", ["", "vw"])
@pytest.mark.parametrize(("omega", "tilt"), TABLES)
def test_right_data_with_noise_are_not_condemned(omega: float, tilt: float, parts: str) -> None:
    right = filmed(omega, tilt, parts=parts)
    for seed, sigma in enumerate((1e-4, 1e-3, 5e-3, 5e-2)):
        for flat in (True, False)[len(parts) // 2 :]:
            seen = shaken(right, sigma, seed)
            kept = {name: array for name, array in seen.items() if not flat or name != "z"}
            checked = tr.check(kept, system(omega, tilt))
            assert checked.answer != "fails", str(checked)
            assert checked.answer == "holds" or sigma > 1e-3, str(checked)
            assert all(figure.bound > 0 for figure in checked.figures if figure.bound is not None)


@pytest.mark.parametrize("sigma", [0.0, 1e-4])
@pytest.mark.parametrize("samples", [12, 13, 14, 16, 17, 18, 19, 22, 23, 24])
@pytest.mark.parametrize("parts", ["", "vw"])
def test_so_many_samples_as_are_taken_are_looked_at(parts: str, samples: int, sigma: float) -> None:
    omega, tilt = -3.49, 0.02
    right = data(omega, tilt, duration=0.1 * (samples - 0.5), every=0.1, parts=parts)
    assert len(right["t"]) == samples
    assert tr.check(shaken(right, sigma, samples), system(omega, tilt)).answer != "fails"


def test_the_bound_is_what_the_noise_leaves_open() -> None:
    omega, tilt = -3.49, 0.02
    right = filmed(omega, tilt)
    shares = []
    for seed in range(6):
        law = tr.check(shaken(right, 1e-3, seed), system(omega, tilt))[LAW]
        assert law.bound is not None
        shares.append(law.value / law.bound)
    assert 0.15 < np.median(shares) < 0.5  # of the longest of some windows: five standard deviations are allowed


@pytest.mark.parametrize("sigma", [1e-4, 1e-3])
@pytest.mark.parametrize(("omega", "tilt"), TABLES[:3])
def test_a_shell_is_found_out_under_the_same_noise(omega: float, tilt: float, sigma: float) -> None:
    checked = tr.check(shaken(filmed(omega, tilt, "wrong-inertia-ratio"), sigma, 1), system(omega, tilt))
    assert checked.answer == "fails"
    assert "wrong-inertia-ratio" in checked.likely[0].name


@pytest.mark.parametrize("how", ["smoothed", "means of five", "millimetres", "every other frame", "uneven", "gap"])
def test_noise_need_not_be_independent_nor_samples_even(how: str) -> None:
    omega, tilt = -3.49, 0.02
    exact, draw = filmed(omega, tilt), np.random.default_rng(3)
    seen = shaken(exact, 1e-3, 4)
    t, n = seen["t"], seen["t"].size
    if how == "smoothed":
        seen = {name: array if name == "t" else savgol_filter(array, 9, 3) for name, array in seen.items()}
    elif how == "means of five":
        seen = {name: np.convolve(array, np.ones(5) / 5, "valid") for name, array in seen.items()}
        seen = {name: array[:1] + 0 * array if name == "z" else array for name, array in seen.items()}
        seen |= {name: seen[name] + _mean_of_five(exact[name]) for name in "xy"}
        seen["z"] = exact["z"][2:-2]
    elif how == "millimetres":
        seen = {name: array if name == "t" else np.round(array, 3) for name, array in exact.items()}
    elif how == "every other frame":
        seen = {name: np.interp(t[:-1], t[::2], array[::2]) for name, array in seen.items()}
    else:
        kept = np.sort(draw.choice(n, n * 7 // 10, replace=False)) if how == "uneven" else np.r_[0:100, 140:n]
        seen = {name: array[kept] for name, array in seen.items()}
    checked = tr.check(seen, system(omega, tilt))
    assert checked.answer == "holds", str(checked)


def _mean_of_five(exact: Any) -> Any:
    """Return what a mean takes off a path that bends, so that only the noise is smoothed."""
    return exact[2:-2] - np.convolve(exact, np.ones(5) / 5, "valid")


@pytest.mark.parametrize("samples", [60, 300, 900])
def test_noise_alone_decides_nothing(samples: int) -> None:
    noise = np.random.default_rng(samples).normal(scale=0.05, size=(2, samples))
    still = {"t": np.arange(samples) / 60, "x": noise[0], "y": noise[1]}
    checked = tr.check(still, system(-3.49, 0.0))
    assert (checked.answer, checked.passed, checked.failures) == ("cannot decide", False, ())
    assert "these data cannot decide" in str(checked)
    assert any("inertia ratio" in says for says in checked.blind)
    assert "They would look the same with" in checked.verdict


@pytest.mark.parametrize("samples", [60, 300])
@pytest.mark.parametrize("sigma", [1e-3, 1e-2, 5e-2])
def test_where_it_holds_some_line_has_a_verdict(samples: int, sigma: float) -> None:
    """A circle of 10 cm under 5 cm of noise held, though no line could be told: one mistake would have been too far."""
    t, draw = np.linspace(0.0, 5.0, samples), np.random.default_rng(1)
    x, y = (0.1 * f(t) + draw.normal(scale=sigma, size=samples) for f in (np.cos, np.sin))
    checked = tr.check({"t": t, "x": x, "y": y}, system(3.5, 0.0))
    told = [figure for figure in checked.figures if figure.passed is not None]
    assert checked.answer == ("holds" if told else "cannot decide"), str(checked)
    drawn = [ax.get_title(loc="right") for ax in checked.plot().axes]
    assert drawn.count("within its bound") == len(told), drawn


@pytest.mark.parametrize("rate", [2.0, 10.0, 30.0])
def test_a_fast_motion_is_not_taken_for_noise(rate: float) -> None:
    t = np.arange(0.0, 4.0, 0.01)
    exact = np.column_stack([np.cos(rate * t), np.sin(rate * t)])
    for sigma in (0.0, 1e-6, 1e-3, 3e-2):
        draw = np.random.default_rng(1).normal(scale=sigma, size=exact.shape) if sigma else 0.0
        seen = noise_of(t, exact + draw, {})
        low = float(np.median(seen.spread) * np.sqrt(seen.alike))
        assert low < 1.5 * sigma + 1e-9
        assert low > 0.7 * sigma
        slope = derivative(t, exact + draw, np.arange(0, t.size, 3))
        off = np.linalg.norm(slope.values - rate * np.column_stack([-exact[::3, 1], exact[::3, 0]]), axis=1)
        assert (off < slope.error + 1e-9).all()
