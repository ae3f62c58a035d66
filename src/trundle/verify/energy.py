"""Whether nothing is lost: what the energy gained against the work that was done, over the whole run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..mechanics.algebra import Vector
from ..mechanics.loads import BodyMotion, Load
from ..mechanics.system import RollingSystem, State
from ..solve.samples import Samples
from .bounds import Array
from .card import CardFigure, checked


@dataclass(frozen=True)
class Work:
    """Work on the body, J, and the size of what it is a sum of."""

    friction: float  # of the contact force through the slip
    support: float  # of the contact force, and of couples, through the support's motion
    loads: float  # of loads without a potential, and of couples at the contact
    landings: float  # what impacts took
    size: float

    @property
    def total(self) -> float:
        """All of it."""
        return self.friction + self.support + self.loads + self.landings


def energy(system: RollingSystem, at: Samples) -> Array:
    """Return the kinetic energy and what potential energy there is, J, at each sample.

    Parameters
    ----------
    system : RollingSystem
        Gives inertia and loads.
    at : Samples
        Of the run.

    Returns
    -------
    array (n,)
        J.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane()), gravity=0.0)
    >>> run = tr.simulate(system, system.place(velocity=(1.0, 0.0)), 1.0, 1.0)
    >>> energy(system, run.samples).round(12).tolist()
    [1.4, 1.4]
    """
    motion = at.motion(system)
    V, Omega = motion.velocity, motion.angular_velocity
    J = system.body.inertia_in_space(motion.orientation.matrix())
    total = 0.5 * system.body.mass * V.dot(V) + 0.5 * Omega.dot(J @ Omega)
    for load in system.all_loads:
        if _keeps(load, motion):
            total = total + load.potential(motion)
    return np.broadcast_to(np.asarray(total, dtype=float), at.time.shape)


def _keeps(load: Load, motion: BodyMotion) -> bool:
    """Tell whether a load gives back what it takes: it has a potential."""
    return not load.at_contact and load.potential(motion) is not None


def work(system: RollingSystem, at: Samples, weights: Array, events: tuple[Any, ...]) -> Work:
    """Return the work on the body along a run.

    Parameters
    ----------
    system : RollingSystem
        What moved.
    at : Samples
        At the nodes of a quadrature that stops at every event.
    weights : array (n,)
        Of the nodes, s.
    events : tuple of Event
        Of the run: what struck changed the energy at once.

    Returns
    -------
    Work
        J.
    """
    motion = at.motion(system)
    acting = system.acting_on(motion)
    normal = Vector.of(at.normals(system)) if len(at.time) else Vector(0.0, 0.0, 0.0)
    R = Vector.of(at.contact_force)
    couple = acting.couple * R.dot(normal)
    V, carried, u = at.speeds(system)
    slip = V + carried - u
    done = R.dot(u)
    lost = R.dot(slip)
    given: Any = couple.dot(motion.angular_velocity)
    for load in system.all_loads:
        if not _keeps(load, motion):
            given = given + load.force(motion).dot(V) + load.torque(motion).dot(motion.angular_velocity)
    powers = [np.broadcast_to(np.asarray(power, dtype=float), at.time.shape) for power in (lost, done, given)]
    friction, moved, loads = (float(weights @ power) for power in powers)
    struck = sum(_energy_of(system, event.after) - _energy_of(system, event.before) for event in _striking(events))
    size = float(sum(weights @ np.abs(power) for power in powers)) + abs(struck)
    return Work(friction, moved, loads, float(struck), size)


def _striking(events: tuple[Any, ...]) -> list[Any]:
    return [event for event in events if event.before is not None and event.before != event.after]


def _energy_of(system: RollingSystem, state: State) -> float:
    row = np.array
    at = Samples(
        row([state.time]),
        row([state.position]),
        row([state.position]),
        row([state.velocity]),
        row([state.angular_velocity]),
        row([state.orientation]),
        np.zeros((1, 3)),
        own=row([state.support]),
    )
    return float(energy(system, at)[0])


def balance(
    system: RollingSystem, ends: Samples, at: Samples, weights: Array, events: tuple[Any, ...], bound: float
) -> Iterator[CardFigure]:
    """Compare what the energy gained over a run with the work done.

    Parameters
    ----------
    system : RollingSystem
        What moved.
    ends : Samples
        The two ends of the run.
    at, weights, events
        As for `work`.
    bound : float
        The share that may be left over.

    Yields
    ------
    CardFigure
        One, with the parts in its note.
    """
    first, last = energy(system, ends)[[0, -1]]
    done = work(system, at, weights, events)
    size = max(abs(first), abs(last), float(np.ptp(energy(system, at))), done.size, 1e-300)
    parts = {
        "friction": done.friction,
        "the support": done.support,
        "loads": done.loads,
        "landings": done.landings,
    }
    said = ", ".join(f"{name} {value:+.6g} J" for name, value in parts.items() if abs(value) > 1e-15 * size)
    note = f"energy {first:.6g} to {last:.6g} J; work of {said}" if said else f"energy stays at {first:.6g} J"
    yield checked("energy balance", abs(float(last - first) - done.total) / size, bound, note)
