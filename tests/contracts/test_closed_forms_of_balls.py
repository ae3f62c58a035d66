"""Closed forms of balls in cylinders, on unevenly turning planes, in moving air and against resistance."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.contracts.contract_closed_form import ClosedFormContract
from tests.contracts.test_closed_forms import BALL, PUSHED, SHELL, TUMBLE, Spring, in_pipe, on_plane
from tests.tolerances import EXACT

import trundle as tr
from trundle.mechanics.algebra import Quaternion, Vector
from trundle.mechanics.loads import BodyMotion
from trundle.mechanics.shapes import Sphere
from trundle.solve.exact import (
    BallInLeaningCylinder,
    BallInUprightCylinder,
    SphereComingToRest,
    SphereInMovingAir,
    SphereOnUnsteadyPlane,
)

System = tuple[tr.RollingSystem, tr.State]
LIGHT = tr.Body.sphere(0.03, 0.2, 1e-6)  # all its mass at its centre, or nearly


class InCylinder(ClosedFormContract):
    span = 3.0

    def offset(self, system: tr.RollingSystem, at: Vector) -> Vector:
        sign, distance = (1 if system.support.surface.side == "outside" else -1), mpmath.hypot(at.x, at.y)
        return Vector(at.x / distance, at.y / distance, mpmath.mpf(0)) * (-sign * mpmath.mpf(system.body.shape.radius))


class TestBallInUprightCylinder(InCylinder):
    form = BallInUprightCylinder

    def cases(self) -> list[System]:
        upright: dict[str, Any] = {"tilt": 0.0}
        return [
            in_pipe(BALL, **upright, velocity=(2.0, 0.3), spin=5.0),
            in_pipe(SHELL, rate=3.0, **upright, velocity=(-2.0, 0.3)),
            in_pipe(SHELL, rate=-3.0, side="outside", **upright, velocity=(1.0, 0.0), spin=-2.0),
            in_pipe(BALL, **upright),  # falls
            in_pipe(BALL, **upright, velocity=(1e-9, 0.1), spin=1e3),
            in_pipe(LIGHT, **upright, velocity=(1.0, -0.5), spin=3.0),
            in_pipe(BALL, tilt="180 deg", velocity=(1.0, 0.5)),
            in_pipe(BALL, gravity=0.0, **upright, velocity=(1.0, 0.5), spin=0.5),
            in_pipe(BALL, **upright, velocity=(0.95, 0.0), spin=9.80665 / (0.4 * 2.0 * 0.025)),  # stays level
            in_pipe(BALL, **upright, loads=(tr.Force((0.0, 0.0, 1.0)),), velocity=(1.0, 0.0)),
        ]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, start = in_pipe(BALL, tilt=0.0)
        wall = replace(inside, support=replace(inside.support, motion=tr.UnevenSpin(1.0, 0.1, 2.0)))
        return [
            (wall, wall.place((0.7, 0.25)), "motion, uneven-spin, is"),
            (replace(inside, body=replace(BALL, shape=Sphere(0.025, Vector(0.0, 0.0, 0.001)))), start, "about its"),
            (replace(inside, loads=(tr.Drag(0.1),)), start, "load drag is"),
            (replace(inside, loads=(tr.Torque((0.0, 0.0, 0.1)),)), start, "torque"),
        ]

    def test_logs_and_a_pull_across_are_not_its_own(self) -> None:
        upright = in_pipe(BALL, tilt=0.0)[0]
        log = replace(upright, body=tr.Body.cylinder(0.025, 0.1))
        assert BallInUprightCylinder.violations(log) == [
            "the body is no sphere with isotropic inertia about its centre"
        ]
        assert BallInUprightCylinder.violations(in_pipe(BALL)[0]) == [
            "gravity or a force pulls across the cylinder's axis"
        ]


class TestBallInLeaningCylinder(InCylinder):
    form = BallInLeaningCylinder
    span = 0.6

    def cases(self) -> list[System]:
        return [
            in_pipe(BALL, velocity=(0.5, 0.4), spin=3.0),
            in_pipe(SHELL, rate=2.0, velocity=(7.0, 0.4), spin=3.0, tilt="60 deg"),
            in_pipe(BALL, side="outside", velocity=(-7.0, 0.0), spin=3.0, tilt="-120 deg"),
            in_pipe(LIGHT, velocity=(0.3, 0.4), spin=3.0, tilt="5 deg"),
            in_pipe(BALL, position=(0.0, 0.0), velocity=(0.0, 0.4)),  # along the lowest line
            in_pipe(BALL, loads=(tr.Force((0.1, -0.3, 0.2)),), velocity=(0.1, 0.0)),
        ]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, start = in_pipe(BALL, tilt="60 deg")
        swung = replace(inside, support=replace(inside.support, motion=tr.UnevenSpin(1.0, 0.1, 2.0)))
        return [
            (swung, swung.place((0.7, 0.25)), "motion, uneven-spin, is"),
            (replace(inside, loads=(Spring(1.0),)), start, "Spring"),
            (replace(inside, loads=(tr.Torque((0.0, 0.0, 0.1)),)), start, "torque"),
        ]

    def test_it_repeats_after_its_period(self) -> None:
        still = BallInLeaningCylinder.of(*in_pipe(BALL))  # nothing along the axis: T6 has it, and this form too
        assert still.period == still.pendulum.period
        assert all(BallInLeaningCylinder.of(*case).period == np.inf for case in self.cases())


class OnPlane(ClosedFormContract):
    span = 3.0

    def applied(self, system: tr.RollingSystem, V: Vector) -> tuple[Vector, Vector]:
        """Return what acts, worked out by the loads from place and Ω, and N from the normal components."""
        r, Omega, t, R = self._now
        up = Vector(mpmath.mpf(0), mpmath.mpf(0), mpmath.mpf(1))
        turning = system.support.motion.at(t, *system.support.motion.initial_coordinates()).angular_velocity
        motion = BodyMotion(t, system.body.mass, r, V, Quaternion(1.0, 0.0, 0.0, 0.0), Omega, up, turning)
        tilt, weight = mpmath.mpf(system.support.tilt), mpmath.mpf(system.body.mass) * system.gravity
        force = Vector(weight * mpmath.sin(tilt), mpmath.mpf(0), -weight * mpmath.cos(tilt))
        torque = Vector(mpmath.mpf(0), mpmath.mpf(0), mpmath.mpf(0))
        for load in system.loads:
            force = force + load.force(motion)
            torque = torque + load.torque(motion) + load.torque_per_normal_force(motion) * R.z
        return force, torque

    def _obeys(self, system: tr.RollingSystem, start: tr.State, t: Any) -> None:
        r, _, Omega, R = self.form.of(system, start).motion_at(t)
        self._now = r, Omega, t, R
        super()._obeys(system, start, t)

    def test_it_repeats_after_its_period(self) -> None:
        assert all(self.form.of(*case).period == np.inf for case in self.cases())


class TestSphereInMovingAir(OnPlane):
    form = SphereInMovingAir

    def cases(self) -> list[System]:
        return [
            on_plane(rate=3.5, loads=(tr.Drag(0.01, 3.5),)),
            on_plane(SHELL, rate=-8.0, tilt=0.05, loads=(tr.Drag(0.01, -2.0), tr.Drag(0.001), *PUSHED)),
            on_plane(loads=(tr.Drag(0.01, 1e-12),)),
            on_plane(rate=1e-9, loads=(tr.Drag(1e-9, -3.0),)),
            on_plane(rate=2.0, loads=(tr.RollingCouple(1e-6),)),
            on_plane(rate=2.0, tilt=-0.1, loads=(tr.RollingCouple(1e-5, 1e-7), tr.Drag(0.1, 1.0))),
            on_plane(loads=(tr.RollingCouple(1e-5), tr.Torque((1e-4, 2e-4, 1e-5)))),
        ]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, start = on_plane(rate=3.5, loads=(tr.Drag(0.01, 3.5),))
        tumbling = replace(inside, support=replace(inside.support, motion=TUMBLE))
        return [
            (tumbling, tumbling.place((0.1, -0.05)), "Tumble"),
            (replace(inside, loads=(tr.QuadraticDrag(0.01),)), start, "load quadratic-drag is"),
            (replace(inside, loads=(Spring(1.0),)), start, "Spring"),
        ]


class TestSphereComingToRest(OnPlane):
    form = SphereComingToRest

    def cases(self) -> list[System]:
        return [
            on_plane(loads=(tr.RollingResistance(1e-4),)),
            on_plane(SHELL, loads=(tr.QuadraticDrag(1e-3),)),
            on_plane(loads=(tr.QuadraticDrag(1e-9),)),
            on_plane(loads=(tr.RollingResistance(1e-9), tr.Drag(0.3))),
            on_plane(loads=(tr.RollingResistance(1e-4), tr.Drag(0.01), tr.QuadraticDrag(0.05), tr.RollingCouple(1e-6))),
            on_plane(loads=(tr.RollingResistance(1e-4), tr.Force((0.0, 0.0, -0.5))), velocity=(0.0, -0.6)),
        ]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, start = on_plane(loads=(tr.RollingResistance(1e-4),))
        turning = on_plane(rate=1.0, loads=(tr.RollingResistance(1e-4),))
        return [
            (*turning, "support moves"),
            (*on_plane(tilt=0.1, loads=(tr.RollingResistance(1e-4),)), "pushes along"),
            (replace(inside, loads=(tr.QuadraticDrag(0.1, 2.0),)), start, "air moves"),
            (replace(inside, loads=(tr.PivotFriction(1e-5), tr.RollingResistance(1e-4))), start, "load pivot-friction"),
        ]


class SpinBy(tr.SpinBy):
    """Its material moves the same whatever the angle: the contract asks without one."""

    def at(self, time: Any, *own: Any) -> Any:
        return super().at(time, *(own or (0.0,)))


class TestSphereOnUnsteadyPlane(OnPlane):
    form = SphereOnUnsteadyPlane
    span = 0.5

    def cases(self) -> list[System]:
        def turned(motion: tr.Motion, **more: Any) -> System:
            system, _ = on_plane(**more)
            system = replace(system, support=replace(system.support, motion=motion))
            return system, system.place((0.1, -0.05), (0.03, 0.2), spin=1.5)

        varying = (tr.Force(("0.1*sin(3*t)", 0, "0.05*cos(t)")), tr.Torque((0, "1e-4*t", "1e-6*exp(-t)")))
        return [
            turned(tr.UnevenSpin(3.5, 0.1, 3.5)),
            turned(SpinBy("3.5*(1 - exp(-t/2))"), tilt=0.05, loads=(tr.Drag(0.05),)),
            turned(SpinBy("2*cos(3*t)"), body=SHELL, loads=varying),
            on_plane(rate=2.0, loads=(*varying, tr.Drag(2.0))),
        ]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, start = self.cases()[0]
        others = [replace(inside, support=replace(inside.support, motion=m)) for m in (TUMBLE, tr.Wobble(2.0, 0.1))]
        return [
            *((other, other.place((0.1, -0.05)), other.support.motion.word) for other in others),
            (replace(inside, loads=(tr.Drag(0.1, 1.0),)), start, "load drag is"),
            (replace(inside, loads=(Spring(1.0),)), start, "Spring"),
        ]

    def test_members_broadcast(self) -> None:
        # Motion and loads are the same for all; the numbers may be members.
        single = self.form.of(*self.cases()[1])
        speeds, ratios = np.array([0.1, 0.5, -2.0])[:, None], np.array([0.4, 0.5, 2 / 3])[:, None]
        stacked = replace(single, velocity=(speeds, 0.0), inertia_ratio=ratios)
        assert {field.name for field in fields(single)} > {"motion", "loads"}
        times = np.linspace(0.0, 3.0, 7)
        many = stacked.motion_at(times)
        for i in range(3):
            one = replace(single, velocity=(float(speeds[i, 0]), 0.0), inertia_ratio=float(ratios[i, 0]))
            for of_all, alone in zip(many, one.motion_at(times), strict=True):
                size = np.abs(alone.array()).max()
                assert np.allclose(of_all.array()[i], alone.array(), rtol=0, atol=EXACT(64, size))

    @pytest.mark.parametrize("rate", ["1/(t - 1)", "sqrt(0.5 - t)"])
    def test_a_rate_that_is_not_finite_is_named_with_its_instant(self, rate: str) -> None:
        system, _ = on_plane()
        system = replace(system, support=replace(system.support, motion=SpinBy(rate)))
        with pytest.raises(tr.TrundleError, match="rate"):
            tr.simulate(system, system.place((0.1, 0.0)), 2.0, 0.1)
