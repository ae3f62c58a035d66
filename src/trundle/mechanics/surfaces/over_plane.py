"""Surfaces that are heights z = h(x, y) over the plane of the first two axes."""

from __future__ import annotations

from typing import Any

from ..algebra import Matrix, Vector
from ..jets import Jet, jets
from ..scalars import Scalar, namespace
from .base import Surface, check_upright, tangential

Slopes = tuple[Scalar, Scalar]  # ∂h/∂x, ∂h/∂y
Bends = tuple[Scalar, Scalar, Scalar]  # ∂²h/∂x², ∂²h/∂x∂y, ∂²h/∂y²


class OverPlane(Surface):
    """A surface z = h(x, y), the body above it; its coordinates are x and y.

    A new one needs `height` and `axisymmetric`; slopes and bends follow by differentiation unless it has them by hand.

    Examples
    --------
    >>> class Wave(OverPlane):
    ...     axisymmetric = False
    ...
    ...     def height(self, x, y):
    ...         return 0.1 * namespace(x).sin(x)
    >>> Wave().point(0.0, 3.0), Wave().normal(Vector(0.0, 3.0, 0.0)).x < 0
    (Vector(x=0.0, y=3.0, z=0.0), True)
    """

    def height(self, x: Scalar, y: Scalar) -> Scalar:
        """Return h(x, y), m.

        Parameters
        ----------
        x, y : Scalar
            m; jets included.

        Returns
        -------
        Scalar
            Over the plane of the first two axes.
        """
        raise NotImplementedError

    def derivatives(self, x: Scalar, y: Scalar) -> tuple[Slopes, Bends]:
        """Return the first derivatives of h, and the second, 1/m.

        Parameters
        ----------
        x, y : Scalar
            m.

        Returns
        -------
        slopes, bends
            (h_x, h_y), and (h_xx, h_xy, h_yy).
        """
        h = self.height(*jets((x, y)))
        if not isinstance(h, Jet):  # a formula in which neither stands
            return (0.0, 0.0), (0.0, 0.0, 0.0)
        (x_, y_), (xx, xy, yy) = h.gradient, h.hessian
        return (x_, y_), (xx, xy, yy)

    def slopes(self, x: Scalar, y: Scalar) -> Slopes:
        """Return the first derivatives of h.

        Parameters
        ----------
        x, y : Scalar
            m.

        Returns
        -------
        tuple of 2 Scalar
            h_x and h_y.
        """
        return self.derivatives(x, y)[0]

    def level(self, p: Vector) -> Scalar:
        """Return the height of p over the surface, along the third axis, m."""
        return p.z - self.height(p.x, p.y)

    def step_onto(self, p: Vector) -> Vector:
        """Return −n φ/|∇φ|."""
        n, length = self.normal_of(self.slopes(p.x, p.y))
        return n * -(self.level(p) / length)

    def normal(self, p: Vector) -> Vector:
        """Return n = (−h_x, −h_y, 1)/√(1 + h_x² + h_y²)."""
        return self.normal_of(self.slopes(p.x, p.y))[0]

    def shape_operator(self, p: Vector) -> Matrix:
        """Return S = −P H P/√(1 + h_x² + h_y²), H the second derivatives of h."""
        slopes, (xx, xy, yy) = self.derivatives(p.x, p.y)
        n, length = self.normal_of(slopes)
        bend = Matrix(Vector(xx, xy, 0.0), Vector(xy, yy, 0.0), Vector(0.0, 0.0, 0.0))
        return tangential(bend, n) * (-1.0 / length)

    def point(self, u: Scalar, v: Scalar) -> Vector:
        """Return (x, y, h(x, y))."""
        return Vector(u, v, self.height(u, v))

    @staticmethod
    def normal_of(slopes: Slopes) -> tuple[Vector, Scalar]:
        """Return n from the slopes, and the length of (−h_x, −h_y, 1)."""
        x, y = slopes
        length = namespace(x, y).sqrt(1.0 + x * x + y * y)
        return Vector(-(x / length), -(y / length), 1.0 / length), length

    def check_tilt(self, tilt: float, received: Any) -> None:
        """Refuse a surface that stands upright or hangs over."""
        check_upright(tilt, received)


def around_axis(x: Scalar, y: Scalar, first: Scalar, second: Scalar) -> tuple[Slopes, Bends]:
    """Return the derivatives of h = f(x² + y²) from f′ and f″.

    Examples
    --------
    >>> around_axis(3.0, 0.0, 0.5, 0.0)
    ((3.0, 0.0), (1.0, 0.0, 1.0))
    """
    twice, bend = 2.0 * first, 4.0 * second
    return (twice * x, twice * y), (twice + bend * (x * x), bend * (x * y), twice + bend * (y * y))
