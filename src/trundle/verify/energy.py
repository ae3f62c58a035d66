"""Whether nothing is lost: what the energy gained against the work that was done, over the whole run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..mechanics.algebra import ZERO, Vector
from ..mechanics.invariants.powers import energies
from ..mechanics.loads import BodyMotion, Load
from ..mechanics.system import RollingSystem
from ..solve.samples import FLIGHT, Samples
from .acting import unturning
from .bounds import A_ROUNDING, SOLVER, Array, blur_of, largest, speed_of
from .card import CardFigure, checked
from .friction import holding

_NODES = 16  # of Gauss and Legendre in each panel
_PARTS = 4  # into which a panel is cut where its power is rough
_TAIL = 1e-2  # share of what may be left over that the quadrature may leave
_ROUNDING = 1e-14  # of a power, that no cutting makes smaller
_STIRRED = 1e-9  # share of the speeds at the contact, of which a body's own may be the small difference
_FEW, _LONGER = 64, 2.5  # panels that are rough, by jumps: they are cut for so many times as many passes
_MOST_ROUGH = 5000  # panels: so many at once are rough from rounding, which no cut makes less


def energy(system: RollingSystem, at: Samples) -> Array:
    """Return the kinetic energy and what potential energy there is, J, at each sample.

    Examples
    --------
    >>> import trundle as tr
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.1, 2.0), tr.Support(tr.Plane()), gravity=0.0)
    >>> run = tr.simulate(system, system.place(velocity=(1.0, 0.0)), 1.0, 1.0)
    >>> energy(system, run.samples).round(12).tolist()
    [1.4, 1.4]
    """
    return np.asarray(_energies(system, at).sum(axis=0))


def _energies(system: RollingSystem, at: Samples) -> Array:
    """Return the kinetic energy and each potential energy (kinds, n): their sum may be the small difference of two."""
    parts = energies(system, at.motion(system))
    return np.stack([np.broadcast_to(np.asarray(part, dtype=float), at.time.shape) for part in parts])


def _keeps(load: Load, motion: BodyMotion) -> bool:
    """Tell whether a load gives back what it takes: it has a potential."""
    return not load.at_contact and load.potential(motion) is not None


def powers(system: RollingSystem, at: Samples) -> Array:
    """Return the power of friction, of the support and of loads without a potential, and how large they may be, W."""
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
        given = given + (system.acting_on(motion, held=True).couple * R.dot(motion.normal)).dot(Omega)
        given = given + _of_resistance(system, at)
    most = R.norm() * (V.norm() + carried.norm() + u.norm())  # what rounding is a share of
    both = (R.dot(V + carried - u), R.dot(u), given, most)
    return np.stack([np.broadcast_to(np.asarray(power, dtype=float), at.time.shape) for power in both])


def _of_resistance(system: RollingSystem, at: Samples) -> Array:
    """Return the power of resistance to rolling, W: against the turning, or the couple that holds a body from it."""
    if not system.resisted:
        return np.zeros(at.time.size)
    motion, held = at.motion(system), unturning(system, at)
    N, lever = (at.contact_force * at.normals(system)).sum(axis=1), ZERO
    for load in system.loads:
        lever = lever + load.torque_per_normal_force(motion) if load.stops else lever
    couple = np.broadcast_to((lever * N).array(), at.position.shape).copy()
    if held.any():
        couple[held] = holding(system, at.part(held))[0]
    return np.asarray((couple * at.angular_velocity).sum(axis=1))


@dataclass(frozen=True)
class _Account:
    """What came of panels, each of them followed once: gains of energy, works of three kinds, and how large they were.

    A second look follows another run, which after many bounces is another motion: nothing is compared across looks.
    """

    gained: Array  # (panels,) J
    works: Array  # (3, panels)
    tails: Array  # (panels,) J, that a polynomial does not follow
    sizes: Array  # (panels,) J
    most: float  # of a part of the energy, J
    blur: float  # of the energy at a panel's ends, by rounding of ρ, from which V and the centre's place are made, J

    @staticmethod
    def of(system: RollingSystem, panels: Array, follow: Callable[[Array], Samples]) -> _Account:
        x, w = np.polynomial.legendre.leggauss(_NODES)
        terms = np.polynomial.legendre.legvander(x, _NODES - 1) * w[:, None] * (np.arange(_NODES) + 0.5)
        tops = terms[:, -2:]  # the last coefficients of each panel's polynomial
        to_ends = terms @ np.polynomial.legendre.legvander(np.array([-1.0, 1.0]), _NODES - 1).T
        half = 0.5 * np.diff(panels)
        times = np.hstack([panels[:, :1], panels[:, :1] + half * (1 + x), panels[:, 1:]])
        order = np.argsort(times, axis=None, kind="stable")
        there = follow(times.ravel()[order]).part(np.argsort(order))
        parts = _energies(system, there)
        E = parts.sum(axis=0).reshape(times.shape)
        each = powers(system, there).reshape(4, *times.shape)
        values, size = each[:3, :, 1:-1], each[3, :, 1:-1]
        # A power that jumps between an end and the node that is nearest to it shows at the end alone.
        beyond = np.abs(values @ to_ends - each[:3][:, :, [0, -1]]) * (1 - x[-1])
        tails = np.maximum(np.abs(values @ tops), beyond).max(axis=(0, 2)) * half[:, 0]
        works = (values @ w) * half[:, 0]
        ends = there.part(np.arange(times.size).reshape(times.shape)[:, [0, -1]].ravel())
        pulled = np.broadcast_to(system.loads_on(ends.motion(system))[0].array(), ends.position.shape)
        moved = float(system.body.mass) * largest(ends.velocity) * largest(ends.angular_velocity) + largest(pulled)
        blur = moved * blur_of(system, ends)
        return _Account(E[:, -1] - E[:, 0], works, tails, (size @ w) * half[:, 0], float(np.abs(parts).max()), blur)


def balance(
    system: RollingSystem,
    ends: Samples,
    panels: Array,
    follow: Callable[[Array], Samples],
    landings: Sequence[tuple[float, float]],
    bound: float,
    passes: int = 8,
) -> CardFigure:
    """Compare what the energy gained over a run with the work done."""
    first, last = energy(system, ends)[[0, -1]]
    struck = float(sum(work for _, work in landings))
    left, total, size = float(sum(gained - work for gained, work in landings)), np.zeros(3), 0.0
    most = max(abs(first), abs(last), abs(struck), (_STIRRED * speed_of(system, ends)) ** 2 * float(system.body.mass))
    allowed = np.full(len(panels), 1.0 / len(panels))  # each panel's share of what may be left over
    unknown, blur = 0.0, 0.0
    longest = int(_LONGER * passes)
    for done in range(1, longest + 1):
        found = _Account.of(system, panels, follow)
        most, blur = max(most, found.most), max(blur, found.blur)
        limit = _TAIL * bound * max(most, size + float(found.sizes.sum()), 1e-300)
        rough = found.tails > np.maximum(allowed * limit, _ROUNDING * found.sizes)
        most_now = _FEW if done >= passes else _MOST_ROUGH
        if done == longest or rough.sum() > most_now:
            unknown, rough = float(found.tails[rough].sum()), np.zeros_like(rough)
        left += float((found.gained - found.works.sum(axis=0))[~rough].sum())
        total, size = total + found.works[:, ~rough].sum(axis=1), size + float(found.sizes[~rough].sum())
        if not rough.any():
            break
        edges = panels[rough, :1] + np.diff(panels[rough]) * np.linspace(0.0, 1.0, _PARTS + 1)
        panels = np.stack([edges[:, :-1].ravel(), edges[:, 1:].ravel()], axis=1)
        allowed = np.repeat(allowed[rough] / _PARTS, _PARTS)
    size = max(most, size, 1e-300)
    friction, support, loads = total
    parts = {"friction": friction, "the support": support, "loads": loads, "impacts": struck}
    said = ", ".join(f"{name} {value:+.6g} J" for name, value in parts.items() if abs(value) > 1e-15 * size)
    note = f"energy {first:.6g} to {last:.6g} J; work of {said}" if said else f"energy stays at {first:.6g} J"
    blur *= max(1.0, bound / SOLVER / A_ROUNDING)  # a step leaves no less of the orientation than its tolerance
    return checked("energy balance", abs(left) / size, bound + (unknown + blur) / size, note)
