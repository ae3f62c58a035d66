"""A body at rest on a support at rest, held by its rolling resistance: nothing moves until a load changes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from ...mechanics.algebra import Vector
from ...mechanics.scalars import Scalar
from ...mechanics.system import RollingSystem, State
from ..samples import RESTING
from .base import ClosedForm
from .domain import ANY_BODY, AT_REST, RESISTANCES, START, STILL_AIR, Condition, constant_forces, under
from .formula import Lines, quantity


def _moves(system: RollingSystem, start: State) -> Iterator[str]:  # noqa: ARG001
    if any((*start.velocity, *start.angular_velocity)):
        yield "the body moves"


@dataclass(frozen=True)
class RestingBody(ClosedForm):
    """Rest: R = −F (T3 with V̇ = 0).

    Parameters
    ----------
    position : triple of float or array
        Centre of mass, m.
    force : triple of float or array
        F, weight included, N.

    Examples
    --------
    >>> RestingBody((0.0, 0.0, 0.1), (0.0, 0.0, -9.8)).motion_at(5.0)[3]
    Vector(x=0.0, y=0.0, z=9.8)
    """

    position: tuple[Scalar, Scalar, Scalar]
    force: tuple[Scalar, Scalar, Scalar]

    name = "body at rest"
    equation = "T3"
    source = "theory page, T3, with nothing moving"
    conditions = (
        ANY_BODY,
        Condition(" at rest", _moves, START),
        replace(AT_REST, words=", on a support at rest"),
        under(
            ", under gravity, constant loads and resistances",
            "not constant",
            *RESISTANCES,
        ),
        STILL_AIR,
    )
    phases = (RESTING,)
    impossible_events = frozenset({"lift", "start", "slip", "rim", "end", "edge", "curved"})

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> RestingBody:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> ball, felt = tr.Body.solid_sphere(1.0, 1.0), [tr.RollingResistance(0.01)]
        >>> felt = tr.RollingSystem(ball, tr.Support(tr.Plane()), felt)
        >>> RestingBody.of(felt, felt.place()).force
        (0.0, 0.0, -9.80665)
        """
        cls.check_domain(system, start)
        return cls(start.position, tuple(constant_forces(system)[0]))

    @property
    def period(self) -> float:
        """Infinite: nothing moves."""
        return math.inf

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return 0, 1/s."""
        return 0.0

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> RestingBody((0.0, 0.0, 0.1), (0.0, 0.0, -9.8)).motion_at(5.0)[0]
        Vector(x=0.0, y=0.0, z=0.1)
        """
        zero = 0 * t
        still = Vector(zero, zero, zero)
        return still + Vector(*self.position), still, still, still - Vector(*self.force)

    def fixed_axis_rotation(self, t: Any) -> tuple[Vector, Any]:
        """Return no turn at all."""
        return Vector(0.0, 0.0, 1.0), 0 * t

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return what the support bears."""
        return [(r"R = -F,\quad V = \Omega = 0", f"|R| = {quantity(math.hypot(*map(float, self.force)), 'N')}")]
