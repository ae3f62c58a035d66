"""Surfaces of supports, in the support's own frame: level function, unit normal, shape operator, coordinates.

A new surface is one class with these; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ..errors import InvalidValueError, UnknownNameError
from . import checks
from .algebra import E_X, E_Y, E_Z, Matrix, Vector
from .scalars import Scalar, is_number, namespace


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

    rim: Scalar | None = None
    axisymmetric = True

    def __post_init__(self) -> None:
        if self.rim is not None:
            object.__setattr__(self, "rim", checks.positive(self.rim, "length", "rim"))

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

    def under(self, u: Scalar, v: Scalar, offset: Vector) -> Vector:
        """Return the contact of a body whose centre of mass is over (x, y)."""
        return Vector(u + offset.x, v + offset.y, 0.0)

    def check_tilt(self, tilt: float, received: Any) -> None:
        """Refuse a plane that stands upright or hangs over."""
        if not abs(tilt) < math.pi / 2:
            remedy = "Did you mean degrees? Write 'deg' behind the number." if is_number(received) else ""
            raise InvalidValueError("tilt", "must lie in (−90°, 90°)", received, remedy)


_SIDES = ("inside", "outside")


@dataclass(frozen=True)
class Cylinder(Surface):
    """A circular cylinder about the support's third axis, rolled on from inside or outside.

    A tilt of 90° lays it down: gravity then acts along the first axis, and the angle is counted from the lowest line.

    Parameters
    ----------
    radius : float or quantity
        b, m.
    side : str
        "inside" or "outside", where the body is.

    Examples
    --------
    >>> pipe = Cylinder("50 cm")
    >>> pipe.point(0.0, 2.0), pipe.normal(pipe.point(0.0, 2.0)).x
    (Vector(x=0.5, y=0.0, z=2.0), -1.0)
    """

    radius: Scalar
    side: str = "inside"
    axisymmetric = True
    coordinates = ("angle", "length")

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", checks.positive(self.radius, "length", "radius"))
        if self.side not in _SIDES:
            raise UnknownNameError("side of a cylinder", str(self.side), _SIDES)

    @property
    def sign(self) -> float:
        """+1 where the body is outside, −1 where it is inside."""
        return 1.0 if self.side == "outside" else -1.0

    def level(self, p: Vector) -> Scalar:
        """Return the distance from the wall, m."""
        return (_from_axis(p)[1] - self.radius) * self.sign

    def normal(self, p: Vector) -> Vector:
        """Return the direction away from the axis outside, towards it inside."""
        return _from_axis(p)[0] * self.sign

    def shape_operator(self, p: Vector) -> Matrix:
        """Return ±1/d around and 0 along, d being the distance of p from the axis."""
        e, distance = _from_axis(p)
        around = Vector(-e.y, e.x, 0.0)
        return Matrix.outer(around, around) * (self.sign / distance)

    def point(self, u: Scalar, v: Scalar) -> Vector:
        """Return the point at an angle from the first axis towards the second, rad, and a height along the axis, m."""
        xp = namespace(u, self.radius)
        return Vector(self.radius * xp.cos(u), self.radius * xp.sin(u), v)

    def coordinates_of(self, p: Vector) -> tuple[Scalar, Scalar]:
        """Return angle and height."""
        return namespace(p.x, p.y).atan2(p.y, p.x), p.z

    def directions(self, p: Vector) -> tuple[Vector, Vector]:
        """Return the tangent around, towards growing angle, and the axis."""
        e, _ = _from_axis(p)
        return Vector(-e.y, e.x, 0.0), E_Z


def _from_axis(p: Vector) -> tuple[Vector, Scalar]:
    """Return the direction away from the third axis, and the distance from it."""
    distance = namespace(p.x, p.y).sqrt(p.x * p.x + p.y * p.y)
    return Vector(p.x / distance, p.y / distance, 0.0), distance
