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

    def carried(self, own: Vector) -> Vector:
        """Return where the point of the support with given own coordinates is, m."""
        return self.origin + self.rotation @ own

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

    @property
    def mean_rate(self) -> Scalar:
        """The rate at which the support turns about its third axis on the whole, rad/s."""
        return 0.0 if self.steady_rate is None else self.steady_rate

    @property
    def fastest_rate(self) -> Scalar:
        """The fastest rate in the motion, rad/s: what a look at it must resolve."""
        return abs(self.mean_rate)


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


@dataclass(frozen=True)
class UnevenSpin(Motion):
    """A turn about the support's third axis whose rate varies a little: ω(t) = ω₀(1 + ε sin νt).

    Parameters
    ----------
    rate : float or quantity
        ω₀, rad/s.
    variation : float
        ε, as a share of ω₀.
    variation_rate : float or quantity
        ν, rad/s; a belt or a gear gives one period a turn, ν = ω₀.

    Examples
    --------
    >>> UnevenSpin(3.5, 0.01, 3.5).at(0.0).angular_velocity.z
    3.5
    """

    rate: Scalar
    variation: Scalar
    variation_rate: Scalar

    def __post_init__(self) -> None:
        object.__setattr__(self, "rate", checks.real(self.rate, "angular velocity", "rate"))
        object.__setattr__(self, "variation", checks.real(self.variation, "number", "variation"))
        rate = checks.positive(self.variation_rate, "angular velocity", "variation_rate")
        object.__setattr__(self, "variation_rate", rate)

    @property
    def fastest_rate(self) -> Scalar:
        """The faster of the turn and its variation."""
        return abs(self.rate) * (1 + abs(self.variation)) + abs(self.variation_rate)

    @property
    def mean_rate(self) -> Scalar:
        """ω₀, rad/s."""
        return self.rate

    def at(self, time: Scalar) -> SupportState:
        """Return the support turned by ω₀(t + ε(1 − cos νt)/ν)."""
        phase = self.variation_rate * time
        xp = namespace(self.rate, self.variation, phase)
        sine, half = xp.sin(phase), xp.sin(0.5 * phase)
        angle = self.rate * (time + self.variation * (2 * half * half) / self.variation_rate)
        c, s = xp.cos(angle), xp.sin(angle)
        rotation = Matrix(Vector(c, -s, 0.0), Vector(s, c, 0.0), E_Z)
        omega = E_Z * (self.rate * (1 + self.variation * sine))
        omega_rate = E_Z * (self.rate * self.variation * self.variation_rate * xp.cos(phase))
        return SupportState(rotation, ZERO, ZERO, ZERO, omega, omega_rate)


@dataclass(frozen=True)
class Wobble(Motion):
    """A steady turn about the support's third axis of a support that sits askew on its axle.

    The axle does not move; the support's own axis leans from it, at t = 0 away from the second axis, and goes round
    with it.

    Parameters
    ----------
    rate : float or quantity
        ω about the axle, rad/s.
    angle : float or quantity
        ε between the axle and the support's own axis, rad.

    Examples
    --------
    >>> Wobble(3.5, "0.1 deg").at(0.0).angular_velocity
    Vector(x=0.0, y=0.0, z=3.5)
    """

    rate: Scalar
    angle: Scalar

    def __post_init__(self) -> None:
        object.__setattr__(self, "rate", checks.real(self.rate, "angular velocity", "rate"))
        object.__setattr__(self, "angle", checks.real(self.angle, "angle", "angle"))

    @property
    def fastest_rate(self) -> Scalar:
        """|ω|."""
        return abs(self.rate)

    @property
    def mean_rate(self) -> Scalar:
        """ω, rad/s."""
        return self.rate

    def at(self, time: Scalar) -> SupportState:
        """Return the support leaning by ε about its first axis, then turned by ωt about the axle."""
        xp = namespace(self.rate, self.angle, time)
        c, s = xp.cos(self.rate * time), xp.sin(self.rate * time)
        cl, sl = xp.cos(self.angle), xp.sin(self.angle)
        rotation = Matrix(Vector(c, -(s * cl), s * sl), Vector(s, c * cl, -(c * sl)), Vector(0.0, sl, cl))
        return SupportState(rotation, ZERO, ZERO, ZERO, E_Z * self.rate, ZERO)
