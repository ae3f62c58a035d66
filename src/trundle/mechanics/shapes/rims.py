"""Discs and rings on their rim, sharp or rounded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

from ... import wording
from ..algebra import Matrix, Vector
from ..parts import NOT_NEGATIVE, Number
from ..scalars import Scalar
from .base import CENTRE, RADIUS, Shape, moved, on_third_axis

FLAT = 1e-6  # rad; a disc this near to lying flat touches on its face, which is no longer a contact at one point


class _Rim(Shape):
    """What disc and torus have in common: the circle of radius a across the third axis."""

    validity_end: ClassVar[str] = "came to lie flat on its face"
    radius: Scalar
    centre: Vector | None

    @property
    def axisymmetric(self) -> bool:
        """Whether its centre lies on the third axis."""
        return on_third_axis(self.centre)

    def validity_margin(self, nu: Vector) -> Scalar:
        """Return |ν_t|² less that of a disc within 1e-6 rad of lying flat; ν_t is the part of ν in its plane."""
        return nu.x * nu.x + nu.y * nu.y - FLAT * FLAT

    def support_map(self, nu: Vector) -> Vector:
        """Return X = c + a ν_t/|ν_t|."""
        flat = Vector(nu.x, nu.y, 0.0)
        return moved(self.centre, flat * (self.radius / flat.norm()))

    def support_gradient(self, nu: Vector) -> Matrix:
        """Return (a/|ν_t|) t tᵀ with t along the rim: of the two radii of curvature, that across the rim is zero."""
        length = Vector(nu.x, nu.y, 0.0).norm()
        along = Vector(-nu.y, nu.x, 0.0) / length
        return Matrix.outer(along, along) * (self.radius / length)


@dataclass(frozen=True)
class Disc(_Rim):
    """A thin disc or hoop on its sharp rim; its axis is the third of the body frame.

    It touches at one point of the rim while it is upright or leans. Lying flat it touches on its face, which is not in
    the shape: a run ends where `validity_margin` falls to zero.

    Parameters
    ----------
    radius : float
        a, m.
    centre : Vector, optional
        The disc's centre from the centre of mass in the body frame, m; absent: the two coincide.

    Examples
    --------
    >>> Disc(0.3).support_map(Vector(0.6, 0.0, -0.8))
    Vector(x=0.3, y=0.0, z=0.0)
    """

    noun = "disc"
    radius: Annotated[Scalar, RADIUS]
    centre: Annotated[Any, CENTRE] = None  # a Vector or None once it is made

    def noun_of(self, body: Any) -> str:
        """Return "ring" where the mass lies near the rim."""
        third = getattr(body.inertia, "z", 0.0)
        return "ring" if third > 0.8 * body.mass * self.radius**2 else self.noun


@dataclass(frozen=True)
class Torus(_Rim):
    """A ring or disc with a rounded rim; its axis is the third of the body frame.

    The rim is the circle of radius a, rounded with radius e, so that the whole is a + e in radius and 2e thick. As
    `Disc`, it touches on the rim only.

    Parameters
    ----------
    radius : float
        a, of the circle that the rim is rounded about, m.
    rim_radius : float
        e, of the rounding, m; 0 leaves a sharp rim.
    centre : Vector, optional
        See Disc.

    Examples
    --------
    >>> Torus(0.3, rim_radius=0.05).support_map(Vector(1.0, 0.0, 0.0)).x
    0.35
    """

    noun = "ring"
    radius: Annotated[Scalar, RADIUS]
    rim_radius: Annotated[Scalar, Number("length", NOT_NEGATIVE)]
    centre: Annotated[Any, CENTRE] = None  # a Vector or None once it is made

    @property
    def reach(self) -> Scalar:
        """Out to the edge of the rim."""
        return self.radius + self.rim_radius

    def key_numbers(self) -> list[str]:
        """Return both radii."""
        radii = (wording.small_length(radius) for radius in (self.radius, self.rim_radius))
        return ["radius {}, rim {}".format(*radii)]

    def support_map(self, nu: Vector) -> Vector:
        """Return X = c + a ν_t/|ν_t| + e ν."""
        return super().support_map(nu) + nu * self.rim_radius

    def support_gradient(self, nu: Vector) -> Matrix:
        """Return (a/|ν_t|) t tᵀ + e(1 − ν νᵀ)."""
        return super().support_gradient(nu) + (Matrix.identity() - Matrix.outer(nu, nu)) * self.rim_radius
