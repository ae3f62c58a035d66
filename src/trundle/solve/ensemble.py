"""Many members of one system at once: heyoka's Taylor integrator with eight of them in each vector register.

Members share the structure of the system; their numbers and their starts are their own, and so is every step size, so
that what a member gives does not depend on its company.
"""

from __future__ import annotations

import copy
import os
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.contact import Contact, contact_at
from ..mechanics.nearest import beside
from ..mechanics.parameters import numbers, with_numbers
from ..mechanics.placing import SLIP_TOLERANCE
from ..mechanics.system import RollingSystem, State
from . import integrators, taylor
from .laws import Law, RollingLaw
from .lowering import Lowered
from .samples import AT_ONCE, Array, Samples

LANES = 8  # doubles in the widest registers; where they are half as wide, two at a time still gain
_MOST_CHUNKS = 10
_MOST_STEPS = 30  # of Newton's method
_PRESSED = 1e-9  # share of the weight with which a member must press on to be taken along


@dataclass(frozen=True)
class Block:
    """What one register's worth of members did, or a part of it.

    Parameters
    ----------
    members : array (k,)
        Which they are.
    rows : slice
        The instants that this is about.
    samples : Samples
        Of all at the first instant, then of all at the second, and so on.
    system : RollingSystem
        Its numbers are arrays as long as the samples where members differ.
    """

    members: Array
    rows: slice
    samples: Samples
    system: RollingSystem


def together(systems: Sequence[RollingSystem], repeat: int = 1) -> RollingSystem:
    """Return one system whose numbers are arrays over members, or plain numbers where all agree.

    Examples
    --------
    >>> import trundle as tr
    >>> balls = [tr.RollingSystem(tr.Body.solid_sphere(a, 1.0), tr.Support(tr.Plane())) for a in (0.1, 0.2)]
    >>> together(balls, 2).body.shape.radius.tolist(), together(balls).body.mass
    ([0.1, 0.2, 0.1, 0.2], 1.0)
    """
    values = np.array([numbers(system) for system in systems]).T
    columns = [float(row[0]) if (row == row[0]).all() else np.tile(row, repeat) for row in values]
    return with_numbers(systems[0], columns)


def rolling_from(systems: Sequence[RollingSystem], starts: Sequence[State]) -> tuple[Array, Any]:
    """Return the numbers (p, q, Ω, ...) of every start, and which of them plainly roll.

    Parameters
    ----------
    systems : sequence of RollingSystem
        Of one structure.
    starts : sequence of State
        At one time.

    Returns
    -------
    states : array (members, size)
        As `RollingLaw` takes them.
    rolls : array (members,) of bool
        Whether a start touches, does not slip, and is held by its support with something to spare. What else it may
        be is the scalar engine's to find out.
    """
    system, time = together(systems), starts[0].time
    r, V, Omega, q, coordinates = (
        np.array([getattr(start, name) for start in starts], dtype=float)
        for name in ("position", "velocity", "angular_velocity", "orientation", "support")
    )
    with np.errstate(all="ignore"):  # a start far from the support converges to nothing, and is left out
        contact = _settled(system, time, Vector.of(r), Quaternion.of(q), tuple(coordinates.T))
        states = np.column_stack([contact.point.array(), q, Omega, coordinates])
        arm = contact.offset.norm()
        touches = (contact.centre - Vector.of(r)).norm() <= SLIP_TOLERANCE * arm
        v, turning = Vector.of(V), Vector.of(Omega)
        u = contact.support.material_velocity(contact.point)
        speed = np.maximum(np.maximum(v.norm(), turning.norm() * arm), _norm(u))
        grips = contact.slip_velocity(v, turning).norm() <= SLIP_TOLERANCE * speed
        held = _held(system, time, states)
    return states, np.broadcast_to(touches & grips & held, (len(starts),)).copy()


def _norm(v: Vector) -> Any:
    return np.sqrt(np.asarray(v.dot(v), dtype=float))


def _settled(system: RollingSystem, time: float, r: Vector, q: Quaternion, coordinates: tuple[Any, ...]) -> Contact:
    """Return the contacts nearest to many bodies: `mechanics.nearest.settle` on arrays."""
    point = r
    contact = contact_at(system, time, point, q, coordinates)
    for step in range(_MOST_STEPS):
        off, aside, down = beside(system, contact, r, bent=step > 0)
        moved = _norm(off) + _norm(down)
        going = 1.0 if step == 0 else np.where(moved > 1e-15 * (point.norm() + contact.offset.norm()), 1.0, 0.0)
        if not np.any(going):
            break
        point = point + (aside + down) * going  # who has arrived stays, however far the others have to go
        contact = contact_at(system, time, point, q, coordinates)
    return contact


def _held(system: RollingSystem, time: float, states: Array) -> Any:
    stops = RollingLaw().event_functions(system, time, list(states.T), ())
    held = np.ones(len(states), dtype=bool)
    for name, value in stops.items():
        least = _PRESSED * system.body.mass * abs(system.gravity) if name == "lift" else 0.0
        held &= np.broadcast_to(value > least, held.shape)
    return held


def integrate(
    systems: Sequence[RollingSystem],
    states: Array,
    members: Sequence[int],
    times: Array,
    done: Callable[[Block], None],
    *,
    tolerance: float = taylor.TOLERANCE,
    workers: int = 1,
) -> list[int]:
    """Follow members that roll, for as long as they do.

    Parameters
    ----------
    systems : sequence of RollingSystem
        All of them, of one structure.
    states : array (all, size)
        As `rolling_from` gives them.
    members : sequence of int
        Which to follow.
    times : array (n,)
        Ascending, s, the first that of the starts.
    done : callable
        Given each part of a block as it is done, from any thread. What it was given of members that are returned is to
        be forgotten.
    tolerance : float
        Of each step, relative.
    workers : int
        Threads.

    Returns
    -------
    list of int
        Members that came to a stop of the law, or broke down.
    """
    law = RollingLaw()
    zeros = np.all([np.equal(numbers(system), 0) for system in systems], axis=0)
    lowered, key = integrators.ready(systems[0], law, tolerance, zeros=frozenset(np.flatnonzero(zeros).tolist()))
    integrator = integrators.kept(f"{LANES}-{key}", lambda: _compile(lowered, tolerance))
    blocks = [list(members[i : i + LANES]) for i in range(0, len(members), LANES)]
    halt = threading.Event()  # somebody pressed Ctrl-C, or another thread failed

    def work(which: int) -> list[int]:
        mine = copy.copy(integrator)
        stopped: list[int] = []
        try:
            for block in blocks[which::workers]:
                run = _Lanes(mine, lowered, [systems[i] for i in block], states[block])
                for rows, lanes, path in run.follow(times):
                    done(completed(law, systems, [block[lane] for lane in lanes], times, rows, path))
                    if halt.is_set():
                        return stopped
                stopped += [block[lane] for lane in sorted(run.left)]
        except BaseException:
            halt.set()
            raise
        return stopped

    if workers == 1:
        return sorted(work(0))
    with ThreadPoolExecutor(workers) as pool:
        try:
            return sorted(member for part in pool.map(work, range(workers)) for member in part)
        finally:
            halt.set()


def cores() -> int:
    """Return how many threads can run at once.

    Examples
    --------
    >>> cores() >= 1
    True
    """
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def completed(
    law: Law, systems: Sequence[RollingSystem], members: list[int], times: Array, rows: slice, path: Array
) -> Block:
    """Complete the states (rows, size, members) of some members at some of the instants."""
    system = together([systems[i] for i in members], len(path))
    flat = path.transpose(0, 2, 1).reshape(-1, path.shape[1])
    samples = law.record(system, np.repeat(times[rows], len(members)), flat)
    return Block(np.array(members), rows, samples, system)


class _Lanes:
    """Members on their way, one in each lane of an integrator.

    Where a lane stops, all go back to where the leg began, and another's state takes its place.
    """

    def __init__(self, integrator: Any, lowered: Lowered, systems: list[RollingSystem], states: Array) -> None:
        self.integrator, self.lowered, self.count = integrator, lowered, len(systems)
        self.lane = [min(i, self.count - 1) for i in range(LANES)]  # a short block repeats its last member
        self.given = [numbers(systems[i]) for i in self.lane]
        self.state, self.left = states[self.lane].T.copy(), set[int]()

    def follow(self, times: Array) -> Iterator[tuple[slice, list[int], Array]]:
        """Yield rows, the lanes that came so far, and their states (rows, size, lanes), leg by leg."""
        place = 0
        for begin, instants, end in _legs(times):
            path = self._leg(begin, instants, end)
            if path is None:
                return
            rows, place = slice(place, place + instants.size), place + instants.size
            if instants.size:
                kept = [lane for lane in range(self.count) if lane not in self.left]
                yield rows, kept, path[:, :, kept]

    def _leg(self, begin: float, instants: Array, end: float) -> Array | None:
        """Return the states (instants, size, LANES) of those that come through; None where nobody does."""
        grid = np.concatenate([[0.0], (instants if instants.size else np.array([end])) - begin])
        first = 0 if instants.size and instants[0] == begin else 1  # heyoka's grid begins where the integrator is
        grid = np.repeat(grid[1 - first :, None], LANES, axis=1)
        while len(self.left) < self.count:
            alive = next(i for i in range(self.count) if i not in self.left)
            for i in range(LANES):
                if self.lane[i] in self.left:
                    self.state[:, i], self.given[i] = self.state[:, alive], self.given[alive]
            failed = self._begin(begin)
            if not failed:
                path = self.integrator.propagate_grid(grid)[-1]
                ended = [_ended(result[0]) for result in self.integrator.propagate_res]
                failed = {self.lane[i] for i in range(LANES) if self.lane[i] not in self.left and ended[i]}
            if not failed:
                self.state = path[-1].copy()
                return path[first : first + instants.size]
            self.left |= failed
        return None

    def _begin(self, time: float) -> set[int]:
        """Set states and parameters at a new reference of time, and return the lanes for which these are no numbers."""
        self.integrator.set_time(0.0)
        if self.lowered.event_functions:
            self.integrator.reset_cooldowns()
        failed = set()
        for i in range(LANES):
            try:
                values = self.lowered.values(self.given[i], time)
                self.integrator.pars[:, i] = values[: self.lowered.parameters]
                self.integrator.state[:, i] = self.lowered.tidy([0.0, *self.state[:, i].tolist(), *values])
            except (ArithmeticError, ValueError):
                failed.add(self.lane[i])
        finite = np.isfinite(self.integrator.pars).all(axis=0) & np.isfinite(self.integrator.state).all(axis=0)
        return failed | {self.lane[i] for i in np.flatnonzero(~finite)}


def _ended(outcome: Any) -> bool:
    """Tell whether a lane came to a stop or broke down; one that was cut short by another lane's stop has not."""
    import heyoka

    return int(outcome) >= -1000 or outcome == heyoka.taylor_outcome.err_nf_state


def _legs(times: Array) -> Iterator[tuple[float, Array, float]]:
    """Yield the legs of a run: where each begins, its instants, none where it only leads on, and where it ends."""
    begin = float(times[0])
    for part in taylor._chunks(times, _MOST_CHUNKS, AT_ONCE // LANES):
        while part[0] - begin > taylor._LONGEST:
            yield begin, part[:0], begin + taylor._LONGEST
            begin += taylor._LONGEST
        yield begin, part, float(part[-1])
        begin = float(part[-1])


def _compile(lowered: Lowered, tolerance: float) -> Any:
    import heyoka

    equations, stops = lowered.heyoka()
    return heyoka.taylor_adaptive_batch(
        equations,
        np.zeros((len(equations), LANES)),
        pars=np.zeros((lowered.parameters, LANES)),
        tol=tolerance,
        compact_mode=True,
        t_events=[heyoka.t_event_batch(stop, direction=heyoka.event_direction.negative) for stop in stops],
    )
