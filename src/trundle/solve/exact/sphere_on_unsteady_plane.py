"""T9: a sphere on a plane that turns at any given ω(t) about its normal, under forces given in time: quadratures."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ...errors import SolverError
from ...mechanics.algebra import Vector
from ...mechanics.loads import Force, Load, Torque, at_rest, constant_part
from ...mechanics.motions import Motion, SpinBy, UnevenSpin
from ...mechanics.scalars import Scalar
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .quadrature import is_one, one_by_one, rule, series_at

_LONGEST = 0.5  # s, of a piece: what a rate or a load does within a fiftieth of it would not be seen
_MOST_PHASE = 0.7  # rad of κ and e-folds of drag on a piece
_SHARE, _SHORTEST = 4e-15, 1e-13  # left by the last coefficients; of a piece where the rate or a load has a kink
_MOST_PIECES = 2_000_000
_MOST_KNOWN, _MOST_KINKS = 1000, 200


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
    domain = (
        "a sphere about its centre of mass with the same inertia about every axis, on a plane that turns about its "
        "normal at a rate given in time, under gravity, forces and torques given in time and linear drag in still air"
    )

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SphereOnUnsteadyPlane:
        """Read the closed form's numbers from a system and a start.

        Parameters
        ----------
        system : RollingSystem
            Must lie in the domain.
        start : State
            A start that rolls.

        Returns
        -------
        SphereOnUnsteadyPlane
            The motion; its t = 0 is the start's time.

        Raises
        ------
        OutOfDomainError
            If the system lies outside the domain.

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

    @classmethod
    def outside(cls, system: RollingSystem, start: State | None = None) -> list[str]:  # noqa: ARG003  any start
        """Name what of a system lies outside the domain.

        Parameters
        ----------
        system : RollingSystem
            Any system.
        start : State, optional
            Its start; every one that rolls lies in the domain.

        Returns
        -------
        list of str
            Empty where the closed form applies.

        Examples
        --------
        >>> import trundle as tr
        >>> table = tr.Support(tr.Plane(), motion=tr.Wobble(3.5, 0.1))
        >>> SphereOnUnsteadyPlane.outside(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), table))
        ["the support's motion Wobble is no turn about its normal at a rate given in time"]
        """
        reasons, motion = [], system.support.motion
        if not system.body.is_isotropic_sphere:
            reasons.append("the body is no sphere with isotropic inertia about its centre")
        if not isinstance(system.support.surface, Plane):
            reasons.append(f"the surface is a {type(system.support.surface).__name__}, not a Plane")
        if motion.steady_rate is None and not (isinstance(motion, (SpinBy, UnevenSpin))):
            reasons.append(
                f"the support's motion {type(motion).__name__} is no turn about its normal at a rate given in time"
            )
        reasons += [
            f"the load {type(load).__name__} is neither given in time nor linear drag in still air"
            for load in system.loads
            if not (load.constant or load.linear_drag is not None or isinstance(load, (Force, Torque)))
        ]
        return reasons

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
        now = self.motion.at(self.start_time + t, *self.motion.own_start())
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

        Raises
        ------
        SolverError
            If the rate or a load is not finite: the message names the instant.

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

    def position_at(self, t: Any) -> Vector:
        """Return the centre in the inertial support frame, m, at a time since the start, s."""
        return self.motion_at(t)[0]

    @cached_property
    def _course(self) -> _Course:
        return _Course(self)

    @cached_property
    def _precise(self) -> _PreciseCourse:
        return _PreciseCourse(self)


class _Course:
    """ζ and ζ̇ piece by piece, from ζ_j and V_j at the start of each, so that strong drag costs no digits.

    ζ = ζ_j + ξ with ξ = e^Λ ∫e^−Λ N dt, ζ̇ = λξ + N, N = V_j + i(κ − κ_j)ζ_j + ∫φ dt, Λ = ∫λ dt and λ = iκ − γ.
    """

    def __init__(self, form: SphereOnUnsteadyPlane) -> None:
        self.form, self.edges, self.length = form, [0.0], min(_LONGEST, _start_length(form))
        self.zeta, self.velocity = [complex(*form.position)], [complex(*form.velocity)]
        self.rate = [float(form.rates(0.0)[0])]
        self.turned, self.kinks = [0.0], 0
        self.series: list[Any] = []  # of ∫ω and ∫K_z, of ∫e^−Λ N and ∫φ
        self.stacked: Any = None

    def reach(self, t: Any) -> None:
        """Work out the pieces up to the last of the times."""
        last = float(np.max(t, initial=0.0))
        if self.edges[-1] <= last:
            self._extend(last)

    def at(self, t: Any, omega: Any) -> tuple[Any, Any, Any]:
        """Return ζ, ζ̇ and ∫K_z dt; ω is the plane's rate then."""
        t, form = np.asarray(t, dtype=float), self.form
        if self.stacked is None:
            self.stacked = (
                np.array(self.edges), *(np.stack(part, axis=-1) for part in zip(*self.series, strict=True)),
                *(np.array(part) for part in (self.zeta, self.velocity, self.rate, self.turned)),
            )  # fmt: skip
        edges, real, plane, zeta, velocity, rate, turned = self.stacked
        j = np.clip(np.searchsorted(edges, t, side="right") - 1, 0, len(edges) - 2)
        x = 2 * (t - edges[j]) / (edges[j + 1] - edges[j]) - 1
        (angle, couple), (weighted, push) = series_at(real, j, x), series_at(plane, j, x)
        gone = np.exp(1j * form.share * angle - form.gamma * (t - edges[j])) * weighted
        driven = velocity[j] + 1j * form.share * (omega - rate[j]) * zeta[j] + push
        return zeta[j] + gone, (1j * form.share * omega - form.gamma) * gone + driven, turned[j] + couple

    def _extend(self, end: float) -> None:
        self.stacked = None
        while self.edges[-1] <= end:
            begin = self.edges[-1]
            self.length = min(_LONGEST, 2 * self.length)
            while not self._piece(begin):
                self.length /= 2
            if len(self.series) > _MOST_PIECES:
                raise SolverError(
                    f"The plane's turning and the loads change too fast to be followed over {end:g} s: "
                    f"{_MOST_PIECES} pieces end at t = {begin:g} s. Ask for a shorter run."
                )

    def _piece(self, begin: float) -> bool:
        """Add a piece; False where it is too long for its polynomials."""
        form, this = self.form, rule()
        half = 0.5 * self.length
        times = begin + half * (1 + this.points)
        with np.errstate(all="ignore"):  # what is not finite is refused by name
            omega = np.broadcast_to(form.rates(times)[0], times.shape)
            _, _, push, couple = (np.broadcast_to(part, times.shape) for part in form.pushes(times))
        _check_finite(form.start_time + times, omega, push, couple)
        swept = half * (form.gamma + form.share * np.abs(omega).max())
        kinked = self.length <= _SHORTEST * max(1.0, begin)
        if swept > _MOST_PHASE:
            if kinked:
                raise SolverError(f"The plane's rate grows beyond any bound at t = {form.start_time + begin:.6g} s.")
            return False
        decay = np.exp(form.gamma * half * (1 + this.points) - 1j * form.share * half * (this.running @ omega))
        carried = 1j * form.share * (omega - self.rate[-1]) * self.zeta[-1]
        weighted = decay * (self.velocity[-1] + carried + half * (this.running @ push))
        values = np.stack([omega, couple, weighted, push])
        tail = np.abs(values @ this.coefficients[-2:].T).max(axis=1)
        size = np.abs(values).max(axis=1)
        size[0] = max(size[0], 1 / (form.share * half + 1e-300))
        size[3] += size[2] / half
        slope = np.abs(np.diff(values, axis=1) / np.diff(times)).max(axis=1)
        noise = 2e-15 * (form.start_time + begin + self.length) * slope  # from the rounding of the time itself
        if (tail > _SHARE * size + noise).any():
            if not kinked:
                return False
            self.kinks += 1
            if self.kinks > _MOST_KINKS:
                raise SolverError(
                    "The plane's rate, or a load, is not smooth enough for quadrature near "
                    f't = {form.start_time + begin:.6g} s. Use method="taylor" or method="runge-kutta".'
                )
        series = half * (this.antiderivative @ values.T)
        angle, turned, added, push = series.sum(axis=0)
        gone = np.exp(1j * form.share * angle.real - 2 * form.gamma * half) * added
        rate = float(form.rates(begin + self.length)[0])
        driven = self.velocity[-1] + 1j * form.share * (rate - self.rate[-1]) * self.zeta[-1] + push
        self.series.append((series[:, :2].real, series[:, 2:]))
        self.zeta.append(complex(self.zeta[-1] + gone))
        self.velocity.append(complex((1j * form.share * rate - form.gamma) * gone + driven))
        self.rate.append(rate)
        self.turned.append(self.turned[-1] + float(turned.real))
        self.edges.append(begin + self.length)
        return True


class _PreciseCourse:
    """The same with mpmath's numbers, on even pieces and by T9 as it stands: ζ = e^Λ (ζ_j + ∫e^−Λ M dt)."""

    def __init__(self, form: SphereOnUnsteadyPlane) -> None:
        self.form, self.digits, self.length = form, 0, min(0.25, _start_length(form))
        self.states: list[Any] = []
        self.known: dict[Any, tuple[Any, Any, Any]] = {}

    def reach(self, t: Any) -> None:
        """Pieces are worked out as they are needed."""

    def at(self, t: Any, omega: Any) -> tuple[Any, Any, Any]:
        """Return ζ, ζ̇ and ∫K_z dt at t ≥ 0; ω is the plane's rate then."""
        import mpmath

        form = self.form
        if self.digits != mpmath.mp.dps or len(self.known) > _MOST_KNOWN:
            zeta, rate = mpmath.mpc(*form.position), form.rates(mpmath.mpf(0))[0]
            moment = mpmath.mpc(*form.velocity) - (1j * (self._share * rate) - self._gamma) * zeta
            self.digits, self.states, self.known = mpmath.mp.dps, [(zeta, moment, mpmath.mpf(0))], {}
        if t not in self.known:
            self.known[t] = self._at(t)
        zeta, moment, turned = self.known[t]
        return zeta, (1j * (self._share * omega) - self._gamma) * zeta + moment, turned

    def _at(self, t: Any) -> tuple[Any, Any, Any]:
        import mpmath

        length = mpmath.mpf(self.length)
        whole = max(0, int(mpmath.floor(t / length)))
        while len(self.states) <= whole:
            self.states.append(self._ahead(self.states[-1], (len(self.states) - 1) * length, length))
        return self._ahead(self.states[whole], whole * length, t - whole * length)

    @property
    def _share(self) -> Any:
        import mpmath

        k = mpmath.mpf(self.form.inertia_ratio)
        return k / (1 + k)

    @property
    def _gamma(self) -> Any:
        import mpmath

        return mpmath.mpf(self.form.drag) / (mpmath.mpf(self.form.mass) * (1 + mpmath.mpf(self.form.inertia_ratio)))

    def _ahead(self, state: tuple[Any, Any, Any], begin: Any, length: Any) -> tuple[Any, Any, Any]:
        import mpmath

        this, half, (zeta, moment, turned) = rule(self.digits), length / 2, state
        times = [begin + half * (1 + x) for x in this.points]
        omega = np.array([self.form.rates(t)[0] for t in times], dtype=object)
        pushes = [self.form.pushes(t) for t in times]
        push, couple = (np.array([row[i] for row in pushes], dtype=object) for i in (2, 3))
        exponent = self._gamma * half * (1 + this.points) - 1j * (self._share * half * (this.running @ omega))
        grown = np.frompyfunc(mpmath.exp, 1, 1)(exponent)
        weighted = grown * (moment + half * (this.running @ push))
        whole = 1j * (self._share * half * (this.total @ omega)) - self._gamma * length
        return (
            mpmath.exp(whole) * (zeta + half * (this.total @ weighted)),
            moment + half * (this.total @ push),
            turned + half * (this.total @ couple),
        )


def _start_length(form: SphereOnUnsteadyPlane) -> float:
    return 1.0 / max(float(form.motion.fastest_rate) + float(form.gamma), 2.0)


def _is_mpmath(t: Any) -> bool:
    return type(t).__module__.partition(".")[0] == "mpmath"


def _check_finite(times: Any, *values: Any) -> None:
    for value, name in zip(values, ("the plane's rate", "a force or torque", "a torque"), strict=True):
        wrong = ~np.isfinite(value)
        if wrong.any():
            raise SolverError(f"{name[0].upper()}{name[1:]} is not finite at t = {times[wrong].min():.6g} s.")
