"""T15d: Chaplygin's ball that turns steadily about one of its principal axes, however that leans: along a line."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...mechanics.algebra import E_Z, Quaternion, Vector
from ...mechanics.scalars import Scalar, namespace
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .chaplygin_domain import CHAPLYGIN_BALL, ON_LEVEL_PLANE, principal_axes, two_are_equal
from .domain import START, Condition, constant_forces
from .finding import Finding
from .fits import Seen, needed_friction
from .formula import Lines, quantity

_ASIDE = 1e-14  # share of the momentum that may lie across Ω by rounding


def _wobbles(system: RollingSystem, start: State) -> Iterator[str]:
    if not any(start.angular_velocity):
        return
    Omega = Vector(*start.angular_velocity)
    own = system.body.inertia_in_space(Quaternion(*start.orientation).matrix()) @ Omega
    moments = principal_axes(system.body)[0]
    about = Omega.dot(own) / Omega.dot(Omega)
    if Omega.cross(own).norm() > _ASIDE * Omega.norm() * own.norm():
        yield "the ball does not turn about a principal axis"
    elif two_are_equal(moments) is None and sorted(moments, key=lambda J: abs(J - about))[0] == sorted(moments)[1]:
        yield "the ball turns about its middle axis, where a rounding would decide which way it goes over"


@dataclass(frozen=True)
class SteadyChaplyginBall(ClosedForm):
    """A ball with its centre of mass at its centre and a constant Ω along a principal axis, or at rest (T15d).

    The plane has nothing to hold against: friction is zero. Every number may be a float, or an array of members.

    Parameters
    ----------
    radius : float or array
        a, m.
    position : pair of float or array
        Centre at t = 0 over the plane, m.
    angular_velocity : triple of float or array
        Ω, rad/s.
    normal_force : float or array
        N, N.

    Examples
    --------
    >>> SteadyChaplyginBall(0.1, (0.0, 0.0), (0.0, 3.0, 4.0)).motion_at(2.0)[0]
    Vector(x=0.6000000000000001, y=0.0, z=0.1)
    """

    radius: Scalar
    position: tuple[Scalar, Scalar]
    angular_velocity: tuple[Scalar, Scalar, Scalar]
    normal_force: Scalar = 0.0

    name = "Chaplygin's ball about a principal axis"
    equation = "T15d"
    source = "Chaplygin, Mat. Sb. 24, 139 (1903); theory page, T15"
    conditions = (
        *CHAPLYGIN_BALL,
        *ON_LEVEL_PLANE,
        Condition(", turning about a principal axis that is not the middle one, or at rest", _wobbles, START),
    )
    impossible_events = frozenset({"lift", "slip", "curved"})

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SteadyChaplyginBall:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> ball = tr.Body(1.0, tr.Principal(3e-3, 4e-3, 5e-3), tr.Sphere(0.1))
        >>> system = tr.RollingSystem(ball, tr.Support(tr.Plane()))
        >>> SteadyChaplyginBall.of(system, system.place(spin=3.0)).angular_velocity
        (0.0, 0.0, 3.0)
        """
        cls.check_domain(system, start)
        force, _ = constant_forces(system)
        return cls(system.body.radius, start.position[:2], start.angular_velocity, -float(force.z))

    @property
    def period(self) -> float:
        """Infinite: it goes along a line, or nowhere."""
        return math.inf

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return Ω, rad/s."""
        return float(Vector(*self.angular_velocity).norm())

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> SteadyChaplyginBall(0.1, (0.0, 0.0), (0.0, 3.0, 4.0), 9.8).motion_at(2.0)[3]
        Vector(x=0.0, y=0.0, z=9.8)
        """
        (x, y), (p, q, r), a, zero = self.position, self.angular_velocity, self.radius, 0.0 * t
        V = Vector(a * q + zero, -a * p + zero, zero)
        return (
            Vector(x + V.x * t, y + V.y * t, a + zero),
            V,
            Vector(p + zero, q + zero, r + zero),
            Vector(zero, zero, self.normal_force + zero),
        )

    def fixed_axis_rotation(self, t: Any) -> tuple[Vector, Any]:
        """Return the axis and the angle by which the ball has turned."""
        Omega = Vector(*self.angular_velocity)
        xp = namespace(Omega.x, Omega.y, Omega.z)
        speed = xp.sqrt(Omega.dot(Omega))
        return (Omega / speed if speed else E_Z), speed * t

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return how the ball moves along its line."""
        p, q, r = map(float, self.angular_velocity)
        turning, speed = quantity(math.hypot(p, q, r), "rad/s"), quantity(float(self.radius) * math.hypot(p, q), "m/s")
        return [
            (r"\dot\Omega = 0", rf"|\Omega| = {turning}"),
            (r"V = a\,\Omega\times n", f"|V| = {speed}"),
        ]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare its speed, and the friction that it takes: none."""
        p, q, r = map(float, self.angular_velocity)
        gone = float(np.abs(seen.zeta[-1] - seen.zeta[0]) / seen.time[-1])
        scale = float(self.radius) * math.hypot(p, q, r)
        note = "it turns about the same axis and keeps its speed"
        yield Finding(
            "Speed",
            "v",
            float(self.radius) * math.hypot(p, q),
            gone,
            "m/s",
            note=note,
            scale=scale,
            said="rolls straight at {}",
        )
        yield needed_friction(0.0, seen.at)
