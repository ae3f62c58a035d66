"""T8: a ball that rolls round and along a cylinder at any angle to gravity, above all one that lies level."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...mechanics.algebra import E_Z, Vector
from ...mechanics.scalars import Scalar, namespace
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .cylinder_on_cylinder import CylinderOnCylinder, angles
from .finding import Finding
from .fits import Seen
from .formula import Lines, decimal
from .phi import phase, two_product
from .quadrature import PreciseRunning, Running, is_one, one_by_one
from .round_cylinder import ON_CYLINDER, frequency_ratio, numbers_of

_PIECE = 1.0  # of the pendulum's own argument λt: its functions are analytic at least π/2 off the real axis
_STANDS = 90.0  # on the separatrix it has come to rest on top, to the last digit, after so long
_FULL_TURNS, _FULL_TURNS_REST = 4 * math.pi, 4.898587196589413e-16  # 4π as a float, and what that leaves

Pair = tuple[Any, Any]


@dataclass(frozen=True)
class BallInLeaningCylinder(ClosedForm):
    """Across the axis a pendulum (T6); along it ż and σ = a Ω·n are sines and cosines of √(k/(1 + k)) (θ − θ₀) (T8).

    The height needs one quadrature, of cos q(θ − θ₀) and sin q(θ − θ₀) over a period of the pendulum, which is done
    to the last digits; any later time costs no more. Every number may be a float, or an array of members.

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²), of the ball.
    track_radius : float or array
        b of the cylinder, m.
    side : float or array
        +1 outside, −1 inside: ℓ = b + side·a.
    rate : float or array
        ω of the cylinder about its axis, rad/s.
    angle, angular_rate : float or array
        θ and θ̇ of the centre at t = 0, rad and rad/s, from the first axis towards the second.
    height, climb : float or array
        z and ż of the centre at t = 0, along the axis, m and m/s.
    spin : float or array
        Ω·n at t = 0, rad/s.
    force : triple of float or array
        Constant force, weight included, N.
    from_top : float or array
        As for `CylinderOnCylinder`.

    Examples
    --------
    What the ball does along a level pipe, and its spin, do not move it across: on the lowest line it stays there.

    >>> ball = BallInLeaningCylinder(0.1, 1.0, 0.4, 0.5, -1.0, 0.0, 0.0, 0.0, 0.0, 0.3, 5.0, (9.80665, 0.0, 0.0))
    >>> [round(float(part), 12) for part in ball.motion_at(2.0)[0]]
    [0.4, 0.0, 0.6]
    """

    radius: Scalar
    mass: Scalar
    inertia_ratio: Scalar
    track_radius: Scalar
    side: Scalar
    rate: Scalar
    angle: Scalar
    angular_rate: Scalar
    height: Scalar = 0.0
    climb: Scalar = 0.0
    spin: Scalar = 0.0
    force: tuple[Scalar, Scalar, Scalar] = (0.0, 0.0, 0.0)
    from_top: Scalar = math.nan

    name = "ball round and along a leaning cylinder"
    equation = "T8"
    source = "Abramowitz and Stegun (1964), ch. 16, and one quadrature; Cross, Am. J. Phys. 89, 459 (2021); theory page"
    conditions = ON_CYLINDER

    impossible_events = frozenset({"curved"})

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> BallInLeaningCylinder:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> pipe = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
        >>> BallInLeaningCylinder.of(pipe, pipe.place((1.0, 0.0), (0.0, 0.4))).climb
        0.4
        """
        cls.check_domain(system, start)
        numbers = numbers_of(system, start)
        (fx, fy, _), (x, y, _) = numbers["force"], start.position
        return cls(**numbers, from_top=angles(fx * x + fy * y, fx * y - fy * x)[1])

    # The constants of the motion

    @property
    def length(self) -> Scalar:
        """ℓ = b + side·a, of the centre from the axis, m."""
        return self.track_radius + self.side * self.radius

    @property
    def pendulum(self) -> CylinderOnCylinder:
        """The motion across the axis."""
        return self._pendulum

    @cached_property
    def _pendulum(self) -> CylinderOnCylinder:
        fx, fy, _ = self.force
        xp = namespace(self.angle)
        c, s = xp.cos(self.angle), xp.sin(self.angle)
        straight = fy == 0 and fx >= 0  # the pull is along the first axis, or there is none
        return CylinderOnCylinder(
            radius=self.radius,
            mass=self.mass,
            inertia_ratio=self.inertia_ratio,
            track_radius=self.track_radius,
            side=self.side,
            rate=self.rate,
            angle=self.angle if straight else xp.atan2(fx * s - fy * c, fx * c + fy * s),
            angular_rate=self.angular_rate,
            height=self.height,
            force=(fx, fy),
            from_top=self.from_top,
        )

    @property
    def goes_round(self) -> Any:
        """Whether it goes round rather than swings."""
        return self._pendulum.goes_round

    @property
    def advance(self) -> float:
        """Way along the axis from one swing to the next, m; a ball that goes round comes back to no such measure."""
        if not is_one(self) or self.goes_round or self._pendulum.period == math.inf:
            return math.nan
        return float(self.motion_at(self._pendulum.period)[0].z - self.height)

    @property
    def period(self) -> float:
        """Of the swing where nothing moves along the axis, s; infinite elsewhere."""
        if not is_one(self):
            return math.inf
        across = self.climb == 0 and self.force[2] == 0 and (self.spin == 0 or self.angular_rate == 0 == self._pull)
        return float(self._pendulum.period) if across else math.inf

    def max_rate(self, duration: float) -> float:
        """Return that of the pendulum, 1/s: what happens along the axis is slower."""
        return self._pendulum.max_rate(duration)

    def repeats(self, stop: str) -> float:
        """Return the pendulum's period for what the motion across the axis decides."""
        return float(self._pendulum.period) if stop == "lift" else self.period

    @property
    def _pull(self) -> float:
        return math.hypot(*self.force[:2])

    @property
    def _share(self) -> Scalar:
        return self.inertia_ratio / (1 + self.inertia_ratio)

    @property
    def _fall(self) -> Scalar:
        return self.force[2] / (self.mass * (1 + self.inertia_ratio))

    # The angle since the start, as cos qΔ and sin qΔ/q, and their integrals

    def _pair(self, angle: Any) -> Pair:
        xp = namespace(angle)
        q = xp.sqrt(self._share + 0 * angle)
        turned, none = q * angle, q == 0
        return xp.cos(turned), xp.where(none, angle, xp.sin(turned) / xp.where(none, q + 1, q))

    def _times(self, a: Pair, b: Pair) -> Pair:
        return a[0] * b[0] - self._share * a[1] * b[1], a[0] * b[1] + a[1] * b[0]

    def _since(self, t: Any) -> Any:
        """Return Δ = θ − θ₀, counted on over whole rounds."""
        if not _is_mpmath(t):
            return self._pendulum.turned_at(t)
        import mpmath

        sine, cosine, _ = self._pendulum.gone_at(t)
        half = mpmath.atan2(sine, cosine)
        rounds = round((self._since(float(t)) / 2 - float(half)) / (2 * math.pi))  # a float tells these
        return 2 * (half + rounds * 2 * mpmath.pi)

    def _turned(self, t: Any) -> tuple[Pair, Pair]:
        """Return (cos qΔ, sin qΔ/q) and their integrals over time since the start."""
        constants = self._pendulum._constants
        if _is_mpmath(t):
            first, second = self._precise.at(t)
            return self._pair(self._since(t)), (first, second)
        if constants.scale == 0:
            return (1.0 + 0 * t, 0.0 * t), (t, 0.0 * t)
        if constants.phase_rate == 0:
            moving = np.minimum(t, _STANDS / constants.scale)
            now, (first, second) = self._pair(np.asarray(self._since(moving))), self._running.at(moving)
            return now, (first + (t - moving) * now[0], second + (t - moving) * now[1])
        y, turned = phase((constants.phase_rate, constants.phase_rate_rest), t)
        periods, rest = np.round((y - turned) / (2 * math.pi)), np.asarray(turned) / constants.phase_rate
        now, since = self._pair(np.asarray(self._since(rest))), self._running.at(rest)
        if not constants.rotates:
            whole = self._period_integral
            return now, (since[0] + periods * whole[0], since[1] + periods * whole[1])
        rotated = self._rotated(periods)
        before, here = self._times(self._summed(periods), self._period_integral), self._times(rotated, tuple(since))
        return self._times(rotated, now), (before[0] + here[0], before[1] + here[1])

    @cached_property
    def _running(self) -> Running:
        constants = self._pendulum._constants
        length = _STANDS / constants.scale if constants.phase_rate == 0 else math.pi / constants.phase_rate
        pieces = math.ceil(length * constants.scale / _PIECE)
        first = 0 if constants.phase_rate == 0 else -pieces
        return Running(lambda t: np.stack(self._pair(self._since(t))), first, pieces, length / pieces)

    @cached_property
    def _precise(self) -> PreciseRunning:
        scale = float(self._pendulum._constants.scale)
        return PreciseRunning(lambda t: list(self._pair(self._since(t))), _PIECE / scale if scale else 1e300)

    @cached_property
    def _period_integral(self) -> Pair:
        """Over a period of the half angle, which may be two rounds."""
        half = math.pi / self._pendulum._constants.phase_rate
        (ahead, behind), one = (tuple(self._running.at(t)) for t in (half, -half)), 1.0
        rotated = self._rotated(one) if self._pendulum._constants.rotates else (1.0, 0.0)
        back = self._times(rotated, behind)
        return ahead[0] - back[0], ahead[1] - back[1]

    @cached_property
    def _gain(self) -> tuple[float, float]:
        """4πq of a period that goes round, less whole turns, as a float and what that leaves."""
        value, rest = frequency_ratio(self.inertia_ratio)
        product, error = two_product(value, _FULL_TURNS)
        rest = error + value * _FULL_TURNS_REST + rest * _FULL_TURNS
        sense = float(self._pendulum._constants.sense)
        turned = phase((product, rest), 1.0)[1]
        return sense * turned, 0.0

    def _circled(self, angle: Any) -> Pair:
        q = math.sqrt(self._share)
        return np.cos(angle), np.sin(angle) / q

    def _rotated(self, periods: Any) -> Pair:
        return self._circled(phase(self._gain, periods)[1])

    def _summed(self, periods: Any) -> Pair:
        """Return the sum of the turns of the first periods: sin(nβ/2)/sin(β/2) times the turn by (n − 1)β/2."""
        half = 0.5 * self._gain[0]
        share = periods if half == 0 else np.sin(phase((half, 0.0), periods)[1]) / math.sin(half)
        turn = self._circled(phase((half, 0.0), periods - 1.0)[1])
        return share * turn[0], share * turn[1]

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> still = BallInLeaningCylinder(0.1, 1.0, 0.4, 0.5, -1.0, 0.0, 0.0, 0.0, force=(9.80665, 0.0, 0.0))
        >>> float(still.motion_at(3.0)[3].x)
        -9.80665
        """
        if not is_one(self):
            return one_by_one(self, t)
        position, velocity, Omega, R = self._pendulum.motion_at(t)
        (c, s), (C, S) = self._turned(t)
        share, fall, climb0, twist0 = self._share, self._fall, self.climb, self.radius * self.spin
        z = climb0 * C + share * twist0 * S + 0.5 * fall * (C * C + share * S * S)
        climb = climb0 * c + share * twist0 * s + fall * (c * C + share * s * S)
        twist = twist0 * c - climb0 * s - fall * (s * C - c * S)
        out = Vector(position.x, position.y, 0.0) / self.length
        around, per_radius = Vector(-out.y, out.x, 0.0), self.side / self.radius
        rate = velocity.dot(around) / self.length
        return (
            position + E_Z * z,
            velocity + E_Z * climb,
            Omega + out * (twist * per_radius) - around * (climb * per_radius),
            R + E_Z * (self.mass * (fall + share * rate * twist) - self.force[2]),
        )

    def position_at(self, t: Any) -> Vector:
        """Return the centre in the inertial support frame, m, at a time since the start, s."""
        return self.motion_at(t)[0]

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:
        """Return the pendulum, and the way along the axis."""
        q = decimal(math.sqrt(self._share))
        formula = r"\dot z - iq\sigma = W_0\,e^{iq(\theta - \theta_0)} + \dots,\quad q = \sqrt{\frac{k}{1+k}}"
        return [*self.pendulum.formulas(system), (formula, f"q = {q}")]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare the pendulum, and the way along the axis in one swing."""
        pendulum = self.pendulum
        yield from pendulum.swinging(seen, pendulum.from_pull(seen.at.position))
        advance = float(self.advance)
        if math.isfinite(advance) and advance and seen.time[-1] >= pendulum.period:
            z = seen.at.position[:, 2]
            gone = float(np.interp(float(pendulum.period), seen.time, z) - z[0])
            yield Finding("Way along the axis in one swing", r"\Delta z", advance, gone, "m", scale=float(np.ptp(z)))


def _is_mpmath(t: Any) -> bool:
    return type(t).__module__.partition(".")[0] == "mpmath"
