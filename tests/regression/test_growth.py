"""How far two honest runs may be apart: what a method errs in its steps, as a random walk that the motion magnifies."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import scipy.integrate

import trundle as tr
from trundle.solve import runge_kutta
from trundle.solve.dense import Dense
from trundle.solve.methods import Method
from trundle.verify.bounds import A_STEP, bound_of, own_sizes, sizes_of, turned_in
from trundle.verify.compared import Compared
from trundle.verify.growth import MOST, Growth, growth

BALL = tr.Body.solid_sphere(0.02, 0.05)
G = 9.80665


def a_growth(magnified: float, carried: float = 0.0) -> Growth:
    return Growth(np.array([0.0, 1.0]), np.array([0.0, magnified]), np.zeros(0), 1.0, carried)


@pytest.mark.parametrize("steps", [10, 1000, 20_000])
@pytest.mark.parametrize("magnified", [100.0, 1e5])
def test_a_bound_is_what_as_many_errors_add_up_to(steps: int, magnified: float) -> None:
    """Errors of any size up to that of a step add up to that times √(steps/3), in the mean."""
    method, random = Method.of("taylor", 1e-15), np.random.default_rng(steps)
    errors = random.uniform(-1.0, 1.0, (400, steps)) * A_STEP * method.tolerance
    adds_up = math.sqrt((errors.sum(axis=1) ** 2).mean()) * magnified
    (_, allowed) = a_growth(magnified).widened(bound_of(method), steps, a_growth(magnified).at(np.array([0.0, 1.0])))
    if allowed > bound_of(method):
        assert adds_up == pytest.approx(allowed / math.sqrt(3), rel=0.15)
    else:
        assert adds_up < allowed


def test_what_was_apart_before_is_magnified_too_and_too_much_tells_nothing() -> None:
    bound, much = 1e-12, a_growth(1e4, carried=3e-9)
    (_, allowed) = much.widened(bound, 1, much.at(much.times))
    assert allowed == pytest.approx(1e4 * 3e-9, rel=1e-2)
    lost = a_growth(1e12)
    assert lost.widened(bound, 1e4, lost.magnified)[-1] == MOST
    assert lost.told_until(bound, 1e4) == 1.0


def compared(system: tr.RollingSystem, start: tr.State, end: float, name: str = "runge-kutta") -> Compared:
    method, times = Method.of(name), np.linspace(start.time, end, 11)
    kept = method.dense(system, start, end)
    assert isinstance(kept, Dense)
    ours = kept(times)
    return Compared(system, start, ours, ours, method, method, sizes_of(system, ours), turned_in(ours), kept)


SHAKEN = tr.Support(tr.Plane(), motion=tr.Shake((0.0, 0.0, 1e-4), 300.0), friction=0.2, restitution=0.6)
CASES = {
    "shaken as it turns by a radian": (tr.RollingSystem(BALL, SHAKEN), {"velocity": (0.02, 0.0)}, 1.0),
    "bouncing": (
        tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.2, restitution=0.6)),
        {"velocity": (0.3, 0.0, 0.0), "height": 0.1},
        0.5,
    ),
    "in a bowl": (tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.3))), {"position": (0.1, 0.0)}, 3.0),
}


@pytest.mark.parametrize("case", CASES)
def test_each_step_counts_once(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Counted where SciPy makes them."""
    system, placed, end = CASES[case]
    taken: list[int] = []
    step = scipy.integrate.DOP853.step

    def counted(stepper: Any) -> Any:
        taken.append(1)
        return step(stepper)

    monkeypatch.setattr(scipy.integrate.DOP853, "step", counted)
    monkeypatch.setattr(runge_kutta, "available", lambda: False)
    both = compared(system, system.place(**placed), end)
    assert both.kept is not None
    assert both.kept.steps == len(taken)
    assert both._steps == max(len(taken), both.turned)
    assert both._steps > 1.5 * both.turned


def test_beside_a_closed_form_there_is_a_step_a_radian_of_the_fastest_rate() -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(3.0)))
    start = system.place((0.1, 0.0), (0.0, 0.2))
    ours = Method.of("exact").solve(system, start, np.linspace(0.0, 5.0, 11))
    sizes, method = sizes_of(system, ours), Method.of("taylor")
    both = Compared(system, start, ours, ours, method, method, sizes, turned_in(ours))
    turned = float(np.linalg.norm(ours.angular_velocity, axis=1).max()) * 5.0
    assert turned + 5.0 * 3.0 <= both._steps <= turned + 5.0 * (3.0 + 2.0)  # the table's rate, and that of the circle


def test_a_ball_in_a_narrow_pipe_goes_round_more_often_than_it_turns() -> None:
    pipe = tr.RollingSystem(tr.Body.solid_sphere(0.059, 0.0173), tr.Support(tr.Cylinder(0.060)))
    start = pipe.place((0.0, 0.0), (1.8, 0.0))
    ours = Method.of("exact").solve(pipe, start, np.linspace(0.0, 2.0, 300))
    sizes, method = sizes_of(pipe, ours), Method.of("taylor")
    both = Compared(pipe, start, ours, ours, method, method, sizes, turned_in(ours))
    assert both._steps > 2.0 * 1.8 / 0.001
    assert turned_in(ours) < 100


@pytest.mark.parametrize("rate", [6.0, 6.5])
def test_what_runs_away_grows_as_theory_says(rate: float) -> None:
    """On a plane under F = +c (x, y) all distances grow as e^{λt} in the end, λ² = 5c/(7m)."""
    push = tr.Potential(f"-{0.5 * rate**2 * 1.4 * BALL.mass!r}*(x**2 + y**2)")
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=[push])
    start, times = system.place((1e-3, 0.0)), np.linspace(0.0, 1.5, 61)
    method = Method.of("taylor")
    ours = method.solve(system, start, times)
    found = growth(system, start, ours, method, sizes_of(system, ours))
    assert found.until == 1.5
    sooner, later = np.diff(found.at(np.array([1.0, 1.25, 1.5])))  # less what does not grow
    assert later / sooner == pytest.approx(math.exp(rate * 0.25), rel=0.02)


@pytest.mark.parametrize("sideways", [1e-6, -1e-6])
def test_what_a_small_change_does_to_a_free_axle_counts_too(sideways: float) -> None:
    table = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.FreeAxle(1e-4)), (tr.Force((1.0, 0.0, 0.0)),))
    times, method = np.linspace(0.0, 0.3, 21), Method.of("taylor")
    start = table.place((-0.1, 0.0), (0.5, 0.0), spin=0.0)  # over the axle, and the table stays as it is
    ours = method.solve(table, start, times)
    other = method.solve(table, table.place((-0.1, 0.1 * sideways), (0.5, 0.0), spin=0.0), times)
    sizes = sizes_of(table, ours)
    by = np.abs(other.support_coordinates - ours.support_coordinates) / own_sizes(table, ours, sizes)
    assert np.abs(ours.support_coordinates).max() < 1e-12
    assert by.max() > 50 * abs(sideways)  # a little of the ball is much of what stands still
    assert growth(table, start, ours, method, sizes).at(times)[-1] > by.max() / abs(sideways)
