"""The orientation against forty digits, against closed forms, and after a million circles."""

from __future__ import annotations

import math
from dataclasses import astuple
from typing import Any

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from tests.reference.t5 import Ball
from tests.reference.turning import DIGITS, power, quaternion_product, rotations
from tests.tolerances import EXACT

import trundle as tr
from trundle.solve.closed_form import orientations
from trundle.solve.exact import SphereOnPlane
from trundle.solve.orientation import orientation

LEVEL = Ball(0.025, 0.065, 0.4, 3.5, (0.1, 0.03), (0.05, 0.2), spin=-2.0)
BALLS = {
    "level": LEVEL,
    "level, put down": Ball(0.025, 0.065, 0.4, 3.5, (0.1, 0.03), (0.0, 0.0)),
    "tilted": Ball(0.025, 0.065, 0.4, 3.5, (0.1, 0.03), (0.05, 0.2), spin=3.0, force=(0.03, 0.0, -0.6)),
    "with drag": Ball(0.025, 0.065, 0.4, 8.0, (0.1, 0.03), (0.05, 0.2), spin=1.0, drag=0.02),
    "everything": Ball(
        0.025, 0.065, 2 / 3, -4.0, (0.1, 0.03), (0.05, 0.2), 1.0, (0.03, -0.02, -0.6), (2e-4, 1e-4, 3e-5), 0.01
    ),
    "slope": Ball(0.025, 0.065, 0.4, 0.0, (0.1, 0.03), (-0.3, 0.2), spin=4.0, force=(0.03, 0.0, -0.6)),
    "hardly turning": Ball(0.025, 0.065, 0.4, 1e-12, (0.1, 0.03), (0.05, 0.2), force=(0.03, 0.0, -0.6)),
    "fast table": Ball(0.1, 0.065, 0.1, 30.0, (0.1, 0.03), (0.05, 0.2), spin=-2.0),
}
HALF_TURNED = (1e-9, 0.6, 0.8, 0.0)


def found(ball: Ball, times: Any, start: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0), begin: float = 0.0) -> Any:
    motion = SphereOnPlane(*astuple(ball))
    state = tr.State((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), start, begin)
    return orientations(motion, state, np.asarray(times, dtype=float))


def off(q: Any, wanted: Any) -> float:
    return float(max(abs(mpf(float(part)) - other) for part, other in zip(q, wanted, strict=True)))


@pytest.mark.parametrize("name", BALLS)
def test_moderate_runs(name: str) -> None:
    times = [0.0, 0.01, 0.7, 1.5]
    for q, wanted in zip(found(BALLS[name], times), rotations(BALLS[name], times), strict=True):
        assert off(q, wanted) <= 1e-12


def test_it_does_not_depend_on_which_times_are_asked() -> None:
    alone, among = found(LEVEL, [2.5])[-1], found(LEVEL, np.linspace(0.0, 2.5, 2000))[-1]
    assert np.abs(alone - among).max() <= 1e-12


def test_the_start_is_turned_along() -> None:
    begin, times = 5.0, [5.0, 5.5, 6.0]
    ours = found(BALLS["tilted"], times, HALF_TURNED, begin)
    for q, turned in zip(ours, rotations(BALLS["tilted"], [0.0, 0.5, 1.0]), strict=True):
        assert off(q, quaternion_product(turned, HALF_TURNED)) <= 1e-12


CIRCLES = {
    "nudged": Ball(0.1, 0.065, 0.4, 3.5, (0.1, 0.03), (0.05, 0.2), spin=-1.0),
    "co-rotating": Ball(0.1, 0.065, 2 / 3, -20.0, (0.1, 0.03), (0.6, -2.0), spin=2.0),
    "put down": Ball(0.025, 0.065, 0.4, 3.5, (0.1, 0.03)),
}


@pytest.mark.parametrize("name", CIRCLES)
def test_a_million_circles(name: str) -> None:
    ball = CIRCLES[name]
    with mpmath.workdps(DIGITS):
        k, rate = mpf(ball.inertia_ratio), mpf(abs(ball.rate))
        period = 2 * mpmath.pi * (1 + k) / (rate * k)
        # Just before and just after a whole number of turns the choice of that number is the rounding's.
        times = [float(n * period + rest) for n in (3, 1000, 10**6 - 1, 10**6) for rest in (0, period / 3)]
        turns = [int(mpf(t) / period) for t in times]
        rests = [mpf(t) - n * period for t, n in zip(times, turns, strict=True)]
        order = sorted(range(len(times)), key=rests.__getitem__)
        *sorted_parts, once = rotations(ball, [*(rests[i] for i in order), period])
        within = dict(zip(order, sorted_parts, strict=True))
        for i, q in enumerate(found(ball, times)):
            wanted = quaternion_product(within[i], power(once, turns[i]))
            assert off(q, wanted) <= 1e-12


def test_uniform_precession() -> None:
    """A circle about the axis: seen from a frame that turns at κ, Ω does not change, so q is a product of two turns."""
    # k = 1/2 makes κ = ω/3 = 1 a float, and the circle's centre the axis to the last digit.
    ball = Ball(0.125, 0.5, 0.5, 3.0, (0.25, 0.0), (0.0, 0.25), spin=2.0)
    times = [0.3, 6.0, 700.0, 1e7]
    with mpmath.workdps(60):
        for t, q in zip(times, found(ball, times), strict=True):
            wanted = precessed((4, 0, 2), 1, t)
            assert off(q, wanted) <= 1e-12


def precessed(across_and_along: tuple[Any, Any, Any], rate: Any, t: float) -> tuple[Any, ...]:
    """The orientation where Ω keeps its size about an axis that turns at κ: from that frame it is Ω₀ − κ e₃."""
    x, y, z = across_and_along
    own, half = mpmath.matrix([x, y, z - rate]), mpf(t) / 2
    size = mpmath.norm(own)
    turned = (mpmath.cos(size * half), *(part / size * mpmath.sin(size * half) for part in own))
    return quaternion_product((mpmath.cos(rate * half), 0, 0, mpmath.sin(rate * half)), turned)


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.6, 0.0, 0.8), (0.0, 0.0, 0.0)])
def test_a_constant_angular_velocity_is_composed_as_scipy_does(axis: tuple[float, float, float]) -> None:
    from scipy.spatial.transform import Rotation

    # Ω = (iζ̇)/a on a fixed level plane.
    ball = Ball(0.5, 1.0, 0.4, 0.0, (0.0, 0.0), (5 * axis[1], -5 * axis[0]), spin=10 * axis[2])
    times = np.linspace(0.0, 4.0, 400)
    ours = found(ball, times, HALF_TURNED)
    start = Rotation.from_quat(np.array(HALF_TURNED) / math.hypot(*HALF_TURNED), scalar_first=True)
    wanted = [(Rotation.from_rotvec(10 * np.array(axis) * t) * start).as_matrix() for t in times]
    assert np.abs(Rotation.from_quat(ours, scalar_first=True).as_matrix() - wanted).max() <= EXACT(64 * 40, 1)


TURNING = {"fast about an axis that hardly turns": (1000, 1, 3), "slow about one that turns fast": (0.25, 200, 0.125)}


@pytest.mark.parametrize("name", TURNING)
def test_many_samples_share_a_step_and_a_sample_many_steps(name: str) -> None:
    """Ω of constant size about an axis that turns at κ: seen from there it is constant, as in uniform precession."""
    across, rate, along = TURNING[name]
    times = np.linspace(0.0, 20.0, 1501)
    q = orientation(
        lambda t: np.stack([across * np.cos(rate * t), across * np.sin(rate * t), along + 0 * t]), times, (1, 0, 0, 0)
    )
    with mpmath.workdps(60):
        for i in range(0, 1501, 100):
            wanted = precessed((across, 0, along), rate, float(times[i]))
            assert off(q[i], wanted) <= EXACT(4, math.hypot(across, along - rate) * 20)


def test_a_turn_that_nobody_saw_when_the_steps_were_chosen() -> None:
    """About one axis, and at rest whenever it is looked at first: the angle is an integral."""
    looks, end, speed = 32, 20.0, 43.0

    def turning(t: Any) -> Any:
        return np.outer(np.full(3, 3**-0.5), speed * np.sin(np.pi * looks * t / end) ** 2)

    times = np.linspace(0.0, end, 101)
    q = orientation(turning, times, (1, 0, 0, 0))
    wave = 2 * math.pi * looks / end
    half = 0.25 * speed * (times - np.sin(wave * times) / wave)
    wanted = np.stack([np.cos(half), *(3**-0.5 * np.sin(half),) * 3], axis=1)
    assert np.abs(q - wanted).max() <= EXACT(2, 0.5 * speed * end)


def test_no_step_crosses_a_kink() -> None:
    """A quarter of a turn about x, then one about y."""
    corner, end = math.pi / 2, math.pi

    def turning(t: Any) -> Any:
        return np.stack([np.where(t < corner, 1.0, 0.0), np.where(t < corner, 0.0, 1.0), 0 * t])

    q = orientation(turning, np.array([corner / 2, corner, end]), (1, 0, 0, 0), kinks=[corner])
    wanted = [(math.cos(math.pi / 8), math.sin(math.pi / 8), 0, 0), (0.5**0.5, 0.5**0.5, 0, 0), (0.5, 0.5, 0.5, -0.5)]
    assert np.abs(q - wanted).max() <= EXACT(8, 1)
    with pytest.raises(tr.SolverError, match="not smooth"):
        orientation(turning, np.array([3.0]), (1, 0, 0, 0))


def test_nothing_happens_at_half_a_turn() -> None:
    # From just before half a turn to just after it the quaternion goes on smoothly; its sign does not jump.
    ball = Ball(0.5, 1.0, 0.4, 0.0, (0.0, 0.0), (0.0, -0.5), spin=0.0)  # Ω = (1, 0, 0)
    near = math.pi + np.array([-1e-6, -1e-9, 0.0, 1e-9, 1e-6, 1.0])
    ours = found(ball, near)
    assert np.abs(ours[:, 0] - np.cos(near / 2)).max() <= EXACT(32, 1)
    assert np.abs(ours[:, 1] - np.sin(near / 2)).max() <= EXACT(32, 1)
    many = found(BALLS["tilted"], np.linspace(0.0, 4.0, 4001))
    assert (np.einsum("ni,ni->n", many[1:], many[:-1]) > 0.9).all()
    assert many[:, 0].min() < -0.5  # it has gone through half a turn


def test_it_stays_of_unit_length() -> None:
    many = found(BALLS["everything"], np.linspace(0.0, 50.0, 1001))
    assert np.abs(np.linalg.norm(many, axis=1) - 1).max() <= EXACT(4, 1)


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_the_numerical_methods_turn_the_same_way(method: str) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    table = tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05)
    system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    start = system.place((0.1, 0.03), (0.05, 0.2), spin=3.0, orientation=HALF_TURNED)
    ours = tr.simulate(system, start, duration=1.0, every=0.5, method=method)
    pull = 0.065 * 9.80665 * math.sin(0.05)
    ball = Ball(0.025, 0.065, 0.4, 3.5, (0.1, 0.03), (0.05, 0.2), 3.0, (pull, 0.0, -0.6))
    turned = rotations(ball, ours.data.time.values.tolist())
    for q, part in zip(ours.data.orientation.values, turned, strict=True):
        assert off(q, quaternion_product(part, start.orientation)) <= (1e-12 if method == "taylor" else 1e-9)
