"""First integrals, and which system has them (theory page, section 6): told from its symmetries, not from its name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from .algebra import Vector
from .loads import BodyMotion, Load, at_rest
from .scalars import Scalar, is_zero
from .shapes import concentric_sphere
from .surfaces import Plane
from .system import RollingSystem


@dataclass(frozen=True, slots=True)
class Record:
    """A body's motion and contact at one instant, or at many with arrays as components."""

    motion: BodyMotion
    contact: Vector  # p, m

    @property
    def offset(self) -> Vector:
        """ρ = p − r, m."""
        return self.contact - self.motion.position


@dataclass(frozen=True)
class Invariant:
    """A first integral: when it holds, its value, and the size against which its drift is small or not.

    Examples
    --------
    >>> [integral.name for integral in INVARIANTS]
    ['energy', 'moving energy', 'spin about the normal', 'angular momentum about the contact']
    """

    name: str
    formula: str
    unit: str
    holds: Callable[[RollingSystem], bool]
    terms: Callable[[RollingSystem, Record], list[Any]]  # their sum is constant; scalars or vectors


def _kinetic(system: RollingSystem, at: Record) -> list[Scalar]:
    V, Omega = at.motion.velocity, at.motion.angular_velocity
    return [0.5 * system.body.mass * V.dot(V), 0.5 * Omega.dot(_spin_momentum(system, at))]


def _spin_momentum(system: RollingSystem, at: Record) -> Vector:
    return system.body.inertia_in_space(at.motion.orientation.matrix()) @ at.motion.angular_velocity


def _energy(system: RollingSystem, at: Record) -> list[Scalar]:
    return [*_kinetic(system, at), *(load.potential(at.motion) for load in system.all_loads)]


def _moving_energy(system: RollingSystem, at: Record) -> list[Scalar]:
    r, V = at.motion.position, at.motion.velocity
    rate = system.support.motion.steady_rate
    orbital, own = r.cross(V).z * system.body.mass, _spin_momentum(system, at).z
    return [*_energy(system, at), -(rate * orbital), -(rate * own)]


def _contact_momentum(system: RollingSystem, at: Record) -> list[Vector]:
    rho, Omega = at.offset, at.motion.angular_velocity
    return [_spin_momentum(system, at), system.body.mass * rho.cross(Omega.cross(rho))]


def _conservative(load: Load) -> bool:
    return load.potential(at_rest(1.0)) is not None


def _is_fixed(system: RollingSystem) -> bool:
    rate = system.support.motion.steady_rate
    return rate is not None and is_zero(rate)


def _has_energy(system: RollingSystem) -> bool:
    return _is_fixed(system) and all(_conservative(load) for load in system.all_loads)


def _has_moving_energy(system: RollingSystem) -> bool:
    turns = system.support.motion.steady_rate is not None and not _is_fixed(system)
    symmetric = all(_conservative(load) and load.symmetric for load in system.all_loads)
    return turns and system.support.surface.axisymmetric and symmetric


def _has_spin(system: RollingSystem) -> bool:
    on_plane = system.body.is_isotropic_sphere and isinstance(system.support.surface, Plane)
    on_plane = on_plane and system.support.motion.steady_rate is not None  # the normal stays the third axis
    return on_plane and all(load.leaves_spin for load in system.all_loads)


def _has_contact_momentum(system: RollingSystem) -> bool:
    sphere = concentric_sphere(system.body.shape) and isinstance(system.support.surface, Plane)
    pressed = all(_conservative(load) and load.constant and load.symmetric for load in system.all_loads)
    return sphere and _is_fixed(system) and pressed


INVARIANTS = (
    Invariant("energy", "½mV² + ½Ω·JΩ + U", "J", _has_energy, _energy),
    Invariant("moving energy", "E − ω·L", "J", _has_moving_energy, _moving_energy),
    Invariant("spin about the normal", "Ω·n", "rad/s", _has_spin, lambda _, at: [at.motion.angular_velocity.z]),
    Invariant(
        "angular momentum about the contact",
        "JΩ + mρ×(Ω×ρ)",
        "kg m²/s",
        _has_contact_momentum,
        _contact_momentum,
    ),
)


def invariants_of(system: RollingSystem) -> tuple[Invariant, ...]:
    """Return the first integrals that a system has.

    Parameters
    ----------
    system : RollingSystem
        Any system.

    Returns
    -------
    tuple of Invariant
        Those that its symmetries give; a tilted turning table has neither energy nor moving energy.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    >>> [integral.name for integral in invariants_of(system)]
    ['spin about the normal']
    """
    return tuple(integral for integral in INVARIANTS if integral.holds(system))
