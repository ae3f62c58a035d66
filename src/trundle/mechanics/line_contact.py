"""Cylinders and hoops that roll straight: how they lie, and what would turn them out of their line (section 2).

Such a body touches along a line, which holds its axis parallel to the support. It moves exactly as a sphere of the
same radius and inertia ratio would, as long as that sphere stays in the plane across the line; that much is asked here.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError, SolverError
from . import checks
from .algebra import Matrix, Quaternion, Vector
from .contact import Contact, roll
from .motions import SupportState
from .nearest import closest_contact
from .scalars import namespace
from .surfaces import Surface

if TYPE_CHECKING:
    from .system import RollingSystem, State

TOLERANCE = 1e-9  # share of Ω or Ω̇ that may lie across the axis
_FURTHER = 0.7  # times |ρ|: how far on and back what pushes it is looked at
_INSTANTS = (0.0, 0.137, 0.382, 0.618, 0.871, 1.0)  # of the run, at which it is looked at


def facing(contact: Contact, begin: SupportState, surface: Surface, velocity: Any, turned: float) -> Quaternion:
    """Return the orientation of a cylinder laid across its way.

    Examples
    --------
    >>> import trundle as tr
    >>> slope = tr.RollingSystem(tr.Body.hoop(0.1, 1.0), tr.Support(tr.Plane(), tilt=0.1))
    >>> slope.place().orientation  # its axis is the second of the support frame
    (0.5, -0.5, -0.5, -0.5)
    """
    own = begin.local(contact.point)
    first, second = (begin.rotation @ e for e in surface.directions(own))
    along = (1.0, 0.0)
    if velocity is not None and not isinstance(velocity, str):
        count = 3 if hasattr(velocity, "__len__") and len(velocity) == 3 else 2  # the third is along the normal
        vx, vy, *_ = checks.components(velocity, "velocity", "velocity", count)
        speed = namespace(vx, vy).hypot(vx, vy)
        # The way is not reversed by rolling backwards along the first coordinate.
        if speed > 0:
            along = (vx / speed, vy / speed) if vy != 0 else (1.0, vy / vx)
    d, n = first * along[0] + second * along[1], contact.normal
    xp = namespace(turned)
    c, s = xp.cos(turned), xp.sin(turned)
    up, forward = n * c + d * s, d * c - n * s
    return Quaternion.of_matrix(Matrix(up, forward, n.cross(d)).transpose)


def check_start(system: RollingSystem, start: State, until: float | None = None) -> None:
    """Refuse a cylinder that lies askew, spins out of its line, or is pushed out of it now or later.

    Examples
    --------
    >>> import trundle as tr
    >>> turntable = tr.RollingSystem(tr.Body.cylinder(0.1, 1.0), tr.Support(tr.Plane(), motion=tr.Spin(1.0)))
    >>> turntable.place((0.3, 0.0))
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `body` must roll straight, its Ω along its axis; got ... A sphere ...
    """
    if system.body.shape.axis is None:
        return
    q, Omega = Quaternion(*start.orientation), Vector(*start.angular_velocity)
    axis = q.matrix() @ system.body.shape.axis
    contact = closest_contact(system, start.time, Vector(*start.position), q, start.support)
    if abs(axis.dot(contact.normal)) > TOLERANCE:
        remedy = "Leave `orientation` out and it is laid across its way."
        raise InvalidValueError(
            "orientation", "must lay a cylinder's axis along the support", start.orientation, remedy
        )
    if (contact.shape_operator @ axis).norm() * contact.offset.norm() > TOLERANCE:
        raise _crooked("its axis along a straight line of the surface", "Leave `orientation` out, or turn it.")
    if _across(Omega, axis) > TOLERANCE * Omega.norm():
        raise _crooked("its Ω along its axis", "A sphere rolls in every direction.")
    V = Vector(*start.velocity)
    along = V - contact.support.material_velocity(contact.point)
    if abs(along.dot(axis)) > TOLERANCE * max(along.norm(), V.norm()):
        raise _crooked("its way across its axis", "Leave `orientation` out and it is laid across its way.")
    _check_aside(system, start, contact, axis, start.time if until is None else until)


def _check_aside(system: RollingSystem, start: State, contact: Contact, axis: Vector, until: float) -> None:
    """Refuse what would turn the cylinder out of its line: there, a little further on, rolling either way, later.

    What is the same on both sides of the plane across the axis never does, wherever the cylinder rolls to. What is not
    the same may still balance at one place and instant, as on the axle of a turntable.
    """
    q, Omega, n, arm = Quaternion(*start.orientation), Vector(*start.angular_velocity), contact.normal, contact.offset
    motion = contact.body_motion(system.body.mass, start.time, Vector(*start.velocity), q, Omega)
    force, torque = system.loads_on(motion)
    pull = float(force.norm() + torque.norm() / arm.norm()) / float(system.body.mass)
    rate = max(
        float(abs(Omega.dot(axis))), math.sqrt(pull / float(arm.norm())), float(contact.support.angular_velocity.norm())
    )
    way = n.cross(axis) * (_FURTHER * float(arm.norm()))
    tried = [(start.time, 0.0, Omega, start.support)]
    tried += [
        (start.time + share * (until - start.time), side, axis * (side * rate), start.support)
        for share in (_INSTANTS if until > start.time else (0.0,))
        for side in (1.0, -1.0)
    ]
    moves = bool(Omega.norm() > 0)
    for time, side, turning, support in tried:  # to which states of a faster axle are added on the way
        half = -0.5 * _FURTHER * side * moves  # of the angle by which it has rolled there
        turned = Quaternion(math.cos(half), *(axis * math.sin(half))) * q
        try:
            there = closest_contact(system, time, Vector(*start.position) + way * side, turned, support)
            now = roll(system, time, there.point, turned, turning, support)
        except (SolverError, ArithmeticError, ValueError):  # the surface does not reach there
            continue
        if side == 0 and now.angular_acceleration.norm() > TOLERANCE * rate * rate:
            moves = True  # else it lies still where it is
        if moves and system.support.motion.free and support == start.support:
            angle, axle_rate = support
            _, growth = system.support.motion.coordinate_rates(time, support, now.axle_moment)
            if abs(growth) > TOLERANCE * rate * rate:  # it will turn otherwise
                tried.append((time, side, turning, (angle, axle_rate + (rate or math.sqrt(abs(growth))))))
        size = max(float(now.angular_acceleration.norm()), rate * rate)
        if _across(now.angular_acceleration, axis) > TOLERANCE * size or abs(axis.dot(there.normal)) > TOLERANCE:
            when = "" if time == start.time else f" (at t = {time:.4g} s)"
            remedy = "Let it start along the slope, and push it that way; a sphere rolls in every direction."
            raise _crooked(f"with nothing that pushes it out of its line{when}", remedy)


def _across(v: Vector, axis: Vector) -> float:
    return float((v - axis * v.dot(axis)).norm())


def _crooked(how: str, remedy: str) -> InvalidValueError:
    return InvalidValueError("body", f"must roll straight, {how}", "one that touches along a line", remedy)
