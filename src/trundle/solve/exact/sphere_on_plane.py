"""T5: a sphere with isotropic inertia on a plane that is fixed or turns steadily, under constant loads and drag."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from ...errors import OutOfDomainError
from ...mechanics.algebra import Vector
from ...mechanics.loads import constant_part
from ...mechanics.parts import Number
from ...mechanics.scalars import Scalar, is_number, is_zero, namespace
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from ...wording import as_ratio, pair
from .base import ClosedForm
from .circle import Circle
from .domain import ROUND, TURNING_STEADILY, linear_drag, on, under
from .finding import Finding
from .fits import TOO_LITTLE, Seen, acceleration, circle, exponent, needed_friction
from .formula import Lines, decimal, number, quantity
from .many_samples import ManySamples
from .phi import Complex, exponentials, phase, quotient_times

if TYPE_CHECKING:
    from ..monodromy import Monodromy

_STILL = 1e-12  # share of the table's speed below which a ball that was put down gently has not moved
_SLOWEST = 1e-12  # rad/s; a slower circle is a straight line to anyone

# What one sees, for the number that `promised` gives.
_STAYS, _CIRCLES = "stays, to within {}", "circles at {} of the table's rate"
_STRAIGHT, _ACCELERATES = "rolls straight at {}", "accelerates at {}"
_DRIFTS = ("drifts {}", "drifts {} along the slope's level")


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

    radius: Annotated[Scalar, Number("length")]
    mass: Annotated[Scalar, Number("mass")]
    inertia_ratio: Annotated[Scalar, Number("number")]
    rate: Annotated[Scalar, Number("angular velocity")]
    position: Annotated[tuple[Scalar, Scalar], Number("length")]
    velocity: Annotated[tuple[Scalar, Scalar], Number("velocity")] = (0.0, 0.0)
    spin: Annotated[Scalar, Number("angular velocity")] = 0.0
    force: Annotated[tuple[Scalar, Scalar, Scalar], Number("force")] = (0.0, 0.0, 0.0)
    torque: Annotated[tuple[Scalar, Scalar, Scalar], Number("torque")] = (0.0, 0.0, 0.0)
    drag: Annotated[Scalar, Number("damping")] = 0.0

    name = "sphere on a plane"
    equation = "T5"
    source = "Milne, Vectorial Mechanics (1948); Weltner, Am. J. Phys. 47, 984 (1979); theory page, section 5"
    conditions = (
        ROUND,
        on(Plane),
        TURNING_STEADILY,
        under(
            ", under gravity, constant loads and linear drag in still air",
            "neither constant nor linear drag",
            linear_drag,
        ),
    )

    impossible_events = frozenset({"lift"})  # N is constant

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

    # The constants of the motion

    @property
    def kappa(self) -> Scalar:
        """κ = ω k/(1 + k), the rate of the circle, rad/s."""
        return self._kappa_pair[0]

    @cached_property
    def _kappa_pair(self) -> tuple[Scalar, Scalar]:
        return quotient_times(self.rate, self.inertia_ratio)

    @property
    def gamma(self) -> Scalar:
        """γ = c/(m(1 + k)), the rate at which drag slows the ball, 1/s."""
        return 0.0 if is_zero(self.drag) else self.drag / (self.mass * (1 + self.inertia_ratio))

    @cached_property
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

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
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
        zeta = Complex(*self.position) + self._gone(t)
        return Vector(zeta.re, zeta.im, self.radius)

    def _gone(self, t: Any) -> Complex:
        """Return how far it is from where it started: beside a distant place a difference has fewer digits."""
        _, t_phi1, tt_phi2 = self._terms(t)
        return t_phi1 * Complex(*self.velocity) + tt_phi2 * self.phi

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> still = SphereOnPlane(0.025, 0.065, 0.4, 3.5, (0.1, 0.0), force=(0.0, 0.0, -0.64))
        >>> still.motion_at(2.0)[3]
        Vector(x=0.0, y=0.0, z=0.64)
        """
        m, a = self.mass, self.radius
        terms = exponential, t_phi1, tt_phi2 = self._terms(t)
        V0, phi = Complex(*self.velocity), self.phi
        zeta0 = Complex(*self.position)
        zeta = zeta0 + (t_phi1 * V0 + tt_phi2 * phi)  # as `position_at` has it
        V = exponential * V0 + t_phi1 * phi
        # R from Newton's law with ζ̈ = e^{λt}(λζ̇₀ + φ).
        A0 = self._lam * V0 + phi
        fx, fy, fz = self.force
        R = (exponential * A0).scaled(m) - Complex(fx, fy) + V.scaled(self.drag)
        return (
            Vector(zeta.re, zeta.im, a),
            Vector(V.re, V.im, 0.0),
            self._turning(t, terms),
            Vector(R.re, R.im, 0.0 if is_zero(fz) else -fz),
        )

    def angular_velocity_at(self, t: Any) -> Vector:
        """Return Ω alone."""
        return self._turning(t, self._terms(t))

    @property
    def _lam(self) -> Complex:
        return Complex(0.0 if is_zero(self.drag) else -self.gamma, self.kappa)

    def _turning(self, t: Any, terms: tuple[Complex, Complex, Complex]) -> Vector:
        """Return Ω from no slip, a Ω = iζ̇ + ωζ.

        It is written so that it keeps its digits where Ω starts at 0 and where it dies out:
        a Ω = e^{λt} a Ω₀ + t φ₁ [ω(ζ̇₀ − λζ₀) + iφ] + ω t² φ₂ φ.
        """
        exponential, t_phi1, tt_phi2 = terms
        m, a, k, omega = self.mass, self.radius, self.inertia_ratio, self.rate
        V0, zeta0, phi = Complex(*self.velocity), Complex(*self.position), self.phi
        gain = (V0 - self._lam * zeta0).scaled(omega) + phi.times_i
        Omega0 = V0.times_i + zeta0.scaled(omega)
        Omega = (exponential * Omega0 + t_phi1 * gain + (tt_phi2 * phi).scaled(omega)).scaled(1 / a)
        torque_n = self.torque[2]
        spin = self.spin if is_zero(torque_n) else self.spin + torque_n * t / (k * m * a * a)
        return Vector(Omega.re, Omega.im, spin)

    def fixed_axis_rotation(self, t: Any) -> tuple[Vector, Any] | None:
        """Return the axis and the angle x/a by which the ball has turned, where it rolls straight on a fixed plane."""
        (vx, vy), phi = self.velocity, self.phi
        fixed = is_zero(self.rate) and is_zero(self.spin) and is_zero(self.torque[2])
        if not (fixed and all(map(is_number, (vx, vy, phi.re, phi.im))) and vx * phi.im == vy * phi.re):
            return None
        x, y = (vx, vy) if vx or vy else (phi.re, phi.im)
        size = math.hypot(x, y) or 1.0
        x, y, gone = x / size, y / size, self._gone(t)
        return Vector(-y, x, 0.0), (gone.re * x + gone.im * y) / self.radius

    @property
    def circle(self) -> Circle | None:
        """The circle in which it goes on a plane that turns, without drag."""
        if not self.has_guiding_centre:
            return None
        drift = complex(*map(float, self.drift_velocity))
        arm = (complex(*map(float, self.velocity)) - drift) / (1j * float(self.kappa))
        centre = complex(*map(float, self.guiding_centre(0.0)))
        return Circle(float(self.kappa), centre, drift, arm, said="κ = ω k/(1 + k)")

    def monodromy(self) -> Monodromy | None:
        """Return the turn over one circle from numbers that start exact: a Ω = ω ζ_c + (ω − κ)(ζ − ζ_c)."""
        if not is_zero(self.torque[2]):
            return None
        import mpmath

        from ..monodromy import Monodromy

        with mpmath.workdps(40):
            number = mpmath.mpf
            precise = replace(
                self,
                radius=number(self.radius),
                mass=number(self.mass),
                inertia_ratio=number(self.inertia_ratio),
                rate=number(self.rate),
                position=tuple(number(part) for part in self.position),
                velocity=tuple(number(part) for part in self.velocity),
            )
            centre = mpmath.mpc(*precise.guiding_centre(0))
            arm = mpmath.mpc(*precise.position) - centre
            turning = (precise.rate - precise.kappa) * arm / precise.radius
            return Monodromy.of_turning_vector(
                precise.rate * centre / precise.radius, turning, self.spin, precise.kappa
            )

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:
        """Return its circle, its braked motion or its acceleration."""
        if self.has_guiding_centre:
            return self._circle_formulas(system)
        k, push, lines = float(self.inertia_ratio), complex(self.phi.re, self.phi.im), []
        if self.drag:
            turning = r"\ddot\zeta = (i\kappa - \gamma)\,\dot\zeta + \varphi,\quad \kappa = \frac{k}{1+k}\,\omega"
            if self.kappa:
                lines.append((turning, rf"\kappa = {quantity(self.kappa, 'rad/s')}"))
            else:
                lines.append(
                    (r"\dot V = \varphi - \gamma V", rf"|\varphi| = {quantity(abs(push), 'm/s^2')}" if push else "")
                )
            heavy = rf"{decimal(self.mass)}\cdot(1 + {number(k)})"
            found = (
                rf"\gamma = \frac{{{decimal(self.drag)}}}{{{heavy}}}\,\mathrm{{s^{{-1}}}} "
                rf"= {quantity(self.gamma, '1/s')}"
            )
            lines.append((r"\gamma = \frac{c}{m(1+k)}", found))
            if push:
                speed = abs(push / complex(-float(self.gamma), float(self.kappa)))
                formula = r"|V| \to |\varphi/(i\kappa - \gamma)|" if self.kappa else r"|V| \to |\varphi|/\gamma"
                lines.append((formula, rf"|V| \to {quantity(speed, 'm/s')}"))
            return lines
        if not push:
            speed = math.hypot(*map(float, self.velocity))
            return [(r"\zeta = \zeta_0 + \dot\zeta_0\,t", rf"|\dot\zeta_0| = {quantity(speed, 'm/s')}")]
        if system.loads:
            formula = r"\dot V = \frac{F + K\times n/a}{m(1+k)}"
            heavy = rf"{decimal(self.mass)}\,\mathrm{{kg}}\cdot(1 + {number(k)})"
            above = quantity(abs(push) * float(self.mass) * (1 + k), "N")
            return [(formula, rf"|\dot V| = \frac{{{above}}}{{{heavy}}} = {quantity(abs(push), 'm/s^2')}")]
        above = rf"{quantity(system.gravity, 'm/s^2')}\cdot\sin {_degrees(abs(float(system.support.tilt)))}"
        numbers = rf"\dot v = \frac{{{above}}}{{1 + {number(k)}}} = {quantity(abs(push), 'm/s^2')}"
        return [(r"\dot v = \frac{g\sin\alpha}{1+k}", numbers)]

    def _circle_formulas(self, system: RollingSystem) -> Lines:
        k, rate, kappa = float(self.inertia_ratio), float(self.rate), float(self.kappa)
        radius, drift = float(self.circle_radius), complex(*map(float, self.drift_velocity))
        numbers = rf"\kappa = {number(k / (1 + k))}\cdot {quantity(rate, 'rad/s')} = {quantity(kappa, 'rad/s')}"
        lines = [(r"\kappa = \frac{k}{1+k}\,\omega", numbers)]
        if drift and system.loads:
            lines.append((r"v_d = \frac{i\varphi}{\kappa}", rf"|v_d| = {quantity(abs(drift), 'm/s')}"))
        elif drift:
            above = rf"{quantity(system.gravity, 'm/s^2')}\cdot\sin {_degrees(float(system.support.tilt))}"
            below = rf"{number(k)}\cdot {quantity(rate, 'rad/s')}"
            signed = quantity(math.copysign(abs(drift), drift.imag), "m/s")
            lines.append((r"v_d = \frac{g\sin\alpha}{k\,\omega}", rf"v_d = \frac{{{above}}}{{{below}}} = {signed}"))
        if radius:
            above = r"|\dot\zeta_0 - v_d|" if drift else r"|\dot\zeta_0|"
            share = rf"\frac{{{quantity(radius * abs(kappa), 'm/s')}}}{{{quantity(abs(kappa), 'rad/s')}}}"
            lines.append((rf"\varrho = \frac{{{above}}}{{|\kappa|}}", rf"\varrho = {share} = {quantity(radius, 'm')}"))
        return lines

    def promised(self, said: str) -> Scalar | None:
        """Return what its circle, its drift or its acceleration is said to be."""
        xp = namespace(self.kappa, self.phi.re, self.velocity[0])
        if said == _STAYS:
            return 0.0
        if said == _CIRCLES:
            return self.inertia_ratio / (1 + self.inertia_ratio)
        push = xp.hypot(self.phi.re, self.phi.im)
        if said in _DRIFTS:
            return push / xp.abs(self.kappa)
        if said == _STRAIGHT:
            return xp.hypot(*self.velocity)
        return push if said == _ACCELERATES else None

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare its circle, its braked motion or its acceleration, and the friction that rolling takes (T5f)."""
        if self.has_guiding_centre:
            yield from self._circling(seen)
        elif self.drag:
            yield from self._braked(seen)
        else:
            yield from self._pushed(seen)
        if not self.drag:
            yield from self._friction_needed(seen)

    def _circling(self, seen: Seen) -> Iterator[Finding]:
        kappa, drift, radius = float(self.kappa), complex(*self.drift_velocity), float(self.circle_radius)
        centre, share = complex(*self.guiding_centre(0.0)), float(self.inertia_ratio) / (1 + float(self.inertia_ratio))
        if radius <= _STILL * abs(self.rate) * (abs(centre) + self.radius):
            zeta = seen.zeta
            moved = float(np.max(np.abs(zeta - zeta[0] - drift * seen.time)))
            if not drift:
                note = "put down gently, it stays while the table turns away under it"
                scale = max(abs(centre), self.radius)
                yield Finding(
                    "Distance that it moves",
                    r"\varrho",
                    0.0,
                    moved,
                    "m",
                    note=note,
                    scale=scale,
                    said=_STAYS,
                )
                return
            speed = abs(zeta[-1] - zeta[0]) / float(seen.time[-1])
            note = "straight, without loops"
            yield Finding(
                "Drift speed", r"|v_d|", abs(drift), speed, "m/s", note=note, said=_drifts(drift, seen.system)
            )
            yield _direction(drift, zeta[-1] - zeta[0], seen.system)
            return
        found = circle(seen, abs(kappa))
        note = "" if found else TOO_LITTLE
        rate = found.rate if found else None
        yield Finding("Angular rate of the circle", r"\kappa", kappa, rate, "rad/s", note=note)
        of_table = f"{as_ratio(share)} of the table's rate, whatever its size and mass"
        measured = rate and rate / float(self.rate)
        said = "" if drift else _CIRCLES
        yield Finding("Share of the table's rate", r"\kappa/\omega", share, measured, "", note=of_table, said=said)
        yield Finding("Radius of the circle", r"\varrho", radius, abs(found.arm) if found else None, "m", note=note)
        if not drift:
            name, scale = "Distance of its centre from the axis", max(abs(centre), radius)
            measured = abs(found.centre) if found else None
            yield Finding(name, r"|\zeta_c|", abs(centre), measured, "m", note=note, scale=scale)
            return
        measured, said = abs(found.drift) if found else None, _drifts(drift, seen.system)
        yield Finding("Drift speed", r"|v_d|", abs(drift), measured, "m/s", note=note, said=said)
        yield _direction(drift, found.drift if found else None, seen.system)

    def _pushed(self, seen: Seen) -> Iterator[Finding]:
        """Compare with the parabola on a plane at rest."""
        push, system = complex(self.phi.re, self.phi.im), seen.system
        if not push:
            gone = float(np.abs(seen.zeta[-1] - seen.zeta[0]) / seen.time[-1])
            note = "nothing pushes it: it keeps its speed"
            speed = math.hypot(*map(float, self.velocity))
            yield Finding("Speed", "v", speed, gone, "m/s", note=note, said=_STRAIGHT)
            return
        found = acceleration(seen)
        yield Finding("Acceleration", r"|\varphi|", abs(push), abs(found), "m/s²", said=_ACCELERATES)
        slide = float(system.gravity) * math.sin(abs(float(system.support.tilt)))
        if slide and not system.loads:
            share = 1 / (1 + float(self.inertia_ratio))
            note = f"{as_ratio(share)} of that of a block without friction"
            yield Finding("Share of a sliding block's", r"\frac{1}{1+k}", share, abs(found) / slide, "", note=note)
            return
        turned = math.degrees(cmath.phase(push) + cmath.phase(found / push))
        note = "from the first axis towards the second"
        yield Finding(
            "Its direction", r"\arg\varphi", math.degrees(cmath.phase(push)), turned, "°", note=note, scale=360.0
        )
        applied, along = complex(*map(float, self.force[:2])), push / abs(push)
        reaction, seen_so = (((float(self.mass) * a - applied) / along).real for a in (push, found))
        note = "along the acceleration; negative: it holds the ball back"
        scale = max(abs(applied), float(self.mass) * abs(push))
        yield Finding("Reaction of the support", r"R_\parallel", reaction, seen_so, "N", note=note, scale=scale)

    def _braked(self, seen: Seen) -> Iterator[Finding]:
        """Compare with the spiral or the straight course that air brakes."""
        gamma, kappa, push = float(self.gamma), float(self.kappa), complex(self.phi.re, self.phi.im)
        found = exponent(seen, math.hypot(gamma, kappa))
        rate = found[0] if found else None
        note = "" if found else TOO_LITTLE
        yield Finding(
            "Rate at which air slows it", r"\gamma", gamma, None if rate is None else -rate.real, "1/s", note=note
        )
        if kappa:
            measured = None if rate is None else rate.imag
            yield Finding(
                "Angular rate of the spiral", r"\kappa", kappa, measured, "rad/s", note=note, said="spirals at {}"
            )
        if push:
            final = abs(push / complex(-gamma, kappa))
            measured = abs(found[1] / found[0]) if found else None
            yield Finding(
                "Speed that it comes to", r"|\varphi/\lambda|", final, measured, "m/s", note=note, said="comes to {}"
            )

    def _friction_needed(self, seen: Seen) -> Iterator[Finding]:
        """Compare the friction that rolling takes with T5f, where no torque acts."""
        fx, fy, fz = (float(part) for part in self.force)
        if any(self.torque) or not fz < 0:
            return
        pull = math.hypot(fx, fy)
        if self.has_guiding_centre:
            turned = abs(float(self.kappa)) * float(seen.time[-1])
            radius = float(self.circle_radius)
            if pull and radius and turned < 2 * math.pi:
                return  # the largest comes with a full turn
            needed = (pull + float(self.mass) * float(self.kappa) ** 2 * radius) / -fz
        else:
            needed = pull * float(self.inertia_ratio) / (1 + float(self.inertia_ratio)) / -fz
        yield needed_friction(needed, seen.at)


def _degrees(angle: float) -> str:
    return quantity(math.degrees(angle), "deg")


def _drifts(drift: complex, system: RollingSystem) -> str:
    """Say that it drifts, and where to if that is level on a slope."""
    level = float(system.support.tilt) != 0 and abs(drift.real) <= _STILL * abs(drift)
    return _DRIFTS[1] if level else _DRIFTS[0]


def _direction(predicted: complex, measured: complex | None, system: RollingSystem) -> Finding:
    """Compare directions, in degrees from the first axis towards the second: from downhill, where there is a slope."""
    tilted = float(system.support.tilt) != 0
    name = "Direction of the drift, from straight downhill" if tilted else "Direction of the drift"
    turned = None if measured is None else math.degrees(cmath.phase(predicted) + cmath.phase(measured / predicted))
    note = "90° is level: on average it does not come down" if tilted and not system.loads else ""
    return Finding(name, r"\arg v_d", math.degrees(cmath.phase(predicted)), turned, "°", note=note, scale=360.0)
