"""T15c: Chaplygin's ball of any three moments whose momentum is upright: a free body, by Jacobi's functions of time."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...mechanics.algebra import E_Z, Quaternion, Vector
from ...mechanics.scalars import Scalar, namespace
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .chaplygin_domain import (
    CHAPLYGIN_BALL,
    ON_LEVEL_PLANE,
    TURNS,
    body_quaternion,
    principal_axes,
    stance_of,
    turning_faster,
    two_are_equal,
)
from .domain import FORCES, START, Condition, constant_forces, that
from .finding import Finding
from .fits import Seen
from .formula import Lines, quantity
from .phi import phase
from .quadrature import PreciseRunning, Running, is_one, one_by_one
from .upright_polhode import Constants, Now, Polhode, precession

_ASIDE = 1e-14  # share of (J + D)Ω that may lie across n by rounding
_PIECE = 0.5  # of Jacobi's argument λt: the functions are analytic at least 0.8 off the real axis
_TURN = 3.0  # rad of precession on a piece, at most
_MOST_PIECES = 20_000
_SEPARATRIX = 1e-14  # m₁ so small is one that rounding has made


def _asymmetric(system: RollingSystem) -> bool:
    return two_are_equal(principal_axes(system.body)[0]) is None


def _leaning(system: RollingSystem, start: State) -> Iterator[str]:
    L = _momentum(system, start)
    if math.hypot(L.x, L.y) > _ASIDE * L.norm():
        yield "the momentum about the contact is not along the normal"
    elif any(start.angular_velocity):
        moments, axes = principal_axes(system.body)
        q = Quaternion(*start.orientation) * body_quaternion(axes)
        a, m = system.body.radius, system.body.mass
        form = UprightChaplyginBall(a, m, moments, (0.0, 0.0), (q.w, q.x, q.y, q.z), L.z)
        if Polhode.of(form).complement < _SEPARATRIX:
            yield "the ball turns about its middle axis or comes to, where a rounding would decide"
        elif form._pieces > _MOST_PIECES:
            yield "two moments are so nearly equal that it goes round too slowly to be followed"


@dataclass(frozen=True)
class UprightChaplyginBall(ClosedForm):
    """A ball with its centre of mass at its centre whose momentum about the contact is along n (T15c).

    Then (J + D)Ω = Ln with a constant L, D = ma²: n goes round in the body as the angular momentum of a free one with
    the moments J + D does, by sn, cn and dn of the time. The precession ψ about n is an integral of the third kind, and
    the path one quadrature of e^iψ over half a round, which is done to the last digits; any later time costs no more.
    Every number may be a float, or an array of members.

    Parameters
    ----------
    radius, mass : float or array
        a in m, m in kg.
    moments : triple of float or array
        J along the principal axes, kg m², no two equal.
    position : pair of float or array
        Centre at t = 0 over the plane, m.
    orientation : 4 floats or arrays
        Quaternion from the principal axes to the inertial support frame at t = 0.
    momentum : float or array
        L, kg m²/s.
    body_axes : 4 floats or arrays
        Quaternion from the principal axes to the body frame.
    normal_force : float or array
        N, N.

    Examples
    --------
    Ω·n is constant, as the energy is LΩ·n/2:

    >>> ball = UprightChaplyginBall(0.1, 0.64, (2e-3, 3.2e-3, 4.8e-3), (0.0, 0.0), (0.8, 0.6, 0.0, 0.0), 0.08)
    >>> bool(np.ptp(ball.motion_at(np.linspace(0.0, 9.0, 9))[2].z) < 1e-15)
    True
    """

    radius: Scalar
    mass: Scalar
    moments: tuple[Scalar, Scalar, Scalar]
    position: tuple[Scalar, Scalar]
    orientation: tuple[Scalar, Scalar, Scalar, Scalar]
    momentum: Scalar
    body_axes: tuple[Scalar, Scalar, Scalar, Scalar] = (1.0, 0.0, 0.0, 0.0)
    normal_force: Scalar = 0.0

    name = "Chaplygin's ball with upright momentum"
    equation = "T15c"
    source = "Chaplygin, Mat. Sb. 24, 139 (1903); Landau and Lifshitz, Mechanics (1976), section 37, for the free body"
    conditions = (
        *CHAPLYGIN_BALL,
        that(_asymmetric, ", with three different moments", "two of the moments of inertia are equal", FORCES),
        *ON_LEVEL_PLANE,
        TURNS,
        Condition(", with its momentum about the contact along the normal", _leaning, START),
    )
    impossible_events = frozenset({"lift", "curved"})  # N is constant

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> UprightChaplyginBall:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> ball = tr.Scenario.load("chaplygin-ball")
        >>> round(UprightChaplyginBall.of(ball.system(), ball.start_state()).momentum, 12)
        0.08
        """
        cls.check_domain(system, start)
        moments, axes = principal_axes(system.body)
        turn = body_quaternion(axes)
        force, _ = constant_forces(system)
        q = Quaternion(*start.orientation) * turn
        return cls(
            radius=system.body.radius,
            mass=system.body.mass,
            moments=moments,
            position=start.position[:2],
            orientation=(q.w, q.x, q.y, q.z),
            momentum=float(_momentum(system, start).z),
            body_axes=(turn.w, turn.x, turn.y, turn.z),
            normal_force=-float(force.z),
        )

    # The constants of the motion

    @cached_property
    def _floats(self) -> Constants:
        return Constants.of(self)

    @property
    def round_period(self) -> float:
        """Time in which n goes half round in the body, s: after it Ω is as long as before."""
        return 2 * math.pi / self._floats.rate

    @property
    def period(self) -> float:
        """Infinite: the path is a rosette that does not close."""
        return math.inf

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return a bound of how fast Ω changes, rad/s."""
        c = self._floats
        return abs(self.momentum) / (min(self.moments) + self.mass * self.radius**2) + c.rate

    def repeats(self, stop: str) -> float:
        """Return the time after which the size of the force repeats."""
        return self.round_period if stop == "slip" else self.period

    @property
    def _pieces(self) -> int:
        """Of the quadrature, over half of `round_period`."""
        c = self._floats
        fastest = abs(c.steady) + abs(c.extra) * max(1.0, 1.0 / (1.0 - c.nu))
        half = math.pi / c.rate
        return math.ceil(half * max(abs(c.scale) / _PIECE, fastest / _TURN))

    # Precession and path

    @cached_property
    def _precession(self) -> Running:
        step = math.pi / self._floats.rate / self._pieces
        return Running(lambda t: self._floats.at(t, 1.0).precession[None], -self._pieces, self._pieces, step)

    @cached_property
    def _way(self) -> Running:
        def turning(t: Any) -> Any:
            now, psi = self._floats.at(t, 1.0), self._precession.at(t)[0]
            c, s = np.cos(psi), np.sin(psi)
            return np.stack([now.along * c - now.across * s, now.along * s + now.across * c])

        step = math.pi / self._floats.rate / self._pieces
        return Running(turning, -self._pieces, self._pieces, step)

    @cached_property
    def _round(self) -> complex:
        """∫(Ω over the plane) over one period of it, from t = 0, with ψ = 0 there."""
        half = math.pi / self._floats.rate
        ahead, behind = (complex(*self._way.at(t)) for t in (half, -half))
        return ahead - np.exp(1j * self._floats.gain) * behind

    @cached_property
    def _precise(self) -> PreciseRunning:
        import mpmath

        def turning(t: Any) -> list[Any]:
            c = Constants.of(self, t)
            now, psi = c.at(t, 1), precession(c, t)
            z = mpmath.expj(psi) * mpmath.mpc(now.along, now.across)
            return [z.real, z.imag]

        return PreciseRunning(turning, 0.5 * _PIECE / abs(self._floats.scale))

    def _turned(self, t: Any) -> tuple[Constants, Now, Any]:
        """Return constants, what repeats, and e^iψ, the axis that it is told along."""
        if _is_mpmath(t):
            import mpmath

            c = Constants.of(self, t)
            return c, c.at(t, 1), mpmath.expj(c.psi + precession(c, t))
        c, (rounds, rest) = self._floats, self._rounds(t)
        parity = 1.0 - 2.0 * (rounds % 2)
        here = np.exp(1j * self._precession.at(rest)[0])
        return c, c.at(rest, parity), self._before(rounds) * (parity if c.middle else 1.0) * here

    def _rounds(self, t: Any) -> tuple[Any, Any]:
        """Return how many half rounds are done, and the time since, s."""
        c = self._floats
        y, turned = phase((c.rate, c.rate_rest), np.asarray(t, dtype=float))
        return np.round((y - turned) / (2 * math.pi)), turned / c.rate

    def _before(self, rounds: Any) -> Any:
        """Return e^iψ after some half rounds, with the flips in it."""
        c = self._floats
        return np.exp(1j * (c.psi + phase((c.gain, c.gain_rest), rounds)[1]))

    def _gone(self, t: Any) -> Any:
        """Return ∫Ω over the plane since the start, as a complex number."""
        if _is_mpmath(t):
            import mpmath

            c, (x, y) = Constants.of(self, t), self._precise.at(t)
            return mpmath.expj(c.psi) * mpmath.mpc(x, y)
        c, (rounds, rest) = self._floats, self._rounds(t)
        way, half = self._way.at(rest), 0.5 * c.gain
        many = rounds if half == 0 else np.sin(phase((half, 0.5 * c.gain_rest), rounds)[1]) / math.sin(half)
        summed = many * np.exp(1j * (c.psi + phase((half, 0.5 * c.gain_rest), rounds - 1.0)[1])) * self._round
        return summed + self._before(rounds) * (way[0] + 1j * way[1])

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> ball = UprightChaplyginBall(0.1, 0.64, (2e-3, 3.2e-3, 4.8e-3), (0.0, 0.0), (0.8, 0.6, 0.0, 0.0), 0.08)
        >>> [round(float(part), 12) + 0.0 for part in ball.motion_at(0.0)[1]]
        [0.032, 0.0, 0.0]
        """
        if not is_one(self):
            return one_by_one(self, t)
        (c, now, turn), gone = self._turned(t), self._gone(t)
        Omega = self._angular_velocity(c, now, turn)
        along, across = now.along_rate - now.precession * now.across, now.across_rate + now.precession * now.along
        a, m, zero = c.radius, c.mass, 0 * Omega.x
        fx, fy = along * turn.real - across * turn.imag, along * turn.imag + across * turn.real
        return (
            Vector(c.px + a * gone.imag, c.py - a * gone.real, a + zero),
            Vector(a * Omega.y, -a * Omega.x, zero),
            Omega,
            Vector(m * a * fy, -m * a * fx, c.normal_force + zero),
        )

    def angular_velocity_at(self, t: Any) -> Vector:
        """Return Ω alone, without the path."""
        return self._angular_velocity(*self._turned(t)) if is_one(self) else self.motion_at(t)[2]

    @staticmethod
    def _angular_velocity(c: Constants, now: Now, turn: Any) -> Vector:
        x, y, along, across = turn.real, turn.imag, now.along, now.across
        Ox = along * x - across * y
        return Vector(Ox, along * y + across * x, c.upright + 0 * Ox)

    def representative_orientation(self, t: Any) -> Quaternion:
        """Return the orientation, or the same with the other sign."""
        c, now, turn = self._turned(t)
        leaned = stance_of(E_Z, now.normal).conjugate  # takes n in the body to n; a turn about n is left
        e = leaned.matrix() @ c.followed
        size = namespace(turn.real).sqrt(e.x * e.x + e.y * e.y)
        size = size + (size == 0)
        c2, s2 = (turn.real * e.x + turn.imag * e.y) / size, (turn.imag * e.x - turn.real * e.y) / size
        xp = namespace(c2)
        half = 0.5 * xp.atan2(s2, c2)
        return Quaternion(xp.cos(half), 0.0, 0.0, xp.sin(half)) * leaned * Quaternion(*self.body_axes).conjugate

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return the momentum about the contact, which it keeps."""
        momentum = quantity(self.momentum, r"kg\,m^2/s")
        return [(r"(J + m a^2)\,\Omega = L\,n", f"L = {momentum}")]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare the time after which Ω is as long as before."""
        found = turning_faster("Time of half a round of the normal in the ball", self.round_period, seen)
        if found is not None:
            yield found[0]


def _momentum(system: RollingSystem, start: State) -> Vector:
    """Return (J + D)Ω, which is Chaplygin's vector but for a part along n."""
    Q, Omega = Quaternion(*start.orientation).matrix(), Vector(*start.angular_velocity)
    D = system.body.mass * system.body.radius**2
    return system.body.inertia_in_space(Q) @ Omega + Omega * D


def _is_mpmath(t: Any) -> bool:
    return type(t).__module__.partition(".")[0] == "mpmath"
