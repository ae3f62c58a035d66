"""Systems with a mistake in them: wrong numbers, or a term of the law left out. The law itself is never retyped."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..mechanics.algebra import ZERO, Matrix, Vector
from ..mechanics.bodies import Body, Isotropic, Principal, Tensor
from ..mechanics.loads import Force, Load
from ..mechanics.motions import Fixed, Motion, Spin, SupportState
from ..mechanics.system import RollingSystem
from .examining import eliminated_law
from .motion import Motion as TheirMotion
from .record import Array


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


def constrained_without_carrying(system: RollingSystem, at: TheirMotion) -> tuple[Array, Array]:
    """Return V̇ and Ω̇ where u̇ is left out of the law of Ω, and V follows from Ω by the true constraint."""
    V_rate, Omega_rate = eliminated_law(without_carrying(system), at)
    slip, Omega, V = (Vector.of(v) for v in (np.zeros_like(at.slip), at.angular_velocity, at.velocity))
    p_rate, _ = at.contact.rates(slip, Omega, V)
    carried = at.contact.support.material_acceleration(at.contact.point, p_rate).array()
    return V_rate + np.broadcast_to(carried, V_rate.shape), Omega_rate


def turns(system: RollingSystem) -> bool:
    """Tell whether the support is one whose rate can be another: fixed, or turning steadily."""
    return isinstance(system.support.motion, (Fixed, Spin))


def with_rate(system: RollingSystem, rate: float) -> RollingSystem:
    """Return the system on a support that turns at another rate, rad/s."""
    return replace(system, support=replace(system.support, motion=Spin(rate)))


def with_inertia(system: RollingSystem, factor: float) -> RollingSystem:
    """Return the system with all moments of inertia multiplied."""
    body = system.body
    if isinstance(body.inertia, Principal):
        inertia: Any = Principal(*(float(getattr(body.inertia, axis)) * factor for axis in "xyz"))
    elif isinstance(body.inertia, Tensor):
        inertia = Tensor(*(float(element) * factor for element in body.inertia.elements))
    else:
        moment = float(body.inertia_in_space(Matrix.identity()).a.x)
        inertia = Isotropic(moment * factor)  # more than a shell's, even: theirs may be so
    return replace(system, body=replace(body, inertia=inertia))


def with_push(system: RollingSystem, x: float, y: float) -> RollingSystem:
    """Return the system with a constant force more, given as an acceleration in the support frame, m/s²."""
    m = float(system.body.mass)
    return replace(system, loads=(*system.loads, Force((m * x, m * y, 0.0))))


def without_load(system: RollingSystem, load: Load) -> RollingSystem:
    """Return the system with one load left out."""
    return replace(system, loads=tuple(other for other in system.loads if other is not load))
