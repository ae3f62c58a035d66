"""Motions given by formulas in the time: a turn by its rate, a tilt by its angle, a shift by its place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ... import wording
from ..algebra import E_Z, ZERO, Matrix, Vector
from ..expressions import course, now
from ..parts import Number, Numbers
from ..scalars import Scalar, is_zero
from .base import Motion, SupportState
from .pace import largest
from .turning import about_third_axis, turned_about

AXIS = Numbers(Number("number", example=1), "In the support frame, of any length.", direction=True)


@dataclass(frozen=True)
class SpinBy(Motion):
    """A turn about the support's third axis at a given rate ω(t): a start-up, a ramp, a wow.

    The angle turned through is a coordinate of the run's own, integrated with the rest: no antiderivative is needed.

    Parameters
    ----------
    rate : formula, float or quantity
        ω in the time t in s, rad/s, such as ``"3.5*(1 - exp(-t/2))"``.

    Examples
    --------
    >>> run_up = SpinBy("3.5*(1 - exp(-t/2))")
    >>> run_up.at(0.0, 0.0).angular_acceleration.z
    1.75
    """

    rate: Annotated[
        Any,
        Number("angular velocity", said="A formula in the time t.", example="3.5*(1 - exp(-t/2))", varies=True),
    ]
    kind = "spin-by"
    label = "Turns by a formula"
    way = "unevenly turning"
    coordinates = ("angle",)
    keeps_axis = True

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return the formula."""
        return [f"{ground} {wording.formula(self.rate, 'ω', 'rad/s')}"]

    def initial_coordinates(self) -> tuple[Scalar, ...]:
        """Return the angle 0: not yet turned."""
        return (0.0,)

    def coordinate_rates(self, time: Scalar, coordinates: tuple[Scalar, ...], moment: Scalar) -> tuple[Scalar, ...]:  # noqa: ARG002
        """Return ω(t), whatever the body does."""
        return (now(self.rate, time),)

    @property
    def mean_rate(self) -> Scalar:
        """ω(0), rad/s: the rate it starts with."""
        return now(self.rate, 0.0)

    @property
    def fastest_rate(self) -> Scalar:
        """As `fastest_rate_within` its first ten seconds."""
        return self.fastest_rate_within(0.0, 10.0)

    def fastest_rate_within(self, start: float, end: float) -> float:
        """Return the largest |ω| in an interval of time, and how fast it changes there, rad/s."""
        sizes = largest(self.rate, start, end)
        return sizes.value + sizes.pace

    def at(self, time: Scalar, *coordinates: Scalar) -> SupportState:
        """Return the support turned by the angle it has reached."""
        (angle,) = coordinates
        rate, growth, _ = course(self.rate, time)
        return SupportState(about_third_axis(angle), ZERO, ZERO, ZERO, E_Z * rate, E_Z * growth)


@dataclass(frozen=True)
class Tilt(Motion):
    """A support turned by a given angle about an axis through the origin that does not move.

    Parameters
    ----------
    angle : formula, float or quantity
        θ in the time t in s, rad; positive turns right-handed about the axis.
    axis : sequence of 3 floats
        Its direction in the inertial support frame, of any length; the second axis unless said otherwise: a positive
        angle then lowers the side of the first axis, as the support's own `tilt` does.

    Examples
    --------
    >>> Tilt("0.1*t").at(0.0).angular_velocity
    Vector(x=0.0, y=0.1, z=0.0)
    """

    angle: Annotated[Any, Number("angle", said="A formula in the time t.", example="0.1*sin(2*t)", varies=True)]
    axis: Annotated[Any, AXIS] = (0.0, 1.0, 0.0)
    kind = "tilt"
    label = "Tilts by a formula"
    way = "tilting"

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return the formula."""
        return [f"{ground} tilts by {wording.formula(self.angle, 'θ', 'rad')}"]

    @property
    def fastest_rate(self) -> Scalar:
        """As `fastest_rate_within` its first ten seconds."""
        return self.fastest_rate_within(0.0, 10.0)

    def fastest_rate_within(self, start: float, end: float) -> float:
        """Return the largest rate in an interval of time, and how fast it changes there, rad/s."""
        sizes = largest(self.angle, start, end)
        return sizes.rate + sizes.pace

    def at(self, time: Scalar) -> SupportState:
        """Return the support turned by θ(t)."""
        return turned_about(direction_of(self.axis), course(self.angle, time))


@dataclass(frozen=True)
class Move(Motion):
    """A support that is shifted without turning, by formulas in the time.

    Parameters
    ----------
    position : sequence of 3 formulas, floats or quantities
        X in the time t in s, where the support's origin is in the inertial support frame, m.

    Examples
    --------
    >>> Move(("0.5*t**2", 0.0, 0.0)).at(2.0).velocity
    Vector(x=2.0, y=0.0, z=0.0)
    """

    position: Annotated[
        Any,
        Numbers(
            Number("length", varies=True),
            "Of the support's origin: numbers or formulas in the time t.",
            example=("0.01*sin(6*t)", 0, 0),
        ),
    ]
    kind = "move"
    label = "Moves by a formula"
    turns = False

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return the formula of each component that is not nothing."""
        parts = zip(self.position, "xyz", strict=True)
        said = [wording.formula(part, name, "m") for part, name in parts if not is_zero(part)]
        return [f"{ground} at {', '.join(said)}"] if said else []

    @property
    def fastest_rate(self) -> Scalar:
        """As `fastest_rate_within` its first ten seconds."""
        return self.fastest_rate_within(0.0, 10.0)

    def fastest_rate_within(self, start: float, end: float) -> float:
        """Return how fast the place changes in an interval of time, as a rate of swinging, rad/s."""
        return max(largest(part, start, end).pace for part in self.position)

    def at(self, time: Scalar) -> SupportState:
        """Return the support at X(t)."""
        where, velocity, acceleration = (
            Vector(*parts) for parts in zip(*(course(p, time) for p in self.position), strict=True)
        )
        return SupportState(Matrix.identity(), where, velocity, acceleration, ZERO, ZERO)


def direction_of(axis: Vector) -> Vector:
    """Return the unit vector along an axis.

    Examples
    --------
    >>> direction_of(Vector(0.0, 2.0, 0.0))
    Vector(x=0.0, y=1.0, z=0.0)
    """
    return axis / axis.norm()
