"""The event functions of corners that loads have, beside those of a law."""

from __future__ import annotations

from collections.abc import Sequence

from ..mechanics.algebra import Vector
from ..mechanics.scalars import Scalar
from ..mechanics.system import RollingSystem
from .laws import CORNER, Law

_NUMBERS = 4  # of each corner: the direction that its vector has, and 1/W


def count(system: RollingSystem) -> int:
    """Return how many numbers the event functions of a system's corners take.

    Examples
    --------
    >>> import trundle as tr
    >>> count(tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()), loads=[tr.QuadraticDrag(0.1)]))
    4
    """
    return _NUMBERS * len(system.corners)


def vectors(system: RollingSystem, law: Law, time: Scalar, state: Sequence[Scalar]) -> list[Vector]:
    """Return what passes through zero at each corner."""
    if not system.corners:
        return []
    motion = law.motion(system, time, state)
    return [corner(motion) for corner in system.corners]


def all_event_functions(
    system: RollingSystem, law: Law, time: Scalar, state: Sequence[Scalar], given: Sequence[Scalar]
) -> dict[str, Scalar]:
    """Return what ends a stretch where it falls through zero: a law's event functions, and the corners of the loads.

    A vector w that had the direction ŵ passes close by zero where w·ŵ + w²/W falls through it, W being a small length:
    one that only turns about has no such instant.
    """
    split = len(given) - count(system)
    found = law.event_functions(system, time, state, given[:split])
    for i, w in enumerate(vectors(system, law, time, state)):
        x, y, z, inverse = given[split + _NUMBERS * i : split + _NUMBERS * (i + 1)]
        found[f"{CORNER} {i + 1}"] = w.dot(Vector(x, y, z)) + w.dot(w) * inverse
    return found
