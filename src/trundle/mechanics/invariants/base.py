"""What a first integral is: when it holds, through what, and its value."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..algebra import Vector
from ..loads import BodyMotion
from ..records import frozen_record
from ..scalars import Scalar
from ..system import RollingSystem

ROLLING, SLIPPING, FLIGHT = PHASES = ("rolling", "slipping", "flight")


@frozen_record()
class Record:
    """A body's motion and contact at one instant, or at many with arrays as components."""

    motion: BodyMotion
    contact: Vector  # p, m
    support_coordinates: tuple[Scalar, ...] = ()  # coordinates of the support's motion, as its `coordinates` names them

    @property
    def offset(self) -> Vector:
        """ρ = p − r, m."""
        return self.contact - self.motion.position


@dataclass(frozen=True)
class Invariant:
    """A first integral: when it holds, its value, and the size against which its drift is small or not.

    Examples
    --------
    >>> from trundle.mechanics.invariants import INVARIANTS
    >>> [integral.name for integral in INVARIANTS][:3]
    ['energy', 'moving energy', 'energy with the table']
    """

    name: str
    formula: str
    unit: str
    survives: Callable[[RollingSystem], tuple[str, ...]]  # the phases in which a system has it; none: it has it not
    terms: Callable[[RollingSystem, Record], list[Any]]  # their sum is constant; scalars, vectors or arrays
    through_changes: bool = False  # whether landings and other impulses at the contact leave it alone, too
    phases: tuple[str, ...] = ()  # those of the system that it was found for
    size: Callable[[RollingSystem, Record], Scalar] | None = (
        None  # of what it is made of, where all its terms may vanish
    )

    def holds(self, system: RollingSystem) -> bool:
        """Tell whether a system that rolls has it."""
        return ROLLING in self.survives(system)

    def sized_terms(self, system: RollingSystem, at: Record) -> tuple[list[Any], list[Any]]:
        """Return its terms, and all whose size its drift is small beside, or not."""
        terms = self.terms(system, at)
        return terms, [*terms, self.size(system, at)] if terms and self.size is not None else terms


def products(one: Vector, other: Vector) -> list[Scalar]:
    """Return the three terms of a scalar product, which say how large it would be did they not cancel.

    Examples
    --------
    >>> products(Vector(1.0, 2.0, 3.0), Vector(4.0, 5.0, 6.0))
    [4.0, 10.0, 18.0]
    """
    return [a * b for a, b in zip(one, other, strict=True)]
