"""Tables of motions of the support."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from ...errors import InvalidValueError
from ..fields import Measure, Measures, Varying
from .values import Angle, Moment, PositiveRate, Rate, Share, Table

if TYPE_CHECKING:
    from ...mechanics.motions import Motion


@dataclass(frozen=True)
class Direction(Measures):
    """The type of three numbers that are a direction.

    Examples
    --------
    >>> Direction(Measure("number"), 3)([0, 2, 0])
    (0.0, 2.0, 0.0)
    """

    def __call__(self, value: Any) -> Any:
        """Return the checked numbers."""
        found = super().__call__(value)
        if not any(found):
            raise InvalidValueError("", "must have a direction", value, "Write for instance [1, 0, 0].")
        return found


VaryingRate = Annotated[float | str, Varying("angular velocity", example='"3.5*(1 - exp(-t/2))"')]
VaryingTorque = Annotated[float | str, Varying("torque")]
VaryingAngle = Annotated[float | str, Varying("angle", example='"0.1*sin(2*t)"')]
VaryingPlace3 = Annotated[tuple[float | str, float | str, float | str], Measures(Varying("length"), 3)]
Place3 = Annotated[tuple[float, float, float], Measures(Measure("length", example='"2 mm"'), 3)]
Axis = Annotated[tuple[float, float, float], Direction(Measure("number", example="1"), 3)]
RotationalDamping = Annotated[float, Measure("rotational damping", "not negative")]
BearingTorque = Annotated[float, Measure("torque", "not negative")]


def plain(value: float | str) -> float | str:
    """Return a number without the text that it was written as; a formula stays one.

    Parameters
    ----------
    value : float or str
        Of a table.

    Returns
    -------
    float or str
        For the mechanics.

    Examples
    --------
    >>> plain("2*t"), plain(2)
    ('2*t', 2.0)
    """
    return value if isinstance(value, str) else float(value)


def plains(values: tuple[float | str, ...]) -> tuple[float | str, ...]:
    """Return numbers and formulas as `plain` does.

    Parameters
    ----------
    values : tuple of float or str
        Of a table.

    Returns
    -------
    tuple of float or str
        For the mechanics.

    Examples
    --------
    >>> plains(("2*t", 2))
    ('2*t', 2.0)
    """
    return tuple(map(plain, values))


class FixedMotion(Table):
    """A support at rest."""

    kind: Literal["fixed"]

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import Fixed

        return Fixed()


class SpinMotion(Table):
    """A support that turns steadily about its axis."""

    kind: Literal["spin"]
    rate: Rate = Field(description="Positive turns the first axis towards the second.", examples=["33.3 rpm"])

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import Spin

        return Spin(float(self.rate))


class UnevenSpinMotion(Table):
    """A turn about the axis whose rate varies a little, rate (1 + variation sin(variation_rate t))."""

    kind: Literal["uneven-spin"]
    rate: Rate = Field(description="On the whole.", examples=["33.3 rpm"])
    variation: Share = Field(description="As a share of the rate.", examples=[0.01])
    variation_rate: PositiveRate = Field(description="Of the variation; the rate itself: once a turn.")

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import UnevenSpin

        return UnevenSpin(float(self.rate), float(self.variation), float(self.variation_rate))


class WobbleMotion(Table):
    """A steady turn of a support that sits askew on its axle."""

    kind: Literal["wobble"]
    rate: Rate = Field(description="About the axle.", examples=["33.3 rpm"])
    angle: Angle = Field(description="Between the axle and the support's own axis.", examples=["0.1 deg"])

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import Wobble

        return Wobble(float(self.rate), float(self.angle))


class SpinByMotion(Table):
    """A turn about the axis at a given rate: a start-up, a ramp."""

    kind: Literal["spin-by"]
    rate: VaryingRate = Field(description="A formula in the time t.")

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import SpinBy

        return SpinBy(plain(self.rate))


class FreeAxleMotion(Table):
    """A support that is free to turn on its axle."""

    kind: Literal["free-axle"]
    inertia: Moment = Field(description="Of the support about its axle.", examples=["0.01 kg*m^2"])
    rate: Rate = Field(default=0.0, description="At the start.")
    motor_torque: VaryingTorque = Field(default=0.0, description="A number or a formula in the time t.")
    bearing_drag: RotationalDamping = Field(default=0.0, description="Of a viscous bearing.")
    bearing_torque: BearingTorque = Field(default=0.0, description="Of a dry bearing, against the turning.")
    below: PositiveRate = Field(default=0.01, description="The rate below which a dry bearing eases off.")

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import FreeAxle

        bearing = (float(self.bearing_drag), float(self.bearing_torque), float(self.below))
        return FreeAxle(float(self.inertia), float(self.rate), plain(self.motor_torque), *bearing)


class TiltMotion(Table):
    """A turn about an axis that does not move, by a given angle."""

    kind: Literal["tilt"]
    angle: VaryingAngle = Field(description="A formula in the time t.")
    axis: Axis = Field(default=(0.0, 1.0, 0.0), description="In the support frame, of any length.")

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import Tilt

        return Tilt(plain(self.angle), plains(self.axis))


class RockMotion(Table):
    """Rocking about an axis that does not move, by the angle amplitude sin(rate t + phase)."""

    kind: Literal["rock"]
    amplitude: Angle = Field(examples=["3 deg"])
    rate: Rate = Field(examples=["2 rad/s"])
    phase: Angle = 0.0
    axis: Axis = Field(default=(0.0, 1.0, 0.0), description="In the support frame, of any length.")

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import Rock

        return Rock(float(self.amplitude), float(self.rate), float(self.phase), plains(self.axis))


class PrecessingTiltMotion(Table):
    """A lean whose direction goes round while the support does not spin, as a pan is swirled."""

    kind: Literal["precessing-tilt"]
    angle: Angle = Field(description="Between the support's own axis and the third axis.", examples=["3 deg"])
    rate: Rate = Field(description="At which the lowest side goes round.", examples=["2 rad/s"])

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import PrecessingTilt

        return PrecessingTilt(float(self.angle), float(self.rate))


class ShakeMotion(Table):
    """Shaking along a line, amplitude sin(rate t + phase)."""

    kind: Literal["shake"]
    amplitude: Place3 = Field(description="In the support frame.")
    rate: Rate = Field(examples=["30 rad/s"])
    phase: Angle = 0.0

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import Shake

        return Shake(plains(self.amplitude), float(self.rate), float(self.phase))


class MoveMotion(Table):
    """A support that is shifted without turning."""

    kind: Literal["move"]
    position: VaryingPlace3 = Field(description="Of the support's origin: numbers or formulas in the time t.")

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import Move

        return Move(plains(self.position))


_Part = (
    FixedMotion
    | SpinMotion
    | UnevenSpinMotion
    | WobbleMotion
    | SpinByMotion
    | FreeAxleMotion
    | TiltMotion
    | RockMotion
    | PrecessingTiltMotion
    | ShakeMotion
    | MoveMotion
)


class CombinedMotion(Table):
    """Motions that carry each other, the outermost first."""

    kind: Literal["combined"]
    parts: tuple[Annotated[_Part, Field(discriminator="kind")], ...]

    def build(self) -> Motion:
        """Return the motion."""
        from ...mechanics.motions import Combined

        return Combined(tuple(part.build() for part in self.parts))

    @model_validator(mode="after")
    def _check(self) -> Self:
        self.build()  # it knows which motions go together
        return self


Motions = _Part | CombinedMotion

PARTS: dict[str, type[Table]] = {
    "fixed": FixedMotion,
    "spin": SpinMotion,
    "uneven-spin": UnevenSpinMotion,
    "wobble": WobbleMotion,
    "spin-by": SpinByMotion,
    "free-axle": FreeAxleMotion,
    "tilt": TiltMotion,
    "rock": RockMotion,
    "precessing-tilt": PrecessingTiltMotion,
    "shake": ShakeMotion,
    "move": MoveMotion,
}
MOTIONS: dict[str, type[Table]] = {**PARTS, "combined": CombinedMotion}
