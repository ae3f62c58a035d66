"""What static friction and resistance to rolling can hold."""

from __future__ import annotations

from ...mechanics.algebra import Vector
from ...mechanics.contact import Contact
from ...mechanics.scalars import Scalar
from ...mechanics.system import RollingSystem

# By this share static friction and resistance hold more than they say, so that rounding does not decide.
CONE_SLACK = 1e-9


def left_of_resistance(system: RollingSystem, normal_force: Scalar, holding: Vector) -> Scalar:
    """Return what is left of resistance to rolling that holds a body: its most squared less the couple squared."""
    most = system.resistance * normal_force
    return most * most * (1 + CONE_SLACK) - holding.dot(holding)


def cone(
    system: RollingSystem, contact: Contact, reaction: Vector, N: Scalar, floor: Scalar = 0.0
) -> dict[str, Scalar]:
    """Return the normal force, and what is left of the friction cone where friction has a limit."""
    n = contact.normal
    found = {"lift": N + floor}
    if system.support.friction is not None:
        f, most = reaction - n * N, system.support.friction * (N + floor)
        found["slip"] = most * most * (1 + CONE_SLACK) - f.dot(f)
    return found
