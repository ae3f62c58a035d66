"""T11: a sphere that slips on a plane at rest, level or tilted, until it grips."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...mechanics.algebra import Vector
from ...mechanics.scalars import Scalar, is_zero
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from ...wording import as_ratio
from ..samples import ROLLING, SLIPPING, Samples
from .base import ClosedForm
from .domain import CONSTANT_LOADS, NO_TORQUE, PRESSED, ROUND, TURNING_STEADILY, constant_forces, on, that
from .finding import Finding
from .fits import Seen, acceleration, zero_ahead
from .formula import Lines, quantity
from .kepler import inverse_of, precisely
from .quadrature import is_one, one_by_one

_MOST_STEPS = 400


def _rests_or_is_smooth(system: RollingSystem) -> bool:
    rate, support = system.support.motion.steady_rate, system.support
    return rate is None or is_zero(rate) or support.friction is None or is_zero(support.sliding_friction)


@dataclass(frozen=True)
class SlidingSphere(ClosedForm):
    """The motion ṡ = A − B ŝ of the slip, A = F/m along the plane, B = μN(1 + 1/k)/m (T11).

    Straight, the slip changes evenly. Turning, it is a sum of exponentials of x = ∫dt/s, in which the law is linear:
    s = s₀[c e^{−(B−A)x} + d e^{−(B+A)x}] with c, d = (1 ± cos φ₀)/2, φ from A to s; time and place are their integrals.

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²).
    position, velocity : pair of float or array
        Centre at t = 0 over the plane, m and m/s.
    angular_velocity : triple of float or array
        Ω at t = 0, rad/s.
    slip : pair of float or array
        s at t = 0, m/s.
    force : triple of float or array
        Constant, weight included, N.
    friction : float or array
        μ of slipping.

    Examples
    --------
    A solid ball that slides without turning grips after 2v/(7μg), at 5/7 of its speed:

    >>> ball = SlidingSphere(
    ...     0.1, 1.0, 0.4, (0.0, 0.0), (7.0, 0.0), (0.0, 0.0, 0.0), (7.0, 0.0), (0.0, 0.0, -10.0), 0.2
    ... )
    >>> round(ball.grips_at, 15), round(float(ball.motion_at(ball.grips_at)[1].x), 15)
    (1.0, 5.0)
    """

    radius: Scalar
    mass: Scalar
    inertia_ratio: Scalar
    position: tuple[Scalar, Scalar]
    velocity: tuple[Scalar, Scalar]
    angular_velocity: tuple[Scalar, Scalar, Scalar]
    slip: tuple[Scalar, Scalar]
    force: tuple[Scalar, Scalar, Scalar]
    friction: Scalar

    name = "sphere slipping on a plane"
    equation = "T11"
    source = "Coriolis, Théorie mathématique des effets du jeu de billard (1835), level; theory page, T11"
    conditions = (
        ROUND,
        on(Plane),
        that(
            lambda system: system.support.friction is not None,
            "",
            "the support has no friction coefficient",
        ),
        that(_rests_or_is_smooth, " at rest", "the plane turns, so that its own velocity differs from place to place"),
        replace(TURNING_STEADILY, words=" or, without friction, turning steadily"),
        CONSTANT_LOADS,
        NO_TORQUE,
        PRESSED,
    )
    phases = (SLIPPING,)
    impossible_events = frozenset({"lift", "jam"})  # N is constant

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SlidingSphere:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> lane = tr.RollingSystem(tr.Body.solid_sphere(0.1, 7.0), tr.Support(tr.Plane(), friction=0.1), gravity=10.0)
        >>> start = lane.place(velocity=(7.0, 0.0), angular_velocity=(0.0, 0.0, 0.0))
        >>> round(SlidingSphere.of(lane, start).grips_at, 15)
        2.0
        """
        cls.check_domain(system, start)
        (vx, vy, _), (wx, wy, _), a = start.velocity, start.angular_velocity, system.body.radius
        rate, (x, y, _) = system.support.motion.steady_rate or 0.0, start.position
        force, _ = constant_forces(system)
        return cls(
            radius=a,
            mass=system.body.mass,
            inertia_ratio=system.body.inertia_ratio,
            position=(x, y),
            velocity=(vx, vy),
            angular_velocity=start.angular_velocity,
            slip=(vx - a * wy + rate * y, vy + a * wx - rate * x),
            force=tuple(force),
            friction=system.support.sliding_friction,
        )

    @classmethod
    def from_state_vector(cls, system: RollingSystem, start: State, numbers: Sequence[float]) -> SlidingSphere:
        """Take the slip from the law's own numbers: where slip begins, it is smaller than a rounding of V and Ω."""
        return replace(cls.of(system, start), slip=(float(numbers[10]), float(numbers[11])))

    # The constants of the motion

    @property
    def grips_at(self) -> float:
        """Time at which the slip has ended, s: s₀[c/(B − A) + d/(B + A)]; infinite where friction is too weak."""
        return float(_Slip.of(self, float).ends_at)

    @property
    def ends_at(self) -> dict[str, float]:
        """When it grips."""
        return {"grip": self.grips_at}

    @property
    def period(self) -> float:
        """Infinite: it never comes back."""
        return math.inf

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return 0: the path is a parabola, or smoother, 1/s."""
        return 0.0

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> ball = SlidingSphere(0.1, 1.0, 0.4, (0, 0), (7.0, 0), (0, 0, 0), (7.0, 0), (0, 0, -10.0), 0.2)
        >>> round(float(ball.motion_at(0.5)[3].x), 12)
        -2.0
        """
        if not is_one(self):
            return one_by_one(self, t)
        number = _mpf if _is_mpmath(t) else float
        slip = _Slip.of(self, number)
        s, gone, direction = slip.at(t)
        a, k, m = (number(part) for part in (self.radius, self.inertia_ratio, self.mass))
        share, (fx, fy, fz) = k / (1 + k), (number(part) for part in self.force)
        N, mu, zero = -fz, number(self.friction), 0 * t
        # What friction has given: V − V₀ − At, of which the slip takes (1 + 1/k).
        gained = [share * (s[i] - number(self.slip[i]) - f / m * t) for i, f in enumerate((fx, fy))]
        carried = [share * (gone[i] - number(self.slip[i]) * t - f / m * (t * t / 2)) for i, f in enumerate((fx, fy))]
        r, V = ([number(part) for part in of_start] for of_start in (self.position, self.velocity))
        Omega = [number(part) for part in self.angular_velocity]
        pulled = (fx / m, fy / m)
        x, y = (r[i] + V[i] * t + pulled[i] * (t * t / 2) + carried[i] for i in range(2))
        vx, vy = (V[i] + pulled[i] * t + gained[i] for i in range(2))
        return (
            Vector(x, y, a + zero),
            Vector(vx, vy, zero),
            Vector(Omega[0] + gained[1] / (k * a), Omega[1] - gained[0] / (k * a), Omega[2] + zero),
            Vector(zero - mu * N * direction[0], zero - mu * N * direction[1], N + zero),
        )

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return how the slip changes, and when it has gone."""
        k, mu = float(self.inertia_ratio), float(self.friction)
        brake = mu * -float(self.force[2]) / float(self.mass) * (1 + 1 / k)
        formula = r"\dot s = \frac{F}{m} - B\,\hat s,\quad B = \frac{\mu N}{m}\Big(1 + \frac1k\Big)"
        lines = [(formula, rf"B = {quantity(brake, 'm/s^2')}")]
        grips = float(self.grips_at)
        if not math.isfinite(grips):
            return lines
        if any(map(float, self.force[:2])):
            return [*lines, (r"s(t_g) = 0", rf"t_g = {quantity(grips, 's')}")]
        slip = math.hypot(*map(float, self.slip))
        share = rf"\frac{{{quantity(slip, 'm/s')}}}{{{quantity(brake, 'm/s^2')}}}"
        return [*lines, (r"t_g = \frac{|s_0|}{B}", rf"t_g = {share} = {quantity(grips, 's')}")]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare when, where and how fast it grips; measured from where the slip of the samples ends."""
        predicted, samples, system = float(self.grips_at), seen.samples, seen.system
        slips = samples.phase == SLIPPING
        count = int(np.argmin(slips)) if not slips.all() else slips.size
        part = samples.part(slice(0, count))
        if not math.isfinite(predicted):
            yield from self._slipping_on(system, part)
            return
        if count < 3:
            return
        V, carried, u = part.speeds(system)
        slip = np.broadcast_to((V + carried - u).norm(), part.time.shape)
        time = part.time - samples.time[0]
        gripped = zero_ahead(time, slip) if slips.size > count or slip[-1] < 0.5 * slip[0] else None
        note = "where the slip, drawn on, ends"
        yield Finding(
            "Time at which it grips", "t_g", predicted, gripped, "s", note=note, said="slips for {}, then rolls"
        )
        if gripped is None or slips.size <= count:
            return
        r, velocity, _, _ = self.motion_at(predicted)
        way = math.hypot(float(r.x) - float(self.position[0]), float(r.y) - float(self.position[1]))
        degree = min(6 if system.support.tilt else 2, count - 1)
        course = np.polynomial.polynomial.polyfit(time, part.position[:, :2], degree)
        there = np.polynomial.polynomial.polyval(gripped, course)
        gone = float(np.linalg.norm(there - part.position[0, :2]))
        yield Finding(
            "Distance to there", "d_g", way, gone, "m", note="from start to grip, straight", scale=max(way, self.radius)
        )
        after = samples.part(slice(count, None))
        rolls = int(np.argmin(after.phase == ROLLING)) if not (after.phase == ROLLING).all() else after.time.size
        pushed = float(system.support.tilt) != 0 or bool(system.loads)
        if rolls > 3 and not pushed:
            path = after.position[:rolls, :2]
            speed = float(np.linalg.norm(path[-1] - path[0]) / (after.time[rolls - 1] - after.time[0]))
            final = math.hypot(float(velocity.x), float(velocity.y))
            started = math.hypot(*map(float, self.velocity))
            plain = not any(self.angular_velocity[:2]) and started > 0
            note = f"{as_ratio(1 / (1 + float(self.inertia_ratio)))} of the start's" if plain else ""
            yield Finding("Speed after it grips", "v_g", final, speed, "m/s", note=note, scale=max(final, started))

    def _slipping_on(self, system: RollingSystem, part: Samples) -> Iterator[Finding]:
        """Compare the acceleration where it slips for ever, and straight: F/m − μN/m along the slip."""
        pull, slip = complex(*map(float, self.force[:2])), complex(*map(float, self.slip))
        aside = abs((pull * slip.conjugate()).imag)
        if part.time.size < 4 or not slip or aside > 1e-12 * abs(pull) * abs(slip):
            return
        held = float(self.friction) * -float(self.force[2]) * slip / abs(slip)
        predicted, measured = abs(pull - held) / float(self.mass), abs(acceleration(Seen.of(system, part)))
        yield Finding(
            "Acceleration while it slips", r"\dot v", predicted, measured, "m/s²", said="slips, accelerating at {}"
        )


@dataclass(frozen=True)
class _Slip:
    """The slip, along the pull A and across it; all numbers floats, or all mpmath's."""

    size: Any  # s₀, m/s
    c: Any
    d: Any
    sine: Any  # of φ₀
    pull: Any  # A, m/s²
    brake: Any  # B, m/s²
    along: tuple[Any, Any]  # unit vector along A

    @staticmethod
    def of(form: SlidingSphere, number: Any) -> _Slip:
        m, k = number(form.mass), number(form.inertia_ratio)
        sx, sy = (number(part) for part in form.slip)
        Ax, Ay = (number(part) / m for part in form.force[:2])
        size, pull = _root(sx * sx + sy * sy), _root(Ax * Ax + Ay * Ay)
        brake = number(form.friction) * -number(form.force[2]) * (1 + 1 / k) / m
        along = (Ax / pull, Ay / pull) if pull else (sx / size, sy / size) if size else (number(1), number(0))
        if size == 0:
            return _Slip(size, number(1), number(0), number(0), pull, brake, along)
        cosine, sine = (along[0] * sx + along[1] * sy) / size, (along[0] * sy - along[1] * sx) / size
        larger = (1 + abs(cosine)) / 2
        smaller = sine * sine / (4 * larger)  # c d = sin²φ₀/4, of which no digits are lost
        c, d = (larger, smaller) if cosine > 0 else (smaller, larger)
        return _Slip(size, c, d, sine, pull, brake, along)

    @property
    def straight(self) -> bool:
        """Whether the slip keeps its line."""
        return bool(self.pull == 0 or self.brake == 0 or self.c == 0 or self.d == 0)

    @property
    def ends_at(self) -> Any:
        A, B = self.pull, self.brake
        if self.size == 0 or B == 0:
            return math.inf
        if B <= A and self.c > 0:
            return math.inf
        return self.size * ((self.c / (B - A) if self.c else 0) + self.d / (B + A))

    def at(self, t: Any) -> tuple[list[Any], list[Any], list[Any]]:
        """Return s, ∫s dt and ŝ in the plane's two axes."""
        t = t if _is_mpmath(t) else np.minimum(t, self.ends_at)
        (ex, ey), zero = self.along, 0 * t
        along, across, gone_along, gone_across, cosine, sine = self._straight(t) if self.straight else self._turning(t)

        def in_axes(u: Any, v: Any) -> list[Any]:
            return [ex * u - ey * v + zero, ey * u + ex * v + zero]

        return in_axes(along, across), in_axes(gone_along, gone_across), in_axes(cosine, sine)

    def _straight(self, t: Any) -> tuple[Any, ...]:
        cosine = self.c - self.d
        first, rate = (
            (self.size * cosine, self.size * self.sine),
            (self.pull - self.brake * cosine, -self.brake * self.sine),
        )
        return (
            *(part + change * t for part, change in zip(first, rate, strict=True)),
            *(part * t + change * (t * t / 2) for part, change in zip(first, rate, strict=True)),
            cosine, self.sine,
        )  # fmt: skip

    def _turning(self, t: Any) -> tuple[Any, ...]:
        A, B, c, d, s0, sine = self.pull, self.brake, self.c, self.d, self.size, self.sine
        x = self._precise(t) if _is_mpmath(t) else self._found(np.asarray(t, dtype=float))
        slow, fast = _exp(-(B - A) * x), _exp(-(B + A) * x)
        square = s0 * s0
        ahead = c * c * _shrunk(2 * (B - A), x) - d * d * _shrunk(2 * (B + A), x)
        aside = c * _shrunk(2 * B - A, x) + d * _shrunk(2 * B + A, x)
        ratio = _exp(-2 * A * x)
        whole = c + d * ratio
        return (
            s0 * (c * slow - d * fast), s0 * sine * _exp(-B * x), square * ahead, square * sine * aside,
            (c - d * ratio) / whole, sine * _exp(-A * x) / whole,
        )  # fmt: skip

    def _time(self, x: Any) -> tuple[Any, Any]:
        """Return t and s = dt/dx."""
        A, B, c, d, s0 = self.pull, self.brake, self.c, self.d, self.size
        time = s0 * (c * _shrunk(B - A, x) + d * _shrunk(B + A, x))
        return time, s0 * (c * _exp(-(B - A) * x) + d * _exp(-(B + A) * x))

    def _left(self, x: Any) -> tuple[Any, Any]:
        """Return how long it still slips, and s."""
        A, B, c, d, s0 = self.pull, self.brake, self.c, self.d, self.size
        slow, fast = _exp(-(B - A) * x), _exp(-(B + A) * x)
        return s0 * (c * slow / (B - A) + d * fast / (B + A)), s0 * (c * slow + d * fast)

    def _found(self, t: Any) -> Any:
        """Return x at given times: by Newton's method on the time that is left, or within brackets on the time."""
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            if not math.isfinite(self.ends_at):
                return self._bracketed(t)
            left = np.maximum(self.ends_at - t, 1e-300)
            x = np.zeros_like(t)
            for _ in range(_MOST_STEPS):  # ln of a sum of exponentials is convex: from the left no step goes too far
                remaining, s = self._left(x)
                step = np.maximum(remaining * np.log(remaining / left) / s, 0.0)
                x = x + step
                if (step <= 4e-16 * x).all():
                    break
            early = t < 0.5 * self.ends_at
            return np.where(early, self._bracketed(np.where(early, t, 0.0)), x)

    def _bracketed(self, t: Any) -> Any:
        return inverse_of(self._time, t, t / self.size)

    def _precise(self, t: Any) -> Any:
        size, c, d, sine, pull, brake = map(float, (self.size, self.c, self.d, self.sine, self.pull, self.brake))
        rough = _Slip(size, c, d, sine, pull, brake, (1.0, 0.0))
        return precisely(self._time, t, float(rough._found(np.asarray(float(t)))))


def _shrunk(rate: Any, x: Any) -> Any:
    """Return ∫₀ˣ e^{−rate x} dx."""
    if rate == 0:
        return x
    if _is_mpmath(x):
        import mpmath

        return -mpmath.expm1(-rate * x) / rate
    return -np.expm1(-rate * x) / rate


def _exp(x: Any) -> Any:
    if _is_mpmath(x):
        import mpmath

        return mpmath.exp(x)
    return np.exp(x)


def _root(x: Any) -> Any:
    if _is_mpmath(x):
        import mpmath

        return mpmath.sqrt(x)
    return math.sqrt(x)


def _mpf(value: Any) -> Any:
    import mpmath

    return mpmath.mpf(value)


def _is_mpmath(t: Any) -> bool:
    return type(t).__module__.partition(".")[0] == "mpmath"
