"""What the air does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

from ... import wording
from ..algebra import E_Z, Vector
from ..parts import NOT_NEGATIVE, Number
from ..scalars import Scalar, is_zero, namespace
from .base import BodyMotion, Load

if TYPE_CHECKING:
    from ..motions import Motion

STANDING, TURNING = "still", "turning"
_AIR = Number(
    "angular velocity",
    said='"still", "turning" with the support, or a rate of its own.',
    words={STANDING: 0.0, TURNING: TURNING},
)
STILL = 1e-6  # m/s: below it the length of a velocity is rounded off, so that it has slopes also at rest


def through_air(motion: BodyMotion, air_rate: Scalar) -> Vector:
    """Return V − ω_a×r, the velocity of the centre of mass through air that turns about the third axis.

    Examples
    --------
    >>> from trundle.mechanics.loads import at_rest
    >>> through_air(at_rest(1.0), 0.0)
    Vector(x=0.0, y=0.0, z=0.0)
    """
    if is_zero(air_rate):
        return motion.velocity
    return motion.velocity - (E_Z * air_rate).cross(motion.position)


class _OfAir(Load):
    """A force of the air on the centre of mass."""

    @property
    def symmetric(self) -> bool:
        """True: the air looks the same from every side of the axis."""
        return True

    @property
    def leaves_spin(self) -> bool:
        """True: it acts at the centre of mass."""
        return True


class _ThroughAir(_OfAir):
    """A force that depends on the velocity through the air, which may turn."""

    air: Scalar  # ω_a, rad/s; the word "turning" until it is known with which support

    @property
    def _air_turning(self) -> str:
        return "" if is_zero(self.air) else ", air turning"

    @property
    def _turns_along(self) -> bool:
        return isinstance(self.air, str) and self.air == TURNING

    def over(self, motion: Motion) -> Any:
        """Return the same over a support: air that turns with it has its rate on the whole."""
        return replace(self, air=motion.mean_rate) if self._turns_along else self  # type: ignore[type-var]


@dataclass(frozen=True)
class Drag(_ThroughAir):
    """Linear drag −c(V − ω_a×r) in air that is still or turns about the support's third axis.

    Parameters
    ----------
    coefficient : float or quantity
        c, kg/s.
    air : float, quantity or str
        ω_a, at which the air turns, rad/s; "still", or "turning" with the support.

    Examples
    --------
    >>> Drag("0.01 kg/s").coefficient
    0.01
    """

    coefficient: Annotated[Scalar, Number("damping", NOT_NEGATIVE, "Of the force −c V through the air.", "10 g/s")]
    air: Annotated[Any, _AIR] = STANDING
    kind = "drag"
    usual = True

    def key_numbers(self) -> list[str]:
        """Return the coefficient."""
        return [f"drag {wording.with_unit(float(self.coefficient), 'damping')}{self._air_turning}"]

    @property
    def linear_drag(self) -> Scalar | None:
        """C in still air, kg/s."""
        return self.coefficient if is_zero(self.air) else None

    def force(self, motion: BodyMotion) -> Vector:
        """Return −c(V − ω_a×r)."""
        return through_air(motion, self.air) * -self.coefficient


@dataclass(frozen=True)
class QuadraticDrag(_ThroughAir):
    """Quadratic drag −c|v|v with v = V − ω_a×r, in air that is still or turns about the support's third axis.

    |v| is computed as √(v² + v₀²) with v₀ = 1 µm/s, since |v| itself has no slopes at rest: the force is off by less
    than c v₀²/2, 5e-13 m²/s² times c, at any speed.

    Parameters
    ----------
    coefficient : float or quantity
        c, kg/m: ½ρ C_d A of a body of frontal area A in air of density ρ.
    air : float, quantity or str
        ω_a, at which the air turns, rad/s; "still", or "turning" with the support.

    Examples
    --------
    >>> QuadraticDrag("1 g/m").coefficient
    0.001
    """

    coefficient: Annotated[
        Scalar,
        Number(
            "quadratic damping", NOT_NEGATIVE, "0.5 times the air's density, the area and its coefficient.", "0.4 g/m"
        ),
    ]
    air: Annotated[Any, _AIR] = STANDING
    kind = "quadratic-drag"

    def key_numbers(self) -> list[str]:
        """Return the coefficient."""
        return [f"quadratic drag {wording.short(float(self.coefficient), 3)} kg/m{self._air_turning}"]

    @property
    def corners(self) -> tuple[Callable[[BodyMotion], Vector], ...]:
        """v: |v| is rounded off over so little that no step of a method sees it."""
        return (partial(through_air, air_rate=self.air),)

    def force(self, motion: BodyMotion) -> Vector:
        """Return −c|v|v."""
        v = through_air(motion, self.air)
        square = v.dot(v) + STILL * STILL
        return v * (-self.coefficient * namespace(square).sqrt(square))


@dataclass(frozen=True)
class Magnus(_OfAir):
    """The sideways force c Ω×V of still air on a body that turns while it moves.

    Parameters
    ----------
    coefficient : float or quantity
        c, kg; a positive one pushes a ball with topspin down. For a small slow sphere in air of density ρ it is
        π ρ a³ [rubinow1961]; a fast or rough one has a C_L of its own, c = ½ρ C_L A |V|/|Ω|.

    Examples
    --------
    >>> Magnus("0.1 g").coefficient
    0.0001
    """

    coefficient: Annotated[
        Scalar, Number("mass", said="c of the force c Ω×V; positive: topspin pushes down.", example="1 g")
    ]
    kind = "magnus"
    label = "Magnus force"

    def key_numbers(self) -> list[str]:
        """Return the coefficient."""
        return [f"Magnus force, {wording.short(float(self.coefficient), 3)} kg"]

    def force(self, motion: BodyMotion) -> Vector:
        """Return c Ω×V."""
        return motion.angular_velocity.cross(motion.velocity) * self.coefficient
