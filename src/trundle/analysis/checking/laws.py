"""The law of rolling at somebody else's states, and laws with a mistake in them. The law itself is never retyped."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...mechanics.algebra import ZERO, Matrix, Quaternion, Vector
from ...mechanics.bodies import Body
from ...mechanics.contact import roll
from ...mechanics.loads import Force, Load
from ...mechanics.motions import Fixed, Motion, Spin, SupportState
from ...mechanics.slipping import slip
from ...mechanics.system import RollingSystem
from ...verify.acting import cross
from ...verify.law import applied, newton_euler
from .motion import Instants, instants
from .record import Array

Rates = tuple[Array, Array]  # V̇ and Ω̇, (m, 3), m/s² and rad/s²
Law = Callable[[RollingSystem, Instants], Rates]


def independent_law(system: RollingSystem, at: Instants) -> Rates:
    """Return V̇ and Ω̇ from Newton, Euler and the differentiated constraint as one 9×9 system; T2 is not used."""
    slip = Vector.of(at.slip)
    Omega, V = Vector.of(at.angular_velocity), Vector.of(at.velocity)
    p_rate, rho_rate = (np.broadcast_to(v.array(), at.position.shape) for v in at.contact.rates(slip, Omega, V))
    samples = at.samples()
    F, K, J, gyroscopic, u_rate = applied(system, samples, p_rate)
    constraint = u_rate - cross(at.angular_velocity, rho_rate)

    def solved(moment: Array) -> tuple[Array, Array, Array]:
        return newton_euler(float(system.body.mass), J, at.offset, F, moment - gyroscopic, constraint)

    V_rate, Omega_rate, R = solved(K)
    acting = system.acting_on(samples.motion(system))
    if not acting.has_couple:
        return V_rate, Omega_rate
    # A couple that grows with N: all is linear in it, and N = n·R closes the circle.
    V_more, Omega_more, R_more = solved(K + np.broadcast_to(acting.couple.array(), K.shape))
    n = samples.normals(system)
    N = (n * R).sum(axis=1) / (1.0 - (n * (R_more - R)).sum(axis=1))
    return V_rate + N[:, None] * (V_more - V_rate), Omega_rate + N[:, None] * (Omega_more - Omega_rate)


def eliminated_law(system: RollingSystem, at: Instants) -> Rates:
    """Return V̇ and Ω̇ from T2 and T3, for systems that leave a term out: the 9×9 route knows all terms."""
    q, Omega = Quaternion.of(at.orientation), Vector.of(at.angular_velocity)
    now = roll(system, at.time, at.contact.point, q, Omega)
    state = now.contact.body_motion(system.body.mass, at.time, now.velocity, q, Omega)
    return _rates(system, at, now.reaction + system.loads_on(state)[0], now.angular_acceleration)


def frictionless_law(system: RollingSystem, at: Instants) -> Rates:
    """Return V̇ and Ω̇ of a body that slides as a puck does: the support pushes, and nothing holds it along."""
    q, Omega = Quaternion.of(at.orientation), Vector.of(at.angular_velocity)
    slipping = Vector.of(at.slip)
    now = slip(system, at.time, at.contact.point, q, Omega, slipping, direction=ZERO)
    state = now.contact.body_motion(system.body.mass, at.time, now.velocity, q, Omega)
    return _rates(system, at, now.reaction + system.loads_on(state)[0], now.angular_acceleration)


def _rates(system: RollingSystem, at: Instants, force: Vector, turning: Vector) -> Rates:
    shape = at.position.shape
    found = force / system.body.mass, turning
    V_rate, Omega_rate = (np.broadcast_to(v.array(), shape) for v in found)
    return V_rate, Omega_rate


def constrained(law: Law) -> Law:
    """Return a law whose V̇ is another's, and whose Ω̇ follows from it by the true constraint, the spin as it should."""

    def constrained_law(system: RollingSystem, at: Instants) -> Rates:
        V_rate, _ = law(system, at)
        _, true = independent_law(system, at)
        Omega, V, rho = Vector.of(at.angular_velocity), Vector.of(at.velocity), at.contact.offset
        p_rate, rho_rate = at.contact.rates(Vector.of(np.zeros_like(at.slip)), Omega, V)
        u_rate = at.contact.support.material_acceleration(at.contact.point, p_rate)
        across = rho.cross(u_rate - Omega.cross(rho_rate) - Vector.of(V_rate)) / rho.dot(rho)
        along = rho * (Vector.of(true).dot(rho) / rho.dot(rho))
        return V_rate, np.broadcast_to((across + along).array(), V_rate.shape)

    return constrained_law


def circling(factor: float) -> Law:
    """Return the law of a ball that goes round at a factor of the table's rate, where it should be k/(1 + k)."""

    def law(system: RollingSystem, at: Instants) -> Rates:
        k, omega = float(system.body.inertia_ratio), float(system.support.motion.steady_rate or 0.0)
        other = with_rate(system, factor * omega * (1 + k) / k)
        parts = {"position": at.position, "velocity": at.velocity, "orientation": at.orientation}
        n = np.broadcast_to(at.contact.normal.array(), at.position.shape)
        return independent_law(other, instants(other, at.time, parts, (at.angular_velocity * n).sum(axis=1)))

    return constrained(law)


def without_carrying_in_turning(system: RollingSystem, at: Instants) -> Rates:
    """Return V̇ and Ω̇ where u̇ is left out of the law of Ω, and V follows from Ω by the true constraint."""
    V_rate, Omega_rate = eliminated_law(without_carrying(system), at)
    slip, Omega, V = (Vector.of(v) for v in (np.zeros_like(at.slip), at.angular_velocity, at.velocity))
    p_rate, _ = at.contact.rates(slip, Omega, V)
    carried = at.contact.support.material_acceleration(at.contact.point, p_rate).array()
    return V_rate + np.broadcast_to(carried, V_rate.shape), Omega_rate


class _NeverGyroscopic(Body):
    """A body whose Ω×JΩ is forgotten."""

    def gyroscopic(self, Q: Matrix, Omega: Vector) -> Vector:  # noqa: ARG002
        return ZERO


class _NeverCarried(SupportState):
    """A support whose u̇ is forgotten, and whose u is not."""

    __slots__ = ()

    def material_acceleration(self, p: Vector, p_rate: Vector) -> Vector:  # noqa: ARG002
        return ZERO


@dataclass(frozen=True)
class _CarryingForgotten(Motion):
    inner: Motion

    def at(self, time: Any, *own: Any) -> SupportState:
        now = self.inner.at(time, *own)
        return _NeverCarried(
            now.rotation,
            now.origin,
            now.velocity,
            now.acceleration,
            now.angular_velocity,
            now.angular_acceleration,
        )

    @property
    def steady_rate(self) -> Any:
        return self.inner.steady_rate


def without_gyroscopic(system: RollingSystem) -> RollingSystem:
    """Return the system with Ω×JΩ left out of its law."""
    body = system.body
    return replace(system, body=_NeverGyroscopic(body.mass, body.inertia, body.shape))


def without_carrying(system: RollingSystem) -> RollingSystem:
    """Return the system with u̇ left out of its law."""
    return replace(system, support=replace(system.support, motion=_CarryingForgotten(system.support.motion)))


def turns(system: RollingSystem) -> bool:
    """Tell whether the support is one whose rate can be another: fixed, or turning steadily."""
    return isinstance(system.support.motion, (Fixed, Spin))


def with_rate(system: RollingSystem, rate: float) -> RollingSystem:
    """Return the system on a support that turns at another rate, rad/s."""
    return replace(system, support=replace(system.support, motion=Spin(rate)))


def with_inertia(system: RollingSystem, factor: float) -> RollingSystem:
    """Return the system with all moments of inertia multiplied."""
    body = system.body
    return replace(system, body=replace(body, inertia=body.inertia.times(factor, body)))


def with_pull(system: RollingSystem, x: float, y: float, z: float = 0.0) -> RollingSystem:
    """Return the system with a constant force more, given as an acceleration in the support frame, m/s²."""
    m = float(system.body.mass)
    return replace(system, loads=(*system.loads, Force((m * x, m * y, m * z))))


def without_load(system: RollingSystem, load: Load) -> RollingSystem:
    """Return the system with one load left out."""
    return replace(system, loads=tuple(other for other in system.loads if other is not load))
