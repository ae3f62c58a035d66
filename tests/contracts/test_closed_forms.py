"""Closed forms."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import mpmath
import numpy as np
import pytest
from tests.additions import Ball, Tumble
from tests.contracts.contract_closed_form import ClosedFormContract

import trundle as tr
from trundle.errors import OutOfDomainError
from trundle.mechanics.algebra import Vector
from trundle.mechanics.loads import BodyMotion, Load
from trundle.mechanics.shapes import Ellipsoid, Sphere
from trundle.solve.exact import BallInLeaningCylinder, CylinderOnCylinder, SphereOnPlane, closed_form

BALL = tr.Body.solid_sphere(radius=0.025, mass=0.065)
SHELL = tr.Body.hollow_sphere(radius=0.02, mass=0.0027)
TUMBLE = Tumble(1.0, 0.0, 0.0, Vector(0.1, 0.0, 0.0), 1.0)
PUSHED = (tr.Force((0.01, -0.02, 0.05)), tr.Torque((1e-4, 3e-4, -2e-5)))


@dataclass(frozen=True)
class Spring(Load):
    stiffness: float

    def force(self, motion: BodyMotion) -> Vector:
        return motion.position * -self.stiffness


def on_plane(
    body: tr.Body = BALL, rate: float = 0.0, tilt: float = 0.0, loads: Any = (), **start: Any
) -> tuple[tr.RollingSystem, tr.State]:
    motion = tr.Spin(rate) if rate else tr.Fixed()
    system = tr.RollingSystem(body, tr.Support(tr.Plane(), motion=motion, tilt=tilt), loads=loads)
    return system, system.place(**{"position": (0.1, -0.05), "velocity": (0.03, 0.2), "spin": 1.5} | start)


class TestSphereOnPlane(ClosedFormContract):
    form = SphereOnPlane

    def cases(self) -> list[tuple[tr.RollingSystem, tr.State]]:
        return [
            on_plane(rate=3.5),
            on_plane(SHELL, rate=-8.0, velocity="co-rotating", spin=None),
            on_plane(tr.Body.sphere(0.5, 1.0, 0.1), rate=2.0, velocity=None),
            on_plane(rate=3.5, tilt=0.05),
            on_plane(rate=1e-12, tilt=0.05),
            on_plane(tilt=-0.3),
            on_plane(),
            on_plane(rate=3.5, tilt=0.05, loads=(*PUSHED, tr.Drag(0.01))),
            on_plane(SHELL, loads=(tr.Drag(1e-9), *PUSHED)),
            on_plane(loads=(tr.Drag(1.0), tr.Drag(0.5))),
        ]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, _ = on_plane(rate=3.5)
        body, support = inside.body, inside.support
        top = tr.State((0.0, 0.0, 0.525), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        ball = replace(inside, support=replace(support, surface=Ball(0.5, 1.0), motion=tr.Fixed()))
        others = [
            (replace(inside, body=tr.Body(0.065, tr.Principal(1e-5, 2e-5, 2.5e-5), body.shape)), "isotropic inertia"),
            (replace(inside, body=replace(body, shape=Sphere(0.025, Vector(0.0, 0.0, 0.001)))), "about its centre"),
            (replace(inside, body=tr.Body(0.065, tr.Isotropic(1e-5), Ellipsoid(0.02, 0.02, 0.025))), "no sphere"),
            (replace(inside, support=replace(support, motion=TUMBLE)), "Tumble"),
            (replace(inside, loads=(Spring(1.0),)), "Spring"),
        ]
        return [(ball, top, "Ball"), *((system, system.place((0.1, -0.05)), word) for system, word in others)]

    def test_a_compiled_path_is_of_one_ball(self) -> None:
        one = SphereOnPlane.of(*on_plane(rate=3.5))
        with pytest.raises(OutOfDomainError, match="one ball"):
            replace(one, rate=np.array([1.0, 2.0])).compiled()

    @pytest.mark.parametrize(("rate", "loads"), [(0.0, ()), (3.5, (tr.Drag(0.1),))])
    def test_no_guiding_centre_without_a_circle(self, rate: float, loads: Any) -> None:
        motion = SphereOnPlane.of(*on_plane(rate=rate, loads=loads))
        for ask in ("guiding_centre", "drift_velocity", "circle_radius"):
            with pytest.raises(OutOfDomainError, match="guiding centre"):
                getattr(motion, ask)(0.0) if ask == "guiding_centre" else getattr(motion, ask)


def in_pipe(
    body: tr.Body,
    rate: float = 0.0,
    side: str = "inside",
    loads: Any = (),
    gravity: float = 9.80665,
    tilt: Any = "90 deg",
    **start: Any,
) -> tuple[tr.RollingSystem, tr.State]:
    support = tr.Support(tr.Cylinder(0.5, side), motion=tr.Spin(rate) if rate else tr.Fixed(), tilt=tilt)
    system = tr.RollingSystem(body, support, loads=loads, gravity=gravity)
    return system, system.place(**{"position": (0.7, 0.25)} | start)


class TestCylinderOnCylinder(ClosedFormContract):
    form = CylinderOnCylinder
    span = 3.0

    def cases(self) -> list[tuple[tr.RollingSystem, tr.State]]:
        log = tr.Body.cylinder(0.05, 0.75)
        hoop = tr.Body.hoop(0.2, 0.3)
        return [
            in_pipe(log),
            in_pipe(hoop, rate=3.0),
            in_pipe(BALL, velocity=(0.5, 0.0)),
            in_pipe(BALL, velocity=(-0.5, 0.0), rate=-1.5),
            in_pipe(log, velocity=(6.0, 0.0)),
            in_pipe(log, velocity=(-6.0, 0.0), rate=2.0),
            in_pipe(hoop, position=(0.0, 0.0)),  # at rest at the lowest line
            in_pipe(hoop, position=(1e-7, 0.0)),
            in_pipe(tr.Body.cylinder(0.05, 0.75, 1e-3), position=(3.1, 0.0)),
            in_pipe(BALL, position=(3.0, 0.0), side="outside", velocity=(0.1, 0.0)),
            in_pipe(log, gravity=0.0, velocity=(1.0, 0.0)),
            in_pipe(log, gravity=0.0),
            in_pipe(log, loads=(tr.Force((2.0, -3.0, 0.0)),), velocity=(0.5, 0.0)),
            in_pipe(log, tilt="-90 deg"),
        ]

    def violations(self) -> list[tuple[tr.RollingSystem, tr.State, str]]:
        inside, start = in_pipe(BALL)
        swung = replace(inside, support=replace(inside.support, motion=tr.UnevenSpin(1.0, 0.1, 2.0)))
        top = tr.State((0.0, 0.0, 0.525), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        eccentric = replace(BALL, shape=Sphere(0.025, Vector(0.0, 0.0, 0.001)))
        still = replace(start, position=(0.475, 0.0, 0.25), velocity=(0.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 0.0))
        return [
            (swung, swung.place((0.7, 0.25)), "motion, uneven-spin, is"),
            (replace(inside, support=replace(inside.support, surface=Ball(0.5, 1.0))), top, "Ball"),
            (replace(inside, body=eccentric), still, "about its centre"),
            (replace(inside, loads=(Spring(1.0),)), start, "Spring"),
            (replace(inside, loads=(tr.Drag(0.1),)), start, "load drag is"),
            (replace(inside, loads=(tr.Torque((0.0, 0.0, 0.1)),)), start, "torque"),
            (replace(inside, loads=(tr.Force(("t", 0.0, 0.0)),)), start, "load force is"),
        ]

    @pytest.mark.parametrize(
        ("case", "word"),
        [
            (in_pipe(BALL, tilt="80 deg"), "along the cylinder's axis"),
            (in_pipe(BALL, velocity=(0.2, 0.1)), "start moves along"),
            (in_pipe(BALL, velocity=(0.2, 0.0), spin=1.0), "spins across"),
        ],
    )
    def test_what_goes_along_the_axis_is_another_form_s(self, case: Any, word: str) -> None:
        with pytest.raises(OutOfDomainError, match=word):
            CylinderOnCylinder.of(*case)
        assert isinstance(closed_form(*case), BallInLeaningCylinder)

    def offset(self, system: tr.RollingSystem, at: Vector) -> Vector:
        sign, distance = (1 if system.support.surface.side == "outside" else -1), mpmath.hypot(at.x, at.y)
        return Vector(at.x / distance, at.y / distance, mpmath.mpf(0)) * (-sign * mpmath.mpf(system.body.shape.radius))
