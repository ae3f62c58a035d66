"""Surfaces, those of the package and those that only the tests have."""

from __future__ import annotations

import mpmath
import pytest
from tests.additions import Ball
from tests.contracts.contract_surface import SurfaceContract
from tests.precise import directions, vectors

from trundle.errors import InvalidValueError, UnknownNameError
from trundle.mechanics.algebra import Vector
from trundle.mechanics.surfaces import Cylinder, Plane
from trundle.mechanics.system import Support


class TestPlane(SurfaceContract):
    surface = Plane(rim=0.5)

    def points(self) -> list[Vector]:
        return [Vector(v.x, v.y, mpmath.mpf(0)) for v in vectors("plane", 6)]

    @pytest.mark.parametrize("rim", [0.0, -0.1, float("nan"), float("inf")])
    def test_a_rim_is_a_length(self, rim: float) -> None:
        with pytest.raises(InvalidValueError, match="rim"):
            Plane(rim=rim)


class TestOutsideOfBall(SurfaceContract):
    surface = Ball(0.5, side=1.0)
    length = 0.5
    mapped = False

    def points(self) -> list[Vector]:
        return [n * mpmath.mpf(0.5) for n in directions("ball", 6)]


class TestInsideOfBall(TestOutsideOfBall):
    surface = Ball(0.5, side=-1.0)


class TestInsideOfCylinder(SurfaceContract):
    surface = Cylinder(0.5)
    length = 0.5

    def points(self) -> list[Vector]:
        around = [mpmath.mpf(i) for i in range(6)]
        return [Vector(mpmath.cos(i) / 2, mpmath.sin(i) / 2, i - 3) for i in around]

    @pytest.mark.parametrize("side", ["in", "", None])
    def test_a_side_is_inside_or_outside(self, side: object) -> None:
        with pytest.raises(UnknownNameError, match="inside, outside"):
            Cylinder(0.5, side)

    def test_it_may_lie_level_or_hang_over(self) -> None:
        assert Support(self.surface, tilt="90 deg").tilt == pytest.approx(1.5707963267948966)
        with pytest.raises(InvalidValueError, match="tilt"):
            Support(self.surface, tilt=181.0)


class TestOutsideOfCylinder(TestInsideOfCylinder):
    surface = Cylinder(0.5, "outside")
