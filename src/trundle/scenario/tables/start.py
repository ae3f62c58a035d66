"""Where the body is put down, and how long it runs."""

from __future__ import annotations

import math
from typing import Any, Literal

from pydantic import Field, model_validator

from ...errors import InvalidValueError
from ..fields import bare, written
from ..together import tell_all
from .values import Angle, Angle3, Duration, Height, Instant, Own, Place2, Rate, Rate3, Step, Table, Turn4, Velocity

Method = Literal["auto", "exact", "taylor", "runge-kutta"]


class Start(Table):
    """Where the body is put down, and how it moves then."""

    position: Place2 = Field(description="Of the centre over a plane, of the contact on any other surface.")
    velocity: Velocity = Field(
        default=(0.0, 0.0), description="Of the centre, along the two coordinates, and the normal if a third is given."
    )
    spin: Rate | None = Field(
        default=None,
        title="Spin about the normal",
        description="Angular velocity about the normal; the rest follows from no slip.",
        examples=["10 rad/s"],
    )
    angular_velocity: Rate3 | None = Field(default=None, description="All three components, instead of `spin`.")
    orientation: Turn4 | None = Field(
        default=None, description="Quaternion w, x, y, z from the body to the support frame; absent: not turned."
    )
    attitude: Angle3 | None = Field(default=None, description="Heading, lean and turn, instead of `orientation`.")
    roll: Angle = Field(
        default=0.0,
        title="Rolled on by",
        description="Of a cylinder: how far it has rolled on since its mark was on top.",
    )
    height: Height = Field(
        default=0.0,
        title="Height over the support",
        description="Over the support, along the normal: above 0 it falls.",
    )
    time: Instant = Field(default=0.0, description="On the clock of the support's motion, where the run starts.")
    support: Own | None = Field(
        default=None, description="Angle, and rate, of a support that turns by itself; absent: as its motion begins."
    )

    @model_validator(mode="after")
    def _check(self) -> Start:
        tell_all(self._check_spin, self._check_attitude, self._check_length)
        return self

    def _check_spin(self) -> None:
        if self.spin is not None and self.angular_velocity is not None:
            remedy = "Give `spin` and the rest follows from no slip, or all three components and no `spin`."
            shown = written(self.angular_velocity)
            raise InvalidValueError("angular_velocity", "must not stand beside `spin`", shown, remedy)

    def _check_attitude(self) -> None:
        if self.orientation is not None and self.attitude is not None:
            shown = written(self.attitude)
            raise InvalidValueError("attitude", "must not stand beside `orientation`", shown, "Give one of the two.")

    def _check_length(self) -> None:
        length = 1.0 if self.orientation is None else math.hypot(*self.orientation)
        if not 1e-150 < length < 1e150:
            shown = written(self.orientation)
            remedy = "Write [1, 0, 0, 0] for a body that is not turned."
            raise InvalidValueError("orientation", "must be a quaternion of unit length", shown, remedy)

    def arguments(self) -> dict[str, Any]:
        """Return what `RollingSystem.place` takes."""
        return {name: bare(getattr(self, name)) for name in Start.model_fields}


class Run(Table):
    """How long, how finely and by which method."""

    duration: Duration = Field(description="Length of the run.", examples=["60 s"])
    every: Step = Field(title="Between samples", description="Time between samples.", examples=["10 ms"])
    method: Method = Field(default="auto", description="How it is computed.")

    @model_validator(mode="after")
    def _check(self) -> Run:
        from ...solve.sampling import check_sampling

        check_sampling(written(self.duration), written(self.every))
        return self
