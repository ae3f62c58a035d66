"""T14: a sphere on a plane that turns steadily, in air that turns too and against a viscous couple at the contact."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import SolverError
from ...mechanics.algebra import Vector
from ...mechanics.loads import Drag, RollingCouple
from ...mechanics.scalars import Scalar, namespace
from ...mechanics.surfaces import Plane
from ...mechanics.system import RollingSystem, State
from .base import ClosedForm
from .domain import ROUND, TURNING_STEADILY, constant_forces, on, under
from .finding import Finding
from .fits import TOO_LITTLE, Seen, two_exponents
from .formula import Lines, quantity
from .second_order import fundamental


@dataclass(frozen=True)
class SphereInMovingAir(ClosedForm):
    """The motion of ζ̈ = (iκ − γ)ζ̇ + iβζ + φ: two complex exponents, one of which may grow (T14).

    Air that turns at ω_a carries the ball along, −c(ζ̇ − iω_aζ); a couple −c_r(Ω − ω) at the contact does the same as
    air of c = c_r/a² that turns with the plane. Every number may be a float, or an array of members.

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
    force, torque : triple of float or array
        Constant applied force, weight included, N, and torque about the centre, N m.
    drag : float or array
        c of all air, kg/s.
    carried : float or array
        Σ c ω_a, kg rad/s².
    couple, pivot_couple : float or array
        c_r across the normal and along it, N m s.

    Examples
    --------
    A ball at rest on the axis of the table stays there; anywhere else the air takes it round and so outwards:

    >>> ball = SphereInMovingAir(0.025, 0.065, 0.4, 3.5, (0.1, 0.0), drag=0.01, carried=0.035)
    >>> x, y, _ = ball.position_at(30.0)
    >>> bool(math.hypot(x, y) > 0.2)
    True
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
    carried: Scalar = 0.0
    couple: Scalar = 0.0
    pivot_couple: Scalar = 0.0

    name = "sphere on a plane in moving air"
    equation = "T14"
    source = "theory page, T14; Milne, Vectorial Mechanics (1948), without air"
    conditions = (
        ROUND,
        on(Plane),
        TURNING_STEADILY,
        under(
            ", under gravity, constant loads, linear drag in air that is still or turns about the same axis, and a "
            "viscous couple at the contact",
            "neither constant nor linear drag nor a viscous couple",
            Drag,
            RollingCouple,
        ),
    )

    impossible_events = frozenset({"lift"})  # N is constant

    @classmethod
    def of(cls, system: RollingSystem, start: State) -> SphereInMovingAir:
        """Read the closed form's numbers from a system and a start.

        Examples
        --------
        >>> import trundle as tr
        >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5))
        >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table, loads=[tr.Drag(0.01, 3.5)])
        >>> SphereInMovingAir.of(system, system.place((0.1, 0.0))).carried
        0.035
        """
        cls.check_domain(system, start)
        drags = [load for load in system.loads if isinstance(load, Drag)]
        couples = [load for load in system.loads if isinstance(load, RollingCouple)]
        force, torque = constant_forces(system)
        pivots = [c.coefficient if c.pivot_coefficient is None else c.pivot_coefficient for c in couples]
        return cls(
            radius=system.body.radius,
            mass=system.body.mass,
            inertia_ratio=system.body.inertia_ratio,
            rate=system.support.motion.steady_rate,
            position=start.position[:2],
            velocity=start.velocity[:2],
            spin=start.angular_velocity[2],
            force=tuple(force),
            torque=tuple(torque),
            drag=sum((load.coefficient for load in drags), 0.0),
            carried=sum((load.coefficient * load.air for load in drags), 0.0),
            couple=sum((load.coefficient for load in couples), 0.0),
            pivot_couple=sum(pivots, 0.0),
        )

    # The constants of the motion

    @property
    def kappa(self) -> Scalar:
        """κ = ω k/(1 + k), rad/s."""
        return self.rate * self.inertia_ratio / (1 + self.inertia_ratio)

    @property
    def _heavy(self) -> Scalar:
        return self.mass * (1 + self.inertia_ratio)

    @property
    def gamma(self) -> Scalar:
        """γ = (c + c_r/a²)/(m(1 + k)), the rate at which air and couple slow the ball, 1/s."""
        return (self.drag + self._dragging) / self._heavy

    @property
    def beta(self) -> Scalar:
        """β = (Σ c ω_a + c_r ω/a²)/(m(1 + k)), by which they carry it along, 1/s²."""
        return (self.carried + self._dragging * self.rate) / self._heavy

    @property
    def _dragging(self) -> Scalar:
        return self.couple / (self.radius * self.radius)

    @property
    def push(self) -> Any:
        """φ = [F_x + iF_y + (K_y − iK_x)/a]/(m(1 + k)), as a complex number, m/s²."""
        (fx, fy, _), (kx, ky, _) = self.force, self.torque
        return (fx + ky / self.radius + 1j * (fy - kx / self.radius)) / self._heavy

    @property
    def exponents(self) -> tuple[Any, Any]:
        """The two s of e^{st}, complex, 1/s; the ball is driven out for ever where one has a positive real part."""
        half = 0.5 * (1j * self.kappa - self.gamma)
        root = np.sqrt(half * half + 1j * self.beta)
        root = np.where((np.conj(half) * root).real < 0, -root, root)
        fast = half + root
        slow = np.where(fast == 0, 0.0, -1j * self.beta / np.where(fast == 0, 1.0, fast))
        return fast[()], slow[()]

    @property
    def period(self) -> float:
        """Infinite: what brakes or drives the ball never brings it back."""
        return math.inf

    def max_rate(self, duration: float) -> float:  # noqa: ARG002
        """Return the size of the larger s, 1/s."""
        return float(max(map(abs, self.exponents)))

    # The motion

    def motion_at(self, t: Any) -> tuple[Vector, Vector, Vector, Vector]:
        """Return position, velocity, angular velocity and contact force together.

        Examples
        --------
        >>> still = SphereInMovingAir(0.025, 0.065, 0.4, 3.5, (0.0, 0.0), force=(0.0, 0.0, -0.64), drag=0.1)
        >>> float(still.motion_at(2.0)[3].z)
        0.64
        """
        m, a, k, omega = self.mass, self.radius, self.inertia_ratio, self.rate
        lam, mu, phi = 1j * self.kappa - self.gamma, 1j * self.beta, self.push
        zeta0 = self.position[0] + 1j * self.position[1]
        V0 = self.velocity[0] + 1j * self.velocity[1]
        with np.errstate(over="ignore", invalid="ignore"):
            base = fundamental(lam, mu, t)
            zeta = zeta0 * base.U + V0 * base.G + phi * base.H
            V = zeta0 * (mu * base.G) + V0 * base.G_rate + phi * base.G
        if not hasattr(namespace(t), "exact") and not np.isfinite(V).all():
            raise SolverError("The ball is driven out beyond any number. Ask for a shorter run, or give a rim.")
        Omega = (1j * V + omega * zeta) / a
        A = lam * V + mu * zeta + phi
        fx, fy, fz = self.force
        R = m * A - (fx + 1j * fy) + self.drag * V - 1j * self.carried * zeta
        zero = 0 * zeta.real
        return (
            Vector(zeta.real, zeta.imag, a + zero),
            Vector(V.real, V.imag, zero),
            Vector(Omega.real, Omega.imag, self._spin_at(t, k * m * a * a) + zero),
            Vector(R.real, R.imag, zero - fz),
        )

    def position_at(self, t: Any) -> Vector:
        """Return the centre in the inertial support frame, m, at a time since the start, s."""
        return self.motion_at(t)[0]

    def _spin_at(self, t: Any, moment: Scalar) -> Any:
        """Return Ω·n: the couple brings it to the plane's rate, a torque drives it."""
        gain = (self.torque[2] - self.pivot_couple * (self.spin - self.rate)) / moment
        return self.spin + gain * fundamental(-self.pivot_couple / moment, 0.0, t).G.real

    # What is shown

    def formulas(self, system: RollingSystem) -> Lines:  # noqa: ARG002
        """Return its equation of motion."""
        formula = r"\ddot\zeta = (i\kappa - \gamma)\,\dot\zeta + i\beta\,\zeta + \varphi"
        parts = (("\\kappa", self.kappa, "rad/s"), (r"\gamma", self.gamma, "1/s"), (r"\beta", self.beta, "1/s^2"))
        return [(formula, r",\quad ".join(f"{name} = {quantity(value, unit)}" for name, value, unit in parts))]

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Compare its two exponents."""
        predicted = sorted((complex(part) for part in self.exponents), key=abs, reverse=True)
        found = two_exponents(seen, abs(predicted[0]))
        for name, mark, s, measured in zip(("faster", "slower"), "12", predicted, found or (None, None), strict=False):
            size, note = abs(s) or None, "" if measured is not None else TOO_LITTLE
            turn, grow = (None, None) if measured is None else (measured.imag, measured.real)
            turns, grows = rf"\mathrm{{Im}}\,s_{mark}", rf"\mathrm{{Re}}\,s_{mark}"
            yield Finding(f"Angular rate of the {name} part", turns, s.imag, turn, "rad/s", note=note, scale=size)
            yield Finding(f"Growth of the {name} part", grows, s.real, grow, "1/s", note=note, scale=size)
