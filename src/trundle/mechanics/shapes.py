"""Shapes of bodies: support map and inverse curvature, all that contact needs to know of a convex body.

A new shape is one class with `support_map` and `support_gradient`; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from . import checks
from .algebra import Matrix, Vector
from .scalars import Scalar


class Shape:
    """A convex body's surface, known by the point where its outward normal is ν (theory page, section 2)."""

    def support_map(self, nu: Vector) -> Vector:
        """Return X(ν), the body-frame point with outward unit normal ν, in m from the centre of mass."""
        raise NotImplementedError

    def support_gradient(self, nu: Vector) -> Matrix:
        """Return ∂X/∂ν on the tangent plane of ν, in m: symmetric, its eigenvalues the radii of curvature."""
        raise NotImplementedError

    def contact(self, Q: Matrix, n: Vector) -> tuple[Vector, Matrix]:
        """Return ρ = Q X(−Qᵀn) and C = Q (∂X/∂ν) Qᵀ for a support with unit normal n into the body.

        Parameters
        ----------
        Q : Matrix
            Body frame to support frame.
        n : Vector
            Unit normal of the support at the contact, from the support into the body.

        Returns
        -------
        rho : Vector
            From the centre of mass to the contact point, support frame, m.
        C : Matrix
            Inverse curvature at the contact, support frame, m.
        """
        nu = -(Q.transpose @ n)
        return Q @ self.support_map(nu), Q @ self.support_gradient(nu) @ Q.transpose


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

    radius: Scalar
    centre: Vector | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", checks.positive(self.radius, "length", "radius"))

    def support_map(self, nu: Vector) -> Vector:
        """Return X = c + a ν."""
        return self.radius * nu if self.centre is None else self.centre + self.radius * nu

    def support_gradient(self, nu: Vector) -> Matrix:
        """Return a(1 − ν νᵀ)."""
        return self.radius * (Matrix.identity() - Matrix.outer(nu, nu))

    def contact(self, Q: Matrix, n: Vector) -> tuple[Vector, Matrix]:
        """Return ρ = Q c − a n and C = a(1 − n nᵀ): a sphere looks the same from every side, so Q Qᵀ drops out."""
        rho = self.radius * -n
        return rho if self.centre is None else Q @ self.centre + rho, self.support_gradient(n)


def concentric_sphere(shape: Any) -> bool:
    """Tell whether a shape is a sphere about the centre of mass.

    Parameters
    ----------
    shape : Shape
        Any shape.

    Returns
    -------
    bool
        True where X(ν) = a ν.

    Examples
    --------
    >>> concentric_sphere(Sphere(1.0))
    True
    """
    return isinstance(shape, Sphere) and shape.centre is None
