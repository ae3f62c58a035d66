"""Surfaces of supports, in the support's own frame: level function, unit normal and shape operator.

A new surface is one class with these three; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

from dataclasses import dataclass

from . import checks
from .algebra import E_Z, Matrix, Vector
from .scalars import Scalar


class Surface:
    """A smooth surface φ(p) = 0, with φ positive on the side of the body (theory page, section 2)."""

    rim: Scalar | None
    axisymmetric: bool

    def level(self, p: Vector) -> Scalar:
        """Return φ(p), m."""
        raise NotImplementedError

    def normal(self, p: Vector) -> Vector:
        """Return n = ∇φ/|∇φ|, from the support into the body."""
        raise NotImplementedError

    def shape_operator(self, p: Vector) -> Matrix:
        """Return S with dn = S dp along the surface, 1/m: outside a sphere of radius b it is +1/b."""
        raise NotImplementedError


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
