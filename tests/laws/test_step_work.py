"""`auto` at a tolerance: whichever method takes less work to the same error, the same one every time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.tolerances import SOLVER

import trundle as tr
from trundle.solve import compiled_steps, step_work

pytest.importorskip("heyoka")
pytest.importorskip("numba")

COIN = tr.RollingSystem(tr.Body.disc(radius=0.012, mass=0.0075), tr.Support(tr.Plane()))
WOBBLING = COIN.place(attitude=(0.0, "80 deg", 0.0), velocity=(0.5, 0.0), spin=1.0)
G = 9.80665


def energy(run: Any) -> Any:
    """The rattleback's energy, from its samples alone."""
    body, data = run.system.body, run.data
    w, x, y, z = data.orientation.values.T
    Q = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    omega = np.einsum("jit,tj->ti", Q, data.angular_velocity.values)
    J = np.diag([2e-4, 1.6e-3, 1.7e-3])
    J[0, 1] = J[1, 0] = -2e-5
    turning = np.einsum("ti,ij,tj->t", omega, J, omega) / 2
    moving = body.mass * (data.velocity.values**2).sum(axis=1) / 2
    return turning + moving + body.mass * G * data.position.values[:, 2]


@pytest.fixture(scope="module")
def rattleback() -> Any:
    stone = tr.Body.ellipsoid(
        (0.2, 0.03, 0.02), mass=1.0, moments=(2e-4, 1.6e-3, 1.7e-3), products=(-2e-5, 0, 0), centre=(0, 0, 0.01)
    )
    system = tr.RollingSystem(stone, tr.Support(tr.Plane()))
    return system, system.place(attitude=(0.0, 0.02, 0.01), spin=-5.0)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-9])
def test_the_error_reached_is_of_the_tolerance_asked_for(rattleback: Any, tolerance: float) -> None:
    """Against Taylor's method at its finest, and against the energy, which needs no other run."""
    ours = tr.simulate(*rattleback, 30.0, 0.1, tolerance=tolerance)
    fine = tr.simulate(*rattleback, 30.0, 0.1)
    assert (ours.method, fine.method) == ("runge-kutta", "taylor")
    turned = float(np.linalg.norm(fine.data.angular_velocity.values, axis=1).mean() * 30.0)
    p, wanted = ours.data.contact.values, fine.data.contact.values
    assert np.abs(p - wanted).max() <= SOLVER(turned, tolerance, np.abs(wanted).max())
    E = energy(ours)
    kinetic = (E - G * fine.data.position.values[:, 2].min())[0]
    assert np.abs(E - E[0]).max() <= SOLVER(turned / 10, tolerance, kinetic)


def test_its_card_says_what_ran_and_passes(rattleback: Any) -> None:
    ours = tr.simulate(*rattleback, 20.0, 0.1, tolerance=1e-9)
    card = ours.card()
    assert card.method == "Runge-Kutta DOP853, tolerance 1e-11"
    assert ours.tolerance == 1e-11
    assert card.passed, str(card)


@pytest.mark.parametrize("finer", [None, 1e-12])
def test_at_the_last_digits_it_is_taylors_method(rattleback: Any, finer: float | None) -> None:
    run = tr.simulate(*rattleback, 20.0, 0.1, tolerance=finer)
    assert (run.method, run.tolerance) == ("taylor", finer or 1e-15)


def test_a_short_run_and_a_short_law_are_taylors(rattleback: Any) -> None:
    assert tr.simulate(*rattleback, 1.0, 0.1, tolerance=1e-6).method == "taylor"
    assert tr.simulate(COIN, WOBBLING, 60.0, 0.1, tolerance=1e-6).method == "taylor"


def test_a_run_of_many_phases_is_taylors(rattleback: Any) -> None:
    body, start = rattleback[0].body, rattleback[1]
    slips = tr.RollingSystem(body, tr.Support(tr.Plane(), friction=10.0))
    assert not step_work.takes_less(slips, start, 20.0, 1e-6)
    swings = tr.RollingSystem(body, tr.Support(tr.Plane()), loads=[tr.Force(("1e-3 * abs(sin(t))", 0.0, 0.0))])
    assert not step_work.takes_less(swings, start, 20.0, 1e-6)


def test_without_numba_it_is_taylors_method(rattleback: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled_steps, "available", lambda: False)
    assert not step_work.takes_less(*rattleback, 20.0, 1e-6)


def test_it_is_the_same_whatever_has_been_compiled(rattleback: Any) -> None:
    one, other = (tr.simulate(*rattleback, 20.0, 0.1, tolerance=1e-9) for _ in range(2))
    assert one.method == other.method
    assert np.array_equal(one.data.position.values, other.data.position.values)
