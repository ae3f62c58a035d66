"""Tables of motions of the support."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from .values import Angle, PositiveRate, Rate, Share, Table

if TYPE_CHECKING:
    from ...mechanics.motions import Motion


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


Motions = FixedMotion | SpinMotion | UnevenSpinMotion | WobbleMotion

MOTIONS: dict[str, type[Table]] = {
    "fixed": FixedMotion,
    "spin": SpinMotion,
    "uneven-spin": UnevenSpinMotion,
    "wobble": WobbleMotion,
}
