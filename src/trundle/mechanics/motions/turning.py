"""Turns about one axis, from an angle and its rates: what most motions of a support are made of."""

from __future__ import annotations

from typing import Any

from ..algebra import E_Z, ZERO, Matrix, Vector
from ..scalars import Scalar, namespace
from .base import SupportState


def about_third_axis(angle: Scalar) -> Matrix:
    """Return the rotation about the third axis; a positive angle turns the first axis towards the second.

    Examples
    --------
    >>> about_third_axis(0.0) @ Vector(1.0, 2.0, 3.0)
    Vector(x=1.0, y=2.0, z=3.0)
    """
    xp = namespace(angle)
    c, s = xp.cos(angle), xp.sin(angle)
    return Matrix(Vector(c, -s, 0.0), Vector(s, c, 0.0), E_Z)


def about(axis: Vector, angle: Scalar) -> Matrix:
    """Return the rotation about a unit vector by an angle, right-handed: cos θ 1 + sin θ [e]× + (1 − cos θ) e eᵀ.

    Examples
    --------
    >>> about(Vector(0.0, 1.0, 0.0), 0.5) @ Vector(0.0, 1.0, 0.0)
    Vector(x=0.0, y=1.0, z=0.0)
    """
    xp = namespace(angle)
    c, s, half = xp.cos(angle), xp.sin(angle), xp.sin(0.5 * angle)
    x, y, z = axis
    crossed = Matrix(Vector(0.0, -z, y), Vector(z, 0.0, -x), Vector(-y, x, 0.0))
    return Matrix.diagonal(c, c, c) + crossed * s + Matrix.outer(axis, axis) * (2.0 * (half * half))


def turned_about(axis: Vector, course: tuple[Scalar, Scalar, Scalar]) -> SupportState:
    """Return the state of a support turned about an axis through the origin that does not move.

    Examples
    --------
    >>> turned_about(Vector(0.0, 1.0, 0.0), (0.0, 2.0, 3.0)).angular_acceleration
    Vector(x=0.0, y=3.0, z=0.0)
    """
    angle, rate, acceleration = course
    return SupportState(about(axis, angle), ZERO, ZERO, ZERO, axis * rate, axis * acceleration)


def swing(amplitude: Any, rate: Scalar, phase: Scalar, time: Scalar) -> tuple[Any, Any, Any]:
    """Return A sin(νt + φ), its first rate and its second.

    Examples
    --------
    >>> swing(2.0, 3.0, 0.0, 0.0)
    (0.0, 6.0, -0.0)
    """
    where = rate * time + phase
    xp = namespace(where)
    s, c = xp.sin(where), xp.cos(where)
    return amplitude * s, amplitude * (rate * c), amplitude * -(rate * rate * s)
