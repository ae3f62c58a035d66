"""T15: Chaplygin's ball with two equal moments of inertia on a level plane: elementary, but for Kepler's equation."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...mechanics.algebra import Quaternion, Vector
from ...mechanics.loads import constant_part
from ...mechanics.scalars import Scalar, namespace
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .chaplygin_domain import principal_axes, reasons_outside, stance_of
from .kepler import inverse_of, precisely
from .phi import phase
from .quadrature import is_one, one_by_one

_DIGITS = 60  # for the constants: where M is nearly upright they are small differences
_LEVEL = "1e-40"  # of M at least: only where it is upright to all digits is it tipped so, by less than any digit shows
_NOTHING = "1e-25"  # of 1: what so small a tip makes of nothing
_NEVER = 1e30  # s
_EQUAL = 1e-15  # share of a moment by which two that are equal may differ after rounding


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
    domain = (
        "a ball with its centre of mass at its centre and two equal principal moments of inertia, on a level plane at "
        "rest, under constant forces along the normal"
    )
    never = frozenset({"lift", "curved"})  # N is constant

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> ChaplyginBall:
        """Read the closed form's numbers from a system and a start.

        Parameters
        ----------
        system : RollingSystem
            Must lie in the domain.
        start : State
            A start that rolls.

        Returns
        -------
        ChaplyginBall
            The motion; its t = 0 is the start's time.

        Raises
        ------
        OutOfDomainError
            If the system lies outside the domain.

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
        odd = _odd(moments) or 0
        body_axis = axes[odd]
        e = Quaternion(*start.orientation).matrix() @ Vector(*body_axis)
        force, _, _ = constant_part(system.all_loads, system.body.mass)
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

    @classmethod
    def outside(cls, system: RollingSystem, start: State | None = None) -> list[str]:
        """Name what of a system lies outside the domain.

        Parameters
        ----------
        system : RollingSystem
            Any system.
        start : State, optional
            Its start; every one that rolls lies in the domain, unless it is at rest.

        Returns
        -------
        list of str
            Empty where the closed form applies.

        Examples
        --------
        >>> import trundle as tr
        >>> ball = tr.Body(1.0, tr.Principal(3e-3, 4e-3, 5e-3), tr.Sphere(0.1))
        >>> ChaplyginBall.outside(tr.RollingSystem(ball, tr.Support(tr.Plane())))
        ['no two of its moments of inertia are equal']
        """
        reasons = reasons_outside(system)
        if not reasons and _odd(principal_axes(system.body)[0]) is None:
            reasons.append("no two of its moments of inertia are equal")
        if start is not None and not any(start.angular_velocity):
            reasons.append("the ball does not turn")
        return reasons

    # The constants of the motion

    @cached_property
    def _floats(self) -> _Constants:
        return _Constants(*(float(part) for part in _constants(self)))

    def _numbers(self, t: Any) -> _Constants:
        if not _is_mpmath(t):
            return self._floats
        return _Constants(*_constants(self))

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

    def pace(self, duration: float) -> float:  # noqa: ARG002
        """Return a bound of Ω by the energy M·Ω/2, rad/s."""
        twice = self.momentum.dot(Vector(*self.angular_velocity))
        return float(math.sqrt(max(twice, 0.0) / min(self.across, self.along)))

    def repeats(self, stop: str) -> float:
        """Return the period of the nutation for what the forces decide."""
        return self.nutation_period if stop == "slip" else self.period

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Parameters
        ----------
        t : float or array
            Time since the start, s.

        Returns
        -------
        position, velocity, angular_velocity, contact_force : Vector
            In the inertial support frame, m, m/s, rad/s, N.

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

        Parameters
        ----------
        t : float or array
            Time since the start, s.

        Returns
        -------
        Vector
            A unit vector in the inertial support frame.

        Examples
        --------
        >>> ball = ChaplyginBall(0.1, 1.0, 4e-3, 3e-3, (0.0, 0.0), (0.6, 0.0, 0.8), (1.0, 2.0, 3.0))
        >>> [round(float(part), 12) + 0.0 for part in ball.axis_at(0.0)]
        [0.6, 0.0, 0.8]
        """
        c = self._numbers(t)
        return c.at(t).axis(c)

    def stance(self, t: Any) -> Quaternion:
        """Return an orientation with which the axis is where it is: its turns about e do not change the forces."""
        return stance_of(Vector(*self.body_axis), self.axis_at(t))


@dataclass(frozen=True)
class _Constants:
    """What follows from the start once and for all; all floats, or all mpmath's."""

    radius: Any
    mass: Any
    normal_force: Any
    px: Any  # where the centre starts
    py: Any
    mx: Any  # direction of the level part of M
    my: Any
    beta: Any  # D (1/(J₃ + D) − 1/(J₁ + D)): y² = α − βx²
    root: Any  # √α, α = J₁/(J₁ + D)
    cosine: Any  # C(φ₀) and S(φ₀): the middle of the swing
    sine: Any
    size: Any  # κ = S(ψ) at its end
    rest: Any  # k' = √(1 − βκ²)
    lead: Any  # b
    rate: Any  # ν, rad/s, and what the float leaves
    rate_rest: Any
    mean0: Any  # η₀ + b Φ(η₀)
    lag0: Any  # Φ(η₀)
    angle0: Any  # ψ(η₀)
    even: Any  # M̂·e = even C(ψ) + odd S(ψ), for the level part of M
    odd: Any
    turning: Any  # n×M̂·e = turning cos η
    nod: Any  # ẋ = nod cos η
    level: Any  # |M level|/(J₁ + D)
    ring: Any  # Ω = level M̂ + ring e/y, over the plane
    upright: Any  # Ω·n = upright + twist x/y
    twist: Any
    drift: Any  # a Ω over the plane, on average along M̂, m/s
    swing: Any  # and what comes and goes
    sway: Any

    def at(self, t: Any) -> _Now:
        """Return where the nutation is."""
        gone0 = self.mean0 - self.lead * self._lag(0 * self.size + 1)
        if _is_mpmath(t):
            import mpmath

            gone, turn = gone0 + (self.rate + self.rate_rest) * t, 2 * mpmath.pi
            gone = gone - turn * mpmath.floor(gone / turn)
            floats = _Constants(*(float(part) for part in vars(self).values()))
            near = inverse_of(floats._mean, np.array([float(gone)]), np.array([2 * np.pi]))[0]
            eta = precisely(self._mean, gone, float(near))
        else:
            _, turned = phase((self.rate, self.rate_rest), np.asarray(t, dtype=float))
            gone = gone0 + turned
            gone = np.maximum(gone - 2 * np.pi * np.floor(gone / (2 * np.pi)), 0.0)
            eta = inverse_of(self._mean, gone, np.full_like(gone, 2 * np.pi))
        xp = namespace(eta)
        return self._now(xp.sin(eta), xp.cos(eta))

    def _mean(self, eta: Any) -> tuple[Any, Any]:
        """Return η + b Φ(η) less its value at 0, and its slope."""
        xp = namespace(eta)
        S = self.size * xp.sin(eta)
        value = eta + self.lead * (self._lag(xp.cos(eta)) - self._lag(0 * self.size + 1))
        return value, 1 - self.lead * S / xp.sqrt(1 - self.beta * S * S)

    def _lag(self, cosine: Any) -> Any:
        return arc(self.size * cosine / self.rest, -self.beta)

    def _now(self, sine: Any, cosine: Any) -> _Now:
        S = self.size * sine
        C = namespace(S).sqrt(1 - self.beta * S * S)
        y = self.root * (self.cosine * C - self.beta * self.sine * S)
        x = self.root * (self.sine * C + self.cosine * S)
        lag, angle = self._lag(cosine), arc(S, self.beta)
        return _Now(x, y, self.nod * cosine, lag, angle, self.even * C + self.odd * S, self.turning * cosine)


@dataclass(frozen=True)
class _Now:
    """Where the nutation is: x = e·n, y, ẋ, Φ, ψ, and e over the plane along M and across it."""

    x: Any
    y: Any
    x_rate: Any
    lag: Any
    angle: Any
    ahead: Any
    aside: Any

    def axis(self, c: _Constants) -> Vector:
        return Vector(c.mx * self.ahead - c.my * self.aside, c.my * self.ahead + c.mx * self.aside, self.x)


def arc(sine: Any, curvature: Any) -> Any:
    """Return the angle φ with S(φ) = sine, S = sin(√βφ)/√β or, where β is negative, sinh(√−βφ)/√−β.

    Parameters
    ----------
    sine : float, array or mpmath number
        S.
    curvature : float or mpmath number
        β.

    Returns
    -------
    as sine
        φ, which is S itself for β = 0.

    Examples
    --------
    >>> float(arc(0.5, 1.0)) == math.asin(0.5), float(arc(0.5, -1.0)) == math.asinh(0.5), arc(0.5, 0.0)
    (True, True, 0.5)
    """
    if not curvature:
        return sine
    functions, asin, asinh = np, "arcsin", "arcsinh"
    if _is_mpmath(sine):
        import mpmath

        functions, asin, asinh = mpmath, "asin", "asinh"
    root = functions.sqrt(abs(curvature))
    return getattr(functions, asin if curvature > 0 else asinh)(root * sine) / root


def _constants(form: ChaplyginBall) -> tuple[Any, ...]:
    """Return the fields of `_Constants` as mpmath numbers."""
    import mpmath

    given = (form.radius, form.mass, form.across, form.along, form.normal_force)
    with mpmath.workdps(2 * max(_DIGITS, mpmath.mp.dps)):
        a, m, J1, J3, N = map(mpmath.mpf, given)
        px, py = map(mpmath.mpf, form.position)
        e, Omega = (Vector(*map(mpmath.mpf, triple)) for triple in (form.axis, form.angular_velocity))
        e = e / e.norm()
        D, spin = m * a * a, Omega.dot(e)
        A1, A3 = 1 / (J1 + D), 1 / (J3 + D)
        alpha, beta = J1 * A1, D * (A3 - A1)
        root = mpmath.sqrt(alpha)
        M = Omega / A1 + e * ((J3 - J1) * spin)
        M = Vector(M.x, M.y, M.z - D * Omega.z)
        tip = mpmath.mpf(_LEVEL) * (M.norm() or 1 / A1)
        tipped = mpmath.hypot(M.x, M.y) < tip
        if tipped:
            M = Vector(tip, mpmath.mpf(0), M.z)
        level = mpmath.hypot(M.x, M.y)
        mx, my = M.x / level, M.y / level
        x = e.z
        y = mpmath.sqrt(alpha - beta * x * x)
        C, mu = (M.dot(e) + D / J1 * M.z * x) / y, M.z / alpha
        # The middle of the swing, by the double angle.
        w = level**2 + mu**2 - beta * C * C
        R = mpmath.sqrt(w * w + 4 * beta * (C * mu) ** 2)
        cosine = mpmath.sqrt((1 + w / R) / 2)
        sine = C * mu / (R * cosine)
        S0, nodding = (x * cosine - y * sine) / root, e.y * M.x - e.x * M.y  # S(ψ₀) and ẋ₀/A₁
        wide = mpmath.sqrt(alpha * R)
        size = mpmath.hypot(S0, nodding / wide)
        eta0 = mpmath.atan2(S0 * wide, nodding) if size else mpmath.mpf(0)
        rest = mpmath.sqrt(1 - beta * size * size)
        lead, rate = beta * sine / cosine, A1 * mpmath.sqrt(R) / cosine
        lag0 = arc(size * mpmath.cos(eta0) / rest, -beta)
        high = mpmath.mpf(float(rate))
        B = A3 - A1
        ring = B * alpha * C
        sway = a * ring / (A1 * level)
        even, odd = root * (C * cosine - mu * sine) / level, -root * (C * beta * sine + mu * cosine) / level
        way, turning = a * ring / (A1 * mpmath.sqrt(R) * root), size * wide / level
        drift, swing = a * A1 * level + way * rate * even, -way * (even * lead + odd)
        twist = B * C
        if tipped:  # take the tip out again
            none, nothing = 0 * level, mpmath.mpf(_NOTHING)
            level = drift = none
            if max(abs(even), abs(odd) * size, abs(turning)) < nothing:  # e is upright, too
                even = odd = turning = swing = sway = none
            if abs(C) < nothing * abs(mu):  # or level
                ring = twist = swing = sway = none
        return (
            a, m, N, px, py, mx, my, beta, root, cosine, sine, size, rest, lead,
            high, rate - high, eta0 + lead * lag0, lag0, arc(S0, beta), even, odd,
            turning, A1 * size * wide, A1 * level, ring, M.z / J1, twist, drift, swing, sway,
        )  # fmt: skip


def _odd(moments: tuple[float, float, float]) -> int | None:
    """Return which of three moments differs from two that are equal to rounding."""
    for i in range(3):
        first, second = moments[(i + 1) % 3], moments[(i + 2) % 3]
        if abs(first - second) <= _EQUAL * max(first, second):
            return i
    return None


def _is_mpmath(t: Any) -> bool:
    return type(t).__module__.partition(".")[0] == "mpmath"
