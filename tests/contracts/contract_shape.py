"""What every shape of body must obey: inherit `ShapeContract`, say the shape and its level function."""

from __future__ import annotations

from typing import Any

import numpy as np
from tests.precise import across, directions, floats, precisely, quaternions, size_of, slope, unit
from tests.tolerances import EXACT

from trundle.mechanics.algebra import Vector
from trundle.mechanics.shapes import Shape


class ShapeContract:
    """Set `shape`, and write `level`: 0 on the shape's surface, positive outside, without use of the support map."""

    shape: Shape
    edged = False  # True where the surface has an edge, so that a radius of curvature may be zero

    def level(self, x: Vector) -> Any:
        raise NotImplementedError

    @property
    def size(self) -> Any:
        return max(self.shape.support_map(nu).norm() for nu in directions("size", 20))

    @precisely
    def test_it_says_truly_how_far_it_reaches_and_whether_it_is_a_sphere(self) -> None:
        reach, widths = self.shape.reach, []
        for nu in directions("widths", 200):
            across = self.shape.support_map(nu) - self.shape.support_map(-nu)
            widths.append(across.dot(nu) / 2)
            assert not self.shape.spherical or size_of(across - nu * (2 * reach)) <= EXACT(16, reach)
        if reach is not None:
            assert 0.9 * reach <= max(widths) <= reach * (1 + EXACT(16, 1))

    @precisely
    def test_the_support_map_lies_on_the_shape(self) -> None:
        for nu in directions("on", 30):
            x = self.shape.support_map(nu)
            assert abs(self.level(x)) <= EXACT(16, self.size)
            assert self.level(x + nu * 1e-6) > 0  # and ν points out of it

    @precisely
    def test_no_other_point_lies_further_along_the_normal(self) -> None:
        # h(ν) = max X·ν: this makes X the point with outward normal ν of a convex body.
        points = [self.shape.support_map(nu) for nu in directions("others", 60)]
        slack = EXACT(16, self.size)
        for nu in directions("normal", 20):
            furthest = self.shape.support_map(nu).dot(nu)
            assert all(point.dot(nu) <= furthest + slack for point in points)

    @precisely
    def test_the_surface_is_perpendicular_to_the_normal(self) -> None:
        for nu in directions("tangent", 10):
            for t in across(nu):
                along = slope(lambda h, nu=nu, t=t: self.shape.support_map(unit(nu + t * h)))
                assert abs(along.dot(nu)) <= EXACT(16, self.size)

    @precisely
    def test_the_gradient_is_that_of_the_support_map(self) -> None:
        for nu in directions("gradient", 10):
            gradient = self.shape.support_gradient(nu)
            for t in across(nu):
                along = slope(lambda h, nu=nu, t=t: self.shape.support_map(unit(nu + t * h)))
                assert size_of(gradient @ t - along) <= EXACT(16, size_of(gradient))

    @precisely
    def test_the_gradient_is_symmetric_and_positive_on_the_tangent_plane(self) -> None:
        for nu in directions("curvature", 10):
            gradient, (t, s) = self.shape.support_gradient(nu), across(nu)
            tt, ts, st, ss = (u.dot(gradient @ v) for u, v in ((t, t), (t, s), (s, t), (s, s)))
            slack = EXACT(16, size_of(gradient))
            assert abs(ts - st) <= slack
            determinant = tt * ss - ts * st
            assert tt + ss > 0
            assert determinant >= -slack * (tt + ss) if self.edged else determinant > 0

    @precisely
    def test_contact_is_the_support_map_turned_with_the_body(self) -> None:
        # A shape may say `contact` in a shorter way; it must say the same.
        for q, n in zip(quaternions("turned", 10), directions("n", 10), strict=True):
            Q = q.matrix()
            (rho, C), (rho_general, C_general) = self.shape.contact(Q, n), Shape.contact(self.shape, Q, n)
            assert size_of(rho - rho_general) <= EXACT(16, size_of(rho_general))
            assert size_of(C.dense - C_general.dense) <= EXACT(16, size_of(C_general.dense))

    def test_a_whole_array_of_contacts_is_one_call(self) -> None:
        qs, ns = [floats(q) for q in quaternions("many", 5)], [floats(n) for n in directions("many n", 5)]
        Q = type(qs[0])(*np.array([list(q) for q in qs]).T).matrix()
        rho, C = self.shape.contact(Q, Vector(*np.array([list(n) for n in ns]).T))
        for i, (q, n) in enumerate(zip(qs, ns, strict=True)):
            rho_one, C_one = self.shape.contact(q.matrix(), n)
            assert np.allclose(rho.array()[i], rho_one.array(), rtol=0, atol=EXACT(16, float(size_of(rho_one))))
            for row, row_one in zip(C.rows, C_one.rows, strict=True):
                shown = np.broadcast_to(row.array(), (5, 3))[i]
                assert np.allclose(shown, row_one.array(), rtol=0, atol=EXACT(16, float(size_of(C_one.dense))))
