"""Where a body is nearest to its support, found from its centre: the geometry of touch for a body that may fly."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ..errors import SolverError
from .algebra import Quaternion, Vector
from .contact import Contact, contact_at
from .duals import has_duals, value_of, values_of
from .scalars import Scalar, namespace

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from .surfaces import Surface
    from .system import RollingSystem, State

    Array = NDArray[np.float64]

_MOST_STEPS, _MOST_NEAR = 60, 20  # of Newton's method, which needs five: from afar, and from near by
_CLOSE = 1e-9  # share of the lengths at hand to which it must have found the contact
_NEXT_TO = 1e-7  # share of these by which a known point may be off
_ROUNDING, _ALL_BUT = 1e-15, 1e-12  # the second: share by which two gaps are one
_SINGULAR = 1e-6  # of det(1 + (C + g)S), at which a run ends
_LOOKS, _GUESSES = 300, 6  # for a better first guess, and how many of them are followed
_CLOSELY, _CLOSER_GUESSES = 0.93, 5  # cosine of the angle about the nearest one up to which one looks again
_STRIDES, _ROUGHLY = 12, 0.01  # of a look, and share of the lengths at hand to which it must then be there
# Cosine of the angle between the normals of two that lead to the same, and where one looks closely
_ALIKE, _CLOSELY_ALIKE = 0.9, 0.999
_AT_ONCE = 64  # bodies, of which one search takes twice 300 looks each


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
        try:
            _, aside, down = beside(system, contact, centre)
        except ZeroDivisionError:  # from a focal point many are as near
            return contact
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
    if found is None or misplaced(system, found, centre, orientation) or _unsure(system, found, centre):
        import numpy as np

        known = np.full((1, 3), np.nan) if found is None else np.array([tuple(found.point)])
        place = np.array([time]), np.array([tuple(centre)]), np.array([tuple(orientation)])
        point = _searched(system, *place, coordinates, known)[0].tolist()
        if not math.isnan(point[0]):
            found = contact_at(system, time, Vector(*point), orientation, coordinates)
    if found is None or _is_beyond(system.support.surface, found.support.local(found.point)):
        raise _nowhere_nearest(float(time), centre)
    return found


def closest_contacts(system: RollingSystem, time: Array, centre: Array, orientation: Array) -> Contact:
    """Return the same for many at once: at times (n,) with centres (n, 3) and unit quaternions (n, 4).

    Examples
    --------
    >>> import numpy as np
    >>> import trundle as tr
    >>> bowl = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> centre, still = np.array([[0.0, 0.0, 0.2], [0.2, 0.0, 0.2]]), np.tile([1.0, 0.0, 0.0, 0.0], (2, 1))
    >>> closest_contacts(bowl, np.zeros(2), centre, still).point.x.round(12).tolist()
    [0.0, 0.277350098113]
    """
    import numpy as np

    r, q = Vector.of(centre), Quaternion.of(orientation)
    with np.errstate(all="ignore"):  # outside a formula
        contact, left = followed(system, time, r, r, q, ())
        wrong = _not(left <= _CLOSE) | _unsure(system, contact, r)
        for mask, _ in _misplacements(system, contact, r, q):
            wrong = wrong | mask
    points, unsure = contact.point.array(), np.flatnonzero(np.broadcast_to(wrong, time.shape))
    points[~(left <= _CLOSE)] = np.nan
    for rows in np.array_split(unsure, math.ceil(unsure.size / _AT_ONCE)) if unsure.size else ():
        found = _searched(system, time[rows], centre[rows], orientation[rows], (), points[rows])
        points[rows] = np.where(np.isnan(found), points[rows], found)
    contact = contact_at(system, time, Vector.of(points), q)
    inside = system.support.surface.domain_margin(contact.support.local(contact.point))
    lost = np.isnan(points).any(axis=1) if inside is None else ~(np.asarray(inside) >= 0)
    if lost.any():
        first = int(np.argmax(np.broadcast_to(lost, time.shape)))
        raise _nowhere_nearest(float(time[first]), Vector(*centre[first]))
    return contact


def _nowhere_nearest(time: float, centre: Vector) -> SolverError:
    return SolverError(
        f"At t = {time:.9g} s no point of the surface is nearest to the body, whose centre is at "
        f"({', '.join(f'{float(part):.4g}' for part in centre)}) m. Does the surface reach there, and smoothly?"
    )


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
    return next((words for mask, words in _misplacements(system, contact, centre, orientation) if mask), "")


def _misplacements(
    system: RollingSystem, contact: Contact, centre: Vector, orientation: Quaternion
) -> Iterator[tuple[Any, str]]:
    """Tell what there may be against a point that is straight under a body, or under each of many; with the reason."""
    yield _is_beyond(system.support.surface, contact.support.local(contact.point)), "There the support has ended."
    covered = system.body.shape.validity_margin(-(contact.normal @ orientation.matrix()))
    if covered is not None:
        yield (
            _not(covered > 0),
            "There the body has a flat side or an edge towards the support, which its shape does not cover.",
        )
    if contact.flat:
        return
    across = contact.relative_curvature(_gap(contact, centre))
    # Along n it is 1: the two others have the determinant as their product, and their sum is the trace less 1.
    around = sum(row[i] for i, row in enumerate(map(tuple, across.rows))) - 1.0
    yield (
        _not((across.determinant > _SINGULAR) & (around > 0)),
        "There the support is so hollow, or the body so high over it, that other points of it are as near.",
    )


def _not(condition: Any) -> Any:
    return condition ^ True  # of one bool, or of each


def _is_beyond(surface: Surface, there: Vector) -> Any:
    """Tell whether a point is beyond the surface's end: a table's spline goes on there, the surface does not."""
    inside = surface.domain_margin(there)
    return False if inside is None else inside < 0


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
    time: Scalar,
    centre: Vector,
    point: Vector,
    orientation: Quaternion,
    coordinates: tuple[Scalar, ...],
    *,
    near: bool = False,
) -> tuple[Contact, Scalar]:
    """Follow Newton's method from a first guess at p, of one body or of many: the contact, and its last step's share.

    A guess that is near takes the bending there into account from the first step on.

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
    for step in range(_MOST_NEAR if near else _MOST_STEPS):
        off, aside, down = beside(system, contact, centre, bent=near or step > 0)
        left = (off.norm() + down.norm()) / (point.norm() + contact.offset.norm())
        moved = aside + down
        # Who has arrived stays, however far the others have to go.
        point = point + (moved * (1.0 - arrived) if isinstance(arrived, np.ndarray) else moved)
        contact = contact_at(system, time, point, orientation, coordinates)
        if step > 0:  # what is left now is less by as much again; or it was rounding, or leads nowhere
            small = (left <= _CLOSE) & (left * left <= 0.1 * _ROUNDING * last)
            arrived = arrived | small | (left <= _ROUNDING) | (left != left)
        if arrived.all() if isinstance(arrived, np.ndarray) else arrived:
            break
        last = left
    return contact, left


def _gap(contact: Contact, centre: Vector) -> Scalar:
    return (centre + contact.offset - contact.point).dot(contact.normal)


def _unsure(system: RollingSystem, contact: Contact, centre: Vector) -> Any:
    """Tell whether other points may be nearer to a body in flight: not if it is outside something convex."""
    free = system.support.surface.free_radius
    if free is not None and math.isinf(free):
        return False
    return _gap(contact, centre) > _CLOSE * contact.offset.norm()


def _searched(
    system: RollingSystem,
    time: Array,
    centre: Array,
    orientation: Array,
    coordinates: tuple[Scalar, ...],
    known: Array,
) -> Array:
    """Return the nearest of the known points (n, 3) and those to which Newton's method leads from other likely ones.

    Each is one body's. NaN stands for a point that is not known, or for none that was found.
    """
    import numpy as np

    def each(array: Array, times: int) -> Array:
        return np.repeat(array, times, axis=0)

    with np.errstate(all="ignore"):  # outside a formula
        likely = _likely(system, time, centre, orientation, coordinates)
        first = np.concatenate([known[:, None], likely], axis=1)
        count = first.shape[1]
        r, q = Vector.of(each(centre, count)), Quaternion.of(each(orientation, count))
        contact, left = followed(
            system, each(time, count), r, Vector.of(first.reshape(-1, 3)), q, coordinates, near=True
        )
        gap = np.where(left <= _CLOSE, np.abs(_gap(contact, r)), np.inf)
        for wrong, _ in _misplacements(system, contact, r, q):
            gap = np.where(wrong | np.isnan(gap), np.inf, gap)
    gap, rows = gap.reshape(-1, count), np.arange(time.size)
    # Of those that are one but for rounding, the first: then one comes back to what was known, to the last digit.
    best = np.argmax(gap <= gap.min(axis=1, keepdims=True) * (1 + _ALL_BUT), axis=1)
    found = contact.point.array().reshape(-1, count, 3)[rows, best]
    return np.where(np.isfinite(gap[rows, best])[:, None], found, np.nan)


def _likely(
    system: RollingSystem, time: Array, centre: Array, orientation: Array, coordinates: tuple[Scalar, ...]
) -> Array:
    """Return points (n, 11, 3) of the support that are not far straight away from a body, each another way.

    One looks all around, and then more closely about the way on which it is nearest: from high over waves one sees few
    of them.
    """
    import numpy as np

    given = system, time, centre, orientation, coordinates
    around = np.broadcast_to(_lattice(_LOOKS, -1.0), (time.size, _LOOKS, 3))
    points, far = _seen(*given, around)
    closely = _about(around[np.arange(time.size), np.argmin(far, axis=1)], _lattice(_LOOKS, _CLOSELY))
    first = _first(_GUESSES, around, points, far, _ALIKE)
    return np.concatenate([first, _first(_CLOSER_GUESSES, closely, *_seen(*given, closely), _CLOSELY_ALIKE)], axis=1)


def _seen(
    system: RollingSystem,
    time: Array,
    centre: Array,
    orientation: Array,
    coordinates: tuple[Scalar, ...],
    ways: Array,
) -> tuple[Array, Array]:
    """Return the points (n, looks, 3) seen from each body on its ways, the normals there, and how far they are."""
    import numpy as np

    looks, n = ways.shape[1], Vector.of(ways.reshape(-1, 3))
    time, centre, orientation = (np.repeat(array, looks, axis=0) for array in (time, centre, orientation))
    support = system.support.motion.at(time, *coordinates)
    rho = system.body.shape.contact(Quaternion.of(orientation).matrix(), support.rotation @ n)[0]
    reached, far = _reached(system.support.surface, support.local(Vector.of(centre) + rho), n, rho.norm())
    return support.carried(reached).array().reshape(ways.shape), far.reshape(ways.shape[:2])


def _first(count: int, ways: Array, points: Array, far: Array, alike: float) -> Array:
    """Return the first of the points seen (n, count, 3), by how far they are, of ways that are not alike."""
    import numpy as np

    rows, kept = np.arange(far.shape[0]), []
    for _ in range(count):
        best = np.argmin(far, axis=1)
        kept.append(np.where(np.isfinite(far[rows, best])[:, None], points[rows, best], np.nan))
        far = np.where(np.einsum("ni,nki->nk", ways[rows, best], ways) >= alike, np.inf, far)
    return np.stack(kept, axis=1)


def _lattice(count: int, least: float) -> Array:
    """Return so many ways (count, 3), spread evenly over those whose z is `least` at least: Fibonacci's lattice."""
    import numpy as np

    i = np.arange(count) + 0.5
    z, angle = 1.0 - (1.0 - least) * i / count, math.pi * (1.0 + math.sqrt(5.0)) * i
    across = np.sqrt(1.0 - z * z)
    return np.column_stack([across * np.cos(angle), across * np.sin(angle), z])


def _about(way: Array, ways: Array) -> Array:
    """Return ways (n, count, 3) that lie about each of some (n, 3) as given ones lie about z."""
    import numpy as np

    first = np.cross(way, np.eye(3)[np.argmin(np.abs(way), axis=1)])
    first /= np.linalg.norm(first, axis=1)[:, None]
    axes = np.stack([first, np.cross(way, first), way], axis=1)
    return np.einsum("kj,nji->nki", ways, axes)


def _reached(surface: Surface, there: Vector, n: Vector, size: Scalar) -> tuple[Vector, Array]:
    """Return where −n leads from points to the surface, about, and how far that is: infinite where it does not."""
    import numpy as np

    far: Scalar = 0.0
    for _ in range(_STRIDES):  # by as much as it is to the surface: all of the way where it ends upright
        stride = -surface.step_onto(there).dot(surface.normal(there))
        far, there = far + stride, there - n * stride
    leads = (np.abs(stride) <= _ROUGHLY * (size + np.abs(far))) & (surface.normal(there).dot(n) > 0)
    inside = surface.domain_margin(there)
    leads = leads if inside is None else leads & (np.asarray(inside) >= 0)
    return there, np.where(leads, np.abs(far), np.inf)
