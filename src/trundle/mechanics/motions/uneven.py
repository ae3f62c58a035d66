"""Turns as real turntables make them: uneven, or askew on the axle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ... import wording
from ..algebra import E_Z, ZERO, Matrix, Vector
from ..parts import POSITIVE, Number
from ..scalars import Scalar, namespace
from .base import Motion, SupportState
from .turning import about_third_axis


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

    rate: Annotated[Scalar, Number("angular velocity", said="On the whole.", example="33.3 rpm")]
    variation: Annotated[Scalar, Number("number", said="ε, as a share of the rate.", example=0.05)]
    variation_rate: Annotated[
        Scalar, Number("angular velocity", POSITIVE, "ν, at which the rate varies; the rate itself: once a turn.")
    ]
    kind = "uneven-spin"
    label = "Turns unevenly"
    way = "unevenly turning"
    keeps_axis = True

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return the rate and its variation."""
        return [f"{ground} {wording.rate(self.rate)}", f"uneven by {wording.short(100 * float(self.variation), 3)} %"]

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
        omega = E_Z * (self.rate * (1 + self.variation * sine))
        omega_rate = E_Z * (self.rate * self.variation * self.variation_rate * xp.cos(phase))
        return SupportState(about_third_axis(angle), ZERO, ZERO, ZERO, omega, omega_rate)


@dataclass(frozen=True)
class Wobble(Motion):
    """A steady turn about the support's third axis of a support that sits askew on its axle.

    The axle does not move; the support's own axis leans from it and goes round with it, at t = 0 away from the second
    axis, or from where that is once it is turned by φ.

    Parameters
    ----------
    rate : float or quantity
        ω about the axle, rad/s.
    angle : float or quantity
        ε between the axle and the support's own axis, rad.
    phase : float or quantity
        φ, of the lean about the axle, rad.

    Examples
    --------
    >>> Wobble(3.5, "0.1 deg").at(0.0).angular_velocity
    Vector(x=0.0, y=0.0, z=3.5)
    """

    rate: Annotated[Scalar, Number("angular velocity", said="About the axle.", example="33.3 rpm")]
    angle: Annotated[Scalar, Number("angle", said="Between the axle and the support's own axis.", example="1 deg")]
    phase: Annotated[Scalar, Number("angle", said="φ, by which the lean is turned about the axle.")] = 0.0
    kind = "wobble"
    label = "Turns askew on its axle"
    way = "turning"

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return the rate and the angle."""
        return [f"{ground} {wording.rate(self.rate)}", f"askew by {wording.degrees(self.angle)}"]

    @property
    def fastest_rate(self) -> Scalar:
        """|ω|."""
        return abs(self.rate)

    @property
    def mean_rate(self) -> Scalar:
        """ω, rad/s."""
        return self.rate

    def at(self, time: Scalar) -> SupportState:
        """Return the support leaning by ε about its first axis turned by φ, then turned by ωt about the axle."""
        leaning, round_ = namespace(self.angle), namespace(self.phase)
        c, s = round_.cos(self.phase), round_.sin(self.phase)
        cl, sl = leaning.cos(self.angle), leaning.sin(self.angle)
        k = 1.0 - cl
        lean = Matrix(
            Vector(cl + c * c * k, c * s * k, s * sl),
            Vector(c * s * k, cl + s * s * k, -(c * sl)),
            Vector(-(s * sl), c * sl, cl),
        )
        rotation = about_third_axis(self.rate * time) @ lean
        return SupportState(rotation, ZERO, ZERO, ZERO, E_Z * self.rate, ZERO)
