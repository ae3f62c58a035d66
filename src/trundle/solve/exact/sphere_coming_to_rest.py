"""T14: a sphere that rolls straight on a level plane and is braked: by rolling resistance, by air, by a couple."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...mechanics.algebra import Vector
from ...mechanics.loads import Drag, QuadraticDrag, RollingCouple, RollingResistance
from ...mechanics.loads.air import STILL
from ...mechanics.scalars import Scalar, is_number, is_zero, namespace
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from ..samples import RESTING, ROLLING
from .base import ClosedForm
from .domain import ALONG_NORMAL, AT_REST, PRESSED, RESISTANCES, ROUND, STILL_AIR, constant_forces, on, under
from .finding import Finding
from .fits import Seen, zero_ahead
from .formula import Lines, quantity
from .second_order import fundamental


@dataclass(frozen=True)
class SphereComingToRest(ClosedForm):
    """The motion of v̇ = −(r + γv + ηv²) along a line, from v₀ to rest where it stops (T14b).

    r = δN/(a m(1 + k)) is rolling resistance, γ = (c + c_r/a²)/(m(1 + k)) linear drag and the viscous couple,
    η = c₂/(m(1 + k)) quadratic drag. With y = v₀G − r∫G, ÿ = −γẏ − rηy, the way is ln(1 + ηy)/η and v = ẏ/(1 + ηy).
    Every number may be a float, or an array of members.

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²).
    position, velocity : pair of float or array
        Centre at t = 0 over the plane, m and m/s.
    spin : float or array
        Ω·n at t = 0, rad/s.
    normal_force : float or array
        N, N.
    offset : float or array
        δ of rolling resistance, m.
    drag, quadratic_drag : float or array
        c, kg/s, and c₂, kg/m.
    couple, pivot_couple : float or array
        c_r across the normal and along it, N m s.

    Examples
    --------
    A solid ball on felt, 3 m/s and δ = 0.35 mm: it is slowed by (5/7) g δ/a.

    >>> ball = SphereComingToRest(0.0286, 0.17, 0.4, (0.0, 0.0), (3.0, 0.0), 0.0, 0.17 * 9.80665, 0.00035)
    >>> round(float(ball.stops_at) * (5 / 7) * 9.80665 * 0.00035 / 0.0286, 12)
    3.0
    >>> round(ball.way / (3.0 * float(ball.stops_at) / 2), 12)
    1.0
    """

    radius: Scalar
    mass: Scalar
    inertia_ratio: Scalar
    position: tuple[Scalar, Scalar]
    velocity: tuple[Scalar, Scalar]
    spin: Scalar = 0.0
    normal_force: Scalar = 0.0
    offset: Scalar = 0.0
    drag: Scalar = 0.0
    quadratic_drag: Scalar = 0.0
    couple: Scalar = 0.0
    pivot_couple: Scalar = 0.0

    name = "sphere coming to rest on a level plane"
    equation = "T14b"
    source = "theory page, T14; rolling resistance as in Landau and Lifshitz, Mechanics (1976), section 38, with drag"
    conditions = (
        ROUND,
        on(Plane),
        AT_REST,
        under(
            ", under rolling resistance, linear and quadratic drag, a viscous couple, gravity and constant forces",
            "no resistance of this kind",
            *RESISTANCES,
        ),
        ALONG_NORMAL,
        STILL_AIR,
        PRESSED,
    )

    phases = (ROLLING, RESTING)
    impossible_events = frozenset({"lift", "start"})  # N is constant, and nothing drives it

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SphereComingToRest:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> felt = [tr.RollingResistance("0.35 mm")]
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.0286, 0.17), tr.Support(tr.Plane()), felt)
        >>> round(SphereComingToRest.of(system, system.place(velocity=(3.0, 0.0))).way, 3)
        52.495
        """
        cls.check_domain(system, start)
        force, _ = constant_forces(system)

        def total(kind: type, name: str) -> Any:
            return sum((getattr(load, name) for load in system.loads if isinstance(load, kind)), 0.0)

        couples = [load for load in system.loads if isinstance(load, RollingCouple)]
        pivots = [c.coefficient if c.pivot_coefficient is None else c.pivot_coefficient for c in couples]
        return cls(
            radius=system.body.radius,
            mass=system.body.mass,
            inertia_ratio=system.body.inertia_ratio,
            position=start.position[:2],
            velocity=start.velocity[:2],
            spin=start.angular_velocity[2],
            normal_force=-force.z,
            offset=total(RollingResistance, "offset"),
            drag=total(Drag, "coefficient"),
            quadratic_drag=total(QuadraticDrag, "coefficient"),
            couple=total(RollingCouple, "coefficient"),
            pivot_couple=sum(pivots, 0.0),
        )

    # The constants of the motion

    @property
    def _heavy(self) -> Scalar:
        return self.mass * (1 + self.inertia_ratio)

    @property
    def eta(self) -> Scalar:
        """η = c₂/(m(1 + k)), 1/m."""
        return self.quadratic_drag / self._heavy

    @property
    def gamma(self) -> Scalar:
        """γ = (c + c_r/a²)/(m(1 + k)), 1/s."""
        return (self.drag + self.couple / (self.radius * self.radius)) / self._heavy

    @property
    def deceleration(self) -> Scalar:
        """r, by which resistance slows the ball at any speed, m/s².

        Quadratic drag is given as c₂v√(v² + v₀²) with a very small v₀, which is c₂(v² + v₀²/2) but for v₀⁴/(8v²).
        """
        resistance = self.offset * self.normal_force / (self.radius * self._heavy)
        return resistance + 0.5 * STILL * STILL * self.eta

    @property
    def kappa(self) -> float:
        """0: nothing turns its way, rad/s."""
        return 0.0

    @property
    def speed(self) -> Any:
        """v₀ at t = 0, m/s."""
        vx, vy = self.velocity
        return np.hypot(vx, vy)

    @property
    def stops_at(self) -> Any:
        """Time at which it comes to rest, s; infinite without rolling resistance, which alone stops it."""
        ends = (np.asarray(self.offset * self.normal_force) > 0) | (np.asarray(self.speed) == 0)
        return np.where(ends, self._end, np.inf)[()]

    @property
    def _end(self) -> Any:
        """Time up to which the formula holds, s."""
        r, v0, gamma = (np.asarray(part, dtype=float) for part in (self.deceleration, self.speed, self.gamma))
        still, never = v0 == 0, r == 0
        v, push = np.where(still, 1.0, v0), np.where(never, 1.0, r)
        # ẏ = 0 where w cot wt = q with q = r/v₀ + γ/2 and w² = rη − γ²/4.
        q, square = push / v + 0.5 * gamma, push * self.eta - 0.25 * gamma * gamma
        w, u = np.sqrt(np.maximum(square, 0.0)), np.sqrt(np.maximum(-square, 0.0))
        small = np.abs(square) < 1e-3 * q * q
        s = np.where(small, square / (q * q), 0.0)
        series = sum((-s) ** n / (2 * n + 1) for n in range(6)) / q
        short = push * (push / v + gamma + self.eta * v) / v / (q + u)  # q − u, of which q and u have lost the digits
        grown = np.log1p(2 * u / short) / (2 * np.where(u > 0, u, 1.0))
        time = np.where(small, series, np.where(square > 0, np.arctan2(w, q) / np.where(w > 0, w, 1.0), grown))
        return np.where(still, 0.0, np.where(never, np.inf, time))[()]

    @property
    def way(self) -> Any:
        """Way to where it comes to rest, m; infinite where it rolls on for ever."""
        if not is_number(self.stops_at):
            raise NotImplementedError
        if math.isfinite(self.stops_at):
            return float(self._along(self.stops_at)[0])
        if self.gamma == 0:
            return math.inf
        ratio = self.eta * self.speed / self.gamma
        return float(self.speed / self.gamma * (math.log1p(ratio) / ratio if ratio else 1.0))

    @property
    def period(self) -> float:
        """Infinite: it comes to rest."""
        return math.inf

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return how fast it slows down at first, 1/s."""
        v = float(self.speed)
        return float(self.gamma + self.eta * v + (self.deceleration / v if v else 0.0))

    @property
    def ends_at(self) -> dict[str, float]:
        """It stops where resistance stops it, and then for good."""
        return {"stop": float(self.stops_at)}

    # The motion

    def _along(self, t: Any) -> tuple[Any, Any, Any]:
        """Return the way, the speed and the rate of the speed."""
        r, eta = self.deceleration, self.eta
        xp, stop = namespace(t), self._end
        rolls = t < stop
        if hasattr(xp, "exact"):
            base = fundamental(-self.gamma, -r * eta, t if rolls else xp.sqrt(stop * stop + 0 * t))
        else:
            base = fundamental(-self.gamma, -r * eta, np.minimum(t, stop))
        y, y_rate = (
            (self.speed * first - r * second).real for first, second in ((base.G, base.H), (base.G_rate, base.G))
        )
        z = eta * y
        xp = namespace(y) if hasattr(xp, "exact") else np
        way = y * _log_share(z)
        speed = xp.where(rolls, y_rate / (1 + z), 0 * y)
        rate = xp.where(rolls, -(r + (self.gamma + eta * speed) * speed), 0 * y)
        return way, speed, rate

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> ball = SphereComingToRest(0.0286, 0.17, 0.4, (0.0, 0.0), (3.0, 0.0), 0.0, 1.667, 0.00035)
        >>> [float(part) for part in ball.motion_at(1000.0)[1]]  # it has come to rest
        [0.0, 0.0, 0.0]
        """
        way, speed, rate = self._along(t)
        along, a = self._direction, self.radius
        friction = self.mass * rate + (self.drag + self.quadratic_drag * _smoothed(speed)) * speed
        zero = 0 * way
        moment = self.inertia_ratio * self.mass * a * a
        spin = (
            self.spin - self.pivot_couple * self.spin / moment * fundamental(-self.pivot_couple / moment, 0.0, t).G.real
        )
        x, y = self.position
        return (
            Vector(x + along[0] * way, y + along[1] * way, a + zero),
            Vector(along[0] * speed, along[1] * speed, zero),
            Vector(-along[1] * speed / a, along[0] * speed / a, spin + zero),
            Vector(along[0] * friction, along[1] * friction, self.normal_force + zero),
        )

    def position_at(self, t: Any) -> Vector:
        """Return the centre in the inertial support frame, m, at a time since the start, s."""
        return self.motion_at(t)[0]

    @property
    def _direction(self) -> tuple[Any, Any]:
        v0, (vx, vy) = np.asarray(self.speed), self.velocity
        size = np.where(v0 > 0, v0, 1.0)
        return np.where(v0 > 0, vx / size, 1.0)[()], (vy / size)[()]

    def fixed_axis_rotation(self, t: Any) -> tuple[Vector, Any] | None:
        """Return the axis and the angle x/a by which the ball has turned, where it does not spin besides."""
        if not is_zero(self.spin) or not all(map(is_number, self.velocity)):
            return None
        x, y = self._direction
        return Vector(-y, x, 0.0), self._along(t)[0] / self.radius

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return what slows it, and when it stops."""
        parts = (("r", self.deceleration, "m/s^2"), (r"\gamma", self.gamma, "1/s"), (r"\eta", self.eta, "1/m"))
        shown = r",\quad ".join(f"{name} = {quantity(value, unit)}" for name, value, unit in parts if float(value))
        lines = [(r"\dot v = -(r + \gamma v + \eta v^2)", shown)]
        if math.isfinite(float(self.stops_at)):
            lines.append((r"v(t_s) = 0", rf"t_s = {quantity(self.stops_at, 's')}"))
        return lines

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare when and where it comes to rest, or how it slows."""
        samples, predicted = seen.samples, float(self.stops_at)
        rolls = samples.phase == ROLLING
        count = int(np.argmin(rolls)) if not rolls.all() else rolls.size
        part = samples.part(slice(0, count))
        time = part.time - samples.time[0]
        speed = np.hypot(part.velocity[:, 0], part.velocity[:, 1])
        if math.isfinite(predicted) and count < rolls.size:
            stops, note = zero_ahead(time, speed), "where its speed, drawn on, ends"
            yield Finding(
                "Time at which it stops", "t_s", predicted, stops, "s", note=note, said="comes to rest after {}"
            )
            gone = float(np.linalg.norm(samples.position[-1, :2] - samples.position[0, :2]))
            yield Finding("Way to there", "d_s", float(self.way), gone, "m")
        elif count > 3:
            at_start = float(self.deceleration + self.gamma * self.speed + self.eta * self.speed**2)
            slowed = -float(np.gradient(speed[:3], time[:3], edge_order=2)[0])
            note = "by the first three samples"
            yield Finding("Deceleration at the start", r"-\dot v_0", at_start, slowed, "m/s²", note=note)


def _log_share(z: Any) -> Any:
    """Return ln(1 + z)/z, 1 at 0."""
    if type(z).__module__.partition(".")[0] == "mpmath":
        import mpmath

        return mpmath.log1p(z) / z if z else mpmath.mpf(1)
    return np.where(z == 0, 1.0, np.log1p(z) / np.where(z == 0, 1.0, z))[()]


def _smoothed(speed: Any) -> Any:
    square = speed * speed + STILL * STILL
    return namespace(square).sqrt(square)
