"""Numbers of the camera that are free: its height, and its clock where the support moves by one."""

from __future__ import annotations

import numpy as np
from tests.fitting.measured import RADIUS, in_hollow, scenario, seen

import trundle as tr

T = np.arange(100) / 40.0


def test_the_height_shows_where_the_ball_rises_and_falls() -> None:
    """In a hollow, the centre at the height R − (R − a) cos θ is seen 1/(1 − z/H) times as far out."""
    radius, height = 0.3, 0.7
    angle = in_hollow(T, radius, 0.4, 1.0)
    x, z = (radius - RADIUS) * np.sin(angle), radius - (radius - RADIUS) * np.cos(angle)
    data = seen(T, 5e-4, 4, x=x / (1 - z / height), y=0.0 * T)
    hollow = scenario(support={"kind": "bowl", "radius": radius}, start={"position": [0.2, 0.0]})
    found = tr.fit(data, hollow, ["camera.height"], noise="0.5 mm", camera={"height": "1 m"})
    one = found["camera.height"]
    assert one.sigma is not None
    assert abs(one.value - height) < 4 * one.sigma < 0.01
    assert found.passed


def test_the_clock_shows_where_the_support_moves_by_it() -> None:
    """On a plane shaken as A sin νt a ball is taken along by k/(1 + k) of it: the phase tells the time."""
    amplitude, rate, offset = 0.03, 5.0, 0.13
    x = 0.1 + 0.02 * T + 0.4 / 1.4 * amplitude * np.sin(rate * (T + offset))
    shaken = {"kind": "plane", "motion": {"kind": "shake", "amplitude": [amplitude, 0.0, 0.0], "rate": rate}}
    found = tr.fit(seen(T, 3e-4, 5, x=x, y=0.0 * T), scenario(support=shaken), ["camera.time_offset"], noise="0.3 mm")
    one = found["camera.time_offset"]
    assert one.sigma is not None
    assert abs(one.value - offset) < 4 * one.sigma < 0.01
    assert found.passed
