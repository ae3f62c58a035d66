"""Spheres, cylinders that roll straight as one would, and half of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ...errors import InvalidValueError
from ..algebra import E_Z, Matrix, RoundTensor, Vector
from ..scalars import Scalar, is_number
from .base import CENTRE, RADIUS, Shape, moved, on_third_axis


@dataclass(frozen=True)
class Sphere(Shape):
    """A sphere; its centre may sit away from the centre of mass.

    Parameters
    ----------
    radius : float
        a, m.
    centre : Vector, optional
        c, the sphere's centre from the centre of mass in the body frame, m; absent: the two coincide.

    Examples
    --------
    >>> Sphere(0.025).support_map(Vector(0.0, 0.0, -1.0))
    Vector(x=0.0, y=0.0, z=-0.025)
    """

    noun = "ball"
    spherical = True
    radius: Annotated[Scalar, RADIUS]
    centre: Annotated[Any, CENTRE] = None  # a Vector or None once it is made

    @property
    def largest_radius(self) -> Scalar:
        """Its radius."""
        return self.radius

    @property
    def axisymmetric(self) -> bool:
        """Whether its centre lies on the third axis."""
        return on_third_axis(self.centre)

    def support_map(self, nu: Vector) -> Vector:
        """Return X = c + a ν."""
        return moved(self.centre, self.radius * nu)

    def support_gradient(self, nu: Vector) -> Matrix:
        """Return a(1 − ν νᵀ)."""
        return RoundTensor.of(self.radius, nu)

    def contact(self, Q: Matrix, n: Vector) -> tuple[Vector, Matrix]:
        """Return ρ = Q c − a n and C = a(1 − n nᵀ): a sphere looks the same from every side, so Q Qᵀ drops out."""
        rho = self.radius * -n
        return rho if self.centre is None else Q @ self.centre + rho, self.support_gradient(n)


@dataclass(frozen=True)
class Hemisphere(Sphere):
    """Half a sphere, which rocks on its round side; the outward normal of its flat face is the third axis.

    It is a sphere as long as it touches on the round side. The motion on its edge, and on the flat face, is not in the
    shape: a run ends where `validity_margin` falls to zero.

    Parameters
    ----------
    radius, centre : see Sphere
        Of the round side; of a solid one, the centre lies (3/8) a from the centre of mass, along the third axis.

    Examples
    --------
    >>> Hemisphere(0.1, Vector(0.0, 0.0, 0.0375)).validity_margin(Vector(0.0, 0.0, -1.0))
    1.0
    """

    noun = "half-ball"

    def validity_margin(self, nu: Vector) -> Scalar:
        """Return −ν_z: positive on the round side, zero at the edge."""
        return -nu.z


@dataclass(frozen=True)
class CylinderShape(Sphere):
    """A cylinder or hoop that rolls straight, on its round side; its axis is the third of the body frame.

    It touches along a line, which keeps it upright, and moves as a sphere of the same radius would in the plane across
    that line; so it is one to the rolling law (theory page, section 2). What would turn it out of its line is refused.

    Parameters
    ----------
    radius, centre : see Sphere
        The centre of mass may sit off the axis: c then lies across the third axis.

    Examples
    --------
    >>> CylinderShape(0.05).axis
    Vector(x=0.0, y=0.0, z=1.0)
    """

    noun = "cylinder"
    axis = E_Z

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.centre is not None and is_number(self.centre.z) and self.centre.z != 0:
            raise InvalidValueError(
                "centre", "must lie across the cylinder's axis", tuple(self.centre), "Let its third component be 0."
            )


@dataclass(frozen=True)
class HalfCylinder(CylinderShape):
    """Half a cylinder, which rocks on its round side; the outward normal of its flat face is the first axis.

    Parameters
    ----------
    radius, centre : see CylinderShape
        Of the round side; of a solid one, the centre lies 4a/(3π) from the centre of mass, along the first axis.

    Examples
    --------
    >>> HalfCylinder(0.1, Vector(0.04244, 0.0, 0.0)).validity_margin(Vector(-1.0, 0.0, 0.0))
    1.0
    """

    noun = "half-cylinder"

    def validity_margin(self, nu: Vector) -> Scalar:
        """Return −ν_x: positive on the round side, zero at the edge."""
        return -nu.x


def concentric_sphere(shape: Any) -> bool:
    """Tell whether a shape is a sphere about the centre of mass.

    Examples
    --------
    >>> concentric_sphere(Sphere(1.0))
    True
    """
    return isinstance(shape, Sphere) and shape.centre is None
