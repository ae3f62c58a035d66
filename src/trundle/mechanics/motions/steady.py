"""Rest and the steady turn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ... import wording
from ..algebra import E_Z, ZERO, Matrix
from ..parts import Number
from ..scalars import Scalar
from .base import Motion, SupportState
from .turning import about_third_axis


@dataclass(frozen=True)
class Fixed(Motion):
    """A support at rest.

    Examples
    --------
    >>> Fixed().at(1.0).angular_velocity
    Vector(x=0.0, y=0.0, z=0.0)
    """

    kind = "fixed"
    label = "At rest"
    way = "fixed"
    turns = False

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

    rate: Annotated[
        Scalar,
        Number("angular velocity", said="Positive turns the first axis towards the second.", example="33.3 rpm"),
    ]
    kind = "spin"
    label = "Turns evenly"

    @property
    def way(self) -> str:  # type: ignore[override]
        """Turning, unless its rate is 0."""
        return "turning" if self.rate else "fixed"

    def key_numbers(self, ground: str, coordinates: tuple[float, ...]) -> list[str]:  # noqa: ARG002
        """Return its rate, unless that is 0."""
        return [f"{ground} {wording.rate(self.rate)}"] if self.rate else []

    @property
    def steady_rate(self) -> Scalar:
        """ω, rad/s."""
        return self.rate

    def at(self, time: Scalar) -> SupportState:
        """Return the support turned by ωt."""
        return SupportState(about_third_axis(self.rate * time), ZERO, ZERO, ZERO, E_Z * self.rate, ZERO)
