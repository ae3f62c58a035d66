"""Ellipsoids."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ... import wording
from ..algebra import Matrix, ReducedTensor, Vector
from ..scalars import Scalar, is_number, namespace
from .base import CENTRE, RADIUS, Shape, moved, on_third_axis


@dataclass(frozen=True)
class Ellipsoid(Shape):
    """An ellipsoid with its axes along those of the body frame; its centre may sit away from the centre of mass.

    Parameters
    ----------
    a, b, c : float
        Semi-axes along the first, second and third axis of the body frame, m.
    centre : Vector, optional
        The ellipsoid's centre from the centre of mass in the body frame, m; absent: the two coincide.

    Examples
    --------
    >>> Ellipsoid(0.2, 0.03, 0.02).support_map(Vector(0.0, 0.0, -1.0))
    Vector(x=0.0, y=0.0, z=-0.02)
    """

    noun = "ellipsoid"
    a: Annotated[Scalar, RADIUS]
    b: Annotated[Scalar, RADIUS]
    c: Annotated[Scalar, RADIUS]
    centre: Annotated[Any, CENTRE] = None  # a Vector or None once it is made

    @property
    def axisymmetric(self) -> bool:
        """Whether the first two semi-axes are equal, and its centre lies on the third axis."""
        return is_number(self.a) and is_number(self.b) and bool(self.a == self.b) and on_third_axis(self.centre)

    def support_map(self, nu: Vector) -> Vector:
        """Return X = c + Aν/h with A = diag(a², b², c²) and h = √(νᵀAν)."""
        from_centre, _ = self._reached(nu)
        return moved(self.centre, from_centre)

    def support_gradient(self, nu: Vector) -> Matrix:
        """Return (A − x xᵀ)/h with x = Aν/h."""
        x, shrunk = self._reached(nu)
        A = Matrix.diagonal(self.a * self.a, self.b * self.b, self.c * self.c)
        return ReducedTensor.of(A, x, shrunk)

    @property
    def reach(self) -> Scalar:
        """The longest semi-axis."""
        return max(self.a, self.b, self.c)

    @property
    def largest_radius(self) -> Scalar:
        """At the ends of the shortest axis: the square of the longest over it."""
        return max(self.a, self.b, self.c) ** 2 / min(self.a, self.b, self.c)

    def key_numbers(self) -> list[str]:
        """Return its semi-axes."""
        return [f"body {wording.length(self.a, self.b, self.c)}"]

    def parameters(self) -> dict[str, Any]:
        """Return the semi-axes and the centre."""
        return {"semi_axes": (self.a, self.b, self.c), "centre": self.centre}

    def _reached(self, nu: Vector) -> tuple[Vector, Scalar]:
        """Return the point Aν/h from the ellipsoid's centre, and 1/h."""
        stretched = Vector(self.a * self.a * nu.x, self.b * self.b * nu.y, self.c * self.c * nu.z)
        shrunk = 1.0 / namespace(*stretched).sqrt(nu.dot(stretched))
        return stretched * shrunk, shrunk
