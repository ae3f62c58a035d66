"""Cylinders and hoops that roll straight: how they lie, and what would turn them out of their line (section 2).

Such a body touches along a line, which holds its axis parallel to the support. It moves exactly as a sphere of the
same radius and inertia ratio would, as long as that sphere stays in the plane across the line; that much is asked here.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError
from . import checks
from .algebra import Matrix, Quaternion, Vector
from .contact import Contact, roll, settle
from .motions import SupportState
from .surfaces import Surface

if TYPE_CHECKING:
    from .system import RollingSystem, State

TOLERANCE = 1e-9  # share of Ω or Ω̇ that may lie across the axis


def facing(contact: Contact, begin: SupportState, surface: Surface, velocity: Any, turned: float) -> Quaternion:
    """Return the orientation of a cylinder laid across its way.

    Parameters
    ----------
    contact : Contact
        Gives point and normal n.
    begin : SupportState
        Of the support.
    surface : Surface
        Its first coordinate is the way of a body at rest.
    velocity : sequence of 2 floats or quantities, "co-rotating" or None
        Of the centre; its direction d is the way.
    turned : float
        How far it has rolled on since its first axis lay along n, rad.

    Returns
    -------
    Quaternion
        The one whose matrix has the columns n, d, n×d where it has not rolled on.

    Examples
    --------
    >>> import trundle as tr
    >>> slope = tr.RollingSystem(tr.Body.hoop(0.1, 1.0), tr.Support(tr.Plane(), tilt=0.1))
    >>> slope.place().orientation  # its axis is the second of the support frame
    (0.5, -0.5, -0.5, -0.5)
    """
    own = begin.rotation.transpose @ (contact.point - begin.origin)
    first, second = (begin.rotation @ e for e in surface.directions(own))
    along = (1.0, 0.0)
    if velocity is not None and not isinstance(velocity, str):
        count = 3 if hasattr(velocity, "__len__") and len(velocity) == 3 else 2  # the third is along the normal
        vx, vy, *_ = checks.components(velocity, "velocity", "velocity", count)
        speed = math.hypot(vx, vy)
        # The way is not reversed by rolling backwards along the first coordinate.
        if speed > 0 and vy != 0:
            along = (vx / speed, vy / speed)
    d, n = first * along[0] + second * along[1], contact.normal
    c, s = math.cos(turned), math.sin(turned)
    up, forward = n * c + d * s, d * c - n * s
    return Quaternion.of_matrix(Matrix(up, forward, n.cross(d)).transpose)


def check_start(system: RollingSystem, start: State) -> None:
    """Refuse a cylinder that lies askew, spins out of its line, or is pushed out of it.

    Parameters
    ----------
    system : RollingSystem
        Bodies that touch at a point pass.
    start : State
        A start that touches, or falls.

    Raises
    ------
    InvalidValueError
        If the sphere that the cylinder moves as would leave the plane across the cylinder's axis.

    Examples
    --------
    >>> import trundle as tr
    >>> turntable = tr.RollingSystem(tr.Body.cylinder(0.1, 1.0), tr.Support(tr.Plane(), motion=tr.Spin(1.0)))
    >>> turntable.place((0.3, 0.0))
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `body` must roll straight, its Ω along its axis; got Roller(...). A sphere ...
    """
    if system.body.shape.axis is None:
        return
    q, Omega = Quaternion(*start.orientation), Vector(*start.angular_velocity)
    axis = q.matrix() @ system.body.shape.axis
    contact = settle(system, start.time, Vector(*start.position), q, start.support)
    if abs(axis.dot(contact.normal)) > TOLERANCE:
        remedy = "Leave `orientation` out and it is laid across its way."
        raise InvalidValueError(
            "orientation", "must lay a cylinder's axis along the support", start.orientation, remedy
        )
    if (contact.shape_operator @ axis).norm() * contact.offset.norm() > TOLERANCE:
        raise _crooked(system, "its axis along a straight line of the surface", "Leave `orientation` out, or turn it.")
    if _across(Omega, axis) > TOLERANCE * Omega.norm():
        raise _crooked(system, "its Ω along its axis", "A sphere rolls in every direction.")
    V = Vector(*start.velocity)
    along = V - contact.support.material_velocity(contact.point)
    if abs(along.dot(axis)) > TOLERANCE * max(along.norm(), V.norm()):
        raise _crooked(system, "its way across its axis", "Leave `orientation` out and it is laid across its way.")
    now = roll(system, start.time, contact.point, q, Omega, start.support)
    size = max(now.angular_acceleration.norm(), Omega.dot(Omega))
    if _across(now.angular_acceleration, axis) > TOLERANCE * size:
        raise _crooked(
            system, "with nothing that pushes it out of its line", "Let it start along the slope, and push it that way."
        )


def _across(v: Vector, axis: Vector) -> float:
    return float((v - axis * v.dot(axis)).norm())


def _crooked(system: RollingSystem, how: str, remedy: str) -> InvalidValueError:
    return InvalidValueError("body", f"must roll straight, {how}", system.body.shape, remedy)
