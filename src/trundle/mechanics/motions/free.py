"""A support that is free to turn on its axle: the body turns it, too."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from ... import wording
from ..algebra import E_Z, ZERO
from ..expressions import now
from ..parts import NOT_NEGATIVE, POSITIVE, Number
from ..scalars import Scalar, namespace
from .base import Motion, SupportState
from .turning import about_third_axis


@dataclass(frozen=True)
class FreeAxle(Motion):
    """A support free to turn about its third axis, I_t ω̇ = τ + M, where M is the moment that the body exerts on it.

    τ(t, ω) = motor − c ω − τ_b ω/√(ω² + ω_b²) is what acts on the axle besides: a motor, a viscous bearing and a dry
    one. A dry bearing loses its hold below ω_b, so that the rate stays a smooth function of the time.

    Parameters
    ----------
    inertia : float or quantity
        I_t of the support about its axle, kg m².
    rate : float or quantity
        ω at the start, rad/s.
    motor_torque : formula, float or quantity
        In the time t in s, N m; positive drives the first axis towards the second.
    bearing_drag : float or quantity
        c of the viscous bearing, N m s.
    bearing_torque : float or quantity
        τ_b of the dry bearing, N m.
    below : float or quantity
        ω_b, rad/s.

    Examples
    --------
    >>> table = FreeAxle("0.5 kg*m^2", rate=2.0, bearing_drag=0.25)
    >>> table.coordinate_rates(0.0, (0.0, 2.0), moment=1.0)
    (2.0, 1.0)
    """

    inertia: Annotated[Scalar, Number("inertia", POSITIVE, "Of the support about its axle.", "0.05 kg*m^2")]
    rate: Annotated[Scalar, Number("angular velocity", said="At the start.", example="33.3 rpm")] = 0.0
    motor_torque: Annotated[Any, Number("torque", said="A number or a formula in the time t.", varies=True)] = 0.0
    bearing_drag: Annotated[Scalar, Number("rotational damping", NOT_NEGATIVE, "Of a viscous bearing.")] = 0.0
    bearing_torque: Annotated[Scalar, Number("torque", NOT_NEGATIVE, "Of a dry bearing, against the turning.")] = 0.0
    below: Annotated[
        Scalar,
        Number("angular velocity", POSITIVE, "The rate below which a dry bearing eases off.", label="Eases off below"),
    ] = 0.01
    kind = "free-axle"
    label = "Turns freely"
    way = "freely turning"
    coordinates = ("angle", "rate")
    keeps_axis = True
    free = True

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:
        """Return the inertia, and the rate at the start."""
        inertia = wording.short(float(self.inertia), 3)
        return [f"free {ground} of {inertia} kg m², at first {wording.rate(coordinates[-1])}"]

    @property
    def mean_rate(self) -> Scalar:
        """ω at the start, rad/s."""
        return self.rate

    def initial_coordinates(self) -> tuple[Scalar, ...]:
        """Return the angle 0 and the rate at the start."""
        return (0.0, self.rate)

    def axle_torque(self, time: Scalar, coordinates: tuple[Scalar, ...]) -> Scalar:
        """Return τ(t, ω), N m."""
        _, rate = coordinates
        xp = namespace(rate, self.below)
        dry = self.bearing_torque * rate / xp.sqrt(rate * rate + self.below * self.below)
        return now(self.motor_torque, time) - self.bearing_drag * rate - dry

    def coordinate_rates(self, time: Scalar, coordinates: tuple[Scalar, ...], moment: Scalar) -> tuple[Scalar, ...]:
        """Return ω and ω̇ = (τ + M)/I_t."""
        _, rate = coordinates
        return (rate, (self.axle_torque(time, coordinates) + moment) / self.inertia)

    def at(self, time: Scalar, *coordinates: Scalar) -> SupportState:  # noqa: ARG002
        """Return the support turned by its angle, for ω̇ = 0: the contact law adds its own."""
        angle, rate = coordinates
        return SupportState(about_third_axis(angle), ZERO, ZERO, ZERO, E_Z * rate, ZERO)
