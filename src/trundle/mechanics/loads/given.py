"""Loads that do not ask how the body moves: gravity, and forces and torques given as numbers or in the time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any

from ... import wording
from ..algebra import Vector
from ..expressions import Expression, now
from ..parts import Number, Numbers, fields_of
from ..scalars import Scalar, is_zero
from .base import BodyMotion, Load


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
class Given(Load):
    """Three components that are numbers or formulas in the time t.

    Examples
    --------
    >>> Given((1.0, "2*t", 0.0)).at(3.0).y
    6.0
    """

    value: Annotated[Any, Numbers(Number("number", varies=True))]
    noun = "vector"

    def key_numbers(self) -> list[str]:
        """Return its size, or that it varies."""
        if any(isinstance(part, Expression) for part in self.value):
            return [f"{self.noun} that varies"]
        dimension = fields_of(type(self))["value"].each.dimension  # type: ignore[union-attr]
        return [f"{self.noun} {wording.with_unit(math.hypot(*map(float, self.value)), dimension)}"]

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
        return Vector(*(now(part, time) for part in self.value))


@dataclass(frozen=True)
class Force(Given):
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

    value: Annotated[
        Any, Numbers(Number("force", varies=True), "In the support frame, which does not turn with the support.")
    ]
    kind = "force"
    noun = "force"

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
class Torque(Given):
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

    value: Annotated[
        Any, Numbers(Number("torque", varies=True), "In the support frame, which does not turn with the support.")
    ]
    kind = "torque"
    noun = "torque"

    @property
    def leaves_spin(self) -> bool:
        """True where it has no third component."""
        return is_zero(self.value.z)

    def torque(self, motion: BodyMotion) -> Vector:
        """Return K."""
        return self.at(motion.time)
