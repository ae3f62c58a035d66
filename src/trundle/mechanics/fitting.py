"""Whether a body fits the surface it is put on: by the curvature at the contact, and by the rest of the body.

Two surfaces touch in one point and stay apart around it where 1 + C S has no eigenvalue at or below 0 on the tangent
plane (theory page, T1): the body bends more than the surface does towards it. Where the determinant falls to 0 the
rate of the contact is infinite, and the rolling law ends.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ..errors import InvalidValueError
from .algebra import Matrix, Vector
from .contact import Contact
from .overlap import check_clear
from .scalars import Scalar
from .surfaces import Surface

if TYPE_CHECKING:
    from .system import RollingSystem

EDGE = 1e-14  # of a shape's margin, which is a cosine or its square: below it only rounding says which side it is
LEAST_ROOM = 1e-12  # of the eigenvalues of 1 + C S
SHARPEST = 1e9  # bends in a body's size beyond which a surface is no longer smooth there


def fits(contact: Contact) -> Scalar:
    """Return det(1 + C S): positive where the body fits the curvature of the surface, 0 where the law ends.

    Examples
    --------
    A ball of 0.2 m in a bowl of 0.5 m fits by (1 − 0.2/0.5)²:

    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import Quaternion
    >>> from trundle.mechanics.contact import contact_at
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.2, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> round(fits(contact_at(system, 0.0, Vector(0.0, 0.0, 0.0), Quaternion(1.0, 0.0, 0.0, 0.0))), 12)
    0.36
    """
    # On n it is 1, because S n = 0 and C maps to the tangent plane; so all of it is the tangential part.
    return contact.relative_curvature_determinant()


def room(contact: Contact) -> tuple[float, Vector]:
    """Return the smaller eigenvalue of 1 + C S on the tangent plane, and its direction, in numbers.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import Quaternion
    >>> from trundle.mechanics.contact import contact_at
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.2, 1.0), tr.Support(tr.Cylinder(0.5)))
    >>> least, along = room(contact_at(system, 0.0, Vector(0.5, 0.0, 0.0), Quaternion(1.0, 0.0, 0.0, 0.0)))
    >>> round(least, 12), abs(round(along.y, 12))
    (0.6, 1.0)
    """
    import numpy as np

    n = contact.normal
    helper = Vector(1.0, 0.0, 0.0) if abs(n.x) < 0.6 else Vector(0.0, 1.0, 0.0)
    first = n.cross(helper)
    first = first / first.norm()
    second = n.cross(first)
    both = Matrix.identity() + contact.inverse_curvature.dense @ contact.shape_operator.dense
    tangential = np.array([[float(a.dot(both @ b)) for b in (first, second)] for a in (first, second)])
    values, ways = np.linalg.eig(tangential)  # C S is similar to the symmetric √C S √C: they are real
    least = int(np.argmin(values.real))
    u, v = ways[:, least].real
    along = first * float(u) + second * float(v)
    return float(values[least].real), along / along.norm()


def check_place(surface: Surface, u: float, v: float, received: Any, key: str = "position") -> None:
    """Refuse coordinates at which there is no surface, or none that is smooth.

    Examples
    --------
    >>> from trundle.mechanics.surfaces import Cone
    >>> check_place(Cone("45 deg"), 0.0, 0.0, (0, 0))
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `position` must be where the surface is smooth; got (0, 0). Its normal is not...
    """
    p = _finite(lambda: surface.point(u, v), "point")
    if isinstance(p, str):
        raise InvalidValueError(key, "must be on the surface", received, f"There is none: {p}.")
    for name, part in (("normal", surface.normal), ("curvature", surface.shape_operator), ("level", surface.level)):
        found = _finite(lambda part=part: part(p), name)
        if isinstance(found, str):
            remedy = f"Its {name} is not finite there: {found}."
            raise InvalidValueError(key, "must be where the surface is smooth", received, remedy)
    left = surface.domain_margin(p)
    if left is not None and not left > 0:
        raise InvalidValueError(
            key, "must be on the surface, where it is smooth", received, f"It is at or beyond {surface.domain_end}."
        )


def check_curvature(contact: Contact, received: Any, key: str = "position") -> None:
    """Refuse a contact where the body is too big for the curvature of the surface.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import Quaternion
    >>> from trundle.mechanics.contact import contact_at
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.6, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> check_curvature(contact_at(system, 0.0, Vector(0.0, 0.0, 0.0), Quaternion(1.0, 0.0, 0.0, 0.0)), (0, 0))
    Traceback (most recent call last):
    ...
    trundle.errors.InvalidValueError: `position` must be where the body fits the surface; got (0, 0). There the ...
    """
    for name, part in (("normal", contact.normal), ("curvature", contact.shape_operator.dense)):
        if not _all_finite(part):
            raise InvalidValueError(
                key, "must be where the surface is smooth", received, f"Its {name} is not finite there."
            )
    for name, own in (("contact", contact.offset), ("curvature", contact.inverse_curvature.dense)):
        if not _all_finite(own):
            remedy = f"Its {name} is not finite in this position: turn it a little."
            raise InvalidValueError("orientation", "must let the body touch in one point", received, remedy)
    if _size(contact.shape_operator.dense) * contact.offset.norm() > SHARPEST:
        remedy = "Its curvature grows beyond all bounds there: it has an edge or an apex."
        raise InvalidValueError(key, "must be where the surface is smooth", received, remedy)
    misfit = too_big(contact)
    if misfit:
        raise InvalidValueError(key, "must be where the body fits the surface", received, misfit)


def too_big(contact: Contact) -> str:
    """Say in a sentence why a body does not fit the curvature of the surface; empty where it fits.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import Quaternion
    >>> from trundle.mechanics.contact import contact_at
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.6, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> too_big(contact_at(system, 0.0, Vector(0.0, 0.0, 0.0), Quaternion(1.0, 0.0, 0.0, 0.0)))[:68]
    'There the body bends with a radius of 0.6 m, the surface with 0.5 m:'
    """
    if contact.flat:
        return ""
    least, along = room(contact)
    if least > LEAST_ROOM:
        return ""
    # Where they do not fit C t = (1 − least)/(−κ) t with κ the surface's curvature along the way, or nearly so.
    bend = float(along.dot(contact.shape_operator @ along))
    body = float(along.dot(contact.inverse_curvature @ along))
    theirs = f"with {_radius(-bend)}" if bend < 0 else "the other way"
    return (
        f"There the body bends with a radius of {body:.6g} m, the surface {theirs}: "
        "take a smaller body or a wider surface."
    )


def check_start(
    system: RollingSystem, contact: Contact, orientation: Any, received: Any, key: str = "position"
) -> None:
    """Refuse a start at which the body does not fit the surface: by its curvature, or by another part of it.

    Examples
    --------
    >>> import trundle as tr
    >>> from trundle.mechanics.algebra import Quaternion
    >>> from trundle.mechanics.contact import contact_at
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.2, 1.0), tr.Support(tr.Bowl(0.5)))
    >>> q = Quaternion(1.0, 0.0, 0.0, 0.0)
    >>> check_start(system, contact_at(system, 0.0, Vector(0.0, 0.0, 0.0), q), q, (0, 0))
    """
    check_curvature(contact, received, key)
    check_clear(system, contact, orientation, received, key)


def _radius(bend: float) -> str:
    return f"{1.0 / bend:.6g} m"


def _finite(part: Any, name: str) -> Any:
    """Return what a function gives, or a text that says why it is not finite."""
    import numpy as np

    try:
        with np.errstate(all="raise", under="ignore"):
            found = part()
    except ZeroDivisionError:
        return "something is divided by 0"
    except OverflowError:
        return "it is too large for a number"
    except (ArithmeticError, ValueError):
        return "a root or logarithm of a negative number" if name != "point" else "it is outside the formula's range"
    return found if _all_finite(found) else "it is no finite number"


def _all_finite(thing: Any) -> bool:
    return all(math.isfinite(part) for part in _parts(thing))


def _size(thing: Any) -> float:
    return max(abs(float(part)) for part in _parts(thing))


def _parts(thing: Any) -> list[Any]:
    if isinstance(thing, Matrix):
        return [part for row in thing.rows for part in row]
    return list(thing) if isinstance(thing, Vector) else [thing]
