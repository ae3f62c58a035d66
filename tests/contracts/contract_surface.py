"""What every surface must obey: inherit `SurfaceContract`, say the surface and some points on it."""

from __future__ import annotations

import mpmath
from tests.precise import across, numbers, precisely, size_of, slope, unit
from tests.tolerances import EXACT

from trundle.mechanics.algebra import Matrix, Vector
from trundle.mechanics.surfaces import Surface


class SurfaceContract:
    """Set `surface`, and write `points`: points on it, without use of its level function."""

    surface: Surface
    length = 1.0  # over which the surface changes, m
    mapped = True  # it has coordinates
    square = True  # whose lines cross at right angles everywhere
    footed = True  # and which a point over the surface shares with its foot

    def points(self) -> list[Vector]:
        raise NotImplementedError

    def _gradient(self, p: Vector) -> Vector:
        level = self.surface.level
        return Vector(
            slope(lambda h: level(Vector(p.x + h, p.y, p.z))),
            slope(lambda h: level(Vector(p.x, p.y + h, p.z))),
            slope(lambda h: level(Vector(p.x, p.y, p.z + h))),
        )

    @precisely
    def test_the_level_is_zero_on_the_surface(self) -> None:
        assert self.points()
        for p in self.points():
            assert abs(self.surface.level(p)) <= EXACT(16, self.length)

    @precisely
    def test_the_level_is_positive_on_the_side_of_the_body(self) -> None:
        for p in self.points():
            n, step = self.surface.normal(p), mpmath.mpf(self.length) / 1000
            assert self.surface.level(p + n * step) > 0 > self.surface.level(p - n * step)

    @precisely
    def test_the_normal_is_the_direction_in_which_the_level_grows(self) -> None:
        for p in self.points():
            n = self.surface.normal(p)
            assert abs(n.norm() - 1) <= EXACT(16, 1)
            assert size_of(n - unit(self._gradient(p))) <= EXACT(16, 1)

    @precisely
    def test_the_shape_operator_is_how_the_normal_leans(self) -> None:
        # The normals are taken from the level function, so that this test leans on nothing else.
        for p in self.points()[:6]:
            n, S = unit(self._gradient(p)), self.surface.shape_operator(p)
            for t in across(n):
                leans = slope(lambda h, p=p, t=t: unit(self._gradient(p + t * (h * self.length)))) * (1 / self.length)
                assert size_of(S @ t - leans) <= EXACT(16, 1 / self.length)

    @precisely
    def test_the_shape_operator_is_symmetric_and_tangential(self) -> None:
        for p in self.points():
            S, n = self.surface.shape_operator(p), self.surface.normal(p)
            assert size_of(S - S.transpose) <= EXACT(16, 1 / self.length)
            assert size_of(S @ n) <= EXACT(16, 1 / self.length)

    @precisely
    def test_coordinates_find_the_point_again(self) -> None:
        for p in self.points() if self.mapped else []:
            assert size_of(self.surface.point(*self.surface.coordinates_of(p)) - p) <= EXACT(16, self.length)

    @precisely
    def test_a_body_is_put_down_where_it_touches(self) -> None:
        offset = Vector(mpmath.mpf("0.1"), mpmath.mpf("-0.2"), mpmath.mpf("-0.3"))
        for p in self.points() if self.mapped else []:
            u, v = self.surface.coordinates_from_contact(p, offset)
            assert size_of(self.surface.contact_from_coordinates(u, v, offset) - p) <= EXACT(16, self.length)

    @precisely
    def test_its_own_formulas_are_those_of_its_level(self) -> None:
        for p in self.points():
            assert size_of(Surface.normal(self.surface, p) - self.surface.normal(p)) <= EXACT(16, 1)
            bends = Surface.shape_operator(self.surface, p) - self.surface.shape_operator(p)
            assert size_of(bends) <= EXACT(16, 1 / self.length)

    @precisely
    def test_it_says_truly_whether_it_is_flat(self) -> None:
        normals, points = [self.surface.normal(p) for p in self.points()], self.points()
        same = all(size_of(n - normals[0]) <= EXACT(16, 1) for n in normals)
        assert self.surface.flat == same
        assert same == all(size_of(self.surface.shape_operator(p)) <= EXACT(16, 1 / self.length) for p in points)

    @precisely
    def test_lengths_that_it_says_are_known_are_so_on_it_alone(self) -> None:
        for p in self.points():
            by = self.surface.normal(p) * (self.length / 1000)
            over = self.surface.known_lengths(p + by)
            for (length, known), (longer, as_known) in zip(self.surface.known_lengths(p), over, strict=True):
                assert abs(length - known) <= EXACT(16, self.length)
                assert abs(longer - as_known) > self.length / 10**5  # it is worked out where it is asked for

    @precisely
    def test_a_step_onto_it_leaves_the_square_of_what_was_off(self) -> None:
        for p in self.points():
            by = self.length / 10**6
            off = p + self.surface.normal(p) * by
            left = self.surface.step_onto(off) + off - p
            assert size_of(left) <= 100 * by * by / self.length

    @precisely
    def test_a_law_that_takes_a_length_for_known_asks_where_it_is_known(self) -> None:
        for p in self.points():
            by = self.length / 10**6
            off = p + self.surface.normal(p) * by
            step = self.surface.correction(off)
            if size_of(step) > 0 or self.surface.known_lengths(p):
                assert abs(self.surface.level(off + step)) <= 100 * by * by / self.length

    @precisely
    def test_it_is_defined_where_it_is(self) -> None:
        for p in self.points():
            room = self.surface.domain_margin(p)
            assert room is None or room > 0

    @precisely
    def test_the_directions_are_those_in_which_the_coordinates_grow(self) -> None:
        for p in self.points() if self.mapped else []:
            u, v = self.surface.coordinates_of(p)
            grown = (
                unit(slope(lambda h, v=v: self.surface.point(h, v), u)),
                unit(slope(lambda h, u=u: self.surface.point(u, h), v)),
            )
            first, second, n = *self.surface.directions(p), self.surface.normal(p)
            assert size_of(first - grown[0]) <= EXACT(16, 1)
            assert abs(second.norm() - 1) + abs(second.dot(n)) + abs(first.dot(second)) <= EXACT(16, 1)
            assert second.dot(grown[1]) > 0
            assert not self.square or size_of(second - grown[1]) <= EXACT(16, 1)

    @precisely
    def test_a_point_over_the_surface_has_the_coordinates_of_its_foot(self) -> None:
        for p in self.points() if self.mapped and self.footed else []:
            over = p + self.surface.normal(p) * (self.length / 8)
            for a, b in zip(self.surface.coordinates_of(over), self.surface.coordinates_of(p), strict=True):
                assert abs(a - b) <= EXACT(16, 1)

    @precisely
    def test_it_says_truly_whether_it_looks_the_same_from_all_sides(self) -> None:
        turned = []
        for p, angle in zip(self.points(), numbers("around", len(self.points()), 3.0), strict=True):
            c, s = mpmath.cos(angle), mpmath.sin(angle)
            about_axis = Matrix(Vector(c, -s, 0), Vector(s, c, 0), Vector(0, 0, 1))
            turned.append(abs(self.surface.level(about_axis @ p)) <= EXACT(16, self.length))
        assert all(turned) == self.surface.axisymmetric
