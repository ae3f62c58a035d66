"""The plane, bounded by a rim or not."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from ..algebra import E_X, E_Y, E_Z, Matrix, Vector
from ..parts import POSITIVE, Number
from ..scalars import Scalar
from .base import Surface, check_upright


@dataclass(frozen=True)
class Plane(Surface):
    """The plane z = 0 of the support frame, bounded by a circular rim about the axis if one is given.

    Parameters
    ----------
    rim : float or quantity, optional
        Distance of the rim from the axis, m; absent: the plane has no end.

    Examples
    --------
    >>> Plane(rim="0.5 m").normal(Vector(0.1, 0.2, 0.0))
    Vector(x=0.0, y=0.0, z=1.0)
    """

    rim: Annotated[Scalar | None, Number("length", POSITIVE, "Radius of the rim; absent: unbounded.", "0.5 m")] = None
    kind = "plane"
    label = "Table"
    flat = True
    noun, ground = "plane", "table"
    axisymmetric = True
    tilt = Number("angle", said="Angle of the plane's normal to the vertical; down the first axis.")

    @property
    def free_radius(self) -> Scalar:
        """Infinite."""
        return math.inf

    def level(self, p: Vector) -> Scalar:
        """Return the height over the plane, m."""
        return p.z

    def normal(self, p: Vector) -> Vector:  # noqa: ARG002  the same everywhere
        """Return the third axis of the support frame."""
        return E_Z

    def shape_operator(self, p: Vector) -> Matrix:  # noqa: ARG002  the same everywhere
        """Return 0: a plane does not bend."""
        return Matrix.zero()

    def point(self, u: Scalar, v: Scalar) -> Vector:
        """Return (x, y, 0)."""
        return Vector(u, v, 0.0)

    def coordinates_of(self, p: Vector) -> tuple[Scalar, Scalar]:
        """Return x and y."""
        return p.x, p.y

    def directions(self, p: Vector) -> tuple[Vector, Vector]:  # noqa: ARG002  the same everywhere
        """Return the first two axes."""
        return E_X, E_Y

    def contact_from_coordinates(self, u: Scalar, v: Scalar, offset: Vector) -> Vector:
        """Return the contact of a body whose centre of mass is over (x, y)."""
        return Vector(u + offset.x, v + offset.y, 0.0)

    def coordinates_from_contact(self, p: Vector, offset: Vector) -> tuple[Scalar, Scalar]:
        """Return x and y of the centre of mass."""
        return p.x - offset.x, p.y - offset.y

    def check_tilt(self, tilt: float, received: Any) -> None:
        """Refuse a plane that stands upright or hangs over."""
        check_upright(tilt, received)
