"""A body at rest on its support: the work of the loads over virtual displacements, and the law's linear part there.

Nothing of the mechanics is written a second time: the virtual velocity is that of `Contact`, the acceleration that of
`roll` with Ω = 0, and derivatives come from a step along the imaginary axis through the same functions, which loses no
digits however small it is.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...mechanics.algebra import E_X, E_Y, E_Z, ZERO, Quaternion, Vector
from ...mechanics.contact import Contact, contact_at, roll
from ...mechanics.loads import BodyMotion
from ...mechanics.scalars import Scalar
from ...mechanics.system import RollingSystem
from ...solve.laws import RollingLaw

Array = NDArray[np.float64]

STEP = 1e-30  # along the imaginary axis, rad or radii


def still(system: RollingSystem, time: float, contact: Contact, q: Quaternion) -> BodyMotion:
    """Return the motion of a body that is at rest where it touches."""
    return BodyMotion(time, system.body.mass, contact.centre, ZERO, q, ZERO)


def virtual_work(system: RollingSystem, time: float, contact: Contact, q: Quaternion, turn: Vector) -> Scalar:
    """Return the work F·δr + K·δφ of the loads per radian of a virtual rolling, δr = −δφ×ρ, J/rad.

    Examples
    --------
    A ball of weight m g on a slope gives a m g sin α for each radian that it rolls down:

    >>> import trundle as tr
    >>> slope = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane(), tilt=0.5), gravity=10.0)
    >>> q = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> round(virtual_work(slope, 0.0, contact_at(slope, 0.0, ZERO, q), q, E_Y) / 0.479425538604203, 12)
    2.0
    """
    return work_of(contact, *system.loads_on(still(system, time, contact, q)))(turn)


def work_of(contact: Contact, force: Vector, torque: Vector) -> Callable[[Vector], Scalar]:
    """Return the virtual work of a force and a torque as a function of the turn."""
    return lambda turn: force.dot(contact.rolling_velocity(turn)) + torque.dot(turn)


def torque_about_contact(system: RollingSystem, time: float, p: Vector, q: Quaternion) -> Vector:
    """Return the virtual work for turns about the three axes, which is the loads' torque about the contact, N m."""
    contact = contact_at(system, time, p, q)
    works = work_of(contact, *system.loads_on(still(system, time, contact, q)))
    return Vector(*(works(axis) for axis in (E_X, E_Y, E_Z)))


def torque_scale(system: RollingSystem, time: float, p: Vector, q: Quaternion) -> float:
    """Return |F||ρ| + |K|, N m: what the torque about the contact is small against, or not."""
    contact = contact_at(system, time, p, q)
    force, torque = system.loads_on(still(system, time, contact, q))
    return float(force.norm() * contact.offset.norm() + torque.norm())


def potential(system: RollingSystem, time: float, p: Vector, q: Quaternion) -> Scalar:
    """Return the potential energy of the loads that have one, J."""
    motion = still(system, time, contact_at(system, time, p, q), q)
    energies = [load.potential(motion) for load in system.all_loads]
    return sum((energy for energy in energies if energy is not None), 0.0)


def has_energy(system: RollingSystem, time: float, p: Vector, q: Quaternion) -> bool:
    """Whether every load has a potential, or is one that a body at rest does not feel."""
    motion = still(system, time, contact_at(system, time, p, q), q)

    def counts(load: Any) -> bool:
        return load.potential(motion) is not None or load.linear_drag is not None

    return all(counts(load) for load in system.all_loads)


def room(system: RollingSystem, contact: Contact, q: Quaternion) -> Scalar:
    """Return what falls through zero where the support ends, or its shape does: the rolling law's bounds."""
    least: Any = np.inf
    for bound in RollingLaw()._bounds(system, contact, q, 0.0).values():
        least = np.minimum(least, bound)
    return least


def stacked(vectors: Sequence[Vector]) -> Vector:
    """Return one vector with arrays as components, so that a single call handles all."""
    return Vector(*(np.array([float(part) for part in parts]) for parts in zip(*vectors, strict=True)))


def moved(p: Vector, q: Quaternion, dp: Vector, dq: Quaternion, step: Any) -> tuple[Vector, Quaternion]:
    """Return p + step dp and q + step dq."""
    return p + dp * step, Quaternion(*(a + step * b for a, b in zip(q, dq, strict=True)))


def linear_law(
    system: RollingSystem, time: float, p: Vector, q: Quaternion, turns: Sequence[Vector]
) -> tuple[Array, Array, Array]:
    """Return the linear part of the rolling law about rest: Ω̇ = H δφ + G Ω for rolling along some turns.

    Examples
    --------
    A pencil-like hoop of radius a with all its weight off its axis would tip with g/(2a); a plain one stays:

    >>> import trundle as tr
    >>> level = tr.RollingSystem(tr.Body.hoop(0.1, 1.0), tr.Support(tr.Plane()))
    >>> H, G, moves = linear_law(level, 0.0, ZERO, Quaternion(1.0, 0.0, 0.0, 0.0), [E_Y])
    >>> [float(abs(part[0, 0])) for part in (H, G, moves)]
    [0.0, 0.0, 0.1]
    """
    contact, along = contact_at(system, time, p, q), stacked(turns)
    moves = contact.rates(ZERO, along, contact.rolling_velocity(along))[0]
    place = moved(p, q, moves, q.rate(along), 1j * STEP)
    displaced = roll(system, time, *place, ZERO).angular_acceleration
    turning = roll(system, time, p, q, along * (1j * STEP)).angular_acceleration
    basis = along.array()
    H, G = (_imaginary(rate, len(turns)) / STEP for rate in (displaced, turning))
    return basis @ H.T, basis @ G.T, np.broadcast_to(moves.array(), (len(turns), 3)).copy()


def _imaginary(v: Vector, count: int) -> Array:
    return np.stack([np.broadcast_to(np.imag(part), (count,)) for part in v], axis=-1)
