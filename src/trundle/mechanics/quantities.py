"""The numbers of a motion that only its mechanics can tell, such as its energies: what is drawn of it as curves."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from .algebra import Vector
from .invariants import Record
from .invariants.powers import MOVING_ENERGY, energies
from .motions import SupportState
from .scalars import Scalar, is_zero, namespace
from .symmetry import ball_of
from .system import RollingSystem


@dataclass(frozen=True)
class Quantity:
    """One of them, for any scalar."""

    key: str
    label: str
    unit: str
    value: Scalar
    touching: bool = False  # whether there is none in flight


def is_ball(system: RollingSystem) -> bool:
    """Tell whether the body is a sphere about its centre of mass, which rolls any way.

    Examples
    --------
    >>> import trundle as tr
    >>> is_ball(tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane())))
    True
    """
    ball = ball_of(system.body)
    return ball is not None and ball.concentric


def upwards(tilt: Scalar) -> Vector:
    """Return the unit vector that points vertically up, in the support frame.

    Examples
    --------
    >>> upwards(0.0)
    Vector(x=0.0, y=0.0, z=1.0)
    """
    xp = namespace(tilt)
    return Vector(0.0 - xp.sin(tilt), 0.0, xp.cos(tilt))


def angle_between(one: Vector, other: Vector) -> Scalar:
    """Return the angle between two directions, degrees, precise also where it is small.

    Examples
    --------
    >>> round(angle_between(Vector(1.0, 0.0, 0.0), Vector(0.0, 2.0, 0.0)), 12)
    90.0
    """
    across, along = one.cross(other).norm(), one.dot(other)
    return namespace(across, along).atan2(across, along) * (180.0 / math.pi)


def quantities(
    system: RollingSystem, plain: RollingSystem, at: Record, support: SupportState, normal: Vector, force: Vector
) -> Iterator[Quantity]:
    """Yield them all.

    Parameters
    ----------
    system : RollingSystem
        Any scalars.
    plain : RollingSystem
        The same with numbers: which quantities there are is decided by them.
    at : Record
        Motion and contact, support frame.
    support : SupportState
        Pose and twist of the support.
    normal, force : Vector
        n, from the support into the body, and the contact force, N.

    Yields
    ------
    Quantity
        With its value, as many as the scalars hold.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import E_Z
    >>> from trundle.mechanics.loads.base import at_rest
    >>> still, at = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane())), at_rest(2.0)
    >>> told = quantities(still, still, Record(at, at.position), still.support.motion.at(0.0), E_Z, E_Z * 5.0)
    >>> [(one.key, one.value) for one in told][-2:]
    [('normal', 5.0), ('friction', 0.0)]
    """
    yield from _angles(system, plain, at, normal)
    yield from _energies(system, plain, at)
    along = force.dot(normal)
    across = (force - normal * along).norm()
    yield Quantity("normal", "Normal force N", "N", along, touching=True)
    share = 0.0 if is_zero(along) else across / along  # a number 0 is that of flight
    yield Quantity("friction", "Friction needed, |f|/N", "", share, touching=True)
    if plain.support.motion.steady_rate is None:
        yield Quantity("table", "Rate of the support", "rad/s", support.angular_velocity.dot(support.axle))


def _angles(system: RollingSystem, plain: RollingSystem, at: Record, normal: Vector) -> Iterator[Quantity]:
    Omega, up = at.motion.angular_velocity, upwards(system.support.tilt)
    yield Quantity("spin_normal", "Spin about the normal", "rad/s", Omega.dot(normal), touching=True)
    level = plain.support.surface.flat and not float(plain.support.tilt)
    if not level:
        yield Quantity("spin_vertical", "Spin about the vertical", "rad/s", Omega.dot(up))
    axis = at.motion.orientation.matrix().transpose.c
    if not is_ball(plain):
        yield Quantity("lean", "Lean of its axis from the normal", "°", angle_between(axis, normal), touching=True)
    if is_ball(plain) or not level:
        yield Quantity("pole", "Angle of its pole from the vertical", "°", angle_between(axis, up))


def _energies(system: RollingSystem, plain: RollingSystem, at: Record) -> Iterator[Quantity]:
    orbit, turning, *potentials = energies(system, at.motion)
    kinetic, potential = orbit + turning, sum(potentials, 0.0)
    yield Quantity("kinetic", "Kinetic energy", "J", kinetic)
    yield Quantity("potential", "Potential energy", "J", potential)
    yield Quantity("energy", "Kinetic and potential energy", "J", kinetic + potential)
    if plain.support.motion.steady_rate:
        yield Quantity("moving", "Moving energy, E − ω·L", "J", sum(MOVING_ENERGY.terms(system, at), 0.0))


__all__ = ["Quantity", "angle_between", "is_ball", "quantities", "upwards"]
