"""Surfaces, those of the package and those that only the tests have."""

from __future__ import annotations

import mpmath
import pytest
from tests.additions import Ball
from tests.contracts.contract_surface import SurfaceContract
from tests.precise import directions, numbers, precisely, vectors

from trundle.errors import InvalidValueError, UnknownNameError
from trundle.mechanics.algebra import Vector
from trundle.mechanics.bodies import Body
from trundle.mechanics.surfaces import (
    Bowl,
    Cone,
    Cylinder,
    Dome,
    EllipsoidalBowl,
    HeightField,
    OverPlane,
    Paraboloid,
    Plane,
    Revolution,
    Surface,
    TorusTrack,
)
from trundle.mechanics.system import RollingSystem, Support


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


def mp(text: str) -> mpmath.mpf:
    return mpmath.mpf(text)


def on_disc(seed: str, radius: float, count: int = 6) -> list[tuple[mpmath.mpf, mpmath.mpf]]:
    """Return x and y of points about the axis, one of them on the first axis, one very near the axis."""
    x, y = numbers(f"{seed} x", count, radius / 1.5), numbers(f"{seed} y", count, radius / 1.5)
    return [*zip(x, y, strict=True), (mp("0.25") * radius, mp(0)), (mp("1e-9"), mp("-2e-9"))]


class TestBowl(SurfaceContract):
    surface: Surface = Bowl(0.5, rim=0.5)
    length = 0.5
    square = False
    side = 1  # the points are above the plane of the origin or below it

    def points(self) -> list[Vector]:
        half = mp("0.5")
        places = [*on_disc("ball", 0.5), (mp(0), mp(0))]
        return [Vector(x, y, self.side * (half - mpmath.sqrt(half**2 - x * x - y * y))) for x, y in places]

    @pytest.mark.parametrize("tilt", [90.0, 1.6, -2.0])
    def test_it_may_lean_but_not_stand_upright(self, tilt: float) -> None:
        with pytest.raises(InvalidValueError, match="tilt"):
            Support(self.surface, tilt=tilt)

    @pytest.mark.parametrize("numbers", [{"radius": 0.0}, {"radius": -1}, {"radius": 0.5, "rim": 0.51}])
    def test_its_sizes_are_checked(self, numbers: dict[str, float]) -> None:
        with pytest.raises(InvalidValueError, match=r"radius|rim"):
            type(self.surface)(**numbers)

    @precisely
    def test_it_ends_at_its_rim(self) -> None:
        edge = self.surface.point(mp("0.5"), mp(0))
        above = Vector(edge.x, edge.y, edge.z + self.side * mp("0.001"))
        assert self.surface.domain_margin(edge) == 0 > self.surface.domain_margin(above)
        assert type(self.surface)(0.5).domain_margin(edge) is None


class TestDome(TestBowl):
    surface = Dome(0.5, rim=0.5)
    side = -1


class TestClosedSphereAboveItsMiddle(SurfaceContract):
    """The body may run up over the equator, where x and y no longer tell the place."""

    surface = Bowl(0.5)
    length = 0.5
    mapped = False

    def points(self) -> list[Vector]:
        return [n * mp("0.5") + Vector(mp(0), mp(0), mp("0.5")) for n in directions("sphere", 8)]


class TestInsideOfCone(SurfaceContract):
    surface: Surface = Cone("30 deg")
    length = 0.1
    square = False
    side = 1

    def points(self) -> list[Vector]:
        slope = mpmath.cot(mpmath.mpf(self.surface.half_angle))
        return [Vector(x, y, self.side * slope * mpmath.hypot(x, y)) for x, y in on_disc("cone", 1.0)[:-1]]

    @pytest.mark.parametrize("angle", [0.0, -0.1, "90 deg", 30.0])
    def test_its_angle_is_less_than_a_right_one(self, angle: object) -> None:
        with pytest.raises(InvalidValueError, match="half_angle"):
            Cone(angle)

    def test_a_side_is_inside_or_outside(self) -> None:
        with pytest.raises(UnknownNameError, match="inside, outside"):
            Cone(0.5, "out")

    @precisely
    def test_it_ends_at_its_apex(self) -> None:
        for p in self.points():
            assert self.surface.domain_margin(p) > 0 > self.surface.domain_margin(-p)


class TestOutsideOfCone(TestInsideOfCone):
    surface = Cone("30 deg", "outside")
    side = -1


class TestParaboloid(SurfaceContract):
    surface: Surface = Paraboloid(0.5)
    length = 0.5
    square = footed = False

    def points(self) -> list[Vector]:
        b = mpmath.mpf(self.surface.radius)
        return [Vector(x, y, (x * x + y * y) / (2 * b)) for x, y in [*on_disc("dish", 1.0), (mp(0), mp(0))]]

    def test_its_radius_is_not_zero(self) -> None:
        with pytest.raises(InvalidValueError, match="radius"):
            Paraboloid(0.0)


class TestMound(TestParaboloid):
    surface = Paraboloid(-0.5)


class TestEllipsoidalBowl(SurfaceContract):
    surface: Surface = EllipsoidalBowl((0.75, 0.5, 0.25))
    length = 0.25
    square = footed = False

    def points(self) -> list[Vector]:
        a, b, c = (mpmath.mpf(axis) for axis in self.surface.semi_axes)
        places = [*on_disc("bowl", 0.5), (mp(0), mp(0))]
        return [Vector(x, y, c * (1 - mpmath.sqrt(1 - (x / a) ** 2 - (y / b) ** 2))) for x, y in places]

    @pytest.mark.parametrize("axes", [(1, 1), (1, 1, 0), (1, 1, -1), 0.5, "abc"])
    def test_it_has_three_semi_axes(self, axes: object) -> None:
        with pytest.raises(InvalidValueError, match="semi_axes"):
            EllipsoidalBowl(axes)

    def test_it_is_no_deeper_than_half_of_it(self) -> None:
        with pytest.raises(InvalidValueError, match="depth"):
            EllipsoidalBowl((1, 1, 0.5), depth=0.6)


class TestEqualSemiAxes(TestEllipsoidalBowl):
    surface = EllipsoidalBowl((0.75, 0.75, 0.25), depth=0.25)


class TestInsideOfTorus(SurfaceContract):
    surface: Surface = TorusTrack(1.0, 0.25)
    length = 0.25
    side = -1

    def points(self) -> list[Vector]:
        found = []
        # From the line of rest, the angle 0, on; beside the outermost and the innermost line, too.
        for i, across in enumerate(["0", "1", "-1", "1.5707963", "-1.5707963", "3", "-3", "1e-9"]):
            r = 1 + mpmath.sin(mp(across)) / 4
            z = self.side * mpmath.cos(mp(across)) / 4
            found.append(Vector(r * mpmath.cos(i - 3), r * mpmath.sin(i - 3), z))
        return found

    def test_the_tube_fits_into_the_ring(self) -> None:
        with pytest.raises(InvalidValueError, match="tube_radius"):
            TorusTrack(0.5, 0.5)
        with pytest.raises(UnknownNameError, match="inside, outside"):
            TorusTrack(0.5, 0.1, "within")


class TestOutsideOfTorus(TestInsideOfTorus):
    surface = TorusTrack(1.0, 0.25, "outside")
    side = 1


class TestEvenRevolution(SurfaceContract):
    surface: Surface = Revolution("0.25*r*r - r**3*r/8 + sqrt(1 + r**2) - 1")
    square = footed = False

    def profile(self, r: mpmath.mpf) -> mpmath.mpf:
        return r * r / 4 - r**4 / 8 + mpmath.sqrt(1 + r * r) - 1

    def points(self) -> list[Vector]:
        places = [*on_disc("turned", 1.0), (mp(0), mp(0))]
        return [Vector(x, y, self.profile(mpmath.hypot(x, y))) for x, y in places]


class TestFormulaInRAndItsSquare(TestEvenRevolution):
    surface = Revolution("cos(r) + r2/4 - 1")

    def profile(self, r: mpmath.mpf) -> mpmath.mpf:
        return mpmath.cos(r) + r * r / 4 - 1

    def points(self) -> list[Vector]:
        return super().points()[:-1]  # on the axis itself the difference quotients of a square root fail


class TestHeightField(SurfaceContract):
    surface: Surface = HeightField("0.2*sin(3*x)*cos(2*y) + 0.1*x*y**2")
    length = 0.25
    square = footed = False

    def points(self) -> list[Vector]:
        places = [*on_disc("hills", 1.0), (mp(0), mp(0))]
        fifth, tenth = mpmath.mpf(0.2), mpmath.mpf(0.1)
        return [Vector(x, y, fifth * mpmath.sin(3 * x) * mpmath.cos(2 * y) + tenth * x * y * y) for x, y in places]

    @pytest.mark.parametrize("formula", ["z", "x + t", "import os", "", "x**0.5", 3])
    def test_it_is_a_formula_in_x_and_y(self, formula: object) -> None:
        if formula == 3:
            assert HeightField(formula).normal(Vector(0.0, 0.0, 3.0)) == Vector(0.0, 0.0, 1.0)
            return
        with pytest.raises(InvalidValueError, match="formula"):
            HeightField(formula)


class TestHeightOfOnesOwn(SurfaceContract):
    """A new surface is one formula."""

    square = footed = False

    class Saddle(OverPlane):
        axisymmetric = False

        def height(self, x: object, y: object) -> object:
            return x * y

    surface = Saddle()

    def points(self) -> list[Vector]:
        return [Vector(x, y, x * y) for x, y in [*on_disc("saddle", 1.0), (mp(0), mp(0))]]


@pytest.mark.parametrize("x", [-3.0, -0.3, 0.1, 0.4, 7.0])
@pytest.mark.parametrize("y", [-2.0, -0.2, 0.05, 0.6, 3.0])
def test_a_table_of_heights_ends_on_all_sides_and_beyond_its_corners(x: float, y: float) -> None:
    """Beyond two edges at once a product of what is left both ways is positive: a start was taken 10 000 km below."""
    heights = HeightField.through([-0.3, 0.0, 0.2, 0.4], [-0.2, 0.1, 0.3, 0.6], [[0.1, 0.0, 0.2, 0.1]] * 4)
    left = heights.domain_margin(Vector(x, y, 0.0))
    outside = not (-0.3 <= x <= 0.4 and -0.2 <= y <= 0.6)
    inside = -0.3 < x < 0.4 and -0.2 < y < 0.6
    assert left < 0 if outside else left > 0 if inside else abs(left) < 1e-15
    ball = RollingSystem(Body.solid_sphere(0.01, 0.1), Support(heights))
    if inside:
        ball.place((x, y))
    else:
        with pytest.raises(InvalidValueError, match="end of the table"):
            ball.place((x, y))
