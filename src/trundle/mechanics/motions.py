"""Motions of the support: where it is, how it turns, and the accelerations that the rolling law needs.

A new motion is one class with `at`; `tests/contracts` has the test to inherit.
"""

from __future__ import annotations

from dataclasses import dataclass

from . import checks
from .algebra import E_Z, ZERO, Matrix, Vector
from .scalars import Scalar, namespace


@dataclass(frozen=True, slots=True)
class SupportState:
    """Pose, twist and acceleration of the support at one instant, in the inertial support frame.

    Examples
    --------
    >>> Spin(2.0).at(0.0).material_velocity(Vector(0.5, 0.0, 0.0))
    Vector(x=0.0, y=1.0, z=0.0)
    """

    rotation: Matrix  # support's own frame to the inertial frame
    origin: Vector  # X, m
    velocity: Vector  # of X, m/s
    acceleration: Vector  # of X, m/s²
    angular_velocity: Vector  # ω, rad/s
    angular_acceleration: Vector  # rad/s²

    def material_velocity(self, p: Vector) -> Vector:
        """Return u(p) = Ẋ + ω×(p − X), the velocity of the support's material at p, m/s."""
        return self.velocity + self.angular_velocity.cross(p - self.origin)

    def material_acceleration(self, p: Vector, p_rate: Vector) -> Vector:
        """Return u̇ = Ẍ + ω̇×(p − X) + ω×(ṗ − Ẋ), the rate of u along a moving contact point, m/s²."""
        return (
            self.acceleration
            + self.angular_acceleration.cross(p - self.origin)
            + self.angular_velocity.cross(p_rate - self.velocity)
        )


class Motion:
    """How a support moves, as a function of time."""

    def at(self, time: Scalar) -> SupportState:
        """Return pose, twist and acceleration at a time in s."""
        raise NotImplementedError

    @property
    def steady_rate(self) -> Scalar | None:
        """ω of a steady turn about the support's third axis, rad/s; None for any other motion."""
        return None


@dataclass(frozen=True)
class Fixed(Motion):
    """A support at rest.

    Examples
    --------
    >>> Fixed().at(1.0).angular_velocity
    Vector(x=0.0, y=0.0, z=0.0)
    """

    def at(self, time: Scalar) -> SupportState:  # noqa: ARG002  the same always
        """Return rest at the origin."""
        return SupportState(Matrix.identity(), ZERO, ZERO, ZERO, ZERO, ZERO)

    @property
    def steady_rate(self) -> Scalar:
        """0: at rest."""
        return 0.0


@dataclass(frozen=True)
class Spin(Motion):
    """A steady turn about the support's third axis; positive turns the first axis towards the second.

    Parameters
    ----------
    rate : float or quantity
        ω, rad/s.

    Examples
    --------
    >>> round(Spin("33.3 rpm").rate, 4)
    3.4872
    """

    rate: Scalar

    def __post_init__(self) -> None:
        object.__setattr__(self, "rate", checks.real(self.rate, "angular velocity", "rate"))

    @property
    def steady_rate(self) -> Scalar:
        """ω, rad/s."""
        return self.rate

    def at(self, time: Scalar) -> SupportState:
        """Return the support turned by ωt."""
        xp = namespace(self.rate, time)
        c, s = xp.cos(self.rate * time), xp.sin(self.rate * time)
        rotation = Matrix(Vector(c, -s, 0.0), Vector(s, c, 0.0), E_Z)
        return SupportState(rotation, ZERO, ZERO, ZERO, E_Z * self.rate, ZERO)
