"""The circular cylinder, from inside or outside."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from ... import wording
from ..algebra import E_Z, Matrix, Vector
from ..parts import POSITIVE, Choice, Number
from ..scalars import Scalar, namespace
from .base import Surface

SIDES = ("inside", "outside")


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

    radius: Annotated[Scalar, Number("length", POSITIVE, example="40 cm")]
    side: Annotated[str, Choice(SIDES, "side of a cylinder")] = "inside"
    kind = "cylinder"
    noun, ground = "cylinder", "wall"

    @property
    def wall_radius(self) -> Scalar:  # type: ignore[override]
        """Its radius."""
        return self.radius

    @property
    def outline(self) -> tuple[Scalar, ...]:
        """The wall, seen along its axis."""
        return (self.radius,)

    axisymmetric = True
    coordinates = ("angle", "length")
    coordinate_labels = ("Angle about the axis", "Height along the axis")
    tilt = Number("angle", said="Angle of the axis to the vertical; 90 deg: a trough or a log.")

    @property
    def where(self) -> str:  # type: ignore[override]
        """The side."""
        return self.side

    def key_numbers(self) -> list[str]:
        """Return its radius."""
        return [f"wall of radius {wording.length(self.radius)}"]

    @property
    def sign(self) -> float:
        """+1 where the body is outside, −1 where it is inside."""
        return 1.0 if self.side == "outside" else -1.0

    @property
    def free_radius(self) -> Scalar:
        """Its own inside, infinite outside."""
        return math.inf if self.sign > 0 else self.radius

    def level(self, p: Vector) -> Scalar:
        """Return the distance from the wall, m."""
        return (from_axis(p)[1] - self.radius) * self.sign

    def correction(self, p: Vector) -> Vector:
        """Return (b² − d²)/(2 b²) times the way from the axis."""
        square = self.radius * self.radius
        share = 0.5 - 0.5 * (p.x * p.x + p.y * p.y) / square
        return Vector(p.x * share, p.y * share, 0.0)

    def normal(self, p: Vector) -> Vector:
        """Return the direction away from the axis outside, towards it inside."""
        return from_axis(p)[0] * self.sign

    def shape_operator(self, p: Vector) -> Matrix:
        """Return ±1/d around and 0 along, d being the distance of p from the axis."""
        e, distance = from_axis(p)
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
        e, _ = from_axis(p)
        return Vector(-e.y, e.x, 0.0), E_Z


def from_axis(p: Vector) -> tuple[Vector, Scalar]:
    """Return the direction away from the third axis, and the distance from it.

    Examples
    --------
    >>> from_axis(Vector(3.0, 4.0, 7.0))
    (Vector(x=0.6, y=0.8, z=0.0), 5.0)
    """
    distance = namespace(p.x, p.y).sqrt(p.x * p.x + p.y * p.y)
    return Vector(p.x / distance, p.y / distance, 0.0), distance
