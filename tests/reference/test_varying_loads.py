"""A ball on a fixed plane under any force and torque, time-dependent too: Landau's reactions, and quadratures."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.tolerances import SOLVER

import trundle as tr
from trundle.solve.methods import tolerance_of

G, A, M = 9.80665, 0.03, 0.2
FORCE = ("0.05*sin(3*t)", "0.02*t - 0.01", "0.1*cos(t)")
TORQUE = ("1e-4*exp(-t)", "2e-4*cos(2*pi*t)", "3e-5*t**2")
BODIES = {"solid": tr.Body.solid_sphere(A, M), "shell": tr.Body.hollow_sphere(A, M)}


def F(t: Any) -> tuple[Any, ...]:
    return mpmath.sin(3 * t) / 20, t / 50 - mpmath.mpf(1) / 100, mpmath.cos(t) / 10


def K(t: Any) -> tuple[Any, ...]:
    return mpmath.exp(-t) / 10**4, 2 * mpmath.cos(2 * mpmath.pi * t) / 10**4, 3 * t**2 / 10**5


@pytest.fixture(params=["taylor", "runge-kutta"])
def method(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(params=BODIES)
def run(request: pytest.FixtureRequest, method: str) -> tr.Trajectory:
    system = tr.RollingSystem(BODIES[request.param], tr.Support(tr.Plane()), loads=(tr.Force(FORCE), tr.Torque(TORQUE)))
    start = system.place((0.1, -0.2), (0.3, 0.1), spin=2.0)
    return tr.simulate(system, start, 3.0, 0.25, method=method)


def bound(run: tr.Trajectory) -> float:
    turned = float(np.abs(run.data.angular_velocity).max()) * 3.0
    return SOLVER(4 * turned, tolerance_of(run.method))


def twice(rate: Callable[[Any], Any], t: float) -> tuple[float, float]:
    """Return ∫ and ∬ of a rate from 0 to t."""
    once = mpmath.quad(rate, [0, t / 2, t])
    return float(once), float(mpmath.quad(lambda s: (t - s) * rate(s), [0, t / 2, t]))


def test_path_and_spin_are_quadratures(run: tr.Trajectory) -> None:
    k = mpmath.mpf(2) / 5 if run.system.body.inertia_ratio == 0.4 else mpmath.mpf(2) / 3
    share = 1 / (M * (1 + k))
    for i, t in enumerate(run.data.time.values):
        vx, x = twice(lambda s: share * (F(s)[0] + K(s)[1] / A), float(t))
        vy, y = twice(lambda s: share * (F(s)[1] - K(s)[0] / A), float(t))
        spin, _ = twice(lambda s: K(s)[2] / (k * M * A * A), float(t))
        data = run.data.isel(time=i)
        wanted = [0.1 + 0.3 * t + x, -0.2 + 0.1 * t + y, A]
        assert np.allclose(data.position, wanted, rtol=0, atol=bound(run) * (1 + np.abs(wanted).max()))
        assert np.allclose(data.velocity, [0.3 + vx, 0.1 + vy, 0.0], rtol=0, atol=bound(run) * 2)
        wanted = [-(0.1 + vy) / A, (0.3 + vx) / A, 2.0 + spin]
        assert np.allclose(data.angular_velocity, wanted, rtol=0, atol=bound(run) * np.abs(wanted).max())


def test_reactions_are_the_lectures(run: tr.Trajectory) -> None:
    # R_x = (5/7)K_y/a − (2/7)F_x, R_y = −(5/7)K_x/a − (2/7)F_y for the solid ball; 3/5 and 2/5 for a shell.
    turning, pushing = (5 / 7, 2 / 7) if run.system.body.inertia_ratio == 0.4 else (3 / 5, 2 / 5)
    for t, R in zip(run.data.time.values, run.data.contact_force.values, strict=True):
        (fx, fy, fz), (kx, ky, _) = (tuple(map(float, part)) for part in (F(mpmath.mpf(t)), K(mpmath.mpf(t))))
        wanted = [turning * ky / A - pushing * fx, -turning * kx / A - pushing * fy, M * G - fz]
        assert np.allclose(R, wanted, rtol=0, atol=1e-13 * M * G)


def test_the_card_shows_them_and_they_hold(run: tr.Trajectory) -> None:
    card = run.card()
    assert card.passed
    assert {"reaction in the plane", "acceleration in the plane"} <= {figure.name for figure in card.figures}


def test_a_vertical_torque_changes_no_reaction() -> None:
    system, twisted = (
        tr.RollingSystem(BODIES["solid"], tr.Support(tr.Plane()), loads=(tr.Force(FORCE), tr.Torque((1e-4, 2e-4, kz))))
        for kz in (0.0, "0.5*sin(t)")
    )
    runs = [tr.simulate(one, one.place(velocity=(0.3, 0.1)), 2.0, 0.25) for one in (system, twisted)]
    for name in ("contact_force", "position", "velocity"):
        assert np.allclose(*(run.data[name] for run in runs), rtol=0, atol=1e-13)
    assert abs(runs[1].data.angular_velocity[-1, 2].item()) > 1.0


def test_a_planted_fault_in_the_reaction_fails_the_card() -> None:
    run = tr.Scenario.load("ball-under-torque").run()
    force = run.data.contact_force.copy()
    force[:, 0] *= 1 + 1e-9
    from dataclasses import replace

    card = replace(run, data=run.data.assign(contact_force=force)).card()
    assert "reaction in the plane" in [figure.name for figure in card.failures]


def test_formulas_survive_a_file(tmp_path: Any) -> None:
    system = tr.RollingSystem(BODIES["solid"], tr.Support(tr.Plane()), loads=(tr.Force(FORCE), tr.Drag(0.01, 2.0)))
    run = tr.simulate(system, system.place(), 1.0, 0.25)
    again = tr.Trajectory.load(run.save(tmp_path / "run.nc"))
    assert again.system == system
    assert again.at([0.6]).data.position.identical(run.at([0.6]).data.position)
