"""Whether another part of a body lies below the surface that it touches."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError
from .algebra import Vector
from .contact import Contact
from .jets import Jet, jets
from .surfaces import Surface

if TYPE_CHECKING:
    from .system import RollingSystem

_DIRECTIONS = 4096  # in which the body's surface is looked at
_REFINED = 40  # steps from the deepest of them on
_TOUCHING = 1e-9  # of the body's size: no depth to speak of


def check_clear(
    system: RollingSystem, contact: Contact, orientation: Any, received: Any, key: str = "position"
) -> None:
    """Refuse a body of which another part lies below the surface.

    Examples
    --------
    A ball fits the curvature of the side of a narrow paraboloid, but there are two sides:

    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import Quaternion
    >>> from trundle.mechanics.contact import contact_at
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.2, 1.0), tr.Support(tr.Paraboloid(0.1)))
    >>> q = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> contact = contact_at(system, 0.0, tr.Paraboloid(0.1).point(0.15, 0.0), q)
    >>> check_clear(system, contact, q, (0.15, 0))
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `position` must keep the whole body clear of the surface; got (0.15, 0). ...
    """
    if fits_anywhere(system):
        return
    deepest = depth(system, contact, orientation)
    if deepest is None:
        return
    below, where = deepest
    if below > _TOUCHING * contact.offset.norm():
        shown = ", ".join(f"{part:.4g}" for part in where)
        raise InvalidValueError(
            key,
            "must keep the whole body clear of the surface",
            received,
            f"A part of it lies {below:.3g} m below the surface, at ({shown}) m in the support's own frame.",
        )


def fits_anywhere(system: RollingSystem) -> bool:
    """Tell whether a body is known to lie below the surface nowhere, wherever it touches.

    A ball of the body's largest radius of curvature, through the contact, holds the body; the surface crosses none that
    is no larger than its `free_radius` (W. Blaschke, Kreis und Kugel, Veit, Leipzig, 1916, section 24).

    Examples
    --------
    >>> import trundle as tr
    >>> [fits_anywhere(tr.RollingSystem(tr.Body.solid_sphere(a, 1.0), tr.Support(tr.Bowl(0.5)))) for a in (0.2, 0.6)]
    [True, False]
    """
    bends, free = system.body.shape.largest_radius, system.support.surface.free_radius
    return bends is not None and free is not None and bool(bends <= free)


def depth(system: RollingSystem, contact: Contact, orientation: Any) -> tuple[float, tuple[float, ...]] | None:
    """Return how far the deepest of a body's sampled points is below the surface, and where.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import Quaternion
    >>> from trundle.mechanics.contact import contact_at
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.2, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> q = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> below, where = depth(system, contact_at(system, 0.0, Vector(0.0, 0.0, 0.0), q), q)
    >>> abs(below) < 1e-15, abs(where[2]) < 1e-15
    (True, True)
    """
    import numpy as np

    surface = system.support.surface
    with np.errstate(all="ignore"):
        own = _body_point(system, contact, orientation, _directions())
        level = np.broadcast_to(np.asarray(surface.level(own), dtype=float), (_DIRECTIONS,)).copy()
        over = np.isfinite(level) & _there(surface, own)
    if not over.any():
        return None
    level[~over] = math.inf
    at = int(np.argmin(level))
    where = Vector(*(float(np.broadcast_to(part, (_DIRECTIONS,))[at]) for part in own))
    found = _distance(surface, where)
    for _ in range(_REFINED):  # towards the place where the body's normal is opposite to the surface's
        turned = contact.support.rotation @ surface.normal(where)
        further = _body_point(system, contact, orientation, -(orientation.matrix().transpose @ turned))
        if not all(map(math.isfinite, further)) or not _there(surface, further):
            break
        nearer = _distance(surface, further)
        if not nearer < found:
            break
        where, found = further, nearer
    return -found, tuple(map(float, where))


def _body_point(system: RollingSystem, contact: Contact, orientation: Any, nu: Vector) -> Vector:
    """Return X(ν) in the support's own frame, m."""
    ours = contact.centre + orientation.matrix() @ system.body.shape.support_map(nu)
    return contact.support.local(ours)


def _there(surface: Surface, p: Vector) -> Any:
    """Tell whether points have the surface under them, before its rim or end."""
    there, left = p.x == p.x, surface.domain_margin(p)
    if surface.rim is not None:
        there = there & (p.x * p.x + p.y * p.y < float(surface.rim) ** 2)
    return there if left is None else there & (left > 0)


def _distance(surface: Surface, p: Vector) -> float:
    """Return φ/|∇φ|, to first order the distance from the surface, m."""
    level = float(surface.level(p))
    phi = surface.level(Vector(*jets(tuple(p)))) if surface.analytic else None
    if not isinstance(phi, Jet):  # a table: φ is the height
        return level * float(surface.normal(p).z)
    slope = Vector(*phi.gradient).norm()
    return level / slope if math.isfinite(slope) and slope > 0 else level


def _directions() -> Vector:
    """Return directions spread evenly over the sphere: Fibonacci's lattice."""
    import numpy as np

    i = np.arange(_DIRECTIONS) + 0.5
    z, angle = 1.0 - 2.0 * i / _DIRECTIONS, math.pi * (1.0 + math.sqrt(5.0)) * i
    r = np.sqrt(1.0 - z * z)
    return Vector(r * np.cos(angle), r * np.sin(angle), z)
