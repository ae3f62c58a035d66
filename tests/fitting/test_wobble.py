"""A table that is askew on its axle: found in data that have it, with amplitude and phase, and not in others.

The data come from Newton's and Euler's equations with the constraint of rolling, integrated by SciPy.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import trundle as tr
from trundle.mechanics.algebra import Vector

T = np.arange(0.0, 8.0, 0.02)
RATIO, RADIUS, GRAVITY = 0.4, 0.025, 9.80665
WOBBLE = "a wobble of the support"


def rolled(rate: float, angle: float, phase: float, push: float = 0.0) -> Any:
    """The path of a ball on a plane through the origin with the normal n(t): V' + g e = F/m, Ω' = −n × F a/I."""
    from scipy.integrate import solve_ivp

    up, a, k = np.array([0.0, 0.0, 1.0]), RADIUS, RATIO
    turning = rate * up

    def normal(t: float) -> Any:
        lean = rate * t + phase
        return np.array([np.sin(angle) * np.sin(lean), -np.sin(angle) * np.cos(lean), np.cos(angle)])

    def law(t: float, y: Any) -> Any:
        V, Omega, n = y[3:6], y[6:], normal(t)
        dn = np.cross(turning, n)
        across = np.eye(3) - np.outer(n, n)
        carried = np.cross(turning, V - a * dn) + a * np.cross(Omega, dn)
        weight = GRAVITY * up - np.array([push, 0.0, 0.0])
        dV = np.linalg.solve(np.eye(3) + across / k, carried - across @ weight / k)
        return np.concatenate([V, dV, -np.cross(n, dV + weight) / (k * a)])

    n = normal(0.0)
    r = np.array([0.08, 0.0, (a - n[0] * 0.08) / n[2]])
    V = np.array([0.0, 0.1, -(n[1] * 0.1 + np.cross(turning, n) @ r) / n[2]])
    Omega = np.cross(n, V - np.cross(turning, r - a * n)) / a
    found = solve_ivp(law, (0.0, T[-1]), np.concatenate([r, V, Omega]), t_eval=T, rtol=1e-9, atol=1e-11)
    return found.y[:2]


def fitted(rate: float, path: Any, noise: float, seed: int) -> tr.Fit:
    draw = np.random.default_rng(seed)
    data = {"t": T} | {axis: path[i] + draw.normal(scale=noise, size=T.size) for i, axis in enumerate("xy")}
    table = {
        "body": {"kind": "sphere", "radius": RADIUS, "mass": 0.065, "inertia_ratio": 0.43},
        "support": {"kind": "plane", "motion": {"kind": "spin", "rate": rate}},
        "start": {"position": [0.0, 0.0]},
        "run": {"duration": 8.0, "every": 0.02},
    }
    return tr.fit(data, tr.Scenario.read(table), free=["body.inertia_ratio"], noise=noise)


@pytest.mark.parametrize("rate", [3.487, -3.487])
@pytest.mark.parametrize(("angle", "phase"), [(2e-3, 1.1), (2e-3, -2.5), (5e-4, 3.0), (5e-3, 0.0)])
def test_a_wobble_is_found_with_amplitude_and_phase(rate: float, angle: float, phase: float) -> None:
    found = fitted(rate, rolled(rate, angle, phase), 1e-4, 7)
    assert found.answer == "bad"
    best = found.compare().best
    assert best is not None
    assert best.words == WOBBLE
    assert best.chi_square / (2 * T.size - best.numbers) < 1.2
    (_, size, size_sigma), (_, lean, lean_sigma) = best.values
    assert abs(size - angle) < 4 * size_sigma < 0.1 * angle
    assert abs((lean - phase + np.pi) % (2 * np.pi) - np.pi) < 4 * lean_sigma < 0.1


@pytest.mark.parametrize("rate", [3.487, -3.487])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_no_wobble_is_found_where_there_is_none(rate: float, seed: int) -> None:
    found = fitted(rate, rolled(rate, 0.0, 0.0), 5e-4, seed)
    assert found.answer == "good"
    assert found.compare().best is None


def test_a_lean_is_not_taken_for_a_wobble() -> None:
    found = fitted(3.487, rolled(3.487, 0.0, 0.0, push=1e-3), 5e-4, 0)
    best = found.compare().best
    assert best is not None
    assert best.words == "a lean of the support, as a push along it"


def test_the_lean_is_turned_by_the_phase() -> None:
    for phase in (0.0, 1.1, -2.5):
        pose = tr.Wobble(3.0, 0.2, phase).at(0.7).rotation
        columns = np.array([[*(pose @ Vector(*axis))] for axis in np.eye(3)])
        lean = 3.0 * 0.7 + phase
        normal = [np.sin(0.2) * np.sin(lean), -np.sin(0.2) * np.cos(lean), np.cos(0.2)]
        assert np.allclose(columns[2], normal, rtol=0, atol=1e-15)
        assert np.allclose(columns @ columns.T, np.eye(3), rtol=0, atol=1e-15)
