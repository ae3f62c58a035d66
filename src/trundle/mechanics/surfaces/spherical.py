"""The inside and the outside of a sphere: bowl and dome."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from ... import wording
from ...errors import InvalidValueError
from ..algebra import Matrix, RoundTensor, Vector
from ..parts import POSITIVE, Number
from ..scalars import Scalar, is_number, namespace
from .base import Surface, check_upright


@dataclass(frozen=True)
class Spherical(Surface):
    """A sphere of radius b that touches the plane of the first two axes at the origin; see `Bowl` and `Dome`."""

    radius: Annotated[Scalar, Number("length", POSITIVE, example="40 cm")]
    rim: Annotated[
        Scalar | None,
        Number(
            "length",
            POSITIVE,
            "Distance of the edge from the axis, up to the radius; absent: the whole sphere.",
            "35 cm",
        ),
    ] = None
    sign: ClassVar[float] = 0.0  # +1 where the body is outside, −1 where it is inside
    axisymmetric = True
    domain_end = "the rim"

    def __post_init__(self) -> None:
        given = self.rim
        super().__post_init__()
        if is_number(self.rim) and is_number(self.radius) and self.rim > self.radius:
            remedy = f"The sphere's radius is {self.radius:g} m; a rim of that makes a hemisphere."
            raise InvalidValueError("rim", "must be at most the radius", given, remedy)

    @property
    def outline(self) -> tuple[Scalar, ...]:
        """Its rim, or else its widest circle."""
        return (self.radius if self.rim is None else self.rim,)

    def key_numbers(self) -> list[str]:
        """Return its radius."""
        return [f"{self.ground} of radius {wording.length(self.radius)}"]

    @property
    def free_radius(self) -> Scalar:
        """Its own inside, infinite outside."""
        return math.inf if self.sign > 0 else self.radius

    def _arm(self, p: Vector) -> Vector:
        """Return p from the sphere's centre, which lies b over the lowest point or under the top."""
        return Vector(p.x, p.y, p.z + self.sign * self.radius)

    def _depth(self, square: Scalar) -> Scalar:
        """Return how far from the plane of the origin the points are whose distance from the axis has this square."""
        b = self.radius
        return square / (b + namespace(b, square).sqrt(b * b - square))

    def level(self, p: Vector) -> Scalar:
        """Return the distance from the sphere, m."""
        return self.sign * self._over(p) / (self._arm(p).norm() + self.radius)

    def correction(self, p: Vector) -> Vector:
        """Return (b² − d²)/(2 b²) times the way from the centre."""
        return self._arm(p) * (-0.5 * self._over(p) / (self.radius * self.radius))

    def _over(self, p: Vector) -> Scalar:
        """Return d² − b², which keeps the digits near the surface that the difference would lose."""
        return p.dot(p) + (2.0 * self.sign) * self.radius * p.z

    def known_lengths(self, p: Vector) -> tuple[tuple[Scalar, Scalar], ...]:
        """Return the distance from the centre, which is the radius."""
        return ((self._arm(p).norm(), self.radius),)

    def normal(self, p: Vector) -> Vector:
        """Return the direction away from the centre outside, towards it inside."""
        arm = self._arm(p)
        return arm * (self.sign / arm.norm())

    def shape_operator(self, p: Vector) -> Matrix:
        """Return ±1/d in all directions along the sphere, d being the distance of p from the centre."""
        arm = self._arm(p)
        distance = arm.norm()
        e = arm / distance
        return RoundTensor.of(self.sign / distance, e)

    def domain_margin(self, p: Vector) -> Scalar | None:
        """Return how far below its rim a bowl has the point, how far above it a dome, m; without a rim, None."""
        return None if self.rim is None else self._depth(self.rim * self.rim) + self.sign * p.z

    def point(self, u: Scalar, v: Scalar) -> Vector:
        """Return the point at x and y, m, on the half that the origin is on."""
        return Vector(u, v, -self.sign * self._depth(u * u + v * v))

    def coordinates_of(self, p: Vector) -> tuple[Scalar, Scalar]:
        """Return x and y of the point, or of the foot of a point over it."""
        arm = self._arm(p)
        scale = self.radius / arm.norm()
        return arm.x * scale, arm.y * scale

    def check_tilt(self, tilt: float, received: Any) -> None:
        """Refuse a bowl or dome whose axis does not point up."""
        check_upright(tilt, received)


@dataclass(frozen=True)
class Bowl(Spherical):
    """The inside of a sphere of radius b, its lowest point at the origin, its centre at (0, 0, b).

    Parameters
    ----------
    radius : float or quantity
        b, m. A ball fits if it is smaller.
    rim : float or quantity, optional
        Distance of the edge from the axis, m, on the lower half; absent: the sphere is closed.

    Examples
    --------
    >>> Bowl("50 cm").point(0.3, 0.0)
    Vector(x=0.3, y=0.0, z=0.09999999999999999)
    """

    kind = "bowl"
    where, noun, ground = "in", "bowl", "bowl"
    sign: ClassVar[float] = -1.0


@dataclass(frozen=True)
class Dome(Spherical):
    """The outside of a sphere of radius b, its top at the origin, its centre at (0, 0, −b).

    Parameters
    ----------
    radius : float or quantity
        b, m.
    rim : float or quantity, optional
        Distance of the edge from the axis, m, on the upper half; absent: the whole sphere.

    Examples
    --------
    >>> Dome("50 cm").point(0.3, 0.0)
    Vector(x=0.3, y=0.0, z=-0.09999999999999999)
    """

    kind = "dome"
    noun, ground = "dome", "dome"
    sign: ClassVar[float] = 1.0
