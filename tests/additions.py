"""Surfaces and motions that only the tests have: they show that an addition is an addition, not a rewrite."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from trundle.mechanics.algebra import E_X, E_Z, Matrix, Vector
from trundle.mechanics.motions import Motion, SupportState
from trundle.mechanics.scalars import Scalar, namespace
from trundle.mechanics.surfaces import Surface


@dataclass(frozen=True)
class Ball(Surface):
    """A sphere of radius b about the origin: side +1 carries the body outside, −1 inside."""

    b: Scalar
    side: Scalar
    rim = None
    axisymmetric = True

    def level(self, p: Vector) -> Scalar:
        return (p.norm() - self.b) * self.side

    def normal(self, p: Vector) -> Vector:
        return p * (self.side / p.norm())

    def shape_operator(self, p: Vector) -> Matrix:
        e = p / p.norm()
        return (Matrix.identity() - Matrix.outer(e, e)) * (self.side / p.norm())


@dataclass(frozen=True)
class Tumble(Motion):
    """R = R₃(ωt + ½βt²) R₁(γt) about an origin that swings, X = A sin νt: every term of u̇ is there."""

    spin: Scalar
    growth: Scalar
    tip: Scalar
    swing: Any
    pace: Scalar

    def at(self, time: Scalar) -> SupportState:
        xp = namespace(self.spin, self.growth, self.tip, time)
        rate = self.spin + self.growth * time
        angle, lean = self.spin * time + 0.5 * self.growth * time * time, self.tip * time
        c, s, cl, sl = xp.cos(angle), xp.sin(angle), xp.cos(lean), xp.sin(lean)
        about_z = Matrix(Vector(c, -s, 0.0), Vector(s, c, 0.0), E_Z)
        about_x = Matrix(E_X, Vector(0.0, cl, -sl), Vector(0.0, sl, cl))
        tipping = Vector(c, s, 0.0) * self.tip
        there, speed = xp.sin(self.pace * time), xp.cos(self.pace * time) * self.pace
        return SupportState(
            rotation=about_z @ about_x,
            origin=self.swing * there,
            velocity=self.swing * speed,
            acceleration=self.swing * (-(self.pace * self.pace) * there),
            angular_velocity=E_Z * rate + tipping,
            angular_acceleration=E_Z * self.growth + (E_Z * rate).cross(tipping),
        )
