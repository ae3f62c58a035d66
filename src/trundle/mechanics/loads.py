"""Loads on the body: force and torque about its centre of mass, in the inertial support frame.

A new load is one class with `force`, `torque` and, if it has one, `potential`; `tests/contracts` has the test to
inherit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from . import checks
from .algebra import E_Z, ZERO, Quaternion, Vector
from .expressions import Expression, is_formula
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

    constant: bool = False  # the same force and torque always and everywhere

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

    @property
    def leaves_spin(self) -> bool:
        """Whether the load never has a torque along the support's third axis."""
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

    @property
    def leaves_spin(self) -> bool:
        """True: it acts at the centre of mass."""
        return True


@dataclass(frozen=True)
class _Given(Load):
    """Three components that are numbers or formulas in the time t, in the inertial support frame."""

    value: Any
    _kind = "number"

    def __post_init__(self) -> None:
        parts = self.value
        formulas = isinstance(parts, (list, tuple)) and any(map(_is_formula, parts))
        plain = tuple(0.0 if _is_formula(part) else part for part in parts) if formulas else parts
        components = checks.components(plain, self._kind, "value")
        if formulas:
            pairs = zip(parts, components, strict=True)
            components = tuple(
                _formula(part, f"value[{i}]") if _is_formula(part) else number for i, (part, number) in enumerate(pairs)
            )
        object.__setattr__(self, "value", Vector(*components))

    @property
    def constant(self) -> bool:  # type: ignore[override]
        """Whether no component is a formula."""
        return not any(isinstance(part, Expression) for part in self.value)

    @property
    def symmetric(self) -> bool:
        """True where it points along the axis."""
        return is_zero(self.value.x) and is_zero(self.value.y)

    def at(self, time: Scalar) -> Vector:
        """Return the components at a time in s."""
        return Vector(*(part.at(t=time) if isinstance(part, Expression) else part for part in self.value))


def _is_formula(part: Any) -> bool:
    return isinstance(part, Expression) or is_formula(part)


def _formula(part: Any, key: str) -> Expression:
    return part if isinstance(part, Expression) else Expression.parse(part, ("t",), key)


@dataclass(frozen=True)
class Force(_Given):
    """A force on the centre of mass, constant or given as formulas in the time.

    Parameters
    ----------
    value : sequence of 3 floats, quantities or formulas
        F in the inertial support frame, N; a formula such as ``"0.1*sin(3*t)"`` is in SI, t in s.

    Examples
    --------
    >>> Force((0.1, 0.0, 0.0)).value.x
    0.1
    >>> Force(("0.1*t", 0.0, 0.0)).at(2.0).x
    0.2
    """

    _kind = "force"

    @property
    def leaves_spin(self) -> bool:
        """True: it acts at the centre of mass."""
        return True

    def force(self, motion: BodyMotion) -> Vector:
        """Return F."""
        return self.at(motion.time)

    def potential(self, motion: BodyMotion) -> Scalar | None:
        """Return −F·r of a constant force."""
        return -(self.value.dot(motion.position)) if self.constant else None


@dataclass(frozen=True)
class Torque(_Given):
    """A torque about the centre of mass, constant or given as formulas in the time.

    Parameters
    ----------
    value : sequence of 3 floats, quantities or formulas
        K in the inertial support frame, N m; K along the second axis drives the ball along the first.

    Examples
    --------
    >>> Torque(("0 N*m", "2 mN*m", "0 N*m")).value.y
    0.002
    """

    _kind = "torque"

    @property
    def leaves_spin(self) -> bool:
        """True where it has no third component."""
        return is_zero(self.value.z)

    def torque(self, motion: BodyMotion) -> Vector:
        """Return K."""
        return self.at(motion.time)


@dataclass(frozen=True)
class Drag(Load):
    """Linear drag −c(V − ω_a×r) in air that is still or turns about the support's third axis.

    Parameters
    ----------
    coefficient : float or quantity
        c, kg/s.
    air_rate : float or quantity
        ω_a, at which the air turns, rad/s; the support's own rate for air that it carries along.

    Examples
    --------
    >>> Drag("0.01 kg/s").coefficient
    0.01
    """

    coefficient: Scalar
    air_rate: Scalar = 0.0

    def __post_init__(self) -> None:
        value = checks.non_negative(self.coefficient, "damping", "coefficient")
        object.__setattr__(self, "coefficient", value)
        object.__setattr__(self, "air_rate", checks.real(self.air_rate, "angular velocity", "air_rate"))

    @property
    def linear_drag(self) -> Scalar | None:
        """C in still air, kg/s."""
        return self.coefficient if is_zero(self.air_rate) else None

    def force(self, motion: BodyMotion) -> Vector:
        """Return −c(V − ω_a×r)."""
        if is_zero(self.air_rate):
            return motion.velocity * -self.coefficient
        air = (E_Z * self.air_rate).cross(motion.position)
        return (motion.velocity - air) * -self.coefficient

    @property
    def symmetric(self) -> bool:
        """True: the air looks the same from every side of the axis."""
        return True

    @property
    def leaves_spin(self) -> bool:
        """True: it acts at the centre of mass."""
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
