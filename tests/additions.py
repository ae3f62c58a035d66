"""Bodies, surfaces and motions that only the tests have: they show that an addition is an addition, not a rewrite."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from trundle.mechanics.algebra import E_X, E_Z, Matrix, Vector
from trundle.mechanics.motions import Motion, SupportState
from trundle.mechanics.scalars import Scalar, namespace
from trundle.mechanics.shapes import Shape
from trundle.mechanics.surfaces import Surface


@dataclass(frozen=True)
class Ellipsoid(Shape):
    """Semi-axes a, b, c: X = Aν/√(νᵀAν) with A = diag(a², b², c²)."""

    a: Scalar
    b: Scalar
    c: Scalar

    def _stretched(self, nu: Vector) -> tuple[Vector, Scalar]:
        stretched = Vector(self.a * self.a * nu.x, self.b * self.b * nu.y, self.c * self.c * nu.z)
        return stretched, namespace(*nu).sqrt(nu.dot(stretched))

    def support_map(self, nu: Vector) -> Vector:
        stretched, h = self._stretched(nu)
        return stretched / h

    def support_gradient(self, nu: Vector) -> Matrix:
        stretched, h = self._stretched(nu)
        A = Matrix.diagonal(self.a * self.a, self.b * self.b, self.c * self.c)
        return (A - Matrix.outer(stretched, stretched) * (1 / (h * h))) * (1 / h)


@dataclass(frozen=True)
class Torus(Shape):
    """A disc of radius a whose rim is rounded with radius e, X = a ν_t/|ν_t| + e ν; e = 0 leaves a sharp rim."""

    a: Scalar
    e: Scalar

    def support_map(self, nu: Vector) -> Vector:
        flat = Vector(nu.x, nu.y, 0.0)
        return flat * (self.a / flat.norm()) + nu * self.e

    def support_gradient(self, nu: Vector) -> Matrix:
        flat = Vector(nu.x, nu.y, 0.0)
        length = flat.norm()
        around = Matrix.diagonal(1.0, 1.0, 0.0) - Matrix.outer(flat, flat) * (1 / (length * length))
        return around * (self.a / length) + (Matrix.identity() - Matrix.outer(nu, nu)) * self.e


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
