"""T6: a cylinder or ball that rolls round inside or outside a cylinder, across its axis: the pendulum."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...mechanics.algebra import E_Z, Vector
from ...mechanics.duals import Dual, converted, value_of
from ...mechanics.scalars import Scalar, is_number, less, namespace
from ...mechanics.surfaces import Cylinder
from ...mechanics.system import RollingSystem, State
from ..samples import FLIGHT
from .base import ClosedForm
from .domain import (
    CONSTANT_LOADS,
    FORCES,
    NO_TORQUE,
    ROUND,
    START,
    TURNING_STEADILY,
    Condition,
    constant_forces,
    on,
    that,
)
from .finding import Finding
from .fits import COMES_OFF, Array, Seen, angle_where, round_time, swing
from .formula import Lines, decimal, number, quantity
from .jacobi import elliptic
from .phi import phase

_DIGITS = 60  # for the few constants: near the separatrix they are small differences
_ASIDE = 1e-12  # share of the start's speed, or of the load, that may point along the axis by rounding


def _pulled_across(system: RollingSystem) -> bool:
    fx, fy, fz = constant_forces(system)[0]
    return bool(abs(fz) <= _ASIDE * math.hypot(fx, fy))


def _aside(system: RollingSystem, start: State) -> Iterator[str]:
    (*_, vz), (wx, wy, _) = start.velocity, start.angular_velocity
    speed = max(map(abs, (*start.velocity, *(system.body.radius * w for w in start.angular_velocity))))
    if max(abs(vz), system.body.radius * math.hypot(wx, wy)) > _ASIDE * speed:
        yield "the start moves along the cylinder's axis or spins across it"


@dataclass(frozen=True)
class CylinderOnCylinder(ClosedForm):
    """The motion (1 + k) ℓ θ̈ = −(G/m) sin θ of the centre at ℓ from the axis, θ from the direction of the pull G (T6).

    Swinging, going round and the separatrix between them are one formula each of Jacobi's functions of time. The
    steady turning of the larger cylinder changes Ω, not the path. Every number may be a float or an array of members.

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²), of the body that rolls.
    track_radius : float or array
        b of the cylinder that it rolls on, m.
    side : float or array
        +1 outside, −1 inside: ℓ = b + side·a.
    rate : float or array
        ω of that cylinder about its axis, rad/s.
    angle, angular_rate : float or array
        θ and θ̇ at t = 0, rad and rad/s, positive from the first axis towards the second.
    height : float or array
        Of the centre along the axis, m.
    force : pair of float or array
        The pull across the axis, weight included, N; its size is G.
    from_top : float or array
        θ − π or θ + π at t = 0, the angle from the top, where the start is nearer to that: it keeps the digits that θ
        loses there. Elsewhere NaN: θ says it.

    Examples
    --------
    A hoop swings more slowly than a solid ball, here by little enough to be a harmonic oscillator:

    >>> swing = CylinderOnCylinder(0.1, 1.0, 1.0, 1.1, -1.0, 0.0, 1e-6, 0.0, 0.0, (9.80665, 0.0))
    >>> round(swing.period / (2 * math.pi * math.sqrt(2 / 9.80665)), 9)
    1.0
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
    force: tuple[Scalar, Scalar] = (0.0, 0.0)
    from_top: Scalar = math.nan

    name = "cylinder or ball on a cylinder"
    equation = "T6"
    source = "Abramowitz and Stegun, Handbook of Mathematical Functions (1964), ch. 16; theory page, round a cylinder"
    conditions = (
        ROUND,
        on(Cylinder),
        TURNING_STEADILY,
        CONSTANT_LOADS,
        that(_pulled_across, " across that axis", "gravity or a force pulls along the cylinder's axis", FORCES),
        NO_TORQUE,
        Condition(", for a motion in the plane across it", _aside, START),
    )

    impossible_events = frozenset({"curved"})

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> CylinderOnCylinder:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> trough = tr.Support(tr.Cylinder("50 cm"), tilt="90 deg")
        >>> system = tr.RollingSystem(tr.Body.cylinder("5 cm", "1 kg"), trough)
        >>> round(CylinderOnCylinder.of(system, system.place(("60 deg", 0.0))).period, 6)  # 4 K(sin 30°)/√(g/(1.5 ℓ))
        1.769069
        """
        cls.check_domain(system, start)
        surface: Any = system.support.surface
        fx, fy, _ = constant_forces(system)[0]
        r, V = Vector(*start.position), Vector(*start.velocity)
        length = surface.radius + surface.sign * system.body.radius
        pull = (fx, fy) if (fx, fy) != (0, 0) else (1.0, 0.0)
        angle, from_top = angles(pull[0] * r.x + pull[1] * r.y, pull[0] * r.y - pull[1] * r.x)
        return cls(
            radius=system.body.radius,
            mass=system.body.mass,
            inertia_ratio=system.body.inertia_ratio,
            track_radius=surface.radius,
            side=surface.sign,
            rate=system.support.motion.steady_rate,
            angle=angle,
            angular_rate=(r.x * V.y - r.y * V.x) / (namespace(r.x, r.y).hypot(r.x, r.y) * length),
            height=r.z,
            force=(fx, fy),
            from_top=from_top,
        )

    # The constants of the motion

    @property
    def length(self) -> Scalar:
        """ℓ = b + side·a, of the centre from the axis, m."""
        return self.track_radius + self.side * self.radius

    @cached_property
    def _constants(self) -> _Constants:
        """Worked out with many digits; for arrays of members, one by one."""
        sizes = (self.track_radius, self.side, self.radius)
        given = (self.mass, self.inertia_ratio, *sizes, self.angle, self.angular_rate, *self.force, self.from_top)
        if any(isinstance(value, Dual) for value in given):
            return _Constants(*(converted(constant, float) for constant in _constants(*given)))
        if all(is_number(value) for value in given):
            return _Constants(*map(float, _constants(*given)))
        if any(type(value).__module__.partition(".")[0] == "mpmath" for value in given):
            return _Constants(*_constants(*given))
        arrays = np.broadcast_arrays(*given)
        members = zip(*map(np.ravel, arrays), strict=True)
        rows = np.array([[float(c) for c in _constants(*map(float, one))] for one in members])
        return _Constants(*(column.reshape(arrays[0].shape) for column in rows.T))

    @property
    def goes_round(self) -> Any:
        """Whether it goes round rather than swings."""
        return self._constants.rotates > 0

    @property
    def period(self) -> Any:
        """Of the motion, s; infinite at rest and on the separatrix."""
        return self._constants.period

    def expected(self, duration: float) -> list[tuple[str, str]]:  # noqa: ARG002
        """Return how it swings, or goes round."""
        small = math.sqrt(self.length * self.mass * (1 + self.inertia_ratio) / max(math.hypot(*self.force), 1e-300))
        return [
            (
                "it goes round" if self.goes_round else "it swings",
                "for ever" if math.isinf(self.period) else f"once in {self.period:.6g} s",
            ),
            ("a small swing", f"{2 * math.pi * small:.6g} s"),
        ]

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return 2λ, of which θ̇ is no faster, 1/s."""
        return 2 * float(self._constants.scale)

    @property
    def sensitivity(self) -> float:
        """1/m₁: near the separatrix, how many times a rounding of the energy shows as time spent near the top."""
        return float(1 / max(float(self._constants.complement), 1e-16))

    # The motion

    def _jacobi(self, t: Any) -> tuple[tuple[Scalar, Scalar, Scalar], tuple[Scalar, Scalar, Scalar], Scalar]:
        """Return sn, cn and dn of λt, those of the start, and how far the half angle has gone round, rad.

        The functions of λt and of the start are put together by the addition theorems, with denominators that are
        sums of squares; so the start enters by its own sine and cosine and nothing has to be inverted.
        """
        c = self._constants
        y, turned = phase((c.phase_rate, c.phase_rate_rest), t)
        xp = namespace(turned, c.rotates)
        u = xp.where(c.period == math.inf, c.scale * t, turned * c.argument)
        rounds = (y - turned) * xp.where(c.rotates > 0, c.sense, 0 * c.sense)
        # The start's, swinging: κ sn, κ cn and dn; going round: sn, dn and cn.
        return elliptic(u, c.complement), (c.sense * c.sine, c.sn_rate, c.cosine), rounds

    def _halves(self, t: Any) -> tuple[Scalar, Scalar, Scalar]:
        """Return sin(θ/2), cos(θ/2) and θ̇/2."""
        c = self._constants
        (s1, c1, d1), (s2, k2, d2), _ = self._jacobi(t)
        xp, sign, round_ = namespace(s1, c.rotates), c.sense, c.rotates > 0
        swing_den = c1 * c1 + s1 * s1 * d2 * d2
        swing_sine = (s1 * k2 * d2 + s2 * c1 * d1) / swing_den
        swing_cosine = (d1 * d2 - s1 * c1 * s2 * k2) / swing_den
        swing_rate = c.scale * (c1 * k2 - s1 * s2 * d1 * d2) / swing_den
        den = c1 * c1 + s1 * s1 * k2 * k2
        sine = (s1 * d2 * k2 + s2 * c1 * d1) / den
        cosine = (c1 * d2 - s1 * s2 * d1 * k2) / den
        rate = c.scale * (d1 * k2 - c.parameter * s1 * s2 * c1 * d2) / den
        sine, cosine = xp.where(round_, sine, swing_sine), xp.where(round_, cosine, swing_cosine)
        return sign * sine, cosine, sign * xp.where(round_, rate, swing_rate)

    def gone_at(self, t: Any) -> tuple[Scalar, Scalar, Scalar]:
        """Return the sine and cosine of half the angle gone since the start, and twice the whole rounds besides.

        The same addition theorems, less the start's angle by those of the circle: every term has a factor that
        vanishes with the time, so that a small way keeps all its digits beside a large angle.

        Examples
        --------
        >>> sine, cosine, rounds = CylinderOnCylinder(0.1, 1.0, 0.5, 0.5, -1.0, 0.0, 0.0, 2.0).gone_at(10.0)
        >>> round(2 * math.atan2(sine, cosine) + rounds, 12)  # no pull
        20.0
        """
        c = self._constants
        (s1, c1, d1), (s2, k2, d2), rounds = self._jacobi(t)
        xp, round_ = namespace(s1, c.rotates), c.rotates > 0
        less_cosine = xp.where(c1 > 0, s1 * s1 / (1 + xp.where(c1 > 0, c1, 0 * c1)), 1 - c1)  # 1 − cn
        less_delta = c.parameter * s1 * s1 / (1 + d1)  # 1 − dn
        short = xp.where(round_, less_delta, less_cosine)
        kept, driven = xp.where(round_, c1, d1), xp.where(round_, c1 * less_delta, d1 * less_cosine)
        straight = d2 * d2 + s2 * s2 * xp.where(round_, d1, c1)
        den = c1 * c1 + s1 * s1 * xp.where(round_, k2 * k2, d2 * d2)
        sine = (s1 * k2 * straight - s2 * d2 * driven) / den
        cosine = (kept * straight + s1 * k2 * s2 * d2 * short) / den
        return c.sense * sine, cosine, 2 * rounds

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> rest = CylinderOnCylinder(0.1, 1.0, 0.5, 0.5, -1.0, 0.0, 0.0, 0.0, 0.0, (9.80665, 0.0))
        >>> rest.motion_at(3.0)[3].x
        -9.80665
        """
        half_sine, half_cosine, half_rate = self._halves(t)
        sine, cosine = 2 * half_sine * half_cosine, 1 - 2 * half_sine * half_sine
        c, length = self._constants, self.length
        out = Vector(c.pull_x * cosine - c.pull_y * sine, c.pull_y * cosine + c.pull_x * sine, 0.0)
        around = Vector(-out.y, out.x, 0.0)
        speed = 2 * half_rate * length
        Omega = (speed - self.track_radius * self.rate) * self.side / self.radius
        acceleration = around * (-(c.pendulum * sine) * length) - out * (speed * speed / length)
        fx, fy = self.force
        R = acceleration * self.mass - Vector(fx, fy, 0.0)
        zero = 0 * half_sine
        return (
            Vector(out.x * length, out.y * length, self.height + zero),
            around * speed,
            Vector(zero, zero, Omega + zero),
            R,
        )

    def position_at(self, t: Any) -> Vector:
        """Return the centre in the inertial support frame, m, at a time since the start, s."""
        return self.motion_at(t)[0]

    def angle_at(self, t: Any) -> Any:
        """Return θ at a time since the start, rad, counted on over whole rounds.

        Examples
        --------
        >>> CylinderOnCylinder(0.1, 1.0, 0.5, 0.5, -1.0, 0.0, 0.0, 2.0).angle_at(10.0)  # no pull
        20.0
        """
        return self.angle + self.turned_at(t)

    def turned_at(self, t: Any) -> Any:
        """Return θ − θ₀ at a time since the start, rad, counted on over whole rounds; no digit of it is lost beside θ₀.

        Examples
        --------
        >>> fall = CylinderOnCylinder(0.1, 1.0, 0.5, 0.5, -1.0, 0.0, 1.0, 0.0, force=(9.8, 0.0))
        >>> round(fall.turned_at(1e-9) / (-9.8 * math.sin(1.0) / (1.5 * 0.4) * 0.5e-18), 12)  # θ̈ t²/2
        1.0
        """
        sine, cosine, rounds = self.gone_at(t)
        xp, tau, c = namespace(sine), 2 * math.pi, self._constants
        since = xp.atan2(sine, cosine)
        # Half a period from where the rounds count, the half angle is half a turn on: on the side of its own motion.
        _, turned = phase((c.phase_rate, c.phase_rate_rest), t)
        ahead = turned * c.sense
        flip = (c.rotates > 0) & (abs(since) > 3.0) & (since * ahead < 0)
        since = since + xp.where(flip, xp.where(less(ahead, 0), -tau, tau), 0.0)
        return 2 * since + rounds

    def fixed_axis_rotation(self, t: Any) -> tuple[Vector, Any]:
        """Return the axis and the angle by which the body has turned: from its place alone, as x = aφ on a plane."""
        gone = self.length * self.turned_at(t) - self.track_radius * self.rate * t
        return E_Z, gone * self.side / self.radius

    # What is shown

    @property
    def lift_cosine(self) -> Any:
        """Cosine of the angle from the top at which the body comes off, [2 cos θ₀ + (1 + k) mℓθ̇₀²/G]/(3 + k)."""
        k, (fx, fy) = self.inertia_ratio, self.force
        xp = namespace(self.angle, fx, fy)
        speed = self.mass * self.length * self.angular_rate * self.angular_rate / xp.hypot(fx, fy)
        return (-2 * xp.cos(self.angle) + (1 + k) * speed) / (3 + k)

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return the pendulum, and how long it takes for one swing, or round."""
        pull, heavy = math.hypot(*map(float, self.force)), float(self.mass) * (1 + float(self.inertia_ratio))
        square = pull / (heavy * float(self.length))
        below = rf"{decimal(self.mass)}\cdot(1 + {number(self.inertia_ratio)})\cdot {decimal(self.length)}"
        shown = rf"\nu^2 = \frac{{{decimal(pull)}}}{{{below}}}\,\mathrm{{s^{{-2}}}} = {quantity(square, '1/s^2')}"
        lines = [(r"\ddot\theta = -\nu^2\sin\theta,\quad \nu^2 = \frac{G}{m(1+k)\,\ell}", shown)]
        period = float(self.period)
        if math.isfinite(period):
            whole = r"T = \frac{2}{\sqrt\epsilon}\,K\!\left(\frac{\nu^2}{\epsilon}\right)"
            swings = r"T = \frac{4}{\nu}\,K\!\left(\sin^2\tfrac{\theta_{\max}}{2}\right)"
            lines.append((whole if self.goes_round else swings, rf"T = {quantity(period, 's')}"))
        return lines

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare its swing or round, or where it comes off."""
        if not any(event.kind == "lift" for event in seen.samples.events):
            yield from self.swinging(seen, self.from_pull(seen.at.position))
        else:
            yield from self.coming_off(seen, np.abs(self.from_pull(seen.samples.position) % (2 * math.pi) - math.pi))

    def from_pull(self, position: Array) -> Array:
        """Return the angle of the centre about the third axis from the direction of the pull, without jumps, rad."""
        fx, fy = (float(part) for part in self.force)
        angle = np.unwrap(np.arctan2(position[:, 1], position[:, 0]))
        angle = angle - math.atan2(fy, fx)
        return np.asarray(angle - 2 * math.pi * np.round(angle[0] / (2 * math.pi)))

    def swinging(self, seen: Seen, angle: Array) -> Iterator[Finding]:
        """Compare the time and the size of a swing, or the time of a round, with an angle from the pull."""
        if seen.time.size < 6 or not np.ptp(angle) > 0:
            return
        period = float(self.period)
        finite = period if math.isfinite(period) else None
        if self.goes_round:
            yield Finding("Time of one round", "T", finite, round_time(seen.time, angle), "s", said="goes round in {}")
            return
        measured, largest = swing(seen.time, angle)
        if finite is not None:
            note = "" if measured else "the run shows less than one"
            yield Finding("Time of one swing", "T", period, measured, "s", note=note, said="swings to and fro in {}")
        pull = math.hypot(*map(float, self.force))
        if pull and seen.time[-1] >= 0.5 * period:
            heavy = float(self.mass) * float(self.length) * (1 + float(self.inertia_ratio))
            cosine = math.cos(float(self.angle)) - 0.5 * heavy * float(self.angular_rate) ** 2 / pull
            yield Finding("Amplitude", r"\theta_{\max}", math.degrees(math.acos(cosine)), math.degrees(largest), "°")

    def coming_off(self, seen: Seen, from_top: Array) -> Iterator[Finding]:
        """Compare the angle from the top at which the normal force has gone."""
        cosine, samples = float(self.lift_cosine), seen.samples
        flying = samples.phase == FLIGHT
        if abs(cosine) <= 1 and flying.any():
            part = slice(0, int(np.argmax(flying)))
            normal, _ = seen.forces
            predicted, time = math.acos(cosine), samples.time[part]
            yield angle_where(COMES_OFF, predicted, time, from_top[part], normal[part])


@dataclass(frozen=True)
class _Constants:
    """What follows from the start once and for all."""

    rotates: Any  # 1 or 0
    sense: Any  # of going round, ±1
    complement: Any  # m₁
    parameter: Any  # m
    scale: Any  # λ, 1/s
    argument: Any  # 2K/π
    phase_rate: Any  # 2π over the period of the half angle, rad/s, and what the float leaves
    phase_rate_rest: Any
    period: Any  # s
    sine: Any  # sin(θ₀/2)
    cosine: Any
    sn_rate: Any  # |θ̇₀|/(2λ) with its sign where it swings
    pendulum: Any  # G/(m (1 + k) ℓ), 1/s²
    pull_x: Any
    pull_y: Any


def _constants(*given: Any) -> tuple[Any, ...]:
    """Return the fields of `_Constants` as mpmath numbers, or duals of them."""
    import mpmath

    mpf = mpmath.mpf
    with mpmath.workdps(max(_DIGITS, mpmath.mp.dps)):
        m, k, track, side, radius, angle, angular_rate, fx, fy, from_top = (converted(one, mpf) for one in given)
        xp = namespace(*given, mpf(0))
        length = track + side * radius
        G, sine, cosine, v = namespace(fx, fy).hypot(fx, fy), xp.sin(angle / 2), xp.cos(angle / 2), angular_rate / 2
        if not mpmath.isnan(value_of(from_top)):  # from −π to π round the pull, cos(θ/2) is positive
            sine, cosine = xp.cos(from_top / 2) * (-1 if from_top > 0 else 1), abs(xp.sin(from_top / 2))
        pull = (fx / G, fy / G) if G else (mpf(1), mpf(0))
        pendulum = G / (m * (1 + k) * length)
        energy, short = v * v + pendulum * sine**2, pendulum * cosine**2 - v * v  # of the height at the top
        rotates = short < 0
        square = energy if rotates else pendulum
        scale = xp.sqrt(square) if cosine or v else mpf(0)  # at rest on the top it stays
        complement = (abs(short) / square) if square else mpf(1)
        sense = mpf(-1 if rotates and v < 0 else 1)
        sn_rate = v * sense / scale if scale else mpf(1)
        still = energy == 0 or complement == 0 or scale == 0
        quarter = mpmath.pi / (2 * _mean(mpf(1), xp.sqrt(complement))) if complement else mpf(1)
        phase_rate = mpf(0) if complement == 0 else mpmath.pi * scale / (2 * quarter)
        period = mpmath.inf if still else (2 if rotates else 4) * quarter / scale
        high = converted(phase_rate, lambda x: mpf(float(x))) if mpmath.isfinite(value_of(phase_rate)) else phase_rate
        return (
            mpf(int(rotates)), sense, complement, 1 - complement, scale, 2 * quarter / mpmath.pi,
            high, phase_rate - high, period, sine, cosine, sn_rate, pendulum, *pull,
        )  # fmt: skip


def _mean(a: Any, b: Any) -> Any:
    """Return the arithmetic-geometric mean: of duals, whose slopes are a step behind, too."""
    import mpmath

    done = False
    while not done:
        done = abs(value_of(a) - value_of(b)) <= mpmath.sqrt(mpmath.eps) * value_of(a)
        a, b = (a + b) / 2, namespace(a, b).sqrt(a * b)
    return (a + b) / 2


def angles(along: float, across: float) -> tuple[float, float]:
    """Return the angle from the pull, rad, and that from the top, opposite to it, where it is nearer to that; else NaN.

    Examples
    --------
    >>> angles(-1.0, 1e-20)
    (3.141592653589793, -1e-20)
    """
    xp = namespace(along, across)
    return xp.atan2(across, along), xp.atan2(-across, -along) if along < 0 else math.nan
