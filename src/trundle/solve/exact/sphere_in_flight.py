"""T11a: a sphere in flight under constant loads: a parabola, and the instant at which it lands."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...mechanics.algebra import Vector
from ...mechanics.motions import FreeAxle
from ...mechanics.scalars import Scalar, is_number, is_zero, namespace
from ...mechanics.surfaces import Bowl, Cylinder, Dome, Plane
from ...mechanics.system import RollingSystem, State
from ..samples import FLIGHT
from .base import ClosedForm
from .domain import CONSTANT_LOADS, ROUND, TURNING_SO_OR_SO, constant_forces, on
from .finding import Finding
from .fits import Seen
from .formula import Lines, quantity

# Shares of their sizes below which the gap, its rate and its curvature at the start are rounding: a flight begins
# where the support lets go, with all three 0, or after a bounce, with a rate.
_NOTHING = (1e-12, 1e-12, 1e-9)


@dataclass(frozen=True)
class SphereInFlight(ClosedForm):
    """The motion r = r₀ + V₀t + (F/m)t²/2, Ω = Ω₀ + K t/(k m a²) (T11a), which lands at the root of a polynomial.

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²).
    position, velocity : triple of float or array
        Centre at t = 0, m and m/s.
    angular_velocity : triple of float or array
        Ω at t = 0, rad/s.
    force, torque : triple of float or array
        Constant, weight included, N and N m.
    across : triple of float
        1 or 0 for each axis along which the distance from the support is measured: of a plane the third.
    middle : triple of float
        From where: the centre of a bowl, m.
    distance : float
        At which it touches: a over a plane, b + a from the axis of a cylinder when outside, b − a when inside, m.
    side : float
        +1 where it may be no nearer, −1 where it may be no further away.
    axle_rate : float, optional
        Of a support on a free axle, rad/s; absent for any other.

    Examples
    --------
    >>> ball = SphereInFlight(0.1, 1.0, 0.4, (0.0, 0.0, 5.1), (2.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, -10.0))
    >>> ball.ends_at["land"], ball.motion_at(1.0)[0]
    (1.0, Vector(x=2.0, y=0.0, z=0.09999999999999964))
    """

    radius: Scalar
    mass: Scalar
    inertia_ratio: Scalar
    position: tuple[Scalar, Scalar, Scalar]
    velocity: tuple[Scalar, Scalar, Scalar]
    angular_velocity: tuple[Scalar, Scalar, Scalar]
    force: tuple[Scalar, Scalar, Scalar] = (0.0, 0.0, 0.0)
    torque: tuple[Scalar, Scalar, Scalar] = (0.0, 0.0, 0.0)
    across: tuple[float, float, float] = (0.0, 0.0, 1.0)
    middle: tuple[Scalar, Scalar, Scalar] = (0.0, 0.0, 0.0)
    distance: Scalar | None = None
    side: float = 1.0
    axle_rate: Scalar | None = None

    name = "sphere in flight"
    equation = "T11a"
    source = "Galilei, Discorsi (1638), fourth day; theory page, T11"
    conditions = (ROUND, on(Plane, Cylinder, Bowl, Dome), TURNING_SO_OR_SO, CONSTANT_LOADS)
    phases = (FLIGHT,)
    of_arrays = True
    impossible_events = frozenset({"curved"})

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SphereInFlight:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> floor = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()), gravity=10.0)
        >>> round(SphereInFlight.of(floor, floor.place(height=0.2)).ends_at["land"], 12)
        0.2
        """
        cls.check_domain(system, start)
        force, torque = constant_forces(system)
        surface: Any = system.support.surface
        a = system.body.radius
        across, middle, distance, side = (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), a, 1.0
        if not isinstance(surface, Plane):
            side = surface.sign
            distance = surface.radius + side * a
            across = (1.0, 1.0, 0.0) if isinstance(surface, Cylinder) else (1.0, 1.0, 1.0)
            middle = middle if isinstance(surface, Cylinder) else (0.0, 0.0, -side * surface.radius)
        return cls(
            radius=a,
            mass=system.body.mass,
            inertia_ratio=system.body.inertia_ratio,
            position=start.position,
            velocity=start.velocity,
            angular_velocity=start.angular_velocity,
            force=tuple(force),
            torque=tuple(torque),
            across=across,
            middle=middle,
            distance=distance,
            side=side,
            axle_rate=start.support[1] if isinstance(system.support.motion, FreeAxle) else None,
        )

    @property
    def period(self) -> float:
        """Infinite: it never comes back."""
        return math.inf

    def max_rate(self, duration: float) -> float:
        """Return the rate at which the place changes over its distance, 1/s."""
        speeds = [abs(v) + abs(f) * duration / self.mass for v, f in zip(self.velocity, self.force, strict=True)]
        return max(speeds) / float(self.radius if self.distance is None else self.distance)

    @cached_property
    def ends_at(self) -> dict[str, float]:
        """When it lands, s: the first root of the distance, a polynomial, at which that falls to where it touches."""
        f = self._gap()
        largest = max(map(abs, f))
        if largest == 0:
            return {"land": math.inf}
        f = [part / largest for part in f]
        while f[0] == 0:
            f = f[1:]
        if f[0] < 0:  # it presses on the support
            return {"land": 0.0}
        found = [_polished(f, t) for t in _real_roots(f) if t > 0]
        crossed = [t for t in found if _value_and_slope(f, t)[1] <= 0]
        return {"land": crossed[0] if crossed else math.inf}

    def _gap(self) -> list[float]:
        """Return the coefficients of a polynomial of the time that has the sign of the gap, constant first."""
        place = Vector(*self.position) - Vector(*self.middle)
        r, V, A = map(self._across, (place, Vector(*self.velocity), Vector(*self.force) / self.mass))
        ell = float(self.radius if self.distance is None else self.distance)
        # A body that stands still where a support turns under it has a velocity of what rounding leaves of Ω×ρ.
        speed = max(Vector(*self.velocity).norm(), self.radius * Vector(*self.angular_velocity).norm())
        if sum(self.across) == 1:
            f = [sum(r) - ell, sum(V), 0.5 * sum(A)]
            sizes = [ell, speed, 0.0]
        else:
            f = [r.dot(r) - ell * ell, 2 * r.dot(V), V.dot(V) + r.dot(A), A.dot(V), 0.25 * A.dot(A)]
            f = [part * self.side for part in f]
            sizes = [ell * ell, ell * speed, V.dot(V) + ell * A.norm()]
        for i, (share, size) in enumerate(zip(_NOTHING, sizes, strict=True)):
            if abs(f[i]) > share * size:
                break
            f[i] = 0.0
        return f

    def _across(self, v: Vector) -> Vector:
        """Return the part of a vector across the support, of floats."""
        x, y, z = self.across
        return Vector(float(v.x) * x, float(v.y) * y, float(v.z) * z)

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> SphereInFlight(0.1, 1.0, 0.4, (0.0, 0.0, 1.0), (0.0, 0.0, 3.0), (0.0, 1.0, 0.0)).motion_at(2.0)[0].z
        7.0
        """
        zero = 0 * t
        A, V0 = Vector(*self.force) / self.mass, Vector(*self.velocity)
        turned = Vector(*self.torque) / (self.inertia_ratio * self.mass * self.radius * self.radius)
        nothing = Vector(zero, zero, zero)
        return (
            Vector(*self.position) + V0 * t + A * (0.5 * t * t),
            V0 + A * t,
            Vector(*self.angular_velocity) + turned * t,
            nothing,
        )

    def support_coordinates_at(self, t: Any) -> tuple[Any, ...]:
        """Return by how much angle and rate of a free axle grow: nothing touches it."""
        return () if self.axle_rate is None else (self.axle_rate * t, 0 * t)

    def fixed_axis_rotation(self, t: Any) -> tuple[Vector, Any] | None:
        """Return the axis and the angle by which it has turned, where Ω keeps its direction."""
        parts = (*self.angular_velocity, *self.torque)
        if not all(map(is_number, parts)) or not all(is_zero(part) for part in self.torque):
            return None
        Omega = Vector(*self.angular_velocity)
        size = namespace(Omega.x).sqrt(Omega.dot(Omega))
        return (Omega / size, size * t) if size else (Vector(0.0, 0.0, 1.0), 0 * t)

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return the parabola, and when it lands."""
        lands = float(self.ends_at.get("land", math.inf))
        shown = rf"t_l = {quantity(lands, 's')}" if math.isfinite(lands) else ""
        return [(r"r = r_0 + V_0\,t + \frac{F}{2m}\,t^2", shown)]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare when and where it lands on a plane; measured by the parabola of the samples."""
        predicted = float(self.ends_at.get("land", math.inf))
        landed = seen.time.size < seen.samples.time.size
        if not (math.isfinite(predicted) and landed) or tuple(self.across) != (0.0, 0.0, 1.0):
            return
        course = np.polynomial.polynomial.polyfit(seen.time, seen.at.position, 2)
        heights = course[:, 2] - np.array([float(self.radius), 0.0, 0.0])
        lands = float(np.max(np.polynomial.polynomial.polyroots(heights).real))
        note = "by the parabola through its heights"
        yield Finding("Time at which it lands", "t_l", predicted, lands, "s", note=note, said="lands after {}")
        ahead = self.motion_at(predicted)[0]
        way = math.hypot(float(ahead.x) - float(self.position[0]), float(ahead.y) - float(self.position[1]))
        if way:
            there = np.asarray(np.polynomial.polynomial.polyval(lands, course[:, :2]))
            gone = float(np.linalg.norm(there - seen.samples.position[0, :2]))
            yield Finding("Distance to there", "d_l", way, gone, "m")


def _real_roots(f: list[float]) -> list[float]:
    """Return about where a polynomial, constant first, is 0, ascending; a double root once or twice."""
    if not any(f[2:]):  # so after each bounce: it leaves where it is to come back
        return [-f[0] / f[1]] if any(f[1:]) else []
    roots = np.roots(f[::-1])
    return sorted(roots[np.abs(roots.imag) <= 1e-7 * np.abs(roots)].real.tolist())


def _polished(f: list[float], t: float) -> float:
    """Return a root of a polynomial, constant first, to the last digit by Newton's steps."""
    for _ in range(4):
        value, rate = _value_and_slope(f, t)
        if rate == 0:
            break
        t -= value / rate
    return t


def _value_and_slope(f: list[float], t: float) -> tuple[float, float]:
    """Return what a polynomial, constant first, and its derivative are at a time, by Horner's rule."""
    value, slope = 0.0, 0.0
    for coefficient in reversed(f):
        value, slope = value * t + coefficient, slope * t + value
    return value, slope
