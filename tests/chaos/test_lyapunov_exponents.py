"""Lyapunov exponents against what is known of them by formula, and against runs that know nothing of derivatives."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.chaos.bouncing import Bouncing
from tests.tolerances import SOLVER

import trundle as tr
from trundle.analysis.chaos import tangents, volume
from trundle.analysis.chaos.asked import integrator
from trundle.analysis.chaos.exponents import means
from trundle.analysis.chaos.spectrum import LyapunovExponents

G = 9.80665
BALL = tr.Body.solid_sphere(0.025, 0.065)


def test_a_ball_on_a_dome_falls_off_like_a_pendulum():
    """(1 + k)(a + b) θ̈ = g θ: ±√(g/((1 + k)(a + b))), each twice, and four zeros of spin and orientation."""
    dome = tr.RollingSystem(BALL, tr.Support(tr.Dome(0.2)))
    found = tr.lyapunov_exponents(dome, dome.place(), "8 s", transient="4 s")
    rate = math.sqrt(G / (1.4 * 0.225))
    assert np.allclose(found.exponents[:2], rate, rtol=1e-9)
    assert np.allclose(found.exponents[-2:], -rate, rtol=1e-9)
    assert found.zeros_found == 4
    assert found.positive == 2


def test_a_saddle_parts_and_closes_at_the_rates_of_its_curvatures():
    """On a saddle z = x²/2P − y²/2Q a small ball at rest has ±√(g/((1 + k)(Q + a))) across, and swings along."""
    P, Q, a = 0.4, 0.7, 0.025
    saddle = tr.RollingSystem(BALL, tr.Support(tr.HeightField(f"x**2/{2 * P} - y**2/{2 * Q}")))
    found = tr.lyapunov_exponents(saddle, saddle.place(), "10 s", transient="5 s")
    rate = math.sqrt(G / (1.4 * (Q + a)))
    assert abs(found.largest - rate) <= found.errors[0] < 1e-4
    assert abs(found.exponents[-1] + rate) <= found.errors[-1] < 1e-4
    assert found.zeros_found == 6


@pytest.mark.parametrize(("velocity", "spin"), [((-0.3, 0.1), -2.0), ((0.2, 0.0), 5.0)])
def test_drag_damps_two_of_the_exponents_of_a_ball_on_a_plane(velocity, spin):
    """V̇ = −c V/(m (1 + k)): twice that rate, and zeros of place, orientation and spin."""
    plane = tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=[tr.Drag(0.2)])
    found = tr.lyapunov_exponents(plane, plane.place(velocity=velocity, spin=spin), "8 s", every=0.05, transient="4 s")
    rate = 0.2 / (0.065 * 1.4)
    assert math.isclose(found.divergence, -2 * rate, rel_tol=1e-13)
    assert np.allclose(found.exponents[-2:], -rate, rtol=0, atol=found.errors[-2:].max() + 1e-9)
    assert found.zeros.count == found.zeros_found == 6


@pytest.mark.parametrize("name", ["chaplygin-ball", "routh-sphere"])
def test_integrable_motions_have_no_exponents(name):
    """Chaplygin's ball [chaplygin1903], Routh's sphere and a ball in a bowl [routh1905] are integrable."""
    found = tr.lyapunov_exponents(name, duration="8 s")
    assert found.positive == 0
    assert found.zeros_found == found.dimension == 8
    assert found.passed
    assert found.zeros.count == 8
    assert found.sums_apart < 1e-12 * found.rate


def test_chaplygins_ball_on_a_turning_table_is_chaotic_and_keeps_its_volume():
    """It has an invariant measure and is chaotic in general [bizyaev2018]: ±λ, and the volume stays bounded."""
    found = tr.lyapunov_exponents("chaplygin-ball-on-turntable", duration="150 s")
    assert found.positive == 1
    assert abs(found.exponents[0] + found.exponents[-1]) < found.errors[0]
    assert abs(found.divergence) < 0.05 * found.largest
    assert found.sums_apart < 1e-12 * found.rate
    assert found.zeros_found == 6
    assert found.passed


@pytest.mark.parametrize("spin", [5.0, -5.0])
def test_a_spinning_rattleback_gains_or_loses_volume_at_the_rates_of_its_modes(spin):
    """The linear law of the steady spin, found another way: each mode that oscillates counts for two exponents."""
    stone = tr.Scenario.load("rattleback").system()
    (spinning,) = tr.steady_motions(stone, stone.place(spin=spin), holding={"spin": None})
    found = tr.lyapunov_exponents(stone, spinning.state, "2.5 s", transient="0.5 s", every="25 ms")
    total = 2 * sum(mode.growth for mode in spinning.modes)
    assert math.copysign(1.0, total) == math.copysign(1.0, spin)
    assert math.isclose(found.divergence, total, rel_tol=1e-9)
    assert math.isclose(found.sum_between_events, total, rel_tol=1e-9)
    extreme = found.exponents[:2] if spin > 0 else found.exponents[-2:]
    rate = max((mode.growth for mode in spinning.modes), key=abs)
    assert abs(extreme.mean() - rate) <= found.errors.max()


def test_a_fault_in_the_divergence_is_seen(monkeypatch):
    true = volume.slopes_at
    monkeypatch.setattr(volume, "slopes_at", lambda *given: true(*given) * (1 + 1e-6))
    plane = tr.RollingSystem(BALL, tr.Support(tr.Plane()), loads=[tr.Drag(0.2)])
    found = tr.lyapunov_exponents(plane, plane.place(velocity=(0.2, 0.0)), "8 s", every=0.05)
    assert found.passed is False


def test_two_methods_agree():
    def exponents(method: str) -> np.ndarray:
        return tr.lyapunov_exponents("chaplygin-ball-on-turntable", duration="5 s", count=3, method=method).exponents

    assert np.allclose(exponents("taylor"), exponents("runge-kutta"), rtol=0, atol=SOLVER(1e4, 1e-12))


def test_growth_is_that_of_the_difference_between_two_runs():
    """A little more spin: how far apart two runs are after a while, in the units in which the growth is measured."""
    scenario = tr.Scenario.load("chaplygin-ball-on-turntable")
    system, start = scenario.system(), scenario.start_state()
    off = 1e-6

    def numbers(sign: int) -> np.ndarray:
        spin = start.angular_velocity[2] + sign * off
        at = system.place(position=start.position[:2], velocity=(0.0, 0.0), spin=spin, orientation=start.orientation)
        last = tr.simulate(system, at, "6 s", "6 s", method="runge-kutta").data.isel(time=-1)
        return np.concatenate([last.contact, last.orientation, last.angular_velocity])

    now = tangents.beginning(system, start)
    scale = tangents.scale_of(system, now.law, 0.1, 10.0)
    more_spin = np.zeros((10, 1))
    more_spin[9] = 1.0
    integrate, tolerance = integrator(system, "taylor", None, 0.0, 6.0)
    run = tangents.TangentRun(integrate, system, np.linspace(0.0, 6.0, 13)[1:], now, more_spin, 0.1, 10.0)
    run.solve(start, tolerance, None)
    apart = np.linalg.norm((numbers(1) - numbers(-1)) / scale) / (2 * off / 10.0)
    assert math.isclose(math.exp(run.logs[0]), apart, rel_tol=1e-6)


def test_a_bouncing_ball_contracts_at_each_landing():
    """The product of the multipliers of a periodic bounce is e²: no smooth part of the motion has any."""
    bouncing = Bouncing(0.5, Gamma=1.3)
    period = bouncing.period
    found = tr.lyapunov_exponents(bouncing.system, bouncing.start, 40 * period, every=period / 2)
    assert math.isclose(found.sum_across_events, 2 * math.log(0.5) / period, rel_tol=1e-9)
    assert abs(found.sum_between_events) < 1e-9
    exponents = np.sort(np.log(np.abs(bouncing.multipliers)) / period)
    assert np.all(np.abs(found.exponents[-2:] - exponents) <= found.errors[-2:])
    assert found.zeros_found == 10
    assert found.events == 40


def test_a_grip_takes_differences_away():
    """A ball that slips has ten differences, and eight once it rolls: two exponents are −∞."""
    table = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.3))
    start = table.place(velocity=(0.5, 0.0), angular_velocity=(0.0, 0.0, 1.0))
    found = tr.lyapunov_exponents(table, start, "4 s", every=0.02)
    assert found.dimension == 10
    assert np.isneginf(found.exponents[-2:]).all()
    assert found.zeros_found == 8
    assert "taken away by an event" in str(found)
    assert found.passed


def test_what_ends_early_says_so():
    dome = tr.RollingSystem(BALL, tr.Support(tr.Dome(0.2, rim=0.1)))
    found = tr.lyapunov_exponents(dome, dome.place(position=(1e-6, 0.0)), "60 s", every=0.01)
    assert found.duration < found.asked
    assert "rim" in found.ended
    assert found.ended in str(found)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"duration": "0.1 s"}, "Follow it for longer"),
        ({"duration": "1 s", "count": 9}, "whole number from 1 to 8"),
        ({"duration": "-1 s"}, "duration"),
        ({"duration": None}, "duration"),
        ({"duration": "1 s", "method": "euler"}, "euler"),
    ],
)
def test_what_cannot_be_answered_is_refused_in_words(given, said):
    bowl = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.5)))
    with pytest.raises(tr.TrundleError, match=said):
        tr.lyapunov_exponents(bowl, bowl.place(position=(0.1, 0.0)), **given)


def test_a_start_at_an_event_is_refused():
    table = tr.RollingSystem(BALL, tr.Support(tr.Plane(), friction=0.3, restitution=0.5))
    strikes = replace(table.place(), velocity=(0.0, 0.0, -1.0))
    with pytest.raises(tr.SolverError, match="at an event"):
        tr.lyapunov_exponents(table, strikes, "1 s")


def test_a_ball_at_rest_in_a_bowl_swings_and_parts_from_nothing():
    bowl = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.5)))
    found = tr.lyapunov_exponents(bowl, bowl.place(), "20 s")
    assert found.positive == 0
    assert found.zeros_found == 8


def test_a_growth_by_a_power_of_the_time_is_zero_within_its_error_and_an_exponential_is_not():
    time = np.linspace(0.0, 1000.0, 5001)
    for power in (1, 2, 3):
        value, error = means(time, power * np.log(1 + time)[:, None], 100.0, 0.0)
        assert abs(value[0]) <= error[0]
    value, error = means(time, (0.05 * time + np.sin(time))[:, None], 100.0, 0.0)
    assert abs(value[0] - 0.05) <= error[0] < 0.05


def test_differences_keep_to_the_constraints():
    bowl = tr.RollingSystem(BALL, tr.Support(tr.Bowl(0.5), motion=tr.Spin(2.0)))
    start = bowl.place(position=(0.1, 0.0), velocity=(0.0, 0.3))
    now = tangents.beginning(bowl, start)
    scale = tangents.scale_of(bowl, now.law, 0.025, 10.0)
    basis = tangents.tangents(bowl, now, scale)
    rows = tangents.constraint_rows(bowl, now.law, 0.0, now.state_vector)
    assert basis.shape == (10, 8)
    assert np.abs((rows * scale) @ basis).max() < 1e-12


@pytest.mark.parametrize(
    ("exponents", "dimension"),
    [
        ((0.9056, 0.0, -14.5723), 2.06215),  # Lorenz
        ((0.0714, 0.0, -5.3943), 2.0132),  # Rössler
        ((0.41922, -1.62319), 1.25827),  # Hénon's map
        ((0.5, 0.0, 0.0, -0.5), 4.0),  # Hamiltonian: nothing is lost
        ((-0.1, -0.3), 0.0),  # a point
        ((0.0, -0.3), 1.0),  # a circle
        ((0.2, -math.inf), 1.0),  # a difference that an event takes away altogether
        ((0.3, 1e-9, -1e-9, -0.6), 3.5),  # zero within their errors
    ],
)
def test_the_dimension_by_kaplan_and_yorke(exponents: tuple[float, ...], dimension: float) -> None:
    """Of the first three, exponents and dimension are those of Sprott (2003, Chaos and Time-Series Analysis)."""
    found = SimpleNamespace(exponents=np.array(exponents), errors=np.full(len(exponents), 1e-8))
    assert LyapunovExponents.kaplan_yorke_dimension.fget(found) == pytest.approx(dimension, abs=1e-4)
