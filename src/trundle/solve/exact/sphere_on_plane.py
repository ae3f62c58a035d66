"""T5: a sphere with isotropic inertia on a plane that is fixed or turns steadily, under constant loads and drag."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...errors import OutOfDomainError
from ...mechanics.algebra import Vector
from ...mechanics.loads import constant_part
from ...mechanics.scalars import Scalar, is_number, is_zero, namespace
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from ...wording import pair
from .base import ClosedForm
from .many_samples import ManySamples
from .phi import Complex, exponentials, phase, quotient_times

_SLOWEST = 1e-12  # rad/s; a slower circle is a straight line to anyone


@dataclass(frozen=True)
class SphereOnPlane(ManySamples, ClosedForm):
    """The motion ζ(t) = ζ₀ + t φ₁(λt) ζ̇₀ + t² φ₂(λt) φ with λ = iκ − γ, where ζ = x + iy is the centre (T5).

    Every number may be a float, or an array of members that broadcasts against the times: a thousand balls are
    one call. The times may be floats, NumPy or other Array-API arrays, heyoka expressions or SymPy symbols.

    Parameters
    ----------
    radius, mass, inertia_ratio : float or array
        a in m, m in kg, k = I/(m a²).
    rate : float or array
        ω of the plane about its normal, rad/s.
    position, velocity : pair of float or array
        Centre at t = 0 over the plane, m and m/s, in the inertial support frame.
    spin : float or array
        Ω·n at t = 0, rad/s.
    force : triple of float or array
        Constant applied force, weight included, N.
    torque : triple of float or array
        Constant applied torque about the centre, N m.
    drag : float or array
        c of the linear drag −c V, kg/s.

    Examples
    --------
    A solid ball nudged on a level table circles at 2/7 of the table's rate:

    >>> ball = SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.0), (0.0, 0.2))
    >>> round(ball.kappa / 3.5, 15) == round(2 / 7, 15)
    True
    >>> [round(c, 12) for c in ball.position_at(ball.period)]
    [0.1, -0.0, 0.025]
    """

    radius: Scalar
    mass: Scalar
    inertia_ratio: Scalar
    rate: Scalar
    position: tuple[Scalar, Scalar]
    velocity: tuple[Scalar, Scalar] = (0.0, 0.0)
    spin: Scalar = 0.0
    force: tuple[Scalar, Scalar, Scalar] = (0.0, 0.0, 0.0)
    torque: tuple[Scalar, Scalar, Scalar] = (0.0, 0.0, 0.0)
    drag: Scalar = 0.0

    name = "sphere on a plane"
    equation = "T5"
    source = "Milne, Vectorial Mechanics (1948); Weltner, Am. J. Phys. 47, 984 (1979); theory page, section 5"
    domain = (
        "a sphere about its centre of mass with the same inertia about every axis, on a plane that is fixed or "
        "turns steadily about its normal, under gravity, constant force, constant torque and linear drag in still air"
    )

    never = frozenset({"lift"})  # N is constant

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SphereOnPlane:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> slope = tr.Support(tr.Plane(), tilt="30 deg")
        >>> system = tr.RollingSystem(tr.Body.hollow_sphere(radius=0.02, mass=0.0027), slope)
        >>> motion = SphereOnPlane.of(system, system.place())
        >>> round(motion.position_at(1.0).x / (9.80665 * 0.5 / 2), 12)  # a shell gains (3/5) g sin α
        0.6
        """
        cls.check_domain(system, start)
        x, y, _ = start.position
        vx, vy, _ = start.velocity
        force, torque, drag = constant_part(system.all_loads, system.body.mass)
        return cls(
            radius=system.body.radius,
            mass=system.body.mass,
            inertia_ratio=system.body.inertia_ratio,
            rate=system.support.motion.steady_rate,
            position=(x, y),
            velocity=(vx, vy),
            spin=start.angular_velocity[2],
            force=tuple(force),
            torque=tuple(torque),
            drag=drag,
        )

    @classmethod
    def outside(cls, system: RollingSystem, start: State | None = None) -> list[str]:  # noqa: ARG003  any start
        """Name what of a system lies outside the domain.

        Examples
        --------
        >>> import trundle as tr
        >>> SphereOnPlane.outside(tr.RollingSystem(tr.Body.solid_sphere(1.0, 1.0), tr.Support(tr.Plane())))
        []
        """
        reasons = []
        if not system.body.is_isotropic_sphere:
            reasons.append("the body is no sphere with isotropic inertia about its centre")
        if not isinstance(system.support.surface, Plane):
            reasons.append(f"the surface is a {type(system.support.surface).__name__}, not a Plane")
        if system.support.motion.steady_rate is None:
            reasons.append(f"the support's motion {type(system.support.motion).__name__} is no steady turn")
        reasons += [
            f"the load {type(load).__name__} is neither constant nor linear drag"
            for load in system.loads
            if not (load.constant or load.linear_drag is not None)
        ]
        return reasons

    # The constants of the motion

    @property
    def kappa(self) -> Scalar:
        """κ = ω k/(1 + k), the rate of the circle, rad/s."""
        return self._kappa_pair[0]

    @property
    def _kappa_pair(self) -> tuple[Scalar, Scalar]:
        return quotient_times(self.rate, self.inertia_ratio)

    @property
    def gamma(self) -> Scalar:
        """γ = c/(m(1 + k)), the rate at which drag slows the ball, 1/s."""
        return 0.0 if is_zero(self.drag) else self.drag / (self.mass * (1 + self.inertia_ratio))

    @property
    def phi(self) -> Complex:
        """φ = [F_x + iF_y + (K_y − iK_x)/a]/(m(1 + k)), the acceleration that the loads give, m/s²."""
        (fx, fy, _), (kx, ky, _) = self.force, self.torque
        share = 1 / (self.mass * (1 + self.inertia_ratio))
        driven = Complex(fx, fy) + Complex(ky, 0.0 if is_zero(kx) else -kx).scaled(1 / self.radius)
        return driven.scaled(share)

    @property
    def is_drifting(self) -> bool:
        """Whether loads push in the plane, so that the guiding centre drifts or the ball accelerates."""
        return not (is_zero(self.phi.re) and is_zero(self.phi.im))

    @property
    def period(self) -> float:
        """Time of one circle 2π/|κ| where the motion repeats (level, no drag, turning); infinite elsewhere, s."""
        repeats = not self.is_drifting and is_zero(self.drag) and not is_zero(self.rate)
        return 2 * math.pi / abs(self.kappa) if repeats else math.inf

    def expected(self, duration: float) -> list[tuple[str, str]]:
        """Return its circle and where that drifts, or its acceleration."""
        if self.has_guiding_centre and abs(self.kappa) > _SLOWEST:
            return self._circle(duration)
        rows = [("acceleration at rest", pair((self.phi.re, self.phi.im), "m/s²"))]
        return rows + ([("drag halves the speed in", f"{math.log(2) / self.gamma:.6g} s")] if self.gamma > 0 else [])

    def _circle(self, duration: float) -> list[tuple[str, str]]:
        rows = [
            ("one round", f"{2 * math.pi / abs(self.kappa):.6g} s, at {self.kappa:.6g} rad/s"),
            ("its radius", f"{self.circle_radius:.6g} m"),
            ("about the point", pair(self.guiding_centre(0.0), "m")),
        ]
        drift = self.drift_velocity
        if math.hypot(*drift) > 0:
            rows += [
                ("which drifts at", f"{math.hypot(*drift):.6g} m/s, {pair(drift, 'm/s')}"),
                ("and ends at", pair(self.guiding_centre(duration), "m")),
            ]
        return rows

    def pace(self, duration: float) -> float:  # noqa: ARG002
        """Return |λ|, 1/s."""
        return math.hypot(self.kappa, self.gamma)

    def repeats(self, stop: str) -> float:
        """Return the period; the friction goes round with e^{λt}, drift or not."""
        if stop == "slip" and is_zero(self.drag):
            return 0.0 if is_zero(self.kappa) else 2 * math.pi / abs(self.kappa)
        return float(self.period)

    @property
    def drift_velocity(self) -> tuple[Scalar, Scalar]:
        """−φ/(iκ), the velocity of the guiding centre when ω ≠ 0 and c = 0, m/s: across the push, never along it."""
        self._need_guiding_centre()
        drift = self.phi.times_i.scaled(1 / self.kappa)
        return drift.re, drift.im

    @property
    def circle_radius(self) -> Scalar:
        """|ζ̇₀ − drift|/|κ|, the radius of the circle about the guiding centre, m."""
        self._need_guiding_centre()
        (vx, vy), (ux, uy) = self.velocity, self.drift_velocity
        xp = namespace(self.kappa, vx, ux)
        return xp.hypot(vx - ux, vy - uy) / xp.abs(self.kappa)

    def guiding_centre(self, t: Any) -> tuple[Scalar, Scalar]:
        """Return the point about which the ball circles, which drifts steadily.

        Examples
        --------
        >>> SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.0)).guiding_centre(7.0)
        (0.1, 0.0)
        """
        self._need_guiding_centre()
        drift = Complex(*self.drift_velocity)
        start = Complex(*self.position) + (Complex(*self.velocity) - drift).times_i.scaled(1 / self.kappa)
        return start.re + drift.re * t, start.im + drift.im * t

    @property
    def has_guiding_centre(self) -> bool:
        """Whether the ball circles steadily about a point: the plane turns and there is no drag."""
        return is_zero(self.drag) and not is_zero(self.rate)

    def _need_guiding_centre(self) -> None:
        if not self.has_guiding_centre:
            raise OutOfDomainError(
                "A guiding centre exists only on a plane that turns, without drag; "
                f"here ω = {self.rate} rad/s and c = {self.drag} kg/s."
            )

    # The motion

    def _terms(self, t: Any) -> tuple[Complex, Complex, Complex]:
        """Return e^{λt}, t φ₁(λt) and t² φ₂(λt)."""
        y, turned = (0.0, 0.0) if is_zero(self.rate) else phase(self._kappa_pair, t)
        x = 0.0 if is_zero(self.drag) else -(self.gamma * t)
        exponential, phi1, phi2 = exponentials(x, y, turned)
        return exponential, phi1.scaled(t), phi2.scaled(t).scaled(t)

    def position_at(self, t: Any) -> Vector:
        """Return the centre of the ball.

        Examples
        --------
        >>> SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.2)).position_at(5.0)
        Vector(x=0.1, y=0.2, z=0.025)
        """
        _, t_phi1, tt_phi2 = self._terms(t)
        zeta = Complex(*self.position) + t_phi1 * Complex(*self.velocity) + tt_phi2 * self.phi
        return Vector(zeta.re, zeta.im, self.radius)

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> still = SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.0), force=(0.0, 0.0, -0.64))
        >>> still.motion_at(2.0)[3]
        Vector(x=0.0, y=0.0, z=0.64)
        """
        m, a, k, omega = self.mass, self.radius, self.inertia_ratio, self.rate
        exponential, t_phi1, tt_phi2 = self._terms(t)
        V0, phi = Complex(*self.velocity), self.phi
        zeta0 = Complex(*self.position)
        push = tt_phi2 * phi
        zeta = zeta0 + t_phi1 * V0 + push
        V = exponential * V0 + t_phi1 * phi
        # Ω from no slip, a Ω = iζ̇ + ωζ, written so that it keeps its digits where Ω starts at 0 and where it dies out:
        # a Ω = e^{λt} a Ω₀ + t φ₁ [ω(ζ̇₀ − λζ₀) + iφ] + ω t² φ₂ φ.
        lam = Complex(0.0 if is_zero(self.drag) else -self.gamma, self.kappa)
        gain = (V0 - lam * zeta0).scaled(omega) + phi.times_i
        Omega0 = V0.times_i + zeta0.scaled(omega)
        Omega = (exponential * Omega0 + t_phi1 * gain + push.scaled(omega)).scaled(1 / a)
        # R from Newton's law with ζ̈ = e^{λt}(λζ̇₀ + φ).
        A0 = lam * V0 + phi
        fx, fy, fz = self.force
        R = (exponential * A0).scaled(m) - Complex(fx, fy) + V.scaled(self.drag)
        torque_n = self.torque[2]
        spin = self.spin if is_zero(torque_n) else self.spin + torque_n * t / (k * m * a * a)
        return (
            Vector(zeta.re, zeta.im, a),
            Vector(V.re, V.im, 0.0),
            Vector(Omega.re, Omega.im, spin),
            Vector(R.re, R.im, 0.0 if is_zero(fz) else -fz),
        )

    def straight_turn(self, t: Any) -> tuple[Vector, Any] | None:
        """Return the axis and the angle x/a by which the ball has turned, where it rolls straight on a fixed plane."""
        (vx, vy), phi = self.velocity, self.phi
        fixed = is_zero(self.rate) and is_zero(self.spin) and is_zero(self.torque[2])
        if not (fixed and all(map(is_number, (vx, vy, phi.re, phi.im))) and vx * phi.im == vy * phi.re):
            return None
        x, y = (vx, vy) if vx or vy else (phi.re, phi.im)
        size = math.hypot(x, y) or 1.0
        along = Vector(x / size, y / size, 0.0)
        gone = self.position_at(t) - Vector(*self.position, self.radius)
        return Vector(-along.y, along.x, 0.0), gone.dot(along) / self.radius
