"""What every surface is: level function, unit normal, shape operator and coordinates, in the support's own frame."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, ClassVar

from ...errors import InvalidValueError
from ..algebra import ZERO, Matrix, TangentialTensor, Vector
from ..jets import jets
from ..parts import Lengths, Number, Part
from ..scalars import Scalar, namespace

_UPRIGHT = 90  # degrees


class Surface(Part):
    """A smooth surface φ(p) = 0, with φ positive on the side of the body (theory page, section 2).

    A surface of one's own needs `level`, `point` and `axisymmetric`; the rest follows. Where its coordinates are not
    x and y of the point itself, it needs `coordinates_of` and `directions`, too. Formulas that are cheaper or better
    conditioned than the general ones may replace them.

    Examples
    --------
    >>> class Saddle(Surface):
    ...     axisymmetric = False
    ...
    ...     def level(self, p):
    ...         return p.z - p.x * p.y
    ...
    ...     def point(self, u, v):
    ...         return Vector(u, v, u * v)
    >>> Saddle().normal(Vector(0.0, 0.0, 0.0)).z, Saddle().shape_operator(Vector(0.0, 0.0, 0.0)).a.y
    (1.0, -1.0)
    """

    rim: Scalar | None = None  # distance of the edge from the axis, m
    flat = False  # a plane: one normal everywhere
    wall_radius: Scalar | None = None  # of a cylinder, which one sees along its axis, m
    analytic = True  # a formula: heyoka and SymPy can trace it; a table is evaluated on floats and arrays only
    domain_end = "the end of the surface"  # what the body comes to where `domain_margin` falls to 0
    coordinates: tuple[str, str] = ("length", "length")  # kinds of quantity, as in `trundle.units`
    coordinate_labels: tuple[str, str] = ("Position x", "Position y")  # at their controls
    tilt: ClassVar[Number] = Number("angle", said="Angle of the axis to the vertical; down the first axis.")
    points: ClassVar[Mapping[str, Lengths]] = MappingProxyType({})  # what `through` takes, where there is one

    where: str = "on"  # the preposition that goes with it
    noun: str = "surface"  # what figures call it, and, in one word, what is rolled on
    ground: str = "surface"

    def key_numbers(self) -> list[str]:
        """Return what figures say of its size.

        Returns
        -------
        list of str
            Such as ``["bowl of radius 30 cm"]``.
        """
        return []

    @property
    def outline(self) -> tuple[Scalar, ...]:
        """Distances from the axis at which it is seen to end from above, the outermost first, m."""
        return () if self.rim is None else (self.rim,)

    @property
    def free_radius(self) -> Scalar | None:
        """Radius of the largest ball that may touch it anywhere and lies below it nowhere, m; None: not known.

        Infinite where the body's side is outside something convex. Inside something convex it is the least radius of
        curvature, by Blaschke's rolling theorem.
        """
        return None

    @property
    def recordable(self) -> bool:
        """Whether a tape can record it: a formula, or splines through tables."""
        return self.analytic

    @property
    def axisymmetric(self) -> bool:
        """Whether a turn about the third axis leaves the surface as it is."""
        raise NotImplementedError

    def level(self, p: Vector) -> Scalar:
        """Return φ(p), m.

        Parameters
        ----------
        p : Vector
            A point, in the support's own frame, m.

        Returns
        -------
        Scalar
            Positive on the side of the body, zero on the surface; any scalar, jets included.
        """
        raise NotImplementedError

    def step_onto(self, p: Vector) -> Vector:
        """Return the step from p to φ = 0 along ∇φ, one of Newton's method, m.

        Parameters
        ----------
        p : Vector
            A point, in the support's own frame, m.

        Returns
        -------
        Vector
            To be added to p.
        """
        level = self.level(Vector(*jets(tuple(p))))
        slope = Vector(*level.gradient)
        return slope * -(level.value / slope.dot(slope))

    def correction(self, p: Vector) -> Vector:  # noqa: ARG002
        """Return the step onto the surface of a point that rounding has moved off it, to its square, m.

        A law asks for normal and shape operator there. As a rule it may ask at p itself: there they are those of the
        surface φ = const through p, on which a motion is as regular. A step is needed where `known_lengths` names a
        length, and pays where a body may be all but as large as what it is in.

        Parameters
        ----------
        p : Vector
            A point, in the support's own frame, m.

        Returns
        -------
        Vector
            To be added to p.
        """
        return ZERO

    def known_lengths(self, p: Vector) -> tuple[tuple[Scalar, Scalar], ...]:  # noqa: ARG002
        """Return lengths that other methods work out of a point, each with what it is on the surface itself.

        A law whose contact stays there need not work them out.

        Parameters
        ----------
        p : Vector
            A point, in the support's own frame, m.

        Returns
        -------
        tuple of pairs of Scalar
            The length as it is worked out for any point, and on the surface, m.
        """
        return ()

    def normal(self, p: Vector) -> Vector:
        """Return n = ∇φ/|∇φ|, from the support into the body.

        Parameters
        ----------
        p : Vector
            A point, in the support's own frame, m.

        Returns
        -------
        Vector
            Unit normal, own frame.
        """
        slope = Vector(*self.level(Vector(*jets(tuple(p)))).gradient)
        return slope / slope.norm()

    def shape_operator(self, p: Vector) -> Matrix:
        """Return S with dn = S dp along the surface, 1/m: outside a sphere of radius b it is +1/b.

        Parameters
        ----------
        p : Vector
            A point, in the support's own frame, m.

        Returns
        -------
        Matrix
            Symmetric, own frame, with S n = 0.
        """
        level = self.level(Vector(*jets(tuple(p))))
        slope, (xx, xy, xz, yy, yz, zz) = Vector(*level.gradient), level.hessian
        bend = Matrix(Vector(xx, xy, xz), Vector(xy, yy, yz), Vector(xz, yz, zz))
        length = slope.norm()
        return tangential(bend, slope / length) * (1.0 / length)

    def domain_margin(self, p: Vector) -> Scalar | None:  # noqa: ARG002  most have no end
        """Return a number that falls through 0 where the surface ends or has a singular point; None where neither.

        Parameters
        ----------
        p : Vector
            A point, in the support's own frame, m.

        Returns
        -------
        Scalar or None
            Positive inside; its size does not matter.
        """
        return None

    def point(self, u: Scalar, v: Scalar) -> Vector:
        """Return the point of the surface with given coordinates, m.

        Parameters
        ----------
        u, v : Scalar
            Of the kinds in `coordinates`.

        Returns
        -------
        Vector
            In the support's own frame.
        """
        raise NotImplementedError

    def coordinates_of(self, p: Vector) -> tuple[Scalar, Scalar]:
        """Return the coordinates of a point of the surface: x and y, unless it has others.

        Parameters
        ----------
        p : Vector
            A point, in the support's own frame, m.

        Returns
        -------
        tuple of 2 Scalar
            Of the kinds in `coordinates`.
        """
        return p.x, p.y

    def directions(self, p: Vector) -> tuple[Vector, Vector]:
        """Return two unit tangents at right angles: on the first x grows and y stays, on the second y grows.

        Parameters
        ----------
        p : Vector
            A point, in the support's own frame, m.

        Returns
        -------
        tuple of 2 Vector
            Own frame: along them a start's velocity is given.
        """
        n = self.normal(p)
        length = namespace(*n).sqrt(n.x * n.x + n.z * n.z)
        first = Vector(n.z / length, 0.0, -(n.x / length))
        return first, n.cross(first)

    def contact_from_coordinates(self, u: Scalar, v: Scalar, offset: Vector) -> Vector:  # noqa: ARG002
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

    def coordinates_from_contact(self, p: Vector, offset: Vector) -> tuple[Scalar, Scalar]:  # noqa: ARG002
        """Return the coordinates at which a body is put down that touches at p: what `contact_from_coordinates` undoes.

        Parameters
        ----------
        p : Vector
            The contact, m.
        offset : Vector
            ρ, from the centre of mass to the contact, m.

        Returns
        -------
        u, v : Scalar
            Of the kinds in `coordinates`.
        """
        return self.coordinates_of(p)

    def check_tilt(self, tilt: float, received: Any) -> None:
        """Refuse a tilt at which this surface is not what its name says."""
        if not abs(tilt) <= math.pi:
            remedy = _degrees(received, "90 deg lays the axis level.")
            raise InvalidValueError("tilt", "must lie in [-180 deg, 180 deg]", received, remedy)


def tangential(bend: Matrix, n: Vector) -> TangentialTensor:
    """Return P H P with P = 1 − n nᵀ, what is left of a symmetric H along a surface.

    Examples
    --------
    >>> tangential(Matrix.identity(), Vector(0.0, 0.0, 1.0)).c.z
    0.0
    """
    return TangentialTensor.of(bend, n)


def check_upright(tilt: float, received: Any) -> None:
    """Refuse a surface that stands upright or hangs over.

    Examples
    --------
    >>> check_upright(1.6, "1.6 rad")
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `tilt` must lie in (-90 deg, 90 deg); got '1.6 rad'. Did you mean "1.6 deg"?
    """
    if not abs(tilt) < math.pi / 2:
        remedy = _degrees(received, "At 90 deg it is a wall.")
        raise InvalidValueError("tilt", "must lie in (-90 deg, 90 deg)", received, remedy)


def _degrees(received: Any, otherwise: str) -> str:
    """Return what was meant, where somebody wrote degrees without their unit."""
    try:
        bare = float(str(received).removesuffix("rad"))
    except ValueError:
        return otherwise
    return f'Did you mean "{bare:g} deg"?' if abs(bare) < _UPRIGHT else otherwise
