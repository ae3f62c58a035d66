"""Harmonic motions: rocking about an axis, shaking along a line, and a lean that goes round."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ... import wording
from ..algebra import E_Z, ZERO, Matrix, Vector
from ..parts import Number, Numbers
from ..scalars import Scalar, namespace
from .base import Motion, SupportState
from .given import AXIS, direction_of
from .turning import about, swing, turned_about


@dataclass(frozen=True)
class Rock(Motion):
    """A support that rocks about an axis through the origin, by the angle A sin(νt + φ).

    Parameters
    ----------
    amplitude : float or quantity
        A, rad.
    rate : float or quantity
        ν, rad/s.
    phase : float or quantity
        φ, rad.
    axis : sequence of 3 floats
        Its direction in the inertial support frame, of any length; the second axis unless said otherwise: a positive
        angle then lowers the side of the first axis.

    Examples
    --------
    >>> Rock("3 deg", 2.0).at(0.0).angular_velocity.y == 2.0 * Rock("3 deg", 2.0).amplitude
    True
    """

    amplitude: Annotated[Scalar, Number("angle", said="A of A sin(νt + φ).", example="2 deg")]
    rate: Annotated[Scalar, Number("angular velocity", said="ν of A sin(νt + φ).", example="1 turn/s")]
    phase: Annotated[Scalar, Number("angle", said="φ of A sin(νt + φ).")] = 0.0
    axis: Annotated[Any, AXIS] = (0.0, 1.0, 0.0)
    kind = "rock"
    label = "Rocks"
    way = "rocking"

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return amplitude and rate."""
        return [f"rocking by {wording.degrees(self.amplitude)} at {wording.short(float(self.rate), 4)} rad/s"]

    @property
    def fastest_rate(self) -> Scalar:
        """The faster of the rocking and the turn in it."""
        return abs(self.rate) * (1 + abs(self.amplitude))

    def at(self, time: Scalar) -> SupportState:
        """Return the support turned by A sin(νt + φ)."""
        return turned_about(direction_of(self.axis), swing(self.amplitude, self.rate, self.phase, time))


@dataclass(frozen=True)
class Shake(Motion):
    """A support that is shaken along a line without turning, X = A sin(νt + φ).

    Parameters
    ----------
    amplitude : sequence of 3 floats or quantities
        A in the inertial support frame, m.
    rate : float or quantity
        ν, rad/s.
    phase : float or quantity
        φ, rad.

    Examples
    --------
    >>> Shake(("2 mm", 0.0, 0.0), "10 rad/s").at(0.0).velocity
    Vector(x=0.02, y=0.0, z=0.0)
    """

    amplitude: Annotated[Any, Numbers(Number("length", example="1 cm"), "A of A sin(νt + φ), in the support frame.")]
    rate: Annotated[Scalar, Number("angular velocity", said="ν of A sin(νt + φ).", example="1 turn/s")]
    phase: Annotated[Scalar, Number("angle", said="φ of A sin(νt + φ).")] = 0.0
    kind = "shake"
    label = "Shakes"
    way = "shaken"
    turns = False

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return amplitude and rate."""
        return [f"shaken by {wording.length(self.amplitude.norm())} at {wording.short(float(self.rate), 4)} rad/s"]

    @property
    def fastest_rate(self) -> Scalar:
        """|ν|, rad/s."""
        return abs(self.rate)

    def at(self, time: Scalar) -> SupportState:
        """Return the support at A sin(νt + φ)."""
        where, velocity, acceleration = swing(self.amplitude, self.rate, self.phase, time)
        return SupportState(Matrix.identity(), where, velocity, acceleration, ZERO, ZERO)


@dataclass(frozen=True)
class PrecessingTilt(Motion):
    """A support whose axis leans by a given angle in a direction that goes round, while the support does not spin.

    This is how a pan is swirled: R = R₃(νt) R₂(ε) R₃(−νt), which comes back to itself with every round. At t = 0 the
    side of the first axis is the low one.

    Parameters
    ----------
    angle : float or quantity
        ε between the support's own axis and the third axis, rad.
    rate : float or quantity
        ν at which the lowest side goes round, from the first axis towards the second, rad/s.

    Examples
    --------
    >>> axis = PrecessingTilt(0.1, 2.0).at(0.0).rotation @ Vector(0.0, 0.0, 1.0)
    >>> round(axis.x, 6), axis.y
    (0.099833, 0.0)
    """

    angle: Annotated[
        Scalar, Number("angle", said="Between the support's own axis and the third axis.", example="2 deg")
    ]
    rate: Annotated[
        Scalar, Number("angular velocity", said="At which the lowest side goes round.", example="0.5 turn/s")
    ]
    kind = "precessing-tilt"
    label = "Leans round about"
    way = "swirled"

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return angle and rate."""
        return [f"swirled: leaning {wording.degrees(self.angle)}, round at {wording.short(float(self.rate), 4)} rad/s"]

    @property
    def fastest_rate(self) -> Scalar:
        """|ν|, rad/s."""
        return abs(self.rate)

    def at(self, time: Scalar) -> SupportState:
        """Return the support leaning towards νt: ω = ν(e₃ − a) with a its own axis, ȧ = ν e₃×a."""
        where = self.rate * time
        around, leaning = namespace(where), namespace(self.angle)
        c, s = around.cos(where), around.sin(where)
        lean, half = leaning.sin(self.angle), leaning.sin(0.5 * self.angle)
        rotation = about(Vector(-s, c, 0.0), self.angle)
        a = Vector(c, s, 0.0) * lean
        omega = Vector(-a.x, -a.y, 2.0 * (half * half)) * self.rate  # 1 − cos ε, no digits lost
        return SupportState(rotation, ZERO, ZERO, ZERO, omega, E_Z.cross(a) * -(self.rate * self.rate))
