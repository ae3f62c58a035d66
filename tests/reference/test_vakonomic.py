"""The vakonomic equations: against Euler and Lagrange in Euler angles, and against the action; and they are wrong."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.analysis.vakonomic.equations import TOLERANCE

BALL = tr.Body.solid_sphere(0.5, 2.0)
OMEGA, TILT, MULTIPLIERS = 1.3, 0.02, (0.05, -0.3)
SYSTEM = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(OMEGA), tilt=TILT))
START = SYSTEM.place((0.2, 0.1), (0.3, 0.1), spin=0.7)


@pytest.fixture(scope="module")
def in_euler_angles() -> Any:
    """Accelerations and λ̇ from L' = L + λ·(constraint), by SymPy, with Euler angles for the orientation."""
    sp = pytest.importorskip("sympy")
    t = sp.Symbol("t")
    m, a, inertia, omega, force = sp.symbols("m a I omega f")
    q = [sp.Function(name)(t) for name in ("x", "y", "phi", "theta", "psi")]
    x, y, phi, theta = q[:4]
    lam = [sp.Function(name)(t) for name in ("lambda_x", "lambda_y")]
    d = [c.diff(t) for c in q]
    turning = (
        d[3] * sp.cos(phi) + d[4] * sp.sin(theta) * sp.sin(phi),
        d[3] * sp.sin(phi) - d[4] * sp.sin(theta) * sp.cos(phi),
        d[2] + d[4] * sp.cos(theta),
    )
    slips = (d[0] + omega * y - a * turning[1], d[1] - omega * x + a * turning[0])
    lagrangian = (
        m * (d[0] ** 2 + d[1] ** 2) / 2
        + inertia * (d[3] ** 2 + d[2] ** 2 + d[4] ** 2 + 2 * d[2] * d[4] * sp.cos(theta)) / 2
        + force * x
        + sum(one * slip for one, slip in zip(lam, slips, strict=True))
    )
    equations = [sp.diff(sp.diff(lagrangian, rate), t) - sp.diff(lagrangian, c) for c, rate in zip(q, d, strict=True)]
    equations += [sp.diff(slip, t) for slip in slips]
    unknown = sp.symbols("u:7")
    plain = sp.symbols("q:5 v:5 l:2")
    for_ = dict(zip([c.diff(t, 2) for c in q], unknown[:5], strict=True))
    for_ |= dict(zip([one.diff(t) for one in lam], unknown[5:], strict=True))
    steps = (
        for_,
        dict(zip(d, plain[5:10], strict=True)),
        dict(zip([*q, *lam], [*plain[:5], *plain[10:]], strict=True)),
    )
    for step in steps:
        equations = [equation.subs(step) for equation in equations]
    matrix, right = sp.linear_eq_to_matrix(equations, unknown)
    made = sp.lambdify([plain, (m, a, inertia, omega, force)], [matrix, right], cse=True)
    numbers = (2.0, 0.5, 0.4 * 2.0 * 0.25, OMEGA, 2.0 * 9.80665 * math.sin(TILT))

    def slopes(_: float, state: Any) -> Any:
        A, b = made(state, numbers)
        return np.concatenate([state[5:10], np.linalg.solve(np.asarray(A, float), np.asarray(b, float).ravel())])

    return slopes


def test_it_is_what_euler_and_lagrange_say_in_euler_angles(in_euler_angles: Any) -> None:
    from scipy.integrate import solve_ivp

    phi, theta, psi = 0.3, 1.1, 0.2
    to_space = np.array(
        [
            [0.0, math.cos(phi), math.sin(theta) * math.sin(phi)],
            [0.0, math.sin(phi), -math.sin(theta) * math.cos(phi)],
            [1.0, 0.0, math.cos(theta)],
        ]
    )
    rates = np.linalg.solve(to_space, START.angular_velocity)
    begin = [*START.position[:2], phi, theta, psi, *START.velocity[:2], *rates, *MULTIPLIERS]
    times = np.linspace(0.0, 2.0, 9)
    other = solve_ivp(in_euler_angles, (0, 2), begin, method="DOP853", rtol=1e-12, atol=1e-14, t_eval=times).y
    ours = tr.vakonomic_path(SYSTEM, START, times, MULTIPLIERS)
    assert np.abs(ours.position - other[:2].T).max() <= SOLVER(100, 1e-12, np.abs(other[:2]).max())
    assert np.abs(ours.multipliers - other[10:].T).max() <= SOLVER(100, 1e-12, np.abs(other[10:]).max())


def test_energy_with_the_multipliers_work_and_the_length_of_the_momentum_are_constant() -> None:
    path = tr.vakonomic_path(SYSTEM, START, np.linspace(0.0, 3.0, 31), MULTIPLIERS)
    length = np.linalg.norm(path.momentum, axis=1)
    assert np.ptp(path.energy) > 0.1
    assert np.ptp(path.conserved) <= SOLVER(100, TOLERANCE, np.abs(path.energy).max())
    assert np.ptp(length) <= SOLVER(100, TOLERANCE, np.abs(path.momentum).max())


# --- the action itself ----------------------------------------------------------------------------------

STEPS, LENGTH = 200, 1.0


def _rolled(turning: Any, h: float) -> tuple[Any, float]:
    """Roll by Ω(t), given at steps and half-steps: where it ends (x, y and orientation), and the action.

    The rolling constraint gives V; Runge and Kutta's method of fourth order does the rest.
    """
    m, a, moment, force = 2.0, 0.5, 0.4 * 2.0 * 0.25, 2.0 * 9.80665 * math.sin(TILT)

    def rates(state: Any, W: Any) -> Any:
        x, y, s, i, j, k, _ = state.tolist()
        p, q, r = W.tolist()
        Vx, Vy = -OMEGA * y + a * q, OMEGA * x - a * p
        lagrangian = 0.5 * m * (Vx * Vx + Vy * Vy) + 0.5 * moment * (p * p + q * q + r * r) + force * x
        turn = (-p * i - q * j - r * k, p * s + q * k - r * j, q * s + r * i - p * k, r * s + p * j - q * i)
        return np.array([Vx, Vy, *(0.5 * part for part in turn), lagrangian])

    state = np.array([*START.position[:2], 1.0, 0.0, 0.0, 0.0, 0.0])
    for i in range(STEPS):
        W0, W1, W2 = turning[2 * i], turning[2 * i + 1], turning[2 * i + 2]
        k1 = rates(state, W0)
        k2 = rates(state + h / 2 * k1, W1)
        k3 = rates(state + h / 2 * k2, W1)
        k4 = rates(state + h * k3, W2)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return np.array([state[0], state[1], *(2 * state[3:6])]), float(state[6])


def _out_of_stationary(turning: Any) -> float:
    """How much the action changes for rolling variations with both ends held, beside how much it changes for free ones.

    Variations of Ω are taken along polynomials; a change of the action that no combination of the end's changes
    explains is one at fixed ends.
    """
    h, s = LENGTH / STEPS, np.linspace(-1.0, 1.0, 2 * STEPS + 1)
    shapes = [np.polynomial.legendre.Legendre.basis(n)(s)[:, None] * e for n in range(6) for e in np.eye(3)]
    size = 1e-4
    ends, actions = [], []
    for shape in shapes:
        (end_up, up), (end_down, down) = _rolled(turning + size * shape, h), _rolled(turning - size * shape, h)
        ends.append((end_up - end_down) / (2 * size))
        actions.append((up - down) / (2 * size))
    changes, gradient = np.array(ends), np.array(actions)
    explained = changes @ np.linalg.lstsq(changes, gradient, rcond=None)[0]
    return float(np.linalg.norm(gradient - explained) / np.linalg.norm(gradient))


def test_it_makes_the_action_stationary_and_the_true_path_does_not() -> None:
    times = np.linspace(0.0, LENGTH, 2 * STEPS + 1)
    true = tr.simulate(SYSTEM, START, duration=LENGTH, every=LENGTH / (2 * STEPS), method="exact")
    for multipliers in ((0.0, 0.0), MULTIPLIERS):
        path = tr.vakonomic_path(SYSTEM, START, times, multipliers)
        assert _out_of_stationary(path.angular_velocity) < 1e-6  # of differences over 1e-4
    assert _out_of_stationary(true.data.angular_velocity.values) > 1e-3


# --- right and wrong ------------------------------------------------------------------------------------


def test_without_turning_and_forces_both_are_the_straight_line() -> None:
    system = tr.RollingSystem(BALL, tr.Support(tr.Plane()))
    start = system.place((0.2, 0.1), (0.3, 0.1), spin=4.0)
    path = tr.vakonomic_path(system, start, [0.0, 5.0])
    assert np.abs(path.position[-1] - [1.7, 0.6]).max() <= EXACT(64, 2)
    assert not path.multipliers.any()


def test_straight_down_a_slope_both_agree_and_across_it_only_without_spin_for_an_instant() -> None:
    slope = tr.RollingSystem(BALL, tr.Support(tr.Plane(), tilt=0.1))
    down = tr.vakonomic_path(slope, slope.place(), [0.0, 2.0]).position[-1]
    assert abs(down[0] - 9.80665 * math.sin(0.1) / 1.4 * 2) <= SOLVER(100, TOLERANCE, down[0])
    assert abs(down[1]) <= SOLVER(100, TOLERANCE, down[0])
    start = slope.place(velocity=(0.0, 0.3))
    across = tr.vakonomic_path(slope, start, [0.0, 2.0]).position[-1]
    true = tr.simulate(slope, start, duration=2.0, every=2.0).data.position.values[-1, :2]
    assert math.dist(across, true) > 0.01


def test_on_the_turntable_it_leaves_the_circle_whatever_the_multipliers() -> None:
    scenario = tr.Scenario.load("level-turntable-nudged")
    found = tr.compare_vakonomic(scenario)
    middle = found.position.mean(axis=0)
    assert np.ptp(np.hypot(*(found.position[:-1] - found.position[:-1].mean(axis=0)).T)) <= EXACT(64, 1)
    assert np.hypot(*middle) == pytest.approx(0.1, abs=1e-3)
    for multipliers in ([0.0, 0.0], [0.02, 0.0], [0.0, 0.02], [-0.02, 0.0], [0.0, -0.02], [0.3, 0.3]):
        other = tr.compare_vakonomic(scenario, multipliers)
        assert other.apart.max() > 0.3
        assert other.leaves is not None
        assert other.leaves < 3.0


@pytest.mark.parametrize(
    ("system", "said"),
    [
        (tr.RollingSystem(BALL, tr.Support(tr.Cylinder(2.0), tilt="90 deg")), "no plane"),
        (tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Wobble(2.0, 0.01))), "steadily"),
        (tr.RollingSystem(tr.Body.hoop(0.1, 1.0), tr.Support(tr.Plane())), "no sphere"),
        (tr.RollingSystem(BALL, tr.Support(tr.Plane()), (tr.Drag(0.1),)), "a load"),
        (tr.RollingSystem(BALL, tr.Support(tr.Plane()), (tr.Torque((0.1, 0.0, 0.0)),)), "a load"),
    ],
)
def test_what_it_is_not_for(system: tr.RollingSystem, said: str) -> None:
    with pytest.raises(tr.OutOfDomainError, match=said):
        tr.vakonomic_path(system, START, [0.0, 1.0])


@pytest.mark.parametrize("multipliers", [(0.0,), (0.0, math.nan), ("a", 0.0), 3.0])
def test_bad_multipliers(multipliers: Any) -> None:
    with pytest.raises(tr.InvalidValueError, match="multipliers"):
        tr.vakonomic_path(SYSTEM, START, [0.0, 1.0], multipliers)


def test_a_path_that_runs_away_is_an_error_and_not_a_wait() -> None:
    wild = tr.RollingSystem(BALL, tr.Support(tr.Plane(), motion=tr.Spin(30.0)))
    with pytest.raises(tr.SolverError, match="reach"):
        tr.vakonomic_path(wild, wild.place((0.2, 0.0), (0.0, 0.1)), [0.0, 1000.0])


@pytest.mark.parametrize("name", ["level-turntable-nudged", "tilted-turntable", "level-turntable-corotating"])
def test_the_figure_says_which_is_true(name: str) -> None:
    found = tr.compare_vakonomic(tr.Scenario.load(name))
    texts = [text.get_text() for text in found.plot().legends[0].get_texts()]
    assert texts[0].startswith("TRUE")
    assert all(text.startswith("WRONG") for text in texts[1:3])
    assert "wrong" in str(found)
