"""Where a body is nearest to its support, found from its centre: the geometry of touch for a body that may fly."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..errors import SolverError
from .algebra import Quaternion, Vector
from .contact import Contact, contact_at
from .duals import has_duals, value_of, values_of
from .scalars import Scalar, namespace

if TYPE_CHECKING:
    from .surfaces import Surface
    from .system import RollingSystem, State

_MOST_STEPS = 60  # of Newton's method, which needs five
_CLOSE = 1e-9  # share of the lengths at hand to which it must have found the contact
_NEXT_TO = 1e-7  # share of these by which a known point may be off
_ROUNDING = 1e-15
_SINGULAR = 1e-6  # of det(1 + (C + g)S), at which a run ends
_LOOKS, _GUESSES = 600, 6  # for a better first guess, and how many of them are followed
_ALIKE = 0.9  # cosine of the angle between the normals of two that lead to the same


def nearest(
    system: RollingSystem,
    time: Scalar,
    point: Vector,
    centre: Vector,
    orientation: Quaternion,
    coordinates: tuple[Scalar, ...] = (),
) -> Contact:
    """Return the geometry at the support's point nearest to a body, from a point next to it, by one of Newton's steps.

    Examples
    --------
    >>> import trundle as tr
    >>> bowl = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> still, off = Quaternion(1.0, 0.0, 0.0, 0.0), Vector(1e-9, 0.0, 2e-9)
    >>> bool(nearest(bowl, 0.0, off, Vector(0.0, 0.0, 0.3), still).point.norm() < 1e-16)
    True
    """
    import numpy as np

    contact = contact_at(system, time, point, orientation, coordinates)
    with np.errstate(all="ignore"):  # by the end of a formula
        _, aside, down = beside(system, contact, centre)
        step = aside + down
        small = step.norm() <= _NEXT_TO * (point.norm() + contact.offset.norm())
    moved = Vector(*(_either(small, there + by, there) for there, by in zip(point, step, strict=True)))
    return contact_at(system, time, moved, orientation, coordinates)


def _either(condition: Any, yes: Scalar, no: Scalar) -> Scalar:
    if isinstance(condition, bool):
        return yes if condition else no
    return namespace(condition, yes, no).where(condition, yes, no)


def beside(
    system: RollingSystem, contact: Contact, centre: Vector, *, bent: bool = True
) -> tuple[Vector, Vector, Vector]:
    """Return how far the body's point is aside of the support's, and Newton's step along the support and off it."""
    n, support = contact.normal, contact.support
    apart = centre + contact.offset - contact.point
    gap = n.dot(apart)
    off = apart - n * gap
    down = support.rotation @ system.support.surface.step_onto(support.local(contact.point))
    # The normal leans by S along the support, and ρ follows it by C.
    return off, contact.relative_curvature(gap).solve(off) if bent and not contact.flat else off, down


def closest_contact(
    system: RollingSystem, time: float, centre: Vector, orientation: Quaternion, coordinates: tuple[Scalar, ...] = ()
) -> Contact:
    """Return the geometry of touch for a body whose centre of mass is known: the p nearest to the body.

    Where body and support touch, p = r + ρ(n(p)); where they do not, r + ρ is straight over p, by the gap.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Cylinder(0.5), tilt="90 deg"))
    >>> closest_contact(system, 0.0, Vector(0.4, 0.0, 0.0), Quaternion(1.0, 0.0, 0.0, 0.0)).point
    Vector(x=0.5, y=0.0, z=0.0)
    """
    given = system, time, centre, orientation, coordinates
    if has_duals(given):
        return _with_slopes(*given)
    # The normal at the centre is already that at the contact for a sphere over a surface of constant curvature.
    found = _newton(system, time, centre, centre, orientation, coordinates)
    if found is None or misplaced(system, found, centre, orientation) or _hollow_under(found, centre):
        found = _searched(system, time, centre, orientation, coordinates, found) or found
    if found is None or _is_beyond(system.support.surface, found.support.local(found.point)):
        raise SolverError(
            f"At t = {float(time):.9g} s no point of the surface is nearest to the body, whose centre is at "
            f"({', '.join(f'{float(part):.4g}' for part in centre)}) m. Does the surface reach there, and smoothly?"
        )
    return found


def contact_of(system: RollingSystem, start: State) -> Contact:
    """Return the geometry of touch of a state; a system keeps that of the last one that was asked about.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> contact_of(system, system.place((0.3, 0.0))).point
    Vector(x=0.3, y=0.0, z=0.0)
    """
    known: tuple[State, Contact] | None = system._known.get(contact_of)
    if known is None or known[0] is not start:
        place = start.time, Vector(*start.position), Quaternion(*start.orientation), start.support
        system._known[contact_of] = known = start, closest_contact(system, *place)
    return known[1]


def _with_slopes(
    system: RollingSystem, time: Scalar, centre: Vector, orientation: Quaternion, coordinates: tuple[Scalar, ...]
) -> Contact:
    """Return the contact in duals: found for their values, and its slopes by two more of Newton's steps.

    The first leads onto the surface, as it is with other numbers, and only the second has its normal there.
    """
    point = closest_contact(*values_of((system, time, centre, orientation, coordinates))).point
    for _ in range(2):
        contact = contact_at(system, time, point, orientation, coordinates)
        _, aside, down = beside(system, contact, centre)
        step = aside + down
        point = Vector(*(there + (by - value_of(by)) for there, by in zip(point, step, strict=True)))
    return contact_at(system, time, point, orientation, coordinates)


def misplaced(system: RollingSystem, contact: Contact, centre: Vector, orientation: Quaternion) -> str:
    """Say why a point straight under a body is not where it is nearest to the support; empty where it is.

    Examples
    --------
    A ball high over one side of a bowl is nearer to the other:

    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> still = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> contact = contact_at(system, 0.0, Vector(0.0, 0.0, 0.0), still)
    >>> misplaced(system, contact, Vector(0.0, 0.0, 0.3), still)
    ''
    >>> misplaced(system, contact, Vector(0.0, 0.0, 0.6), still)
    'There the support is so hollow, or the body so high over it, that other points of it are as near.'
    """
    if _is_beyond(system.support.surface, contact.support.local(contact.point)):
        return "There the support has ended."
    covered = system.body.shape.validity_margin(-(contact.normal @ orientation.matrix()))
    if covered is not None and not covered > 0:
        return "There the body has a flat side or an edge towards the support, which its shape does not cover."
    if contact.flat:
        return ""
    across = contact.relative_curvature(_gap(contact, centre))
    # Along n it is 1: the two others have the determinant as their product, and their sum is the trace less 1.
    around = sum(row[i] for i, row in enumerate(map(tuple, across.rows))) - 1.0
    if across.determinant > _SINGULAR and around > 0:
        return ""
    return "There the support is so hollow, or the body so high over it, that other points of it are as near."


def _is_beyond(surface: Surface, there: Vector) -> bool:
    """Tell whether a point is beyond the surface's end: a table's spline goes on there, the surface does not."""
    inside = surface.domain_margin(there)
    return inside is not None and bool(inside < 0)


def _newton(
    system: RollingSystem,
    time: float,
    centre: Vector,
    point: Vector,
    orientation: Quaternion,
    coordinates: tuple[Scalar, ...],
) -> Contact | None:
    """Return the contact to which Newton's method leads from a first guess at p; None where it leads nowhere."""
    try:
        contact, left = followed(system, time, centre, point, orientation, coordinates)
    except (ArithmeticError, ValueError):  # outside a formula, or where it has no slope
        return None
    return contact if left <= _CLOSE else None


def followed(
    system: RollingSystem,
    time: float,
    centre: Vector,
    point: Vector,
    orientation: Quaternion,
    coordinates: tuple[Scalar, ...],
) -> tuple[Contact, Scalar]:
    """Follow Newton's method from a first guess at p, of one body or of many: the contact, and its last step's share.

    Examples
    --------
    >>> import numpy as np
    >>> import trundle as tr
    >>> bowl = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> centre, still = Vector(np.array([0.0, 0.2]), 0.0, 0.2), Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> followed(bowl, 0.0, centre, centre, still, ())[0].point.x.round(12).tolist()
    [0.0, 0.277350098113]
    """
    import numpy as np

    last: Scalar = math.inf
    arrived: Any = False
    contact = contact_at(system, time, point, orientation, coordinates)
    for step in range(_MOST_STEPS):
        off, aside, down = beside(system, contact, centre, bent=step > 0)
        left = (off.norm() + down.norm()) / (point.norm() + contact.offset.norm())
        moved = aside + down
        # Who has arrived stays, however far the others have to go.
        point = point + (moved * (1.0 - arrived) if isinstance(arrived, np.ndarray) else moved)
        contact = contact_at(system, time, point, orientation, coordinates)
        if step > 0:  # what is left now is less by as much again; or it was rounding, or leads nowhere
            near = (left <= _CLOSE) & (left * left <= 0.1 * _ROUNDING * last)
            arrived = arrived | near | (left <= _ROUNDING) | (left != left)
        if arrived.all() if isinstance(arrived, np.ndarray) else arrived:
            break
        last = left
    return contact, left


def _gap(contact: Contact, centre: Vector) -> float:
    return float((centre + contact.offset - contact.point).dot(contact.normal))


def _hollow_under(contact: Contact, centre: Vector) -> bool:
    """Tell whether a body is over a support that bends up somehow, of which other points may be nearer."""
    S = contact.shape_operator
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = S.rows
    bends_up = xx + yy + zz < 0 or xx * yy + yy * zz + zz * xx < xy * xy + yz * yz + xz * xz
    return bends_up and _gap(contact, centre) > _CLOSE * contact.offset.norm()


def _searched(
    system: RollingSystem,
    time: float,
    centre: Vector,
    orientation: Quaternion,
    coordinates: tuple[Scalar, ...],
    known: Contact | None,
) -> Contact | None:
    """Return the nearest of the known contact and those to which Newton's method leads from other likely points."""
    try:
        guesses = _guesses(system, time, centre, orientation, coordinates)
    except (ArithmeticError, ValueError):  # outside a formula
        guesses = []
    led_to = (_newton(system, time, centre, point, orientation, coordinates) for point in guesses)
    found = [one for one in (known, *led_to) if one is not None and not misplaced(system, one, centre, orientation)]
    return min(found, key=lambda contact: abs(_gap(contact, centre)), default=None)


def _guesses(
    system: RollingSystem, time: float, centre: Vector, orientation: Quaternion, coordinates: tuple[Scalar, ...]
) -> list[Vector]:
    """Return r + ρ(n) for those n, of many all around, that are nearest to the surface's normal there."""
    import numpy as np

    support, surface = system.support.motion.at(time, *coordinates), system.support.surface
    i = np.arange(_LOOKS)
    z, angle = 1.0 - (2 * i + 1) / _LOOKS, math.pi * (1.0 + math.sqrt(5.0)) * (i + 0.5)  # Fibonacci's lattice
    across = np.sqrt(1.0 - z * z)
    n = support.rotation @ Vector(across * np.cos(angle), across * np.sin(angle), z)
    with np.errstate(all="ignore"):
        points = centre + system.body.shape.contact(orientation.matrix(), n)[0]
        there = support.local(points)
        off = np.linalg.norm((support.rotation @ surface.normal(there)).array() - n.array(), axis=-1)
        inside = surface.domain_margin(there)
        likely = np.isfinite(off) if inside is None else np.isfinite(off) & (np.asarray(inside) >= 0)
    normals, places = n.array(), points.array()
    kept: list[int] = []
    for which in np.argsort(off).tolist():
        if likely[which] and len(kept) < _GUESSES and (normals[kept] @ normals[which] < _ALIKE).all():
            kept.append(which)
    return [Vector(*places[which].tolist()) for which in kept]
