"""Whether nothing is lost: what the energy gained against the work that was done, over the whole run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ..mechanics.algebra import Vector
from ..mechanics.loads import BodyMotion, Load
from ..mechanics.system import RollingSystem
from ..solve.samples import FLIGHT, Samples
from .bounds import Array
from .card import CardFigure, checked

_NODES = 16  # of Gauss and Legendre in each panel
_PARTS = 4  # into which a panel is cut where its power is rough
_MOST_PASSES = 8
_MOST_ROUGH = 5000  # panels: so many at once are rough from rounding, which no cut makes less


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


def powers(system: RollingSystem, at: Samples) -> Array:
    """Return the power of friction, of the support and of loads without a potential, and how large they may be, W.

    Parameters
    ----------
    system : RollingSystem
        What moves.
    at : Samples
        Of the run.

    Returns
    -------
    array (4, n)
        R·s, R·u, and the rest; couples at the contact belong to the loads. The last is |R| times the speeds.
    """
    found = np.zeros((4, at.time.size))
    flies = at.phase == FLIGHT
    for which in (np.flatnonzero(flies), np.flatnonzero(~flies)):  # at the contact nothing acts in flight
        if which.size:
            found[:, which] = _powers(system, at.part(which))
    return found


def _powers(system: RollingSystem, at: Samples) -> Array:
    motion = at.motion(system)
    R, Omega = Vector.of(at.contact_force), motion.angular_velocity
    V, carried, u = at.speeds(system)
    given: Any = 0.0
    for load in system.all_loads:
        if not _keeps(load, motion):
            given = given + load.force(motion).dot(V) + load.torque(motion).dot(Omega)
    if motion.normal is not None:
        given = given + (system.acting_on(motion).couple * R.dot(motion.normal)).dot(Omega)
    largest = R.norm() * (V.norm() + carried.norm() + u.norm())  # what rounding is a share of
    both = (R.dot(V + carried - u), R.dot(u), given, largest)
    return np.stack([np.broadcast_to(np.asarray(power, dtype=float), at.time.shape) for power in both])


def _integrals(system: RollingSystem, panels: Array, follow: Callable[[Array], Samples]) -> tuple[Array, float]:
    """Return the work of each kind (3,) and its size, J; panels are cut until a polynomial follows the powers."""
    x, w = np.polynomial.legendre.leggauss(_NODES)
    tops = np.polynomial.legendre.legvander(x, _NODES - 1)[:, -2:] * w[:, None] * (_NODES - 1)
    total, size = np.zeros(3), 0.0
    for last in [False] * _MOST_PASSES + [True]:
        half = 0.5 * np.diff(panels)
        times = panels[:, :1] + half * (1 + x)
        *values, largest = powers(system, follow(times.ravel())).reshape(4, *times.shape)
        parts, sizes = (np.array(values) @ w) * half[:, 0], (largest @ w) * half[:, 0]
        tails = np.abs(np.array(values) @ tops).max(axis=(0, 2)) * half[:, 0]
        rough = (tails > 1e-15 * max(size + float(sizes.sum()), 1e-300)) & (not last)
        rough &= rough.sum() <= _MOST_ROUGH
        total, size = total + parts[:, ~rough].sum(axis=1), size + float(sizes[~rough].sum())
        if not rough.any():
            break
        edges = panels[rough, :1] + np.diff(panels[rough]) * np.linspace(0.0, 1.0, _PARTS + 1)
        panels = np.stack([edges[:, :-1].ravel(), edges[:, 1:].ravel()], axis=1)
    return total, size


def balance(
    system: RollingSystem,
    ends: Samples,
    panels: Array,
    follow: Callable[[Array], Samples],
    struck: float,
    bound: float,
) -> CardFigure:
    """Compare what the energy gained over a run with the work done.

    Parameters
    ----------
    system : RollingSystem
        What moved.
    ends : Samples
        The two ends of the run.
    panels : array (n, 2)
        Beginning and end of the panels of a quadrature, none of them across an event, s.
    follow : callable
        Takes ascending instants, returns the run's samples there.
    struck : float
        The work of the impulses at its landings, J.
    bound : float
        The share that may be left over.

    Returns
    -------
    CardFigure
        With the parts in its note.
    """
    first, last = energy(system, ends)[[0, -1]]
    (friction, support, loads), size = _integrals(system, panels, follow)
    size = max(abs(first), abs(last), abs(struck), size, 1e-300)
    parts = {"friction": friction, "the support": support, "loads": loads, "landings": struck}
    said = ", ".join(f"{name} {value:+.6g} J" for name, value in parts.items() if abs(value) > 1e-15 * size)
    note = f"energy {first:.6g} to {last:.6g} J; work of {said}" if said else f"energy stays at {first:.6g} J"
    left = float(last - first) - float(friction + support + loads + struck)
    return checked("energy balance", abs(left) / size, bound, note)
