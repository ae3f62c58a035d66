"""Couples that the support exerts on the body where they touch: resistance to rolling and to spinning on the spot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from ... import wording
from ..algebra import ZERO, Vector
from ..parts import NOT_NEGATIVE, POSITIVE, Number
from ..scalars import Scalar, less, namespace
from .base import BodyMotion, Load


class _AtContact(Load):
    """A couple between body and support; nothing in flight."""

    at_contact = True

    @property
    def symmetric(self) -> bool:
        """True: it knows no direction but those of the motion and the normal."""
        return True


@dataclass(frozen=True)
class RollingResistance(_AtContact):
    """Resistance to rolling: the normal force acts a little ahead, a couple −δ N ê against the turning.

    ê is the direction of the part of Ω − ω along the support. The couple is as large for slow rolling as for fast, so
    that it stops the body in a finite time; a body that does not turn over the support has no ê, and no couple here.

    Parameters
    ----------
    offset : float or quantity
        δ, m: published as δ, as δ/a, or as δ/(a(1 + k)); docs/motions-and-loads.md says how to tell.

    Examples
    --------
    >>> RollingResistance("0.05 mm").offset
    5e-05
    """

    offset: Annotated[
        Scalar, Number("length", NOT_NEGATIVE, "How far ahead of the contact the normal force acts.", "0.1 mm")
    ]
    kind = "rolling-resistance"
    stops = True

    def key_numbers(self) -> list[str]:
        """Return δ."""
        return [f"rolling resistance δ = {wording.length(self.offset)}"]

    def torque_per_normal_force(self, motion: BodyMotion) -> Vector:
        """Return −δ ê, m."""
        if motion.normal is None:
            return ZERO
        _, over = _turning(motion, motion.normal)
        length = over.norm()
        xp = namespace(length)
        return over * (-self.offset / xp.where(less(0.0, length), length, 1.0))


@dataclass(frozen=True)
class PivotFriction(_AtContact):
    """Resistance to spinning on the spot: the couple −ε N Ω_n/√(Ω_n² + w²) n, Ω_n the part of Ω − ω along n.

    Dry friction under a small area of contact. Below w it eases off, so that the spin is a smooth function of the time
    and dies out instead of jumping.

    Parameters
    ----------
    offset : float or quantity
        ε, m; (2/3)μ times the radius of an area that is pressed evenly, (3π/16)μ times that of Hertz's.
    below : float or quantity
        w, rad/s.

    Examples
    --------
    >>> PivotFriction("20 um").below
    0.01
    """

    offset: Annotated[
        Scalar, Number("length", NOT_NEGATIVE, "ε: friction coefficient times the area's mean radius.", "0.2 mm")
    ]
    below: Annotated[
        Scalar, Number("angular velocity", POSITIVE, "The spin below which it eases off.", label="Eases off below")
    ] = 0.01
    kind = "pivot-friction"

    def key_numbers(self) -> list[str]:
        """Return ε."""
        return [f"pivot friction ε = {wording.length(self.offset)}"]

    def torque_per_normal_force(self, motion: BodyMotion) -> Vector:
        """Return −ε Ω_n/√(Ω_n² + w²) n, m."""
        n = motion.normal
        if n is None:
            return ZERO
        spin, _ = _turning(motion, n)
        square = spin * spin + self.below * self.below
        return n * (-self.offset * spin / namespace(square).sqrt(square))


@dataclass(frozen=True)
class RollingCouple(_AtContact):
    """A viscous couple −c(Ω − ω) at the contact, as of a soft or sticky support.

    Parameters
    ----------
    coefficient : float or quantity
        c, N m s.
    pivot_coefficient : float or quantity, optional
        Of the part of Ω − ω along the normal, N m s; absent: the same.

    Examples
    --------
    >>> RollingCouple(2e-6).coefficient
    2e-06
    """

    coefficient: Annotated[Scalar, Number("rotational damping", NOT_NEGATIVE, "c of the couple −c(Ω − ω).")]
    pivot_coefficient: Annotated[
        Scalar | None, Number("rotational damping", NOT_NEGATIVE, "About the normal; absent: the same.")
    ] = None
    kind = "rolling-couple"

    def key_numbers(self) -> list[str]:
        """Return the coefficient."""
        return [f"rolling couple {wording.short(float(self.coefficient), 3)} N m s"]

    def torque(self, motion: BodyMotion) -> Vector:
        """Return −c(Ω − ω), its part along n by the coefficient of its own."""
        n = motion.normal
        if n is None:
            return ZERO
        if self.pivot_coefficient is None:
            return (motion.angular_velocity - motion.support_angular_velocity) * -self.coefficient
        spin, over = _turning(motion, n)
        return over * -self.coefficient - n * (self.pivot_coefficient * spin)


def _turning(motion: BodyMotion, n: Vector) -> tuple[Scalar, Vector]:
    """Return how the body turns over its support: the part of Ω − ω along n, and the rest."""
    relative = motion.angular_velocity - motion.support_angular_velocity
    spin = relative.dot(n)
    return spin, relative - n * spin
