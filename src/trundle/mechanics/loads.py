"""Loads on the body: force and torque about its centre of mass, in the inertial support frame.

A new load is one class with `force`, `torque` and, if it has one, `potential`; `tests/contracts` has the test to
inherit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from . import checks
from .algebra import ZERO, Quaternion, Vector
from .scalars import Scalar, is_zero


@dataclass(frozen=True, slots=True)
class BodyMotion:
    """What a load may depend on: the motion of the body at one instant, in the inertial support frame.

    Examples
    --------
    >>> still = BodyMotion(0.0, 0.065, ZERO, ZERO, Quaternion(1.0, 0.0, 0.0, 0.0), ZERO)
    >>> Drag(0.01).force(still)
    Vector(x=-0.0, y=-0.0, z=-0.0)
    """

    time: Scalar  # s
    mass: Scalar  # kg
    position: Vector  # of the centre of mass, m
    velocity: Vector  # of the centre of mass, m/s
    orientation: Quaternion
    angular_velocity: Vector  # rad/s


def at_rest(mass: Scalar) -> BodyMotion:
    """Return a body at rest at the origin, where a load that is constant can be read.

    Parameters
    ----------
    mass : Scalar
        kg.

    Returns
    -------
    BodyMotion
        At t = 0.

    Examples
    --------
    >>> Gravity(0.0, 0.0, -10.0).force(at_rest(2.0)).z
    -20.0
    """
    return BodyMotion(0.0, mass, ZERO, ZERO, Quaternion(1.0, 0.0, 0.0, 0.0), ZERO)


class Load:
    """A force and a torque on the body; by default neither, and no potential."""

    constant = False  # the same force and torque always and everywhere

    @property
    def linear_drag(self) -> Scalar | None:
        """C of a load that is purely −c V, kg/s; None for any other load."""
        return None

    def force(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        """Return the force on the centre of mass, N."""
        return ZERO

    def torque(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        """Return the torque about the centre of mass, N m."""
        return ZERO

    def potential(self, motion: BodyMotion) -> Scalar | None:  # noqa: ARG002
        """Return the potential energy, J; None for a load that has none."""
        return None

    @property
    def symmetric(self) -> bool:
        """Whether turning everything about the support's third axis leaves the load unchanged."""
        return False


@dataclass(frozen=True)
class Gravity(Load):
    """Uniform gravity.

    Parameters
    ----------
    x, y, z : float
        The acceleration of free fall in the support frame, m/s².

    Examples
    --------
    >>> Gravity(0.0, 0.0, -9.80665).symmetric
    True
    """

    x: Scalar
    y: Scalar
    z: Scalar
    constant = True

    @property
    def acceleration(self) -> Vector:
        """The acceleration of free fall, m/s²."""
        return Vector(self.x, self.y, self.z)

    def force(self, motion: BodyMotion) -> Vector:
        """Return m g."""
        return self.acceleration * motion.mass

    def potential(self, motion: BodyMotion) -> Scalar:
        """Return −m g·r."""
        return -(self.acceleration.dot(motion.position)) * motion.mass

    @property
    def symmetric(self) -> bool:
        """True where gravity points along the axis."""
        return is_zero(self.x) and is_zero(self.y)


def _store(load: Any, value: Any, kind: str) -> None:
    object.__setattr__(load, "value", Vector(*checks.components(value, kind, "value")))


@dataclass(frozen=True)
class Force(Load):
    """A constant force on the centre of mass.

    Parameters
    ----------
    value : sequence of 3 floats or quantities
        F in the inertial support frame, N.

    Examples
    --------
    >>> Force((0.1, 0.0, 0.0)).value.x
    0.1
    """

    value: Any
    constant = True

    def __post_init__(self) -> None:
        _store(self, self.value, "force")

    def force(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        """Return F."""
        return self.value

    def potential(self, motion: BodyMotion) -> Scalar:
        """Return −F·r."""
        return -(self.value.dot(motion.position))

    @property
    def symmetric(self) -> bool:
        """True where the force points along the axis."""
        return is_zero(self.value.x) and is_zero(self.value.y)


@dataclass(frozen=True)
class Torque(Load):
    """A constant torque about the centre of mass.

    Parameters
    ----------
    value : sequence of 3 floats or quantities
        K in the inertial support frame, N m; K along the second axis drives the ball along the first.

    Examples
    --------
    >>> Torque(("0 N*m", "2 mN*m", "0 N*m")).value.y
    0.002
    """

    value: Any
    constant = True

    def __post_init__(self) -> None:
        _store(self, self.value, "torque")

    def torque(self, motion: BodyMotion) -> Vector:  # noqa: ARG002
        """Return K."""
        return self.value

    @property
    def symmetric(self) -> bool:
        """True where the torque points along the axis."""
        return is_zero(self.value.x) and is_zero(self.value.y)


@dataclass(frozen=True)
class Drag(Load):
    """Linear drag −c V in still air, V the velocity of the centre of mass in the inertial support frame.

    Parameters
    ----------
    coefficient : float or quantity
        c, kg/s.

    Examples
    --------
    >>> Drag("0.01 kg/s").coefficient
    0.01
    """

    coefficient: Scalar

    def __post_init__(self) -> None:
        value = checks.non_negative(self.coefficient, "damping", "coefficient")
        object.__setattr__(self, "coefficient", value)

    @property
    def linear_drag(self) -> Scalar:
        """c, kg/s."""
        return self.coefficient

    def force(self, motion: BodyMotion) -> Vector:
        """Return −c V."""
        return motion.velocity * -self.coefficient

    @property
    def symmetric(self) -> bool:
        """True: still air looks the same from every side."""
        return True


def constant_part(loads: tuple[Load, ...], mass: Scalar) -> tuple[Vector, Vector, Scalar]:
    """Add up loads that are constant or linear drag.

    Parameters
    ----------
    loads : tuple of Load
        Each `constant`, or with a `linear_drag`.
    mass : Scalar
        Of the body, kg.

    Returns
    -------
    force, torque : Vector
        N and N m.
    drag : Scalar
        c, kg/s.

    Examples
    --------
    >>> constant_part((Gravity(0.0, 0.0, -10.0), Drag(0.01), Drag(0.02)), 2.0)[2]
    0.03
    """
    force, torque, drag = ZERO, ZERO, 0.0
    for load in loads:
        if load.linear_drag is not None:
            drag = drag + load.linear_drag
        else:
            force, torque = force + load.force(at_rest(mass)), torque + load.torque(at_rest(mass))
    return force, torque, drag
