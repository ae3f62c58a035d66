"""Angular momenta of spheres on planes, and Jellett's and Routh's integrals (theory page, section 6).

Everywhere d(JΩ)/dt = K + ρ×R and m V̇ = F + R. On a plane that keeps its normal n, a sphere of radius a whose own
centre is at c from the centre of mass has ρ = c − a n and ρ̇ = Ω×c, whether it rolls, slips or flies over it.
"""

from __future__ import annotations

from typing import Any

from ..algebra import E_Z, Vector
from ..scalars import Scalar, namespace
from ..symmetry import Ball, ball_of, constant_moment, fixed, on_plane, without_torque
from ..system import RollingSystem
from .base import FLIGHT, PHASES, ROLLING, Invariant, Record, products
from .powers import spin_momentum


def _ball_on_plane(system: RollingSystem) -> Ball | None:
    return ball_of(system.body) if on_plane(system) else None


def _offset(system: RollingSystem, at: Record) -> Vector:
    """Return ρ = Q c − a n, m: in flight, too, where the contact is only the nearest point."""
    ball: Any = ball_of(system.body)
    return at.motion.orientation.matrix() @ ball.centre - E_Z * ball.radius


def _has_spin(system: RollingSystem) -> tuple[str, ...]:
    """Find an isotropic sphere about its centre of mass: I d(Ω·n)/dt = K·n + (ρ×R)·n, and ρ is along n."""
    isotropic = system.body.is_isotropic_sphere and on_plane(system)
    return PHASES if isotropic and all(load.leaves_spin for load in system.all_loads) else ()


def _has_normal_momentum(system: RollingSystem) -> tuple[str, ...]:
    """Find the same in a sphere with any inertia about its centre, for n·JΩ."""
    ball = _ball_on_plane(system)
    if ball is None or not ball.concentric or ball.isotropic:
        return ()
    return PHASES if all(load.leaves_spin for load in system.all_loads) else ()


def _normal_momentum(system: RollingSystem, at: Record) -> list[Scalar]:
    J = system.body.inertia_in_space(at.motion.orientation.matrix())
    return products(J.c, at.motion.angular_velocity)


def _normal_momentum_size(system: RollingSystem, at: Record) -> Scalar:
    return system.body.inertia_in_space(at.motion.orientation.matrix()).c.norm() * at.motion.angular_velocity.norm()


def _has_contact_momentum(system: RollingSystem) -> tuple[str, ...]:
    """Find a sphere about its centre of mass, ρ̇ = 0: d/dt(JΩ − mρ×V) = K − ρ×F, whatever the contact force."""
    radius = getattr(system.body.shape, "radius", None)
    centred = _rolls_about_centre(system) and on_plane(system)
    moment = constant_moment(system, E_Z * -radius) if centred and radius is not None else None
    return PHASES if moment is not None and tuple(moment) == (0.0, 0.0, 0.0) else ()


def _rolls_about_centre(system: RollingSystem) -> bool:
    ball = ball_of(system.body)
    return system.body.is_isotropic_sphere or (ball is not None and ball.concentric)


def _contact_momentum(system: RollingSystem, at: Record) -> list[Vector]:
    rho, V = E_Z * -system.body.radius, at.motion.velocity
    return [spin_momentum(system, at), rho.cross(V) * -system.body.mass]


def _has_jellett(system: RollingSystem) -> tuple[str, ...]:
    """Find d(JΩ·ρ)/dt = K·ρ + JΩ·(Ω×c) = 0: K is none, and JΩ, Ω and c lie in one plane if J is symmetric about c."""
    ball = _ball_on_plane(system)
    if ball is None or ball.concentric or ball.axis is None:
        return ()
    return PHASES if all(without_torque(load) for load in system.all_loads) else ()


def _jellett(system: RollingSystem, at: Record) -> list[Scalar]:
    return products(spin_momentum(system, at), _offset(system, at))


def _jellett_size(system: RollingSystem, at: Record) -> Scalar:
    return spin_momentum(system, at).norm() * _offset(system, at).norm()


def _has_routh(system: RollingSystem) -> tuple[str, ...]:
    """Find a sphere with an axis that rolls on a plane at rest under loads along its normal.

    With M = JΩ + mρ×(Ω×ρ), M' = mρ̇×(Ω×ρ) − ρ×F. Its parts along e and n, with F along n, give
    (J₁J₃ + mρ·Jρ) d(Ω·e)/dt = −m Ω·e (ρ·J ρ̇), and ρ·Jρ̇ is half the rate of ρ·Jρ.
    """
    ball = _ball_on_plane(system)
    if ball is None or ball.axis is None or (ball.concentric and ball.isotropic) or not fixed(system):
        return ()
    loads = system.all_loads
    pressed = all(load.constant and load.symmetric and without_torque(load) for load in loads)
    return (ROLLING,) if pressed else ()


def _routh(system: RollingSystem, at: Record) -> list[Scalar]:
    ball: Any = ball_of(system.body)
    axis, root = at.motion.orientation.matrix() @ ball.axis, _routh_root(system, at)
    return [part * root for part in products(at.motion.angular_velocity, axis)]


def _routh_root(system: RollingSystem, at: Record) -> Scalar:
    """Return √(J₁J₃ + mρ·Jρ), kg m²."""
    ball: Any = ball_of(system.body)
    Q, rho = at.motion.orientation.matrix(), _offset(system, at)
    across, about = ball.moments
    squared = across * about + system.body.mass * rho.dot(system.body.inertia_in_space(Q) @ rho)
    return namespace(*rho).sqrt(squared)


def _routh_size(system: RollingSystem, at: Record) -> Scalar:
    return at.motion.angular_velocity.norm() * _routh_root(system, at)


def _has_free_momentum(system: RollingSystem) -> tuple[str, ...]:
    return (FLIGHT,) if all(load.at_contact or without_torque(load) for load in system.all_loads) else ()


SPIN = Invariant(
    "spin about the normal",
    "Ω·n",
    "rad/s",
    _has_spin,
    lambda _, at: [at.motion.angular_velocity.z],
    through_changes=True,
    size=lambda _, at: at.motion.angular_velocity.norm(),
)
NORMAL_MOMENTUM = Invariant(
    "angular momentum about the normal",
    "n·JΩ",
    "kg m²/s",
    _has_normal_momentum,
    _normal_momentum,
    through_changes=True,
    size=_normal_momentum_size,
)
# [chaplygin1903]: on a plane at rest V = −Ω×ρ, and it is JΩ + mρ×(Ω×ρ); so written it holds on moving planes, too.
CONTACT_MOMENTUM = Invariant(
    "angular momentum about the contact",
    "JΩ − mρ×V",
    "kg m²/s",
    _has_contact_momentum,
    _contact_momentum,
    through_changes=True,
)
# [jellett1872], for a body that slips.
JELLETT = Invariant(
    "integral of Jellett", "JΩ·ρ", "kg m³/s", _has_jellett, _jellett, through_changes=True, size=_jellett_size
)
# [routh1905].
ROUTH = Invariant("integral of Routh", "Ω·e √(J₁J₃ + mρ·Jρ)", "kg m²/s", _has_routh, _routh, size=_routh_size)
FREE_MOMENTUM = Invariant(
    "angular momentum about the centre of mass",
    "JΩ",
    "kg m²/s",
    _has_free_momentum,
    lambda system, at: [spin_momentum(system, at)],
)
