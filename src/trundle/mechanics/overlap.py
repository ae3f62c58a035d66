"""Whether another part of a body lies below the surface that it touches."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError
from .algebra import Vector
from .contact import Contact
from .motions import SupportState
from .surfaces import Surface

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .system import RollingSystem

    Array = NDArray[np.float64]

_DIRECTIONS, _FEW = 4096, 512  # in which the surface of one body is looked at, and that of each of many
_SIDES, _ALIKE = 8, 0.9  # from the lowest of them on so many sides, apart by the angle with this cosine,
_REFINED = 40  # so many steps are made down
TOUCHING = 1e-9  # of the body's size: no depth to speak of


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
    if below > TOUCHING * contact.offset.norm():
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
    if free is not None and free == math.inf:  # the plane of touch is between the two
        return True
    return bends is not None and free is not None and bool(bends <= free)


def depth(system: RollingSystem, contact: Contact, orientation: Any) -> tuple[float, tuple[float, ...]] | None:
    """Return how far the deepest of a body's points is below the surface, and where, in the support's own frame.

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
    below, where = depths(system, contact.support, contact.centre, orientation)
    return (float(below[0]), tuple(where[0].tolist())) if below[0] > -math.inf else None


def depths(system: RollingSystem, support: SupportState, centre: Vector, orientation: Any) -> tuple[Array, Array]:
    """Return the same for one or many, (n,) and (n, 3), of which each number is (n, 1); -inf where nothing is over it.

    Examples
    --------
    See `trundle.solve.walls`.
    """
    import numpy as np

    surface, turn = system.support.surface, orientation.matrix()

    def own(nu: Vector) -> Vector:
        return support.local(centre + turn @ system.body.shape.support_map(nu))

    with np.errstate(all="ignore"):
        ways = _directions(_DIRECTIONS if isinstance(centre.x, float) else _FEW)
        looked_at = own(ways)
        level = np.atleast_2d(np.asarray(surface.level(looked_at), dtype=float))
        level = np.where(np.isfinite(level) & _there(surface, looked_at), level, math.inf)
        at = _lowest(level, ways.array(), system.body.shape.support_map(ways).array())
        some = np.isfinite(np.take_along_axis(level, at, axis=1))
        where = Vector(*(np.take_along_axis(np.broadcast_to(part, level.shape), at, axis=1) for part in looked_at))
        found = np.where(some, _distance(surface, where), math.inf)
        for _ in range(_REFINED):  # towards the place where the body's normal is opposite to the surface's
            further = own(-(turn.transpose @ (support.rotation @ surface.normal(where))))
            nearer = np.where(_there(surface, further), _distance(surface, further), math.nan)
            better = nearer < found
            if not better.any():
                break
            where = Vector(*(np.where(better, new, old) for new, old in zip(further, where, strict=True)))
            found = np.where(better, nearer, found)
    deepest = np.argmin(found, axis=1)[:, None]
    places = [np.take_along_axis(part, deepest, axis=1) for part in where]
    return -np.take_along_axis(found, deepest, axis=1)[:, 0], np.hstack(places)


def _lowest(level: Array, normals: Array, places: Array) -> NDArray[np.int_]:
    """Return which points are lowest, each on another side or at another end of the body: the contact is one."""
    import numpy as np

    level, found = level.copy(), []
    sides = normals, places / np.maximum(np.linalg.norm(places, axis=1, keepdims=True), 1e-300)
    for _ in range(_SIDES):
        found.append(np.argmin(level, axis=1))
        alike = [side[found[-1]] @ side.T >= _ALIKE for side in sides]
        level[alike[0] & alike[1]] = math.inf
    return np.stack(found, axis=1)


def _there(surface: Surface, p: Vector) -> Any:
    """Tell whether points have the surface under them, before its rim or end."""
    there, left = p.x == p.x, surface.domain_margin(p)
    if surface.rim is not None:
        there = there & (p.x * p.x + p.y * p.y < float(surface.rim) ** 2)
    return there if left is None else there & (left > 0)


def _distance(surface: Surface, p: Vector) -> Any:
    """Return φ/|∇φ|, to first order the distance from the surface, m."""
    return -surface.step_onto(p).dot(surface.normal(p))


def _directions(count: int) -> Vector:
    """Return directions spread evenly over the sphere: Fibonacci's lattice."""
    import numpy as np

    i = np.arange(count) + 0.5
    z, angle = 1.0 - 2.0 * i / count, math.pi * (1.0 + math.sqrt(5.0)) * i
    r = np.sqrt(1.0 - z * z)
    return Vector(r * np.cos(angle), r * np.sin(angle), z)
