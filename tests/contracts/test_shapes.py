"""Shapes of bodies, those of the package and those that only the tests have."""

from __future__ import annotations

from typing import Any

from tests.additions import Ellipsoid, Torus
from tests.contracts.contract_shape import ShapeContract

from trundle.mechanics.algebra import Vector
from trundle.mechanics.shapes import Sphere


class TestSphere(ShapeContract):
    shape = Sphere(0.3)

    def level(self, x: Vector) -> Any:
        return x.norm() - 0.3


class TestSphereOffCentre(ShapeContract):
    shape = Sphere(0.3, centre=Vector(0.05, -0.02, 0.1))

    def level(self, x: Vector) -> Any:
        return (x - Vector(0.05, -0.02, 0.1)).norm() - 0.3


class TestEllipsoid(ShapeContract):
    shape = Ellipsoid(0.5, 0.3, 0.2)

    def level(self, x: Vector) -> Any:
        return (x.x / 0.5) ** 2 + (x.y / 0.3) ** 2 + (x.z / 0.2) ** 2 - 1


class TestThinDisc(ShapeContract):
    shape = Torus(0.4, 0.0)
    edged = True

    def level(self, x: Vector) -> Any:
        return abs(Vector(x.x, x.y, 0).norm() - 0.4) + abs(x.z)


class TestTorus(ShapeContract):
    shape = Torus(0.4, 0.1)

    def level(self, x: Vector) -> Any:
        return Vector(Vector(x.x, x.y, 0).norm() - 0.4, 0, x.z).norm() - 0.1
