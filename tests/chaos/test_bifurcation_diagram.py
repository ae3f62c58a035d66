"""Bifurcation diagrams against a ball on a shaken table, whose folds and period doublings are known by formula."""

from __future__ import annotations

import numpy as np
import pytest
from tests.chaos.bouncing import Bouncing, G

import trundle as tr

AMPLITUDE = "support.motion.amplitude.z"


def amplitudes(bouncing: Bouncing, gammas: np.ndarray) -> np.ndarray:
    return gammas * G / bouncing.rate**2


@pytest.mark.parametrize("restitution", [0.5, 0.7])
def test_the_period_doubles_where_the_formula_has_it(restitution):
    """From 1 bounce to 2 at Γ, both ways: a doubling that is no jump has no hysteresis."""
    edge = Bouncing.doubling(restitution)
    gammas = edge * np.array([0.95, 0.985, 1.015, 1.05])
    bouncing = Bouncing(restitution, float(gammas[0]))
    found = tr.bifurcation_diagram(
        bouncing.system,
        AMPLITUDE,
        amplitudes(bouncing, gammas),
        "velocity.z",
        "land",
        bouncing.start,
        duration=200 * bouncing.period,
        settle=180 * bouncing.period,
    )
    assert found.periods("up") == found.periods("down") == [1, 1, 2, 2]
    assert found.hysteresis.size == 0
    up = found.data.points.sel(way="up").values
    for value, points in zip(gammas[:2], up[:2], strict=True):  # it comes off at gT/2
        assert np.allclose(points[np.isfinite(points)], G * bouncing.period / 2, rtol=1e-6), value
    assert "1 (" in str(found)


def test_a_ball_that_bounces_once_in_two_periods_falls_out_where_its_orbit_ends_and_does_not_come_back():
    """Down past the fold at Γ = πn(1 − e)/(1 + e), n = 2; on the way up it stays in the step it has found."""
    e = 0.8
    fold = Bouncing.least(e, 2)
    gammas = fold * np.array([0.9, 0.97, 1.05, 1.2])
    bouncing = Bouncing(e, float(gammas[-1]), n=2)
    found = tr.bifurcation_diagram(
        bouncing.system,
        AMPLITUDE,
        amplitudes(bouncing, gammas),
        "velocity.z",
        "land",
        bouncing.start,
        ways=["down", "up"],
        duration=150 * bouncing.period,
        settle=120 * bouncing.period,
    )
    high = G * bouncing.period / 2  # at which it comes off, of two periods of the table
    down, up = (found.data.points.sel(way=way).values for way in ("down", "up"))
    assert np.allclose(down[2:, :10], high, rtol=1e-6)
    assert np.isnan(down[:2]).all()  # it comes to rest
    assert np.isnan(up).all()  # where Γ < 1, the table throws nothing off
    assert np.allclose(found.hysteresis / G * bouncing.rate**2, gammas[2:], rtol=1e-12)


def test_a_stroboscope_sees_a_ball_in_step_at_one_height():
    bouncing = Bouncing(0.5, 1.2)
    gammas = np.array([1.15, 1.2, 1.3])
    found = tr.bifurcation_diagram(
        bouncing.system,
        AMPLITUDE,
        amplitudes(bouncing, gammas),
        "velocity.z",
        start=bouncing.start,
        period=bouncing.period,
        duration=80 * bouncing.period,
        ways=["up"],
    )
    for value, points in zip(gammas, found.data.points.values[0], strict=True):
        landed = Bouncing(0.5, float(value))
        behind = bouncing.start.time % bouncing.period - landed.phase / landed.rate
        known = G * bouncing.period / 2 - G * (behind % bouncing.period)
        assert np.allclose(points[np.isfinite(points)][-3:], known, rtol=0, atol=1e-7)
    assert found.periods("up") == [1, 1, 1]
    assert len(found.plot().axes) == 1


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"values": [1e-3]}, "two or more"),
        ({"values": ["1 kg", "2 kg"]}, "values"),
        ({"ways": "up"}, "both"),
        ({"keep": 0}, "keep"),
        ({"settle": "1 h"}, "shorter"),
        ({"along": "support.shake"}, "support.motion.amplitude.z"),
        ({"observe": "height"}, "height"),
        ({"section": None}, "instead"),
    ],
)
def test_what_cannot_be_drawn_is_refused(change, said):
    bouncing = Bouncing(0.5, 1.2)
    asked = {"along": AMPLITUDE, "values": [1e-3, 2e-3], "observe": "velocity.z", "section": "land"} | change
    with pytest.raises(tr.TrundleError, match=said):
        tr.bifurcation_diagram(bouncing.system, start=bouncing.start, duration="1 s", **asked)
