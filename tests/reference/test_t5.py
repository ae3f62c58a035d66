"""T5 in floats against fifty digits: nothing is lost as ω, the tilt and the drag go to 0, nor at large times."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable
from dataclasses import astuple
from typing import Any

import array_api_strict
import mpmath
import numpy as np
import pytest
from tests.reference.t5 import Ball

from trundle.solve.exact import SphereOnPlane

RATES = [0.0, 1e-12, -1e-12, 1e-9, 1e-6, -1e-3, 0.03, 1.0, -3.487, 30.0, 1e3, -1e3]
RATIOS = [2 / 5, 2 / 3, 0.1]
DRAGS = [0.0, 1e-12, 1e-6, 1e-3, 0.05, 1.0]
TIMES = [10.0**n * factor for n in range(-6, 6) for factor in (1.0, 3.7)] + [1e6]
VECTORS = ("position", "velocity", "angular_velocity", "contact_force")


def balls(seed: str, count: int) -> list[Ball]:
    """Return balls of every rate, ratio and drag, at rest or not, pushed or not."""
    draw = random.Random(seed)  # noqa: S311
    found = []
    for i in range(count):
        rate, ratio, drag = RATES[i % 12], RATIOS[i % 3], draw.choice(DRAGS)
        pair = lambda size: (draw.uniform(-size, size), draw.uniform(-size, size))  # noqa: E731
        moving, pushed, turned = draw.random() < 0.7, draw.random() < 0.5, draw.random() < 0.5
        found.append(
            Ball(
                radius=draw.choice([0.005, 0.025, 1.0]),
                mass=draw.choice([0.0027, 0.065, 5.0]),
                inertia_ratio=ratio,
                rate=rate,
                position=pair(1.0) if draw.random() < 0.8 else (0.0, 0.0),
                velocity=pair(2.0) if moving else (0.0, 0.0),
                spin=draw.uniform(-10, 10),
                force=(*pair(1.0), -draw.uniform(0, 5)) if pushed else (0.0, 0.0, -1.0),
                torque=(*pair(0.01), draw.uniform(-0.01, 0.01)) if turned else (0.0, 0.0, 0.0),
                drag=drag,
            )
        )
    return found


def check(ball: Ball, times: Iterable[float], found: dict[str, Any], phases: float | None = None) -> None:
    """Compare (x, y) of each quantity, arrays (n, 2) or more columns, with the reference.

    Numbers and arrays reduce κt by whole turns to more digits than it has, so that its last place is not lost either;
    the decay γt is known to that place.
    """
    phases = (1.0 if ball.drag else 0.0) if phases is None else phases
    for i, t in enumerate(times):
        wanted = ball.at(t)
        for name, rows in found.items():
            quantity = wanted[name]
            off = abs(mpmath.mpc(float(rows[i][0]), float(rows[i][1])) - quantity.value)
            assert off <= quantity.bound(t, phases), f"{name} of {ball} at t = {t}: off by {float(off):.3g}"


def rows(vector: Any, count: int) -> Any:
    return np.broadcast_to(vector.array(), (count, 3))


@pytest.mark.parametrize("rate", RATES)
def test_floats(rate: float) -> None:
    for ball in [ball for ball in balls("floats", 72) if ball.rate == rate]:
        motion = SphereOnPlane(*astuple(ball))
        for t in TIMES[::3]:
            parts = motion.motion_at(t)
            check(ball, [t], {name: [list(part)] for name, part in zip(VECTORS, parts, strict=True)})
            assert parts[0].z == ball.radius
            assert parts[1].z == 0
            assert parts[3].z == -ball.force[2]
            spin = ball.at(t)["spin"]
            assert abs(parts[2].z - spin.value) <= spin.bound(t)


@pytest.mark.parametrize("rate", RATES)
def test_arrays(rate: float) -> None:
    times = np.array(TIMES)
    for ball in [ball for ball in balls("arrays", 72) if ball.rate == rate]:
        parts = SphereOnPlane(*astuple(ball)).motion_at(times)
        check(ball, TIMES, {name: rows(part, times.size) for name, part in zip(VECTORS, parts, strict=True)})


def test_position_alone_is_the_same_position() -> None:
    for ball in balls("alone", 12):
        motion, times = SphereOnPlane(*astuple(ball)), np.array(TIMES)
        assert np.array_equal(motion.position_at(times).array(), motion.motion_at(times)[0].array())


def test_arrays_of_the_array_api_standard() -> None:
    for ball in balls("standard", 12):
        times = array_api_strict.asarray(TIMES, dtype=array_api_strict.float64)
        parts = SphereOnPlane(*astuple(ball)).motion_at(times)
        found = {}
        for name, part in zip(VECTORS, parts, strict=True):
            columns = [np.broadcast_to(np.asarray(c), (len(TIMES),)) for c in (part.x, part.y)]
            found[name] = np.stack(columns, axis=1)
        check(ball, TIMES, found)


def test_compiled_by_heyoka() -> None:
    pytest.importorskip("heyoka")
    for ball in balls("compiled", 10):
        path = SphereOnPlane(*astuple(ball)).compiled()
        check(ball, TIMES, {"position": np.asarray(path(np.array(TIMES)[None])).T}, phases=1.0)


@pytest.mark.parametrize("step", [1e-6, 1e-3, 0.1, 7.0])
def test_a_path_on_an_even_grid(step: float) -> None:
    for ball in balls("grid", 24):
        path = SphereOnPlane(*astuple(ball)).path_on_grid(step, 10_000)
        some = [0, 1, 2047, 2048, 2049, 5000, 9999]
        assert path.shape == (2, 10_000)
        check(ball, [i * step for i in some], {"position": path[:, some].T}, phases=2.0)


def stacked(members: list[Ball]) -> SphereOnPlane:
    """Return one closed form whose parameters are arrays of members."""

    def stack(values: list[Any]) -> Any:
        if isinstance(values[0], tuple):
            return tuple(stack(list(part)) for part in zip(*values, strict=True))
        return np.array(values)[:, None]

    return SphereOnPlane(*(stack(list(column)) for column in zip(*map(astuple, members), strict=True)))


def test_a_thousand_balls_are_one_call() -> None:
    members, times = balls("members", 1000), np.array([0.0, 1e-3, 0.5, 4.0, 700.0])
    together = [np.broadcast_to(part.array(), (1000, 5, 3)) for part in stacked(members).motion_at(times)]
    for i, ball in enumerate(members):
        alone = SphereOnPlane(*astuple(ball)).motion_at(times)
        for name, part, of_all in zip(VECTORS, alone, together, strict=True):
            # One ball, with its zeros known, takes shorter ways: the last digits may differ.
            for j, t in enumerate(times.tolist()):
                off = np.abs(of_all[i, j] - rows(part, 5)[j]).max()
                if off:
                    spin = abs(ball.spin) + abs(ball.at(t)["spin"].value)
                    assert off <= 2 * ball.at(t)[name].bound(t) + 1e-15 * spin, f"{name} of {ball} at {t}"


def test_members_are_as_exact_as_one_ball() -> None:
    members = balls("exact members", 36)
    together = [
        np.broadcast_to(part.array(), (36, len(TIMES), 3)) for part in stacked(members).motion_at(np.array(TIMES))
    ]
    for i, ball in enumerate(members):
        check(ball, TIMES, {name: part[i] for name, part in zip(VECTORS, together, strict=True)})


def _tenfold(vary: Callable[[float], Ball], exponents: Iterable[int]) -> None:
    for n in exponents:
        ball = vary(10.0**n)
        times = np.array([1e-3, 0.1, 1.0, 30.0])
        parts = SphereOnPlane(*astuple(ball)).motion_at(times)
        check(ball, times.tolist(), {name: rows(part, 4) for name, part in zip(VECTORS, parts, strict=True)})


def test_no_digit_is_lost_on_the_way_to_a_resting_table() -> None:
    push = {"force": (0.03, 0.0, -0.6), "position": (0.1, -0.2), "velocity": (0.3, 0.1)}
    _tenfold(lambda x: Ball(0.025, 0.065, 0.4, x, **push), range(-18, 4))
    _tenfold(lambda x: Ball(0.025, 0.065, 0.4, 0.0, **push, drag=x), range(-18, 1))
    _tenfold(lambda x: Ball(0.025, 0.065, 0.4, x, **push, drag=x), range(-18, 1))


def test_no_digit_is_lost_where_the_two_ways_of_evaluating_meet() -> None:
    # |λt| = 1 is where the series hands over to the exponential.
    for nearly in (1 - 1e-9, 1 - 2.0**-52, 1.0, 1 + 2.0**-52, 1 + 1e-9):
        for drag in (0.0, 0.05):
            ball = Ball(0.025, 0.065, 0.4, 3.5 * nearly, (0.1, 0.0), (0.3, 0.1), force=(0.03, 0.0, -0.6), drag=drag)
            t = 1 / float(np.hypot(ball.rate * 0.4 / 1.4, ball.drag / (0.065 * 1.4)))
            parts = SphereOnPlane(*astuple(ball)).motion_at(t)
            check(ball, [t], {name: [list(part)] for name, part in zip(VECTORS, parts, strict=True)})


def test_no_digit_is_lost_near_a_whole_turn() -> None:
    # There 1 − cos κt and sin κt are tiny, and so is the way from the start.
    ball = Ball(0.025, 0.065, 0.4, 3.5, (0.0, 0.0), (0.3, 0.1))
    motion = SphereOnPlane(*astuple(ball))
    for away in (1e-3, 1e-6, 1e-9):
        t = motion.period * (1 + away)
        parts = motion.motion_at(t)
        check(ball, [t], {name: [list(part)] for name, part in zip(VECTORS, parts, strict=True)})
