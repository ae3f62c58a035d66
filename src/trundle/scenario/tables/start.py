"""Where the body is put down, and how long it runs."""

from __future__ import annotations

import math
from typing import Any, Literal

from pydantic import Field, model_validator

from ...errors import InvalidValueError
from ..fields import written
from .values import Angle, Duration, Place2, Rate, Rate3, Step, Table, Turn4, Velocity2

Method = Literal["auto", "exact", "taylor", "runge-kutta"]


class Start(Table):
    """Where the body is put down, and how it moves then."""

    position: Place2 = Field(description="Of the centre over a plane, x and y; on a cylinder its angle and height.")
    velocity: Velocity2 = Field(default=(0.0, 0.0), description="Of the centre, along the two coordinates.")
    spin: Rate | None = Field(default=None, description="Angular velocity about the normal; the rest follows.")
    angular_velocity: Rate3 | None = Field(default=None, description="All of it, instead of spin.")
    orientation: Turn4 | None = Field(default=None, description="Quaternion w, x, y, z; absent: not turned.")
    roll: Angle = Field(default=0.0, description="Of a cylinder: how far it has rolled on since its mark was on top.")

    @model_validator(mode="after")
    def _check(self) -> Start:
        if self.spin is not None and self.angular_velocity is not None:
            remedy = "Give `spin` and the rest follows from no slip, or all three components and no `spin`."
            shown = written(self.angular_velocity)
            raise InvalidValueError("angular_velocity", "must not stand beside `spin`", shown, remedy)
        length = 1.0 if self.orientation is None else math.hypot(*self.orientation)
        if not 1e-150 < length < 1e150:
            shown = written(self.orientation)
            remedy = "Write [1, 0, 0, 0] for a body that is not turned."
            raise InvalidValueError("orientation", "must be a quaternion of unit length", shown, remedy)
        return self

    def arguments(self) -> dict[str, Any]:
        """Return what `RollingSystem.place` takes."""
        velocity = self.velocity if isinstance(self.velocity, str) else tuple(map(float, self.velocity))
        turning = None if self.angular_velocity is None else tuple(map(float, self.angular_velocity))
        return {
            "position": tuple(map(float, self.position)),
            "velocity": velocity,
            "spin": None if self.spin is None else float(self.spin),
            "angular_velocity": turning,
            "orientation": None if self.orientation is None else tuple(map(float, self.orientation)),
            "roll": float(self.roll),
        }


class Run(Table):
    """How long, how finely and by which method."""

    duration: Duration = Field(examples=["60 s"])
    every: Step = Field(description="Time between samples.", examples=["10 ms"])
    method: Method = "auto"

    @model_validator(mode="after")
    def _check(self) -> Run:
        from ...solve.sampling import check_sampling

        check_sampling(written(self.duration), written(self.every))
        return self
