"""T9: a sphere on a plane that turns at any given ω(t) about its normal, under forces given in time: quadratures."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from ...mechanics.algebra import Vector
from ...mechanics.loads import Force, Load, Torque, at_rest, constant_part
from ...mechanics.motions import Motion, SpinBy, UnevenSpin
from ...mechanics.scalars import Scalar
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .domain import ROUND, linear_drag, moving, on, under
from .finding import Finding
from .fits import Seen
from .formula import Lines, number
from .quadrature import is_one, one_by_one
from .unsteady_course import Course, PreciseCourse


@dataclass(frozen=True)
class SphereOnUnsteadyPlane(ClosedForm):
    """M = ζ̇ − (iκ − γ)ζ changes by the loads alone, and ζ follows from it by one more quadrature (T9).

    Here κ(t) = ω(t) k/(1 + k) and γ = c/(m(1 + k)); without loads M is constant, however the plane is turned. The
    numbers may be floats, or arrays of members; the motion and the loads are the same for all.

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²).
    motion : Motion
        Of the plane: a turn about its normal at a rate that is given in time.
    position, velocity : pair of float or array
        Centre at the start over the plane, m and m/s, in the inertial support frame.
    spin : float or array
        Ω·n at the start, rad/s.
    loads : tuple of Load
        Gravity, constant or varying forces and torques, and linear drag in still air.
    start_time : float
        Time at the start, s.

    Examples
    --------
    A table that is spun up from rest and stopped again leaves a ball at rest over its axis where it was:

    >>> from trundle.mechanics.motions import UnevenSpin
    >>> ball = SphereOnUnsteadyPlane(0.025, 0.065, 0.4, UnevenSpin(3.5, 0.2, 1.0), (0.0, 0.0))
    >>> [float(part) for part in ball.motion_at(7.0)[0]]
    [0.0, 0.0, 0.025]
    """

    radius: Scalar
    mass: Scalar
    inertia_ratio: Scalar
    motion: Motion
    position: tuple[Scalar, Scalar]
    velocity: tuple[Scalar, Scalar] = (0.0, 0.0)
    spin: Scalar = 0.0
    loads: tuple[Load, ...] = ()
    start_time: float = 0.0

    name = "sphere on a plane that turns unevenly"
    equation = "T9"
    source = "theory page, T9, by two quadratures; for a steady turn Milne, Vectorial Mechanics (1948)"
    conditions = (
        ROUND,
        on(Plane),
        moving(
            lambda motion: motion.steady_rate is not None or isinstance(motion, (SpinBy, UnevenSpin)),
            " that turns about its normal at a rate given in time",
            "turn about its normal at a rate given in time",
        ),
        under(
            ", under gravity, forces and torques given in time and linear drag in still air",
            "neither given in time nor linear drag in still air",
            linear_drag,
            Force,
            Torque,
        ),
    )

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SphereOnUnsteadyPlane:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> table = tr.Support(tr.Plane(), motion=tr.UnevenSpin(3.5, 0.1, 3.5))
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
        >>> SphereOnUnsteadyPlane.of(system, system.place((0.1, 0.0))).position
        (0.1, 0.0)
        """
        cls.check_domain(system, start)
        return cls(
            radius=system.body.radius,
            mass=system.body.mass,
            inertia_ratio=system.body.inertia_ratio,
            motion=system.support.motion,
            position=start.position[:2],
            velocity=start.velocity[:2],
            spin=start.angular_velocity[2],
            loads=system.all_loads,
            start_time=start.time,
        )

    # What is given

    @property
    def share(self) -> Scalar:
        """k/(1 + k)."""
        return self.inertia_ratio / (1 + self.inertia_ratio)

    @property
    def kappa(self) -> Scalar:
        """The fastest κ, rad/s: what a look at the motion must resolve."""
        return self.share * self.motion.fastest_rate

    @property
    def drag(self) -> Scalar:
        """The coefficient of linear drag c, kg/s."""
        return sum((load.linear_drag for load in self.loads if load.linear_drag is not None), 0.0)

    @property
    def gamma(self) -> Scalar:
        """γ = c/(m(1 + k)), the rate at which drag slows the ball, 1/s."""
        return self.drag / (self.mass * (1 + self.inertia_ratio))

    @property
    def period(self) -> float:
        """Infinite: a motion with an uneven turn comes back by chance only."""
        return math.inf

    def rates(self, t: Any) -> tuple[Any, Any]:
        """Return ω, rad/s, and ω̇, rad/s², of the plane at a time since the start."""
        now = self.motion.at(self.start_time + t, *self.motion.initial_coordinates())
        return now.angular_velocity.z, now.angular_acceleration.z

    def pushes(self, t: Any) -> tuple[Any, Any, Any, Any]:
        """Return F_x + iF_y, F_z, the acceleration φ that force and torque give, and K_z, at a time since the start."""
        moving = [load for load in self.loads if load.linear_drag is None]
        constant = tuple(load for load in moving if load.constant)
        force, torque, _ = constant_part(constant, self.mass)
        for load in moving:
            if not load.constant:
                now = replace(at_rest(self.mass), time=self.start_time + t)
                force, torque = force + load.force(now), torque + load.torque(now)
        flat = force.x + 1j * force.y
        driven = (flat + (torque.y - 1j * torque.x) / self.radius) / (self.mass * (1 + self.inertia_ratio))
        return flat, force.z, driven, torque.z

    @property
    def impossible_events(self) -> frozenset[str]:  # type: ignore[override]
        """It cannot lift off where nothing varies along the normal."""
        steady = all(load.constant or load.linear_drag is not None for load in self.loads)
        return frozenset({"lift"} if steady else ())

    def max_rate(self, duration: float) -> float:
        """Return the fastest rate of the plane, of drag, and of what the pieces of the quadrature resolve, 1/s."""
        return max((pace for _, pace in self.max_rates(duration)), default=0.0)

    def max_rates(self, duration: float) -> list[tuple[float, float]]:
        """Return the same for each piece: near a pole of a rate or load the last are far shorter than the first."""
        self._course.reach(duration)
        phase = 1 + 1 / float(self.share)  # rad by which the plane turns on a piece, at most, and what changes besides
        ends = [(b, phase / (b - a) + float(self.gamma)) for a, b in pairwise(self._course.edges) if a < duration]
        return [(min(b, duration), pace) for b, pace in ends]

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> from trundle.mechanics.motions import UnevenSpin
        >>> ball = SphereOnUnsteadyPlane(0.025, 0.065, 0.4, UnevenSpin(3.5, 0.2, 1.0), (0.1, 0.0))
        >>> round(float(ball.motion_at(0.0)[2].x), 12)  # ω x/a
        14.0
        """
        if not is_one(self):
            return one_by_one(self, t)
        course = self._precise if _is_mpmath(t) else self._course
        course.reach(t)
        (omega, omega_rate), (flat, normal, push, _) = self.rates(t), self.pushes(t)
        zeta, V, turned = course.at(t, omega)
        m, a, growth = self.mass, self.radius, 1j * (self.share * omega) - self.gamma
        A = 1j * (self.share * omega_rate) * zeta + growth * V + push
        Omega, R = (1j * V + omega * zeta) / a, m * A - flat + self.drag * V
        zero = 0 * zeta.real
        spin = self.spin + turned / (self.inertia_ratio * m * a * a)
        return (
            Vector(zeta.real, zeta.imag, a + zero),
            Vector(V.real, V.imag, zero),
            Vector(Omega.real, Omega.imag, spin),
            Vector(R.real, R.imag, zero - normal),
        )

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:
        """Return the coordinates of the plane's own motion: of `SpinBy` the angle turned through, rad."""
        if not self.motion.coordinates:
            return ()
        self._course.reach(t)
        return (self._course.swept_at(t),)

    def position_at(self, t: Any) -> Vector:
        """Return the centre in the inertial support frame, m, at a time since the start, s."""
        return self.motion_at(t)[0]

    @cached_property
    def _course(self) -> Course:
        return Course(self)

    @cached_property
    def _precise(self) -> PreciseCourse:
        return PreciseCourse(self)

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:
        """Return its equation of motion."""
        shown = rf"\kappa(t) = {number(self.share)}\,\omega(t)"
        if system.loads or float(system.support.tilt):
            return [(r"\frac{d}{dt}\big[\dot\zeta - (i\kappa - \gamma)\,\zeta\big] = \varphi(t)", shown)]
        return [(r"\dot\zeta - i\kappa(t)\,\zeta = M,\quad \kappa = \frac{k}{1+k}\,\omega(t)", shown)]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare M = ζ̇ − iκζ of the start with that of the samples, where no load changes it."""
        if seen.system.loads or float(seen.system.support.tilt):
            return
        rate, share = seen.at.support(seen.system).angular_velocity.z, float(self.share)
        velocity = seen.at.velocity[:, 0] + 1j * seen.at.velocity[:, 1]
        kept = velocity - 1j * share * np.broadcast_to(rate, seen.time.shape) * seen.zeta
        at_start = float(self.motion.at(float(self.start_time), *self.motion.initial_coordinates()).angular_velocity.z)
        predicted = abs(complex(*self.velocity) - 1j * share * at_start * complex(*self.position))
        worst = float(np.abs(kept)[np.argmax(np.abs(np.abs(kept) - predicted))])
        name, symbol = "Velocity less its share of the table's", r"|\dot\zeta - i\kappa\zeta|"
        size, note = max(float(np.max(np.abs(velocity))), predicted), "stays as it is, however the table is turned"
        yield Finding(name, symbol, predicted, worst, "m/s", note=note, scale=size)


def _is_mpmath(t: Any) -> bool:
    return type(t).__module__.partition(".")[0] == "mpmath"
