"""The circular cone, from inside or outside."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from ... import wording
from ...errors import InvalidValueError
from ..algebra import Matrix, Vector
from ..parts import POSITIVE, Choice, Number
from ..scalars import Scalar, namespace
from .base import Surface
from .cylinder import SIDES, from_axis


def _check_half_angle(angle: float, received: Any) -> None:
    if not 0 < angle < math.pi / 2:
        remedy = "It is the angle between axis and wall. Write deg behind degrees."
        raise InvalidValueError("", "must lie between 0 and 90 deg", received, remedy)


@dataclass(frozen=True)
class Cone(Surface):
    """A circular cone about the third axis with its apex at the origin, rolled on from inside or outside.

    Inside it opens upward, z = r cot β, a funnel; outside it opens downward, z = −r cot β, a hill. The apex is not
    smooth: a run ends there.

    Parameters
    ----------
    half_angle : float or quantity
        β, between the axis and the wall, rad.
    side : str
        "inside" or "outside", where the body is.
    rim : float or quantity, optional
        Distance of the edge from the axis, m; absent: the cone has none.

    Examples
    --------
    >>> funnel = Cone("45 deg")
    >>> round(funnel.point(0.3, 0.4).z, 15)
    0.5
    """

    half_angle: Annotated[
        Scalar,
        Number("angle", said="Between the axis and the wall, up to 90 deg.", example="45 deg", limit=_check_half_angle),
    ]
    side: Annotated[str, Choice(SIDES, "side of a cone")] = "inside"
    rim: Annotated[
        Scalar | None, Number("length", POSITIVE, "Distance of the edge from the axis; absent: unbounded.", "40 cm")
    ] = None
    kind = "cone"
    label = "Funnel"
    noun, ground = "cone", "cone"
    axisymmetric = True
    domain_end = "the apex of the cone"

    @property
    def where(self) -> str:  # type: ignore[override]
        """The side."""
        return self.side

    def key_numbers(self) -> list[str]:
        """Return its half-angle."""
        return [f"half-angle {wording.degrees(self.half_angle)}"]

    @property
    def sign(self) -> float:
        """+1 where the body is outside, −1 where it is inside."""
        return 1.0 if self.side == "outside" else -1.0

    def _angle(self) -> tuple[Scalar, Scalar]:
        xp = namespace(self.half_angle)
        return xp.cos(self.half_angle), xp.sin(self.half_angle)

    def level(self, p: Vector) -> Scalar:
        """Return the distance from the wall, m."""
        c, s = self._angle()
        return (self.sign * c) * from_axis(p)[1] + s * p.z

    def normal(self, p: Vector) -> Vector:
        """Return the direction up and away from the axis outside, up and towards it inside."""
        c, s = self._angle()
        e, _ = from_axis(p)
        return Vector(e.x * (self.sign * c), e.y * (self.sign * c), s)

    def shape_operator(self, p: Vector) -> Matrix:
        """Return ±cos β/r around and 0 along the wall, r being the distance of p from the axis."""
        e, distance = from_axis(p)
        around = Vector(-e.y, e.x, 0.0)
        return Matrix.outer(around, around) * (self.sign * self._angle()[0] / distance)

    def domain_margin(self, p: Vector) -> Scalar:
        """Return the height over the apex inside, the depth below it outside, m."""
        return -self.sign * p.z

    def point(self, u: Scalar, v: Scalar) -> Vector:
        """Return the point at x and y, m."""
        c, s = self._angle()
        return Vector(u, v, (-self.sign * c / s) * namespace(u, v).sqrt(u * u + v * v))

    def coordinates_of(self, p: Vector) -> tuple[Scalar, Scalar]:
        """Return x and y of the point, or of the foot of a point over it."""
        c, s = self._angle()
        e, distance = from_axis(p)
        foot = s * (s * distance - (self.sign * c) * p.z)
        return e.x * foot, e.y * foot
