"""T15: Chaplygin's ball with two equal moments of inertia on a level plane: elementary, but for Kepler's equation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.scalars import Scalar
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .chaplygin_domain import (
    CHAPLYGIN_BALL,
    ON_LEVEL_PLANE,
    TURNS,
    principal_axes,
    stance_of,
    turning_faster,
    two_are_equal,
)
from .chaplygin_nutation import Constants
from .domain import FORCES, constant_forces, that
from .finding import Finding
from .fits import Seen
from .formula import Lines, quantity
from .quadrature import is_one, one_by_one

_NEVER = 1e30  # s


def _symmetric(system: RollingSystem) -> bool:
    return two_are_equal(principal_axes(system.body)[0]) is not None


@dataclass(frozen=True)
class ChaplyginBall(ClosedForm):
    """A ball with its centre of mass at its centre and the moments J₁, J₁, J₃, for any start that rolls (T15).

    With D = ma², y² = 1 − D n·(J + D)⁻¹n and x = e·n for the axis e, C = (J₃ + D)(J₁ + D)/J₁ y Ω·e is constant besides
    Chaplygin's M = JΩ + Dn×(Ω×n). They give both rates by x; x and y go along a conic, its angle swings as a sine of η,
    and η follows the time by an equation of Kepler's kind, η + b arsinh(c cos η) = νt. So does the path, without any
    quadrature. Every number may be a float, or an array of members.

    Parameters
    ----------
    radius, mass : float or array
        a in m, m in kg.
    across, along : float or array
        J₁ about every axis across e, and J₃ about e, kg m².
    position : pair of float or array
        Centre at t = 0 over the plane, m.
    axis : triple of float or array
        e at t = 0, a unit vector in the inertial support frame.
    angular_velocity : triple of float or array
        Ω at t = 0, rad/s.
    body_axis : triple of float or array
        e in the body frame.
    normal_force : float or array
        N, N.

    Examples
    --------
    A ball that turns about its axis, however that leans, rolls along a line:

    >>> ball = ChaplyginBall(0.1, 1.0, 4e-3, 3e-3, (0.0, 0.0), (0.6, 0.0, 0.8), (3.0, 0.0, 4.0))
    >>> [round(float(part), 12) + 0.0 for part in ball.motion_at(2.0)[0]]
    [0.0, -0.6, 0.1]
    """

    radius: Scalar
    mass: Scalar
    across: Scalar
    along: Scalar
    position: tuple[Scalar, Scalar]
    axis: tuple[Scalar, Scalar, Scalar]
    angular_velocity: tuple[Scalar, Scalar, Scalar]
    body_axis: tuple[Scalar, Scalar, Scalar] = (0.0, 0.0, 1.0)
    normal_force: Scalar = 0.0

    name = "Chaplygin's ball with two equal moments"
    equation = "T15"
    source = "Chaplygin, Mat. Sb. 24, 139 (1903), for the integrals; theory page, T15, for the time and the path"
    conditions = (
        *CHAPLYGIN_BALL,
        that(_symmetric, ", with two equal moments of inertia", "no two of its moments of inertia are equal", FORCES),
        *ON_LEVEL_PLANE,
        TURNS,
    )
    impossible_events = frozenset({"lift", "curved"})  # N is constant

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> ChaplyginBall:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> ball = tr.Body(1.0, tr.Principal(4e-3, 3e-3, 4e-3), tr.Sphere(0.1))
        >>> system = tr.RollingSystem(ball, tr.Support(tr.Plane()))
        >>> ChaplyginBall.of(system, system.place(velocity=(0.5, 0.0), spin=3.0)).body_axis
        (0.0, 1.0, 0.0)
        """
        cls.check_domain(system, start)
        moments, axes = principal_axes(system.body)
        odd = two_are_equal(moments) or 0
        body_axis = axes[odd]
        e = Quaternion(*start.orientation).matrix() @ Vector(*body_axis)
        force, _ = constant_forces(system)
        return cls(
            radius=system.body.radius,
            mass=system.body.mass,
            across=moments[(odd + 1) % 3],
            along=moments[odd],
            position=start.position[:2],
            axis=(float(e.x), float(e.y), float(e.z)),
            angular_velocity=start.angular_velocity,
            body_axis=body_axis,
            normal_force=-float(force.z),
        )

    # The constants of the motion

    @cached_property
    def _floats(self) -> Constants:
        return Constants.of(self)

    def _numbers(self, t: Any) -> Constants:
        return Constants.of(self, t) if type(t).__module__.startswith("mpmath") else self._floats

    @property
    def momentum(self) -> Vector:
        """M = JΩ + D n×(Ω×n) in the support frame, kg m²/s: constant."""
        D, e, Omega = self.mass * self.radius**2, Vector(*self.axis), Vector(*self.angular_velocity)
        M = Omega * (self.across + D) + e * ((self.along - self.across) * Omega.dot(e))
        return Vector(M.x, M.y, M.z - D * Omega.z)

    @property
    def nutation_period(self) -> float:
        """Of e·n, s: after it Ω, e and the contact force are again what they were, in space."""
        period = 2 * math.pi / self._floats.rate
        return period if period < _NEVER else math.inf

    @property
    def drift(self) -> Vector:
        """How fast the ball gets on from one nutation to the next, m/s."""
        c = self._floats
        return Vector(c.my * c.drift, -c.mx * c.drift, 0.0)

    @property
    def period(self) -> float:
        """Infinite: the ball drifts."""
        return math.inf

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return a bound of Ω by the energy M·Ω/2, rad/s."""
        twice = self.momentum.dot(Vector(*self.angular_velocity))
        return float(math.sqrt(max(twice, 0.0) / min(self.across, self.along)))

    def repeats(self, stop: str) -> float:
        """Return the period of the nutation for what the forces decide."""
        return self.nutation_period if stop == "slip" else self.period

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> ball = ChaplyginBall(0.1, 1.0, 4e-3, 3e-3, (0.0, 0.0), (0.6, 0.0, 0.8), (1.0, 2.0, 3.0), normal_force=9.8)
        >>> later = ball.motion_at(ball.nutation_period)[2]
        >>> [round(float(part), 12) for part in later]
        [1.0, 2.0, 3.0]
        """
        if not is_one(self):
            return one_by_one(self, t)
        c = self._numbers(t)
        now = c.at(t)
        e, ring = now.axis(c), c.ring
        Ox, Oy = c.mx * c.level + e.x * (ring / now.y), c.my * c.level + e.y * (ring / now.y)
        Omega = Vector(Ox, Oy, c.upright + c.twist * now.x / now.y)
        turned = Omega.cross(e)
        shrinks = c.beta * now.x * now.x_rate / (now.y * now.y)
        fx, fy = (ring / now.y) * (turned.x + e.x * shrinks), (ring / now.y) * (turned.y + e.y * shrinks)
        a, m, zero = c.radius, c.mass, 0 * now.x
        ahead, aside = c.drift * t + c.swing * (now.lag - c.lag0), c.sway * (now.angle - c.angle0)
        # Over the plane Ω×n is Ω turned back by a right angle, and so is the way from a ∫Ω dt.
        return (
            Vector(c.px + c.my * ahead + c.mx * aside, c.py - c.mx * ahead + c.my * aside, a + zero),
            Vector(a * Oy, -a * Ox, zero),
            Omega,
            Vector(m * a * fy, -m * a * fx, c.normal_force + zero),
        )

    def axis_at(self, t: Any) -> Vector:
        """Return the ball's axis e.

        Examples
        --------
        >>> ball = ChaplyginBall(0.1, 1.0, 4e-3, 3e-3, (0.0, 0.0), (0.6, 0.0, 0.8), (1.0, 2.0, 3.0))
        >>> [round(float(part), 12) + 0.0 for part in ball.axis_at(0.0)]
        [0.6, 0.0, 0.8]
        """
        c = self._numbers(t)
        return c.at(t).axis(c)

    def representative_orientation(self, t: Any) -> Quaternion:
        """Return an orientation with which the axis is where it is: its turns about e do not change the forces."""
        return stance_of(Vector(*self.body_axis), self.axis_at(t))

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return the momentum about the contact, which it keeps."""
        momentum = quantity(self.momentum.norm(), r"kg\,m^2/s")
        return [(r"M = J\Omega + m a^2\,n\times(\Omega\times n)", f"|M| = {momentum}")]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare the time of a nutation, and how far the ball has got on by then."""
        found = turning_faster("Time of one nutation", float(self.nutation_period), seen)
        if found is None:
            return
        finding, times = found
        yield finding
        speed = None
        if finding.measured:
            ends = np.array([np.interp(times[[0, -1]], seen.time, part) for part in seen.at.position.T[:2]]).T
            speed = float(np.linalg.norm(ends[1] - ends[0]) / (times[-1] - times[0]))
        drift = math.hypot(float(self.drift.x), float(self.drift.y))
        fastest = float(np.max(np.linalg.norm(seen.at.velocity, axis=1)))
        yield Finding("Speed from one nutation to the next", r"\bar v", drift, speed, "m/s", scale=max(drift, fastest))
