"""T12: a ball that rolls along a great circle of a bowl or dome: the pendulum of T6, until the support lets it go."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...mechanics.algebra import E_X, E_Y, E_Z, Vector
from ...mechanics.duals import value_of
from ...mechanics.scalars import Scalar
from ...mechanics.surfaces import Bowl, Dome
from ...mechanics.system import RollingSystem, State
from ..samples import FLIGHT, ROLLING
from .base import ClosedForm
from .cylinder_on_cylinder import CylinderOnCylinder, angles
from .domain import AT_REST, CONSTANT_LOADS, NO_TORQUE, SPHERE, START, Condition, constant_forces, on
from .finding import Finding
from .fits import BEGINS_TO_SLIP, COMES_OFF, Array, Seen, angle_where
from .formula import Lines, decimal, quantity
from .off_a_dome import OffADome

_ASIDE = 1e-12  # share of the motion that may lead out of the plane by rounding
_ROUNDING = 16 * sys.float_info.epsilon


def _aside(system: RollingSystem, start: State) -> Iterator[str]:
    surface: Any = system.support.surface
    arm = Vector(*start.position) + E_Z * (surface.sign * surface.radius)
    V, Omega, force = Vector(*start.velocity), Vector(*start.angular_velocity), constant_forces(system)[0]
    n, a = arm / arm.norm(), system.body.radius
    lever, speed = arm.cross(force), max(V.norm(), a * Omega.norm())
    # Near the top and the bottom the way aside is small or not beside the swing, not beside the sphere.
    heavy = (1 + system.body.inertia_ratio) * system.body.mass * arm.norm()
    swing = max(lever.norm(), speed * math.sqrt(force.norm() * heavy))
    if abs(lever.dot(V)) > _ASIDE * speed * swing + _rounding(arm, force) * speed:
        yield "the start moves out of the plane of the pull"
    elif a * abs(Omega.dot(n)) > _ASIDE * speed:
        yield "the start spins about the normal"
    elif speed == 0 and lever.norm() <= _rounding(arm, force) and arm.dot(force) < 0:
        yield "the start balances on the top, where a rounding would decide which way it falls"


@dataclass(frozen=True)
class SphereOnSphere(ClosedForm):
    """The motion (1 + k) ℓ θ̈ = −(G/m) sin θ in the plane of a great circle, θ from the pull G (T12).

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²).
    track_radius : float or array
        b of the bowl or dome, m.
    side : float or array
        +1 on a dome, −1 in a bowl: ℓ = b + side·a.
    angle, angular_rate : float or array
        θ and θ̇ of the centre at t = 0, rad and rad/s, from `first` towards `second`.
    pull : float or array
        G, weight included, N.
    position : triple of float or array
        Of the centre at t = 0, m: what it goes from there is added, so that a small way on a large sphere is exact.
    first, second : triple of float or array
        Unit vectors in the plane of the circle, the first along G.
    from_top : float or array
        As for `CylinderOnCylinder`.

    Examples
    --------
    A ball that leaves the top of a dome at rest is let go where cos = 2/(3 + k), for a solid one 10/17:

    >>> top, down, along = (0.0, 0.0, 0.1), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)
    >>> ball = SphereOnSphere(0.1, 1.0, 0.4, 0.9, 1.0, math.pi, 0.0, 9.80665, top, down, along)
    >>> round(ball.lift_cosine * 17, 12)
    10.0
    """

    radius: Scalar
    mass: Scalar
    inertia_ratio: Scalar
    track_radius: Scalar
    side: Scalar
    angle: Scalar
    angular_rate: Scalar
    pull: Scalar
    position: tuple[Scalar, Scalar, Scalar]
    first: tuple[Scalar, Scalar, Scalar]
    second: tuple[Scalar, Scalar, Scalar]
    from_top: Scalar = math.nan

    name = "ball in a great circle of a bowl or dome"
    equation = "T12"
    source = "Abramowitz and Stegun (1964), ch. 16, for the pendulum; theory page, T12"
    conditions = (
        SPHERE,
        on(Bowl, Dome),
        AT_REST,
        CONSTANT_LOADS,
        NO_TORQUE,
        Condition(", in the plane of a great circle that the force lies in, without spin out of it", _aside, START),
    )
    impossible_events = frozenset({"curved"})

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SphereOnSphere:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> dome = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Dome(0.9)))
        >>> round(SphereOnSphere.of(dome, dome.place(velocity=(1.0, 0.0))).lift_cosine, 6)  # (2 + 1.4 v²/(g ℓ))/3.4
        0.630224
        """
        cls.check_domain(system, start)
        surface: Any = system.support.surface
        a, b, side = system.body.radius, surface.radius, surface.sign
        arm, V = Vector(*start.position) + E_Z * (side * b), Vector(*start.velocity)
        force, _ = constant_forces(system)
        G, length = force.norm(), b + side * a
        first = force / G if G else arm / arm.norm()
        across = _plane(arm, V, first)
        second = across.cross(first)
        angle, from_top = angles(arm.dot(first), arm.dot(second))
        return cls(
            radius=a,
            mass=system.body.mass,
            inertia_ratio=system.body.inertia_ratio,
            track_radius=b,
            side=side,
            angle=angle,
            angular_rate=arm.cross(V).dot(across) / (arm.norm() * length),
            pull=G,
            position=start.position,
            first=tuple(first),
            second=tuple(second),
            from_top=from_top,
        )

    # The constants of the motion

    @property
    def length(self) -> Scalar:
        """ℓ = b + side·a, of the centre from the sphere's, m."""
        return self.track_radius + self.side * self.radius

    @cached_property
    def pendulum(self) -> CylinderOnCylinder:
        """The same motion in its plane."""
        return CylinderOnCylinder(
            self.radius, self.mass, self.inertia_ratio, self.track_radius, self.side, 0.0 * self.side,
            self.angle, self.angular_rate, 0.0 * self.side, (self.pull, 0.0 * self.pull), self.from_top,
        )  # fmt: skip

    @property
    def lift_cosine(self) -> Any:
        """Cosine of the angle from the top at which a dome lets the ball go."""
        return self.pendulum.lift_cosine

    @property
    def period(self) -> Any:
        """Of the motion, s; infinite at rest and on the separatrix."""
        return self.pendulum.period

    def max_rate(self, duration: float) -> float:
        """Return that of the pendulum, 1/s."""
        return self.pendulum.max_rate(duration)

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> low, down, along = (0.0, 0.0, 0.1), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)
        >>> bowl = SphereOnSphere(0.1, 1.0, 0.4, 0.6, -1.0, 0.0, 0.0, 9.8, low, down, along)
        >>> [part + 0.0 for part in bowl.motion_at(2.0)[3]]
        [0.0, 0.0, 9.8]
        """
        first, second = Vector(*self.first), Vector(*self.second)
        across = first.cross(second)
        _, V, Omega, R = self.pendulum.motion_at(t)
        return (
            Vector(*self.position) + self._way(t),
            first * V.x + second * V.y,
            across * Omega.z,
            first * R.x + second * R.y,
        )

    def _way(self, t: Any) -> Vector:
        """Return how far the centre has gone since the start: its first arm, turned, less itself."""
        first, second, c = Vector(*self.first), Vector(*self.second), self.pendulum._constants
        sine, cosine = c.sense * c.sine, c.cosine
        straight, across = (cosine - sine) * (cosine + sine), 2 * sine * cosine
        out, around = first * straight + second * across, second * straight - first * across
        sine, cosine, _ = self.pendulum.gone_at(t)
        return (around * cosine - out * sine) * (2 * self.length * sine)

    def fixed_axis_rotation(self, t: Any) -> tuple[Vector, Any]:
        """Return the axis and the angle by which the ball has turned: from its place alone."""
        return Vector(*self.first).cross(Vector(*self.second)), self.pendulum.fixed_axis_rotation(t)[1]

    # What is shown

    def _off_the_top(self, friction: Any) -> OffADome:
        """As if it had started on the top, with the energy that it has."""
        k, above = float(self.inertia_ratio), -math.cos(float(self.angle))
        speed = float(self.mass) * float(self.length) * float(self.angular_rate) ** 2 / float(self.pull)
        return OffADome(k, float(friction), speed - 2 * (1 - above) / (1 + k))

    def formulas(self, system: RollingSystem) -> Lines:
        """Return the pendulum in a bowl, and where a dome lets the ball go or slip."""
        if self.side < 0:
            return self.pendulum.formulas(system)
        friction = system.support.friction
        if friction is not None:
            slips = quantity(math.degrees(self._off_the_top(friction).slips_at), "deg")
            formula = (
                r"(3+k)\,\mu\cos\theta_s - k\sin\theta_s = \mu\,\big[2\cos\theta_0 + (1+k)\,\ell\dot\theta_0^2/g\big]"
            )
            return [(formula, rf"\mu = {decimal(friction)},\quad \theta_s = {slips}")]
        cosine = float(self.lift_cosine)
        formula = r"\cos\theta_l = \frac{2\cos\theta_0 + (1+k)\,\ell\dot\theta_0^2/g}{3+k}"
        angle = rf",\quad \theta_l = {quantity(math.degrees(math.acos(cosine)), 'deg')}" if abs(cosine) <= 1 else ""
        return [(formula, rf"\cos\theta_l = {decimal(cosine)}{angle}")]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare the pendulum, or where a dome lets the ball slip and go."""
        leaves = any(event.kind in ("slip", "lift") for event in seen.samples.events)
        if not leaves:
            yield from self.pendulum.swinging(seen, self._from_pull(seen.at.position))
        if self.side < 0 or not leaves:
            return
        from_top, support = np.abs(np.abs(self._from_pull(seen.samples.position)) - math.pi), seen.system.support
        if support.friction is None:
            yield from self.pendulum.coming_off(seen, from_top)
        elif support.kinetic_friction in (None, support.friction):
            yield from self._giving_way(self._off_the_top(support.friction), seen, from_top)

    def _giving_way(self, dome: OffADome, seen: Seen, from_top: Array) -> Iterator[Finding]:
        """Compare where friction gives way, and where the normal force has gone, with T12b and T12c."""
        time, phase, (normal, along) = seen.samples.time, seen.samples.phase, seen.forces
        rolls = slice(0, int(np.argmax(phase != ROLLING)))
        room = dome.friction * normal - along
        yield angle_where(BEGINS_TO_SLIP, dome.slips_at, time[rolls], from_top[rolls], room[rolls])
        flying = phase == FLIGHT
        if flying.any():
            part = slice(rolls.stop, int(np.argmax(flying)))
            yield angle_where(COMES_OFF, dome.lifts_at, time[part], from_top[part], normal[part])

    def _from_pull(self, position: Array) -> Array:
        """Return the angle of the centre along its great circle from the direction of the pull, rad."""
        arm = position - np.array([0.0, 0.0, -float(self.side) * float(self.track_radius)])
        first, second = (np.array([float(part) for part in axis]) for axis in (self.first, self.second))
        return np.asarray(np.unwrap(np.arctan2(arm @ second, arm @ first)))


def _plane(arm: Vector, V: Vector, first: Vector) -> Vector:
    """Return the unit normal of the plane in which it moves: of arm and velocity, of pull and arm, or any."""
    out = arm / arm.norm()
    if V.norm():
        normal = out.cross(V)
    else:
        least = min((E_X, E_Y, E_Z), key=lambda e: abs(e.dot(first)))
        normal = first.cross(out)
        normal = normal if normal.norm() > _rounding(first, out) else first.cross(least)
    straight = normal - first * normal.dot(first)
    return straight / straight.norm()


def _rounding(a: Vector, b: Vector) -> float:
    """Return how large a cross product may be that is nothing but rounding: by the size of what it subtracts."""
    (ax, ay, az), (bx, by, bz) = (tuple(abs(value_of(part)) for part in one) for one in (a, b))
    return _ROUNDING * float(Vector(ay * bz + az * by, az * bx + ax * bz, ax * by + ay * bx).norm())
