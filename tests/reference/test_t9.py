"""T9: a ball on a plane that turns unevenly, against ODEs in mpmath, published limits and other methods."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.exact import SphereOnPlane, SphereOnUnsteadyPlane, closed_form, sphere_on_unsteady_plane

A, M = 0.025, 0.065
BALL = tr.Body.solid_sphere(A, M)


def on(rate: str, loads: Any = (), tilt: float = 0.0, body: tr.Body = BALL) -> tuple[tr.RollingSystem, tr.State]:
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), motion=tr.SpinBy(rate), tilt=tilt), loads)
    return system, system.place((0.1, 0.05), (0.2, -0.1), spin=1.0)


RATES = {
    "3.5*(1 - exp(-t/2))": lambda t: mpmath.mpf(7) / 2 * (1 - mpmath.exp(-t / 2)),
    "2*cos(3*t)": lambda t: 2 * mpmath.cos(3 * t),
    "t": lambda t: t,
}


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("drag", [0.0, 0.05])
def test_it_solves_newton_and_euler(rate: str, drag: float) -> None:
    """m(1 + k)V̇ = k m (ω n×r)˙ − cV in components, Ω from a Ω̇ = n×(…): as Newton and Euler stand, by mpmath."""
    k, turn = mpmath.mpf(0.4), RATES[rate]
    with mpmath.workdps(20):

        def slopes(t: Any, y: Any) -> list[Any]:
            # R from R = mV̇ + cV and k m a² Ω̇ = −a n×R, with the constraint V = a Ω×n + ω n×r differentiated.
            x, z, vx, vy = y
            w, w_rate = turn(t), mpmath.diff(turn, t)
            ux, uy = -(w_rate * z + w * vy), w_rate * x + w * vx
            heavy = mpmath.mpf(M) * (1 + k)
            return [vx, vy, (k * M * ux - drag * vx) / heavy, (k * M * uy - drag * vy) / heavy]

        solution = mpmath.odefun(slopes, 0, [mpmath.mpf(p) for p in (0.1, 0.05, 0.2, -0.1)])
        motion = closed_form(*on(rate, (tr.Drag(drag),) if drag else ()))
        assert isinstance(motion, SphereOnUnsteadyPlane)
        for t in (0.8,):
            wanted = solution(mpmath.mpf(t))
            r, V, Omega, _ = motion.motion_at(t)
            for got, right in zip((r.x, r.y, V.x, V.y), wanted, strict=True):
                assert abs(got - right) <= EXACT(64, 0.3)
            assert abs(A * Omega.x - (turn(t) * wanted[0] - wanted[3])) <= EXACT(64, 1)


def test_without_loads_one_vector_stays_whatever_the_table_does() -> None:
    # V − (k/(1 + k)) ω n×r: so a table spun up from rest gives the ball (2/7) ω n×r at once, at the same place.
    system, start = on("20*exp(-(5*(t - 1))**2)")
    run = tr.simulate(system, start, 2.0, 0.05, method="taylor")
    x, y = run.data.position.values[:, 0], run.data.position.values[:, 1]
    omega = 20 * np.exp(-((5 * (run.data.time.values - 1)) ** 2))
    kept = run.data.velocity.values[:, :2] - (2 / 7) * omega[:, None] * np.column_stack([-y, x])
    assert np.abs(kept - kept[0]).max() <= SOLVER(100, 1e-15, 4.0)


def test_at_a_steady_rate_it_is_t5() -> None:
    table = tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05)
    system = tr.RollingSystem(BALL, table, (tr.Drag(0.01),))
    start = system.place((0.1, 0.05), (0.2, -0.1), spin=1.0)
    t = np.linspace(0.0, 100.0, 301)
    ours, steady = (form.of(system, start).motion_at(t) for form in (SphereOnUnsteadyPlane, SphereOnPlane))
    for one, other in zip(ours, steady, strict=True):
        assert np.allclose(one.array(), other.array(), rtol=0, atol=EXACT(400, np.abs(other.array()).max()))


@pytest.mark.parametrize("rate", ["0*t", "1e-12*sin(t)"])
def test_where_the_table_hardly_turns_the_ball_goes_straight(rate: str) -> None:
    motion = closed_form(*on(rate))
    for t in (1.0, 1000.0):
        r, V, _, _ = motion.motion_at(t)  # type: ignore[union-attr]
        assert abs(r.x - (0.1 + 0.2 * t)) <= 1e-9 * t
        assert abs(V.y + 0.1) <= 1e-9
        if rate == "0*t":
            assert abs(r.x - (0.1 + 0.2 * t)) <= EXACT(2000, 0.2 * t)


def test_a_run_works_out_its_quadratures_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """From the search for its stop to its samples it is one form."""
    made, course = [], sphere_on_unsteady_plane.Course
    monkeypatch.setattr(sphere_on_unsteady_plane, "Course", lambda form: made.append(form) or course(form))
    tr.Scenario.load("turntable-starting-up").run()
    assert len(made) == 1


def test_a_kink_is_found() -> None:
    # ω = |t − 1| from 1 to 0 and up again: ζ through the kink, each side by mpmath's quadrature of the exact phase.
    motion = SphereOnUnsteadyPlane.of(*on("abs(t - 1)"))
    share, M0 = 2 / 7, (0.2 - 0.1j) - 1j * (2 / 7) * 1.0 * (0.1 + 0.05j)

    def swept(t: Any) -> Any:
        return (1 - (1 - t) ** 2) / 2 if t < 1 else mpmath.mpf(1) / 2 + (t - 1) ** 2 / 2

    with mpmath.workdps(25):
        inner = mpmath.quad(lambda s: mpmath.exp(-1j * share * swept(s)), [0, 1, 2.5])
        wanted = mpmath.exp(1j * share * swept(mpmath.mpf(2.5))) * ((0.1 + 0.05j) + M0 * inner)
    r = motion.motion_at(2.5)[0]
    assert abs(complex(r.x, r.y) - complex(wanted)) <= EXACT(64, 1)


def test_forces_in_time_are_taken_along() -> None:
    # A push that turns with κ at resonance: ζ̈ = iκζ̇ + p e^{iκt} has V = (V₀ + pt) e^{iκt}.
    kappa, p = 1.0, 0.3
    push = M * 1.4 * p
    table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
    system = tr.RollingSystem(BALL, table, (tr.Force((f"{push!r}*cos(t)", f"{push!r}*sin(t)", 0)),))
    motion = closed_form(system, system.place((0.0, 0.0), (0.2, 0.0)))
    assert isinstance(motion, SphereOnUnsteadyPlane)
    for t in (0.5, 20.0):
        V = motion.motion_at(t)[1]
        assert abs(complex(V.x, V.y) - (0.2 + p * t) * complex(math.cos(kappa * t), math.sin(kappa * t))) < 1e-13 * (
            1 + t
        )


@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_the_general_law_agrees(method: str) -> None:
    loads = (tr.Force(("0.01*sin(3*t)", 0, "0.05*cos(t)")), tr.Torque((0, "1e-4*t", "1e-6*exp(-t)")), tr.Drag(0.02))
    system, start = on("3.5*(1 - exp(-t/2))", loads, 0.01)
    exact, other = (tr.simulate(system, start, 3.0, 0.25, method=name) for name in ("exact", method))
    turned = float(np.abs(exact.data.angular_velocity).max()) * 3.0
    for name in ("position", "velocity", "angular_velocity", "contact_force", "orientation"):
        size = float(np.abs(exact.data[name]).max())
        bound = SOLVER(20, max(other.tolerance, 1e-15), turned)
        assert float(np.abs(exact.data[name] - other.data[name]).max()) <= bound * size, name
