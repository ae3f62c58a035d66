"""First integrals, and which system has them (theory page, section 6): told from its symmetries, not from its name."""

from __future__ import annotations

from dataclasses import replace

from ..system import RollingSystem
from .base import FLIGHT, PHASES, ROLLING, SLIPPING, Invariant, Record
from .legendre import LEGENDRE_PAIR
from .momenta import (
    CONTACT_MOMENTUM,
    FREE_MOMENTUM,
    JELLETT,
    NORMAL_MOMENTUM,
    ROUTH,
    SPIN,
)
from .powers import ENERGY, ENERGY_WITH_TABLE, MOMENTUM_WITH_TABLE, MOVING_ENERGY
from .revolution import ROUTH_PAIR

INVARIANTS = (
    ENERGY,
    MOVING_ENERGY,
    ENERGY_WITH_TABLE,
    MOMENTUM_WITH_TABLE,
    SPIN,
    NORMAL_MOMENTUM,
    CONTACT_MOMENTUM,
    JELLETT,
    ROUTH,
    ROUTH_PAIR,
    LEGENDRE_PAIR,
    FREE_MOMENTUM,
)


def invariants_of(system: RollingSystem, phases: tuple[str, ...] = (ROLLING,)) -> tuple[Invariant, ...]:
    """Return the first integrals that a system has.

    Parameters
    ----------
    system : RollingSystem
        Any system.
    phases : tuple of str
        What the body does meanwhile, of "rolling", "slipping" and "flight": those are returned that all of these leave
        alone, each with all the phases that it survives.

    Returns
    -------
    tuple of Invariant
        Those that its symmetries give; a tilted turning table has neither energy nor moving energy.

    Examples
    --------
    >>> import trundle as tr
    >>> table = tr.Support(tr.Plane(), motion=tr.Spin(3.5), tilt=0.05)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.025, 0.065), table)
    >>> [integral.name for integral in invariants_of(system)]
    ['spin about the normal']
    >>> [integral.name for integral in invariants_of(system, phases=("flight",))]
    ['energy', 'spin about the normal', 'angular momentum about the centre of mass']
    """
    found = (replace(integral, phases=integral.survives(system)) for integral in INVARIANTS)
    return tuple(integral for integral in found if integral.phases and set(phases) <= set(integral.phases))


__all__ = ["FLIGHT", "INVARIANTS", "PHASES", "ROLLING", "SLIPPING", "Invariant", "Record", "invariants_of"]
