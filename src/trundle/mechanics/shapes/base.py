"""What every shape is: support map and inverse curvature, all that contact needs to know of a convex body."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any, ClassVar

from ... import wording
from ..algebra import Matrix, RotatedTensor, Vector
from ..parts import POSITIVE, Number, Numbers, Part
from ..scalars import Scalar, is_zero


class Shape(Part):
    """A convex body's surface, known by the point where its outward normal is ν (theory page, section 2)."""

    noun: ClassVar[str] = "body"  # in titles and lists
    spherical: ClassVar[bool] = False  # a sphere where it touches
    axis: ClassVar[Vector | None] = None  # body frame; touching along a line, it rolls straight across
    validity_end: ClassVar[str] = (
        "tipped onto the edge of its round side"  # what a body did that left what the shape covers
    )

    def support_map(self, nu: Vector) -> Vector:
        """Return X(ν), the body-frame point with outward unit normal ν, in m from the centre of mass.

        Parameters
        ----------
        nu : Vector
            Outward unit normal ν, body frame.

        Returns
        -------
        Vector
            Body frame.
        """
        raise NotImplementedError

    def support_gradient(self, nu: Vector) -> Matrix:
        """Return ∂X/∂ν on the tangent plane of ν, in m: symmetric, its eigenvalues the radii of curvature.

        Parameters
        ----------
        nu : Vector
            Outward unit normal ν, body frame.

        Returns
        -------
        Matrix
            Body frame, zero along ν.
        """
        raise NotImplementedError

    def validity_margin(self, nu: Vector) -> Scalar | None:  # noqa: ARG002
        """Return what is positive where the formulas hold, as on the round side of a hemisphere; None: everywhere.

        Parameters
        ----------
        nu : Vector
            Outward unit normal ν, body frame.

        Returns
        -------
        Scalar or None
            Where it falls to zero, a run ends.
        """
        return None

    def noun_of(self, body: Any) -> str:  # noqa: ARG002  what a rim carries shows in the inertia only
        """Return how titles name a body of this shape.

        Parameters
        ----------
        body : Body
            Of this shape.

        Returns
        -------
        str
            Such as "disc" or "ring".
        """
        return self.noun

    def key_numbers(self) -> list[str]:
        """Return what figures say of its size.

        Returns
        -------
        list of str
            Such as ``["radius 25 mm"]``.
        """
        return [f"radius {wording.small_length(self.radius)}"] if hasattr(self, "radius") else []

    @property
    def reach(self) -> Scalar | None:
        """Half its largest width, m; None where only its support map tells."""
        return getattr(self, "radius", None)

    @property
    def largest_radius(self) -> Scalar | None:
        """Largest radius of curvature, m: a ball of it through any contact holds the body; None: not known."""
        return None

    def parameters(self) -> dict[str, Any]:
        """Return the numbers of the shape by the names that builders of bodies give them; the fields of a dataclass.

        Returns
        -------
        dict of str to number, Vector or Expression
            SI, body frame.
        """
        return {each.name: getattr(self, each.name) for each in fields(self)} if is_dataclass(self) else {}

    @property
    def axisymmetric(self) -> bool:
        """Whether the surface looks the same after any turn about the body's third axis."""
        return False

    def contact(self, Q: Matrix, n: Vector) -> tuple[Vector, Matrix | RotatedTensor]:
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
        C : Matrix or Turned
            Inverse curvature at the contact, support frame, m.
        """
        nu = -(n @ Q)
        return Q @ self.support_map(nu), RotatedTensor(Q, self.support_gradient(nu))


RADIUS = Number("length", POSITIVE)
CENTRE = Numbers(Number("length"), "From the centre of mass, body frame.")


def moved(centre: Vector | None, point: Vector) -> Vector:
    """Return a point of a shape from the centre of mass, given from the shape's own centre."""
    return point if centre is None else centre + point


def on_third_axis(centre: Vector | None) -> bool:
    """Tell whether a shape's own centre is known to lie on the body's third axis."""
    return centre is None or (is_zero(centre.x) and is_zero(centre.y))
