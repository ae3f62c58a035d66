"""What every surface is: level function, unit normal, shape operator and coordinates, in the support's own frame."""

from __future__ import annotations

import math
from typing import Any

from ...errors import InvalidValueError
from ..algebra import Matrix, Vector
from ..scalars import Scalar, is_number


class Surface:
    """A smooth surface φ(p) = 0, with φ positive on the side of the body (theory page, section 2)."""

    rim: Scalar | None = None
    axisymmetric: bool
    coordinates: tuple[str, str] = ("length", "length")  # kinds of quantity, as in `trundle.units`

    def level(self, p: Vector) -> Scalar:
        """Return φ(p), m."""
        raise NotImplementedError

    def normal(self, p: Vector) -> Vector:
        """Return n = ∇φ/|∇φ|, from the support into the body."""
        raise NotImplementedError

    def shape_operator(self, p: Vector) -> Matrix:
        """Return S with dn = S dp along the surface, 1/m: outside a sphere of radius b it is +1/b."""
        raise NotImplementedError

    def point(self, u: Scalar, v: Scalar) -> Vector:
        """Return the point of the surface with given coordinates, m."""
        raise NotImplementedError

    def coordinates_of(self, p: Vector) -> tuple[Scalar, Scalar]:
        """Return the coordinates of a point of the surface, or of a point straight over it."""
        raise NotImplementedError

    def directions(self, p: Vector) -> tuple[Vector, Vector]:
        """Return the unit tangents along which the two coordinates grow."""
        raise NotImplementedError

    def under(self, u: Scalar, v: Scalar, offset: Vector) -> Vector:  # noqa: ARG002
        """Return the contact of a body put down at coordinates (u, v); on a curved surface they are the contact's.

        Parameters
        ----------
        u, v : Scalar
            Of the kinds in `coordinates`.
        offset : Vector
            ρ, from the centre of mass to the contact, m.

        Returns
        -------
        Vector
            p, m.
        """
        return self.point(u, v)

    def check_tilt(self, tilt: float, received: Any) -> None:
        """Refuse a tilt at which this surface is not what its name says."""
        if not abs(tilt) <= math.pi:
            remedy = "Did you mean degrees? Write 'deg' behind the number." if is_number(received) else ""
            raise InvalidValueError("tilt", "must lie in [−180°, 180°]", received, remedy)
