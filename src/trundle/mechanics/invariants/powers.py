"""Energies, and what a free table has (theory page, section 6): who gives power to whom.

The contact force R gives the body the power R·(s + u), s being the slip and u the velocity of the support's material.
Rolling has s = 0; without friction s·R = 0; in flight R = 0. Over a support that turns with ω about a fixed axis,
R·u = ω·(p×R): what the body gains in energy, it gains ω times in angular momentum about the axis.
"""

from __future__ import annotations

from typing import Any

from ..algebra import Vector
from ..loads import BodyMotion
from ..scalars import Scalar
from ..symmetry import conservative, fixed, free_axle, frictionless, symmetric_potential
from ..system import RollingSystem
from .base import FLIGHT, PHASES, ROLLING, Invariant, Record


def spin_momentum(system: RollingSystem, at: Record) -> Vector:
    """Return JΩ in the support frame, kg m²/s."""
    return system.body.inertia_in_space(at.motion.orientation.matrix()) @ at.motion.angular_velocity


def energies(system: RollingSystem, motion: BodyMotion) -> list[Scalar]:
    """Return the kinetic energy, of the orbit and of the turning, and the potential energy of each load that has one.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.loads.base import at_rest
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane()), gravity=0.0)
    >>> [float(abs(part)) for part in energies(system, at_rest(2.0))]
    [0.0, 0.0, 0.0]
    """
    V, Omega = motion.velocity, motion.angular_velocity
    J = system.body.inertia_in_space(motion.orientation.matrix())
    kinetic = [0.5 * system.body.mass * V.dot(V), 0.5 * Omega.dot(J @ Omega)]
    potential = (load.potential(motion) for load in system.all_loads if not load.at_contact)
    return [*kinetic, *(part for part in potential if part is not None)]


def _energy(system: RollingSystem, at: Record) -> list[Scalar]:
    return energies(system, at.motion)


def _about_axis(system: RollingSystem, at: Record) -> list[Scalar]:
    """Return e·L: of the orbit, whose two products all but cancel as a body goes outwards, and of the turning."""
    r, V = at.motion.position, at.motion.velocity * system.body.mass
    return [r.x * V.y, -(r.y * V.x), spin_momentum(system, at).z]


def _moving_energy(system: RollingSystem, at: Record) -> list[Scalar]:
    rate = system.support.motion.steady_rate
    return [*_energy(system, at), *(-(rate * part) for part in _about_axis(system, at))]


def _energy_with_table(system: RollingSystem, at: Record) -> list[Scalar]:
    inertia: Any = free_axle(system.support.motion)
    return [*_energy(system, at), 0.5 * inertia * at.support_coordinates[1] * at.support_coordinates[1]]


def _momentum_with_table(system: RollingSystem, at: Record) -> list[Scalar]:
    inertia: Any = free_axle(system.support.motion)
    return [*_about_axis(system, at), inertia * at.support_coordinates[1]]


def _working(system: RollingSystem) -> tuple[str, ...]:
    """Return the phases in which nothing is lost to friction."""
    return PHASES if frictionless(system) else (ROLLING, FLIGHT)


def _has_energy(system: RollingSystem) -> tuple[str, ...]:
    if not all(conservative(load) or load.at_contact for load in system.all_loads):
        return ()
    touched = any(load.at_contact for load in system.all_loads)
    return _working(system) if fixed(system) and not touched else (FLIGHT,)


def _has_moving_energy(system: RollingSystem) -> tuple[str, ...]:
    # An elliptic bowl turns with its own ω: of the surface nothing is asked, only of the loads.
    turns = system.support.motion.steady_rate is not None and not fixed(system)
    return _working(system) if turns and symmetric_potential(system) else ()


def _has_energy_with_table(system: RollingSystem) -> tuple[str, ...]:
    free = free_axle(system.support.motion) is not None
    return _working(system) if free and all(conservative(load) for load in system.all_loads) else ()


def _has_momentum_with_table(system: RollingSystem) -> tuple[str, ...]:
    free = free_axle(system.support.motion) is not None
    # What the support exerts besides, such as a couple against rolling, it feels itself.
    others = all(load.at_contact or (conservative(load) and load.symmetric) for load in system.all_loads)
    return PHASES if free and others else ()


ENERGY = Invariant("energy", "½mV² + ½Ω·JΩ + U", "J", _has_energy, _energy)
# [fasso2016]: E − ω·L, where the constraint moves steadily along a symmetry of body and loads.
MOVING_ENERGY = Invariant("moving energy", "E − ω·L", "J", _has_moving_energy, _moving_energy)
# [weckesser1997], whose table is the frame of the system: what it gives, the body gets.
ENERGY_WITH_TABLE = Invariant("energy with the table", "E + ½I_t ω²", "J", _has_energy_with_table, _energy_with_table)
MOMENTUM_WITH_TABLE = Invariant(
    "angular momentum with the table",
    "e·L + I_t ω",
    "kg m²/s",
    _has_momentum_with_table,
    _momentum_with_table,
    through_changes=True,
)
