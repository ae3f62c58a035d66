"""Where formulas divide by what may be zero: no turning, no tilt, no drag, no speed, the axis, half a turn."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from tests.reference.t5 import Ball
from tests.tolerances import EXACT, SOLVER

import trundle as tr
from trundle.solve.exact import SphereOnPlane

A, M, G, K = 0.025, 0.065, 9.80665, 0.4
RATES = (0.0, 1e-12, -1e-12, 3.5)
TILTS = (0.0, 1e-12, 0.05)
DRAGS = (0.0, 1e-12, 0.01)
HALF_TURNED = (1e-9, 0.6, 0.8, 0.0)
STARTS: dict[str, dict[str, Any]] = {
    "at rest on the axis": {},
    "at rest off the axis": {"position": (0.1, -0.05)},
    "spin only": {"spin": 5.0},
    "through the axis": {"position": (-0.05, 0.0), "velocity": (0.1, 0.0)},
    "nearly half turned": {"velocity": (0.1, -0.2), "spin": -2.0, "orientation": HALF_TURNED},
}
PLACES = list(itertools.product(STARTS, RATES, TILTS, DRAGS))
TIMES = np.array([0.0, 0.3, 1.0])


def placed(start: str, rate: float, tilt: float, drag: float) -> tuple[tr.RollingSystem, tr.State]:
    motion = tr.Spin(rate) if rate else tr.Fixed()
    loads = (tr.Drag(drag),) if drag else ()
    system = tr.RollingSystem(tr.Body.solid_sphere(A, M), tr.Support(tr.Plane(), motion=motion, tilt=tilt), loads)
    return system, system.place(**STARTS[start])


@pytest.mark.parametrize("start", STARTS)
def test_the_closed_form_in_every_corner(start: str) -> None:
    for rate, tilt, drag in itertools.product(RATES, TILTS, DRAGS):
        system, state = placed(start, rate, tilt, drag)
        push = (M * G * math.sin(tilt), 0.0, -M * G * math.cos(tilt))
        ball = Ball(A, M, K, rate, state.position[:2], state.velocity[:2], state.angular_velocity[2], push, drag=drag)
        parts = [np.broadcast_to(v.array(), (3, 3)) for v in SphereOnPlane.of(system, state).motion_at(TIMES)]
        for i, t in enumerate(TIMES):
            wanted = ball.at(t)
            for name, part in zip(("position", "velocity", "angular_velocity", "contact_force"), parts, strict=True):
                off = abs(complex(*part[i, :2]) - complex(wanted[name].value))
                assert off <= wanted[name].bound(t), f"{name} at {rate}, {tilt}, {drag}: off by {off}"


@pytest.mark.parametrize("place", PLACES[::5], ids=str)
def test_the_card_in_the_corners(place: tuple[str, float, float, float]) -> None:
    ours = tr.simulate(*placed(*place), duration=1.0, every=0.1)
    assert ours.method == "exact"
    assert all(np.isfinite(variable.values).all() for variable in ours.data.data_vars.values())
    assert ours.card().passed, str(ours.card())


@pytest.mark.parametrize("place", PLACES[3::14], ids=str)
@pytest.mark.parametrize("method", ["taylor", "runge-kutta"])
def test_the_numerical_methods_in_the_corners(method: str, place: tuple[str, float, float, float]) -> None:
    if method == "taylor":
        pytest.importorskip("heyoka")
    ours = tr.simulate(*placed(*place), duration=1.0, every=0.1, method=method)
    wanted = tr.simulate(*placed(*place), duration=1.0, every=0.1, method="exact")
    # The weight is known to its last place, and what a push of that size does in a second is not.
    pushed = {"position": G, "velocity": G, "angular_velocity": G / A, "orientation": G / A, "contact_force": M * G}
    for name, size in pushed.items():
        bound = SOLVER(10, ours.tolerance, size) + SOLVER(100, ours.tolerance, np.abs(wanted.data[name].values).max())
        assert np.abs(ours.data[name].values - wanted.data[name].values).max() <= bound, name
    speed = np.abs(wanted.data.velocity.values).max()
    if speed == 0 or speed > 1e-9:  # a slower motion is made of roundings, and the card may say so
        assert ours.card().passed, str(ours.card())


@pytest.mark.parametrize("start", STARTS)
def test_a_table_that_hardly_turns_is_a_table_at_rest(start: str) -> None:
    for tilt, drag in itertools.product(TILTS, DRAGS):
        still, slow = (
            tr.simulate(*placed(start, rate, tilt, drag), duration=1.0, every=0.1).data for rate in (0.0, 1e-12)
        )
        # κ = 3e-13 rad/s turns the velocity by that angle a second, and the table carries the ball along by ωr.
        reach = 1e-12 * (1 + np.abs(still.position).max() + np.abs(still.velocity).max()).item()
        assert np.abs(still.position - slow.position).max() <= reach
        assert np.abs(still.angular_velocity - slow.angular_velocity).max() <= 2 * reach / A
        assert np.abs(still.orientation - slow.orientation).max() <= 2 * reach / A + EXACT(64, 1)


def test_a_slope_that_hardly_leans_is_level() -> None:
    for start, drag in itertools.product(STARTS, DRAGS):
        level, leaning = (
            tr.simulate(*placed(start, 3.5, tilt, drag), duration=1.0, every=0.1).data for tilt in (0.0, 1e-12)
        )
        assert np.abs(level.position - leaning.position).max() <= G * 1e-12


def test_a_body_that_only_spins_stays_and_spins() -> None:
    ours = tr.simulate(*placed("spin only", 0.0, 0.0, 0.01), duration=10.0, every=1.0).data
    assert (ours.position.values == [0.0, 0.0, A]).all()
    assert (ours.angular_velocity.values == [0.0, 0.0, 5.0]).all()
    angle = 5.0 * ours.time.values / 2
    wanted = np.stack([np.cos(angle), 0 * angle, 0 * angle, np.sin(angle)], axis=1)
    assert np.abs(ours.orientation.values - wanted).max() <= EXACT(64, 1)


def test_a_ball_on_the_axis_of_a_turning_table_stays_whatever_its_spin() -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(A, M), tr.Support(tr.Plane(), motion=tr.Spin(3.5)))
    ours = tr.simulate(system, system.place(spin=2.0), duration=1e6, every=1e5).data
    assert (ours.position.values == [0.0, 0.0, A]).all()


def test_weightless_and_at_rest_nothing_moves() -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(A, M), tr.Support(tr.Plane()), gravity=0.0)
    for method in ("exact", "runge-kutta"):
        ours = tr.simulate(system, system.place((0.1, 0.0)), duration=1.0, every=0.5, method=method).data
        assert (ours.position.values == [0.1, 0.0, A]).all()
        assert (ours.contact_force.values == 0.0).all()


@pytest.mark.parametrize("rate", [1e3, -1e3])
def test_a_furious_table(rate: float) -> None:
    system = tr.RollingSystem(tr.Body.solid_sphere(A, M), tr.Support(tr.Plane(), motion=tr.Spin(rate), tilt=0.5))
    ours = tr.simulate(system, system.place((0.1, 0.0), "co-rotating"), duration=0.5, every=0.01)
    assert ours.card().passed, str(ours.card())


def test_a_support_tilted_almost_to_a_wall() -> None:
    system = tr.RollingSystem(
        tr.Body.solid_sphere(A, M), tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=math.pi / 2 - 1e-9)
    )
    ours = tr.simulate(system, system.place(), duration=1.0, every=0.1)
    assert (ours.data.contact_force.values[:, 2] > 0).all()
    assert ours.card()["friction coefficient needed"].value > 1e8
    assert ours.card().passed, str(ours.card())
