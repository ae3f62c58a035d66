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
from numpy.typing import NDArray

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.nearest import followed
from ..mechanics.parameters import numbers, with_numbers
from ..mechanics.placing import SLIP_TOLERANCE
from ..mechanics.system import RollingSystem, State
from . import integrators, taylor
from .laws import Law, RollingLaw
from .lowering import Lowered
from .samples import AT_ONCE, Array, Samples

LANES = 8  # doubles in the widest registers; where they are half as wide, two at a time still gain
_MOST_CHUNKS = 10
_COMPLETED = 4000  # samples that are completed at once, at least: of few, each costs more
_PRESSED = 1e-9  # share of the weight with which a member must press on to be taken along


@dataclass(frozen=True)
class Block:
    """What some members did, or a part of it."""

    members: NDArray[np.int64]  # (n,): whose each sample is
    rows: NDArray[np.int64]  # (n,): at which instant it is; those of a member ascend
    samples: Samples  # n of them
    system: RollingSystem  # its numbers are arrays as long as the samples where members differ


@dataclass(frozen=True)
class Piece:
    """States (rows, size, members) of some members at some of the instants, to be completed."""

    members: Sequence[int]
    rows: slice
    path: Array

    @property
    def size(self) -> int:
        """How many samples it makes."""
        return len(self.members) * len(self.path)


def numbers_of(systems: Sequence[RollingSystem]) -> list[list[float]]:
    """Return the numbers of each system, which are looked up once where many members share one.

    Examples
    --------
    >>> import trundle as tr
    >>> ball = tr.RollingSystem(tr.Body.solid_sphere(0.1, 1.0), tr.Support(tr.Plane()))
    >>> one, other = numbers_of([ball, ball])
    >>> one is other
    True
    """
    found: dict[int, list[float]] = {}
    for system in systems:
        if id(system) not in found:
            found[id(system)] = numbers(system)
    return [found[id(system)] for system in systems]


def together(systems: Sequence[RollingSystem], repeat: int = 1) -> RollingSystem:
    """Return one system whose numbers are arrays over members, or plain numbers where all agree.

    Examples
    --------
    >>> import trundle as tr
    >>> balls = [tr.RollingSystem(tr.Body.solid_sphere(a, 1.0), tr.Support(tr.Plane())) for a in (0.1, 0.2)]
    >>> together(balls, 2).body.shape.radius.tolist(), together(balls).body.mass
    ([0.1, 0.2, 0.1, 0.2], 1.0)
    """
    if all(system is systems[0] for system in systems):
        return systems[0]
    values = np.array(numbers_of(systems)).T
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
        centre = Vector.of(r)
        contact, _ = followed(system, time, centre, centre, Quaternion.of(q), tuple(coordinates.T))
        states = np.column_stack([contact.point.array(), q, Omega, coordinates])
        arm = contact.offset.norm()
        touches = (contact.centre - centre).norm() <= SLIP_TOLERANCE * arm
        v, turning = Vector.of(V), Vector.of(Omega)
        u = contact.support.material_velocity(contact.point)
        speed = np.maximum(np.maximum(v.norm(), turning.norm() * arm), _norm(u))
        grips = contact.slip_velocity(v, turning).norm() <= SLIP_TOLERANCE * speed
        held = _held(system, time, states)
    return states, np.broadcast_to(touches & grips & held, (len(starts),)).copy()


def _norm(v: Vector) -> Any:
    return np.sqrt(np.asarray(v.dot(v), dtype=float))


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
) -> tuple[list[int], dict[int, Stop]]:
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
        Given each part of a block as it is done, from any thread. What it was given of members that broke down is to be
        forgotten.
    tolerance : float
        Of each step, relative.
    workers : int
        Threads.

    Returns
    -------
    broken : list of int
        Members that broke down.
    stops : dict of int to Stop
        Of each member that came to a stop of the law, where that was.
    """
    law = RollingLaw()
    given = numbers_of(systems)
    zeros = np.equal(np.array(given), 0).all(axis=0)
    lowered, key = integrators.ready(systems[0], law, tolerance, zeros=frozenset(np.flatnonzero(zeros).tolist()))
    integrator = integrators.kept(f"{LANES}-passing-{key}", lambda: _compile(lowered, tolerance))
    blocks = [list(members[i : i + LANES]) for i in range(0, len(members), LANES)]
    halt = threading.Event()  # somebody pressed Ctrl-C, or another thread failed

    def work(which: int) -> tuple[list[int], dict[int, Stop]]:
        mine = copy.copy(integrator)
        broken: list[int] = []
        stops: dict[int, Stop] = {}
        pieces: list[Piece] = []
        try:
            for block in blocks[which::workers]:
                run = _Lanes(mine, lowered, [given[i] for i in block], states[block])
                for rows, lanes, path in run.follow(times):
                    pieces.append(Piece([block[lane] for lane in lanes], rows, path))
                    if sum(piece.size for piece in pieces) >= _COMPLETED:
                        done(completed(law, systems, times, pieces))
                        pieces.clear()
                    if halt.is_set():
                        return broken, stops
                broken += [block[lane] for lane in sorted(run.left)]
                stops |= {block[lane]: stop for lane, stop in run.stops.items()}
            if pieces:
                done(completed(law, systems, times, pieces))
        except BaseException:
            halt.set()
            raise
        return broken, stops

    if workers == 1:
        return work(0)
    with ThreadPoolExecutor(workers) as pool:
        try:
            parts = list(pool.map(work, range(workers)))
        finally:
            halt.set()
    return [member for broken, _ in parts for member in broken], {k: v for _, stops in parts for k, v in stops.items()}


def cores() -> int:
    """Return how many threads can run at once.

    Examples
    --------
    >>> cores() >= 1
    True
    """
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def completed(law: Law, systems: Sequence[RollingSystem], times: Array, pieces: Sequence[Piece]) -> Block:
    """Complete the states of some members at some of the instants, all pieces at once."""
    members = np.concatenate([np.tile(np.asarray(piece.members), len(piece.path)) for piece in pieces])
    rows = np.concatenate([np.repeat(np.arange(times.size)[piece.rows], len(piece.members)) for piece in pieces])
    flat = np.concatenate([piece.path.transpose(0, 2, 1).reshape(-1, piece.path.shape[1]) for piece in pieces])
    system = _of_samples(systems, members)
    return Block(members, rows, law.record(system, times[rows], flat), system)


def _of_samples(systems: Sequence[RollingSystem], members: NDArray[np.int64]) -> RollingSystem:
    """Return one system whose numbers are arrays over samples, of which each is some member's."""
    known, places = np.unique(members, return_inverse=True)
    own = [systems[i] for i in known]
    if all(system is own[0] for system in own):
        return own[0]
    values = np.array(numbers_of(own)).T
    return with_numbers(own[0], [float(row[0]) if (row == row[0]).all() else row[places] for row in values])


@dataclass(frozen=True)
class Stop:
    """Where a member came to a stop of the law: when, s, and by which of its event functions."""

    time: float
    name: str


class _FirstFall:
    """What heyoka calls where an event function falls through zero: it keeps the first time of each lane."""

    def __init__(self) -> None:
        self.times: dict[int, float] = {}

    def __call__(self, integrator: Any, time: float, sign: int, lane: int) -> None:  # noqa: ARG002
        self.times.setdefault(lane, time)


class _Lanes:
    """Members on their way, one in each lane of an integrator.

    Nobody is held up by another's stop: who comes to one goes on to the end of the leg, and what is behind the stop is
    left out. Where a lane breaks down, all go back to where the leg began. Another's state takes the place of both.
    """

    def __init__(self, integrator: Any, lowered: Lowered, given: list[list[float]], states: Array) -> None:
        self.integrator, self.lowered, self.count = integrator, lowered, len(given)
        self.lane = [min(i, self.count - 1) for i in range(LANES)]  # a short block repeats its last member
        self.given = [given[i] for i in self.lane]
        self.state, self.left = states[self.lane].T.copy(), set[int]()
        self.stops: dict[int, Stop] = {}

    def follow(self, times: Array) -> Iterator[tuple[slice, list[int], Array]]:
        """Yield rows, the lanes that came so far, and their states (rows, size, lanes), leg by leg."""
        place = 0
        for begin, instants, end in _legs(times):
            before = set(self.stops)
            path = self._leg(begin, instants, end)
            if path is None:
                return
            kept = [lane for lane in range(self.count) if lane not in self.left and lane not in self.stops]
            if instants.size and kept:
                yield slice(place, place + instants.size), kept, path[:, :, kept]
            for lane in sorted(set(self.stops) - before):
                count = int(np.searchsorted(instants, self.stops[lane].time))
                if count:
                    yield slice(place, place + count), [lane], path[:count, :, [lane]]
            place += instants.size

    def _leg(self, begin: float, instants: Array, end: float) -> Array | None:
        """Return the states (instants, size, LANES) of those that come through; None where nobody does."""
        grid = np.concatenate([[0.0], (instants if instants.size else np.array([end])) - begin])
        first = 0 if instants.size and instants[0] == begin else 1  # heyoka's grid begins where the integrator is
        grid = np.repeat(grid[1 - first :, None], LANES, axis=1)
        while alive := [i for i in range(self.count) if i not in self.left and i not in self.stops]:
            for i in range(LANES):
                if self.lane[i] not in alive:
                    self.state[:, i], self.given[i] = self.state[:, alive[0]], self.given[alive[0]]
            failed = self._begin(begin)
            if not failed:
                path = self.integrator.propagate_grid(grid)[-1]
                ended = [_ended(result[0]) for result in self.integrator.propagate_res]
                failed = {self.lane[i] for i in range(LANES) if self.lane[i] in alive and ended[i]}
            if not failed:
                self.state = path[-1].copy()
                self._take_stops(begin, alive)
                return path[first : first + instants.size]
            self.left |= failed
        return None

    def _take_stops(self, begin: float, alive: list[int]) -> None:
        """Keep the first stop of each member in the leg just done."""
        for name, event in zip(self.lowered.event_functions, self._events, strict=True):
            for lane, time in event.callback.times.items():
                known = self.stops.get(lane)
                if lane in alive and (known is None or begin + time < known.time):
                    self.stops[lane] = Stop(begin + time, name)

    @property
    def _events(self) -> list[Any]:
        return self.integrator.nt_events if self.lowered.event_functions else []

    def _begin(self, time: float) -> set[int]:
        """Set states and parameters at a new reference of time, and return the lanes for which these are no numbers."""
        self.integrator.set_time(0.0)
        for event in self._events:
            event.callback.times.clear()
        failed = set()
        worked_out: dict[int, list[float]] = {}  # many members may share one system
        for i in range(LANES):
            try:
                if id(self.given[i]) not in worked_out:
                    worked_out[id(self.given[i])] = self.lowered.values(self.given[i], time)
                values = worked_out[id(self.given[i])]
                self.integrator.pars[:, i] = values[: self.lowered.parameters]
                self.integrator.state[:, i] = self.lowered.tidy([0.0, *self.state[:, i].tolist(), *values])
            except (ArithmeticError, ValueError):
                failed.add(self.lane[i])
        finite = np.isfinite(self.integrator.pars).all(axis=0) & np.isfinite(self.integrator.state).all(axis=0)
        return failed | {self.lane[i] for i in np.flatnonzero(~finite)}


def _ended(outcome: Any) -> bool:
    """Tell whether a lane broke down; one that was cut short because another did has not."""
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
        nt_events=[
            heyoka.nt_event_batch(stop, _FirstFall(), direction=heyoka.event_direction.negative) for stop in stops
        ],
    )
