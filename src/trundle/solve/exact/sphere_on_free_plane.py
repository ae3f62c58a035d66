"""T13: a ball on a level turntable that turns freely on its axle: a conic, in time by an equation like Kepler's."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from ...mechanics.algebra import Vector
from ...mechanics.scalars import Scalar
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .domain import ALONG_NORMAL, CONSTANT_LOADS, PRESSED, SPHERE, TURNING_FREELY, constant_forces, on
from .finding import Finding
from .fits import Seen, conic, round_time
from .formula import Lines, quantity
from .kepler import inverse_of, precisely, stumpff
from .quadrature import is_one, one_by_one


@dataclass(frozen=True)
class SphereOnFreePlane(ClosedForm):
    """The motion ζ = ζ₀ + ζ₀′ sin ντ/ν + ζ₀″(1 − cos ντ)/ν², t = ∫w dτ, ω = h/w with w² = I_t + mκ̂|ζ|² (T13).

    M = ζ̇ − iκ̂ωζ and h = ωw are constant, κ̂ = k/(1 + k), and ν² = κ̂(κ̂h² − m|M|²): where it is positive, the path
    is an ellipse, where negative, a branch of a hyperbola. The table has turned by hτ.

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²).
    axle_inertia : float or array
        I_t of the table about its axle, kg m².
    rate : float or array
        ω of the table at t = 0, rad/s.
    position, velocity : pair of float or array
        Centre at t = 0 over the plane, m and m/s, in the inertial support frame.
    spin : float or array
        Ω·n, rad/s.
    normal_force : float or array
        N, N.

    Examples
    --------
    A ball that is let go at rest on a heavy table circles as on a driven one:

    >>> ball = SphereOnFreePlane(0.025, 0.065, 0.4, 1e9, 3.5, (0.1, 0.0), (0.0, 0.2))
    >>> round(ball.period * 3.5 / math.pi, 6)  # 2π over 2/7 of the rate
    7.0
    """

    radius: Scalar
    mass: Scalar
    inertia_ratio: Scalar
    axle_inertia: Scalar
    rate: Scalar
    position: tuple[Scalar, Scalar]
    velocity: tuple[Scalar, Scalar] = (0.0, 0.0)
    spin: Scalar = 0.0
    normal_force: Scalar = 0.0

    name = "sphere on a free turntable"
    equation = "T13"
    source = "Weckesser, Am. J. Phys. 65, 736 (1997), for the conic; theory page, T13, for the time"
    conditions = (SPHERE, on(Plane), TURNING_FREELY, CONSTANT_LOADS, ALONG_NORMAL, PRESSED)
    impossible_events = frozenset({"lift"})  # N is constant

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SphereOnFreePlane:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> table = tr.Support(tr.Plane(), motion=tr.FreeAxle(0.01, 3.0))
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
        >>> SphereOnFreePlane.of(system, system.place((0.1, 0.0))).path
        'ellipse'
        """
        cls.check_domain(system, start)
        force, _ = constant_forces(system)
        return cls(
            radius=system.body.radius,
            mass=system.body.mass,
            inertia_ratio=system.body.inertia_ratio,
            axle_inertia=system.support.motion.inertia,
            rate=start.support[1],
            position=start.position[:2],
            velocity=start.velocity[:2],
            spin=start.angular_velocity[2],
            normal_force=-force.z,
        )

    # The constants of the motion

    @property
    def drive(self) -> tuple[Any, Any]:
        """M = ζ̇ − iκ̂ωζ, m/s: constant, however the table turns."""
        M = _Orbit.of(self, float).M
        return M.real, M.imag

    @property
    def angular_momentum(self) -> Any:
        """L = I_tω + m(xẏ − yẋ) about the axle, kg m²/s: constant, besides the spin."""
        (x, y), (vx, vy) = self.position, self.velocity
        return self.axle_inertia * self.rate + self.mass * (x * vy - y * vx)

    @property
    def path(self) -> str:
        """What the conic is: "ellipse", "parabola" or "hyperbola"."""
        square = _Orbit.of(self, float).square
        return "ellipse" if square > 0 else "hyperbola" if square < 0 else "parabola"

    @property
    def period(self) -> float:
        """Of the ellipse, s; infinite on any other path."""
        if not is_one(self):
            return math.inf
        return float(_Orbit.of(self, float).period)

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return a bound of the rate at which it goes round, 1/s."""
        orbit = _Orbit.of(self, float)
        return float((math.sqrt(abs(orbit.square)) + abs(orbit.c)) / math.sqrt(self.axle_inertia))

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> ball = SphereOnFreePlane(0.025, 0.065, 0.4, 0.01, 3.5, (0.1, 0.0), (0.0, 0.2))
        >>> [round(float(part), 12) for part in ball.motion_at(ball.period)[0]]
        [0.1, 0.0, 0.025]
        """
        return self.motion_and_support_at(t)[0] if is_one(self) else one_by_one(self, t)

    def support_coordinates_at(self, t: Any) -> tuple[Any, Any]:
        """Return the angle by which the table has turned, rad, and by how much its rate has grown, rad/s."""
        return self.motion_and_support_at(t)[1]

    def motion_and_support_at(self, t: Any) -> tuple[tuple[Vector, Vector, Vector, Vector], tuple[Any, ...]]:
        """Return what `motion_at` and `own_at` do, by going once from the time to τ."""
        number = _mpf if _is_mpmath(t) else float
        orbit = _Orbit.of(self, number)
        zeta, V, A, omega, angle = orbit.at(t)
        a, m, zero = number(self.radius), number(self.mass), 0 * t
        Omega = (1j * V + omega * zeta) / a
        motion = (
            Vector(zeta.real + zero, zeta.imag + zero, a + zero),
            Vector(V.real + zero, V.imag + zero, zero),
            Vector(Omega.real + zero, Omega.imag + zero, number(self.spin) + zero),
            Vector(m * A.real + zero, m * A.imag + zero, number(self.normal_force) + zero),
        )
        return motion, (angle, omega - self.rate)

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return its two integrals."""
        momentum = quantity(self.angular_momentum, r"kg\,m^2/s")
        drive = math.hypot(*map(float, self.drive))
        return [
            (r"L = I_t\,\omega + m\,\mathrm{Im}(\bar\zeta\dot\zeta)", f"L = {momentum}"),
            (r"M = \dot\zeta - i\frac{k}{1+k}\,\omega\,\zeta", rf"|M| = {quantity(drive, 'm/s')}"),
        ]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare the angular momentum of ball and table, and the conic."""
        coordinates, V = seen.at.support_coordinates, seen.at.velocity
        rate = coordinates[:, 1] if coordinates.shape[1] > 1 else np.full(seen.time.size, np.nan)
        x, y = seen.at.position[:, 0], seen.at.position[:, 1]
        momentum = float(self.axle_inertia) * rate + float(self.mass) * (x * V[:, 1] - y * V[:, 0])
        predicted = float(self.angular_momentum)
        worst = float(momentum[np.argmax(np.abs(momentum - predicted))])
        scale = float(np.max(np.abs(float(self.axle_inertia) * rate)))
        yield Finding(
            "Angular momentum about the axle", "L", predicted, worst, "kg m²/s", note="of ball and table", scale=scale
        )
        if not self.rate:
            return  # a table at rest that the ball sets going: no conic
        centre, measured = conic(seen)
        share = float(self.inertia_ratio) / (1 + float(self.inertia_ratio))
        square = float(self.axle_inertia) + float(self.mass) * share * abs(complex(*self.position)) ** 2
        drive = math.hypot(*map(float, self.drive)) * math.sqrt(float(self.mass) / share)
        eccentricity = drive / (abs(float(self.rate)) * math.sqrt(square))
        scale = max(eccentricity, 0.1)
        said = "" if math.isfinite(self.period) else f"follows a {self.path} of eccentricity {{}}"
        yield Finding(f"Eccentricity of the {self.path}", "e", eccentricity, measured, "", scale=scale, said=said)
        if math.isfinite(self.period):
            angle = np.unwrap(np.angle(seen.zeta - centre))
            measured = None if measured is None else round_time(seen.time, angle)
            yield Finding(
                "Time round the ellipse", "T", float(self.period), measured, "s", said="rounds its ellipse in {}"
            )


@dataclass(frozen=True)
class _Orbit:
    """The linear system ζ′ = icζ + Mw, w′ = mκ̂ Re(ζ̄M) of τ = ∫dt/w; all numbers floats, or all mpmath's."""

    share: Any  # κ̂
    pull: Any  # mκ̂
    axle: Any  # I_t
    zeta: Any  # ζ₀
    first: Any  # ζ₀′ = w₀ζ̇₀
    M: Any
    w: Any  # w₀
    h: Any
    c: Any  # κ̂h
    square: Any  # ν²
    along: tuple[Any, Any]  # X = Re(ζ̄M) and X′ at the start

    @staticmethod
    def of(form: SphereOnFreePlane, number: Any) -> _Orbit:
        k, omega = number(form.inertia_ratio), number(form.rate)
        share = k / (1 + k)
        pull = number(form.mass) * share
        zeta, V = (number(x) + 1j * number(y) for x, y in (form.position, form.velocity))
        M = V - 1j * (share * omega) * zeta
        axle = number(form.axle_inertia)
        square = axle + pull * (zeta.real**2 + zeta.imag**2)
        w = square**0.5 if number is float else _root(square)
        h = omega * w
        c, size = share * h, M.real**2 + M.imag**2
        first = w * V
        along = (zeta.conjugate() * M).real, (first.conjugate() * M).real
        return _Orbit(share, pull, axle, zeta, first, M, w, h, c, c * c - pull * size, along)

    @property
    def turn(self) -> Any:
        """2π/ν, once round the ellipse."""
        return 2 * math.pi / math.sqrt(self.square)

    @property
    def period(self) -> Any:
        if self.square <= 0:
            return math.inf
        return self.turn * (self.w + self.pull * self.along[1] / self.square)

    def _time(self, tau: Any) -> tuple[Any, Any]:
        """Return t and w = dt/dτ."""
        _, s1, c2, s3 = stumpff(self.square, tau)
        X, X_rate = self.along
        return self.w * tau + self.pull * (X * c2 + X_rate * s3), self._rate(s1, c2)

    def _rate(self, s1: Any, c2: Any) -> Any:
        """Return w."""
        X, X_rate = self.along
        return self.w + self.pull * (X * s1 + X_rate * c2)

    @cached_property
    def _vertex(self) -> tuple[float, float, _Orbit] | None:
        """When a hyperbola is nearest to the axle, τ there, and its orbit from there on; None where it only leaves.

        Written from its start, a ball on its way out would be the small difference of what grows as e^|ν|τ.
        """
        X, X_rate = self.along
        if not self.square < 0 or not X < 0 or math.isinf(X_rate):
            return None
        nu = math.sqrt(-self.square)
        if not X_rate + nu * X > 0:
            return None
        tau = 0.5 * math.log((X_rate - nu * X) / (X_rate + nu * X)) / nu
        t, _ = self._time(tau)
        _, s1, c2, _ = stumpff(self.square, np.float64(tau))
        zeta = self.zeta + self.first * s1 + self._second * c2
        w = math.sqrt(self.axle + self.pull * (zeta.real**2 + zeta.imag**2))
        first = 1j * self.c * zeta + self.M * w
        along = 0.0, (first.conjugate() * self.M).real
        return float(t), tau, replace(self, zeta=zeta, first=first, w=w, along=along)

    @property
    def _second(self) -> Any:
        """ζ″ at the start."""
        return 1j * self.c * self.first + self.M * (self.pull * self.along[0])

    def at(self, t: Any) -> tuple[Any, Any, Any, Any, Any]:
        """Return ζ, ζ̇, ζ̈, ω and the table's angle."""
        if _is_mpmath(t) or self._vertex is None:
            return self._from_start(t)
        t = np.asarray(t, dtype=float)
        passed, tau, onward = self._vertex
        before, behind = self._from_start(np.minimum(t, passed)), onward._from_start(np.maximum(t - passed, 0.0))
        behind = (*behind[:4], behind[4] + self.h * tau)
        return tuple(np.where(t < passed, *parts) for parts in zip(before, behind, strict=True))

    def _from_start(self, t: Any) -> tuple[Any, Any, Any, Any, Any]:
        """Return the same, all of it as it grows from the start."""
        rounds: Any = 0.0
        if _is_mpmath(t):
            rough = _Orbit(*(_rounded(getattr(self, field.name)) for field in fields(self)))
            tau = precisely(self._time, t, float(rough.found(np.asarray(float(t)))))
        else:
            t = np.asarray(t, dtype=float)
            rounds = np.floor(t / self.period)
            tau = self.found(t - rounds * self.period if math.isfinite(self.period) else t)
        cosine, s1, c2, _ = stumpff(self.square, tau)
        w = self._rate(s1, c2)
        X = self.along[0] * cosine + self.along[1] * s1
        first, second = self.first, self._second
        zeta, V = self.zeta + first * s1 + second * c2, (first * cosine + second * s1) / w
        omega = self.h / w
        A = 1j * self.share * (omega * V - omega * self.pull * X / (w * w) * zeta)
        whole = rounds * self.turn if self.square > 0 and not _is_mpmath(t) else 0
        return zeta, V, A, omega, self.h * (tau + whole)

    def found(self, t: Any) -> Any:
        """Return τ at given times."""
        return inverse_of(self._time, t, t / self.w)


def _rounded(part: Any) -> Any:
    if isinstance(part, tuple):
        return tuple(float(one) for one in part)
    return complex(part) if hasattr(part, "imag") and part.imag else float(part.real)


def _root(x: Any) -> Any:
    import mpmath

    return mpmath.sqrt(x)


def _mpf(value: Any) -> Any:
    import mpmath

    return mpmath.mpf(value)


def _is_mpmath(t: Any) -> bool:
    return type(t).__module__.partition(".")[0] == "mpmath"
