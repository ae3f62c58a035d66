"""The torus, a track that is rolled on inside its tube or outside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ... import wording
from ...errors import InvalidValueError
from ..algebra import E_Z, Matrix, Vector
from ..parts import POSITIVE, Choice, Number
from ..scalars import Scalar, is_number, namespace
from .base import Surface
from .cylinder import SIDES, from_axis


@dataclass(frozen=True)
class TorusTrack(Surface):
    """A torus about the third axis with its centre at the origin, rolled on inside its tube or outside.

    The first coordinate is the angle about the axis, from the first axis towards the second. The second is the angle
    around the tube, growing outwards from the line on which a body comes to rest: the lowest inside the tube, the
    highest outside.

    Parameters
    ----------
    ring_radius : float or quantity
        D, of the circle that the tube follows, m.
    tube_radius : float or quantity
        b, of the tube, m, less than D. Inside, a ball fits if it is smaller.
    side : str
        "inside" or "outside" of the tube, where the body is.

    Examples
    --------
    >>> track = TorusTrack("40 cm", "10 cm")
    >>> track.point(0.0, 0.0), track.normal(track.point(0.0, 0.0)).z
    (Vector(x=0.4, y=0.0, z=-0.1), 1.0)
    """

    ring_radius: Annotated[Scalar, Number("length", POSITIVE, "Of the circle that the tube follows.", "40 cm")]
    tube_radius: Annotated[Scalar, Number("length", POSITIVE, "Of the tube.", "12 cm")]
    side: Annotated[str, Choice(SIDES, "side of a torus track")] = "inside"
    kind = "torus-track"
    label = "Ring-shaped tube"
    noun, ground = "torus", "torus"

    @property
    def outline(self) -> tuple[Scalar, ...]:
        """The outer edge and the hole."""
        return self.ring_radius + self.tube_radius, self.ring_radius - self.tube_radius

    axisymmetric = True
    coordinates = ("angle", "angle")
    coordinate_labels = ("Angle about the axis", "Angle around the tube")

    def __post_init__(self) -> None:
        given = self.tube_radius
        super().__post_init__()
        ring, tube = self.ring_radius, self.tube_radius
        if is_number(ring) and is_number(tube) and not tube < ring:
            remedy = f"The ring's radius is {ring:g} m, and the tube would run into itself."
            raise InvalidValueError("tube_radius", "must be less than the ring's", given, remedy)

    @property
    def where(self) -> str:  # type: ignore[override]
        """The side."""
        return self.side

    def key_numbers(self) -> list[str]:
        """Return both radii."""
        return [f"ring {wording.length(self.ring_radius)}, tube {wording.length(self.tube_radius)}"]

    @property
    def free_radius(self) -> Scalar | None:
        """Inside, that of the tube, all of which is within it of the ring."""
        return self.tube_radius if self.side == "inside" else None

    @property
    def sign(self) -> float:
        """+1 where the body is outside the tube, −1 where it is inside."""
        return 1.0 if self.side == "outside" else -1.0

    def _from_ring(self, p: Vector) -> tuple[Vector, Scalar, Vector, Scalar]:
        """Return e and r from the axis, and the direction and distance from the middle of the tube."""
        e, r = from_axis(p)
        out = r - self.ring_radius
        distance = namespace(out, p.z).sqrt(out * out + p.z * p.z)
        return e, r, Vector(out / distance, 0.0, p.z / distance), distance

    def level(self, p: Vector) -> Scalar:
        """Return the distance from the wall of the tube, m."""
        return (self._from_ring(p)[3] - self.tube_radius) * self.sign

    def normal(self, p: Vector) -> Vector:
        """Return the direction away from the middle of the tube outside, towards it inside."""
        e, _, away, _ = self._from_ring(p)
        return Vector(e.x * away.x, e.y * away.x, away.z) * self.sign

    def shape_operator(self, p: Vector) -> Matrix:
        """Return ±1/d around the tube, and ±(slope outwards)/r about the axis."""
        e, r, away, distance = self._from_ring(p)
        along, across = Vector(-e.y, e.x, 0.0), e * away.z - E_Z * away.x
        by_tube, by_ring = self.sign / distance, self.sign * away.x / r
        return Matrix.outer(across, across) * by_tube + Matrix.outer(along, along) * by_ring

    def point(self, u: Scalar, v: Scalar) -> Vector:
        """Return the point at an angle about the axis and one around the tube, rad."""
        xp = namespace(u, v, self.ring_radius, self.tube_radius)
        r = self.ring_radius + self.tube_radius * xp.sin(v)
        return Vector(r * xp.cos(u), r * xp.sin(u), (self.sign * self.tube_radius) * xp.cos(v))

    def coordinates_of(self, p: Vector) -> tuple[Scalar, Scalar]:
        """Return the two angles, rad."""
        _, _, away, _ = self._from_ring(p)
        xp = namespace(*p, away.x)
        return xp.atan2(p.y, p.x), xp.atan2(away.x, self.sign * away.z)

    def directions(self, p: Vector) -> tuple[Vector, Vector]:
        """Return the tangent about the axis and the one around the tube, outwards from its line of rest."""
        e, _, away, _ = self._from_ring(p)
        return Vector(-e.y, e.x, 0.0), (e * away.z - E_Z * away.x) * self.sign
