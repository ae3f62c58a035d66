"""What the air does."""

from __future__ import annotations

from dataclasses import dataclass

from .. import checks
from ..algebra import E_Z, Vector
from ..scalars import Scalar, is_zero
from .base import BodyMotion, Load


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
