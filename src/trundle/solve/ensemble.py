"""Many members of one system at once: heyoka's Taylor integrator with several of them in each vector register.

Members share the structure of the system; their numbers and their starts are their own, and so is every step size, so
that what a member gives does not depend on its company.
"""

from __future__ import annotations

import copy
import math
import os
import threading
from collections import deque
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import TrundleError
from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.nearest import followed
from ..mechanics.parameters import numbers, with_numbers
from ..mechanics.placing import SLIP_TOLERANCE
from ..mechanics.system import RollingSystem, State
from . import corners, integrators, phases, runge_kutta, taylor
from .charts import CHART, LAWS_OWN, Chart, charts
from .laws import Law, RollingLaw
from .lowering import Lowered
from .samples import AT_ONCE, Array, Event, Samples
from .transitions import PhaseStart, ZeroCrossing

LANES = 8  # at most: doubles in the widest registers; where they are half as wide, two at a time still gain
_MOST_CHUNKS = 10
_COMPLETED = 4000  # samples that are completed at once, at least: of few, each costs more
_STEPS = 300  # at most, between which lanes that are free are taken again
_FEWEST = 20_000  # steps times `Lowered.cost`, at least: what else is done between two calls takes half of that
# By `Lowered.cost`: what is longer does not fit the processor's nearest memories when its loops are unrolled.
_MOST_UNROLLED = 500
# Of what is longer, unrolled, the registers hold too little: the rest goes to the stack, which is not aligned for eight
# doubles, so that some processes take a third longer than others. Four take as long in each, and no longer on the mean.
_MOST_EIGHT = 300
_NARROW = 1e-6  # share of a leg: a narrower gap has no room to look more often in
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
    """States (rows, size, members), in a chart, of some members at successive instants, to be completed."""

    members: Sequence[int]
    first: int  # row
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
    starts: Mapping[int, State | PhaseStart],
    times: Array,
    done: Callable[[Block], None],
    *,
    tolerance: float = taylor.TOLERANCE,
    workers: int = 1,
    unrolled: bool = False,
) -> tuple[list[int], dict[int, tuple[Event, ...]]]:
    """Follow members through their phases, those that are in the same one together.

    Parameters
    ----------
    systems : sequence of RollingSystem
        All of them, of one structure, without kinks.
    starts : mapping of int to State or PhaseStart
        Which members to follow, and from where.
    times : array (n,)
        Ascending, s, the first that of the starts.
    done : callable
        Given each part of a block as it is done, from any thread. What it was given of members that broke down is to be
        forgotten.
    tolerance : float
        Of each step, relative.
    workers : int
        Threads.
    unrolled : bool
        Whether loops are unrolled, of laws that are not too long: by a fifth to a half faster for some seconds of the
        compiler. The last digits are others.

    Returns
    -------
    broken : list of int
        Members that broke down.
    events : dict of int to tuple of Event
        What happened to each member that came through.
    """
    given = numbers_of(systems)
    compiled = _Compiled(given, tolerance, unrolled)
    halt = threading.Event()  # somebody pressed Ctrl-C, or another thread failed
    members = list(starts)

    def work(which: int) -> tuple[list[int], dict[int, tuple[Event, ...]]]:
        blocks = range(which * LANES, len(members), workers * LANES)
        mine = (i for first in blocks for i in members[first : first + LANES])
        legs = lru_cache(LANES)(partial(_legs, times))  # most members begin at one time
        company = _Company((Member(i, systems[i], given[i], starts[i], times, legs, compiled) for i in mine), halt)
        try:
            for pieces in company.follow():
                done(pieces.completed(systems, times))
        except BaseException:
            halt.set()
            raise
        for lanes in company.lanes.values():
            integrators.put_back(lanes.name, lanes.integrator)
        return company.broken, company.events

    if workers == 1:
        return work(0)
    with ThreadPoolExecutor(workers) as pool:
        try:
            parts = list(pool.map(work, range(workers)))
        finally:
            halt.set()
    return [i for broken, _ in parts for i in broken], {i: found for _, events in parts for i, found in events.items()}


def cores() -> int:
    """Return how many threads can run at once.

    Examples
    --------
    >>> cores() >= 1
    True
    """
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def completed(
    law: Law, systems: Sequence[RollingSystem], times: Array, pieces: Sequence[Piece], chart: Chart = LAWS_OWN
) -> Block:
    """Complete the states of some members at some of the instants, all pieces at once."""
    counts = np.array([len(piece.members) for piece in pieces])
    sizes = np.array([piece.size for piece in pieces])
    within = np.arange(sizes.sum()) - np.repeat(sizes.cumsum() - sizes, sizes)  # which sample of its piece
    row, which = np.divmod(within, np.repeat(counts, sizes))
    members = np.concatenate([piece.members for piece in pieces])[np.repeat(counts.cumsum() - counts, sizes) + which]
    rows = np.repeat([piece.first for piece in pieces], sizes) + row
    flat = np.concatenate([piece.path.transpose(0, 2, 1).reshape(-1, piece.path.shape[1]) for piece in pieces])
    system = _of_samples(systems, members)
    states = taylor.to_law(chart, system, times[rows], flat)
    return Block(members, rows, law.record(system, times[rows], states), system)


def _of_samples(systems: Sequence[RollingSystem], members: NDArray[np.int64]) -> RollingSystem:
    """Return one system whose numbers are arrays over samples, of which each is some member's."""
    known, places = np.unique(members, return_inverse=True)
    own = [systems[i] for i in known]
    if all(system is own[0] for system in own):
        return own[0]
    values = np.array(numbers_of(own)).T
    return with_numbers(own[0], [float(row[0]) if (row == row[0]).all() else row[places] for row in values])


class _Compiled:
    """Laws of one structure, in the charts of its members, compiled for several of them."""

    def __init__(self, given: Sequence[Sequence[float]], tolerance: float, unrolled: bool) -> None:
        zeros = np.equal(np.array(given), 0).all(axis=0)
        self.zeros, self.tolerance = frozenset(np.flatnonzero(zeros).tolist()), tolerance
        self.unrolled = unrolled
        self.lock = threading.Lock()
        self.known: dict[Any, list[tuple[Lowered, str]]] = {}  # by law and charts
        self.of: dict[Any, list[tuple[Lowered, str]]] = {}  # the same by system and law

    def chosen(self, system: RollingSystem, law: Law, state: Sequence[float]) -> tuple[Lowered, str]:
        """Return a law in the chart of fewest operations around a state."""
        seen = id(system), law.identity  # many may share one system
        if seen not in self.of:
            among = charts(system, law)
            one = law.identity, among
            if one not in self.known:
                with self.lock:
                    self.known[one] = integrators.ready_in(system, law, self.tolerance, self.zeros, among)
            self.of[seen] = self.known[one]
        return next(each for each in self.of[seen] if each[0].chart.contains(state))

    def integrator(self, lowered: Lowered, key: str) -> tuple[Any, str]:
        """Return one that nobody else uses, and the name under which to put it back."""
        unrolled = self.unrolled and lowered.cost <= _MOST_UNROLLED
        level = integrators.UNROLLED if unrolled else integrators.WITH_CARE
        lanes = LANES // 2 if unrolled and lowered.cost > _MOST_EIGHT else LANES
        name = f"{lanes}-stopping-{key}-{level}"
        with self.lock:
            made = integrators.kept(name, lambda: _compile(lowered, self.tolerance, unrolled, lanes))
            return integrators.idle(name) or copy.copy(made), name


class Member:
    """One member on its way: the stretch that it is on, and the leg of that."""

    def __init__(
        self,
        index: int,
        system: RollingSystem,
        numbers: list[float],
        start: State | PhaseStart,
        times: Array,
        legs: Callable[[float, int], Sequence[_Leg]],
        compiled: _Compiled,
    ) -> None:
        self.index, self.system, self.numbers, self.times, self.legs_from = index, system, numbers, times, legs
        self.compiled = compiled
        self.samples: list[Samples] = []  # of instants that no stretch holds
        self.course = phases.course(system, start, times, self.samples.append, sampled=self._asked)
        self.patience = taylor.Shared().patience(float(times[0]), float(times[-1]))
        self.now: PhaseStart
        self.left: Array

    def _asked(self, time: float) -> bool:
        """Tell whether an instant is one of those asked for."""
        row = int(self.times.searchsorted(time))
        return row < self.times.size and bool(self.times[row] == time)

    def set_out(self) -> bool:
        """Go to the first stretch; tell whether there is one."""
        return self._take(lambda: next(self.course))

    def goes_on(self, stop: ZeroCrossing | None) -> bool:
        """Go to the next stretch, from where this one was left; tell whether there is one."""
        if stop is not None and stop.name == CHART:
            self._begin(stop.time, stop.state_vector, self.reached)
            return True
        return self._take(lambda: self.course.send((stop, self.reached)))

    def _take(self, stretch: Callable[[], tuple[PhaseStart, Array]]) -> bool:
        try:
            self.now, self.left = stretch()
            while not self.left.size:
                self.now, self.left = self.course.send((None, 0))
        except StopIteration as done:
            self.events: tuple[Event, ...] = done.value
            return False
        event_parameters = (*self.now.event_parameters, *corners.directions(self.system, self.now))
        self.given = [*self.numbers, *event_parameters] if event_parameters else self.numbers
        self.first, self.begun = self.times.size - self.left.size, self.now.time  # row; s
        self.lasted = taylor.lasted(self.system, self.now)
        self._begin(self.now.time, self.now.state_vector, 0)
        return True

    def _begin(self, time: float, state: Any, reached: int) -> None:
        """Begin the stretch, or go on in it, from the law's numbers, with so many of its instants behind it."""
        self.reached = reached  # instants of the stretch
        if self.now.law.brief:  # it is followed by itself: to trace it takes longer
            return
        self.lowered, self.key = self.compiled.chosen(self.system, self.now.law, state)
        self.state = np.array(self.lowered.chart.of_law(self.system, time, state), dtype=float)
        self.legs = iter(self.legs_from(time, self.first + reached))

    def lanes(self) -> _Lanes:
        """Return lanes for it, and for whoever follows the same law in the same chart."""
        return _Lanes(*self.compiled.integrator(self.lowered, self.key), self.lowered, self.now.law)

    def next_leg(self) -> bool:
        """Go to the next leg of the stretch; tell whether there is one."""
        leg = next(self.legs, None)
        if leg is not None:
            self.leg, self.begin, self.instants, self.end = leg, leg.begin, leg.instants, leg.end
            self.leg_from = self.reached
        return leg is not None

    def looks(self, now: float) -> _Looks:
        """Return when to look at it next, so long after its leg began."""
        if self.reached == self.leg_from and now == 0.0:
            return self.leg.looks
        return _Looks.of(self.leg, self.reached - self.leg_from, now)

    def longest(self, time: float) -> float:
        """Return how long its next step may be, s."""
        longest = self.lasted + (time - self.begun)
        return longest if longest <= taylor.GROWN * self.lasted else math.inf


class _Pieces:
    """Samples of one law, in one chart, that wait to be completed."""

    def __init__(self, law: Law, chart: Chart) -> None:
        self.law, self.chart, self.waiting, self.size = law, chart, list[Piece](), 0

    def add(self, piece: Piece) -> None:
        self.waiting.append(piece)
        self.size += piece.size

    def completed(self, systems: Sequence[RollingSystem], times: Array) -> Block:
        """Return them, and wait for others."""
        waiting, self.waiting, self.size = self.waiting, [], 0
        return completed(self.law, systems, times, waiting, self.chart)


class _Ready:
    """Samples that are complete."""

    def __init__(self, member: Member) -> None:
        self.member, self.samples = member, Samples.joined(member.samples)

    def completed(self, systems: Sequence[RollingSystem], times: Array) -> Block:  # noqa: ARG002
        """Return those at the instants asked for: an event that ends a run may be between two."""
        rows = np.minimum(np.searchsorted(times, self.samples.time), times.size - 1)
        asked = times[rows] == self.samples.time
        rows, samples = rows[asked], self.samples.part(asked)
        return Block(np.full(rows.size, self.member.index), rows, samples, self.member.system)


class _Company:
    """Members on their way, sorted by the law that each has to follow next, and by its chart."""

    def __init__(self, members: Iterator[Member], halt: Any) -> None:
        self.members, self.halt = members, halt
        self.waiting: dict[Any, deque[Member]] = {}
        self.lanes: dict[Any, _Lanes] = {}
        self.ready: list[_Ready] = []
        self.broken: list[int] = []
        self.events: dict[int, tuple[Event, ...]] = {}

    def follow(self) -> Iterator[_Pieces | _Ready]:
        """Follow all of them to the end, and yield what is to be completed."""
        while self._set_out(self.waiting.values()) and not self.halt.is_set():
            key = max(self.waiting, key=lambda key: len(self.waiting[key]))
            lanes, waiting = self._lanes(key), self.waiting[key]
            for member, stop in lanes.follow(waiting):
                if member is not None:
                    self._lead(member, None if isinstance(stop, Exception) else partial(member.goes_on, stop))
                if lanes.pieces.size >= _COMPLETED:
                    yield lanes.pieces
                yield from self._drained()
                if self.halt.is_set():
                    return
                self._set_out([waiting])
        yield from (lanes.pieces for lanes in self.lanes.values() if lanes.pieces.size)
        yield from self._drained()

    def _set_out(self, waiting: Collection[deque[Member]]) -> bool:
        """Let members set out until enough wait, and not all at once, which is dear; tell whether any do."""
        while sum(map(len, waiting)) < LANES and (member := next(self.members, None)) is not None:
            self._lead(member, member.set_out)
        return any(waiting)

    def _lanes(self, key: Any) -> _Lanes:
        if key not in self.lanes:
            self.lanes[key] = self.waiting[key][0].lanes()
        return self.lanes[key]

    def _drained(self) -> Iterator[_Ready]:
        ready, self.ready = self.ready, []
        yield from ready

    def _lead(self, member: Member, onward: Callable[[], bool] | None) -> None:
        """Lead a member to its next stretch, if it can be led there."""
        try:
            goes_on = onward is not None and onward()
            while goes_on and member.now.law.brief:
                goes_on = self._briefly(member)
        except (TrundleError, ArithmeticError, ValueError):
            onward = None
        if onward is None:
            self.broken.append(member.index)
        elif goes_on:
            law = member.now.law
            by = law.identity, member.lowered.chart
            self.waiting.setdefault(by, deque()).append(member)
        else:
            self.events[member.index] = member.events
            if member.samples:
                self.ready.append(_Ready(member))

    def _briefly(self, member: Member) -> bool:
        """Follow a member by itself through what is too short to be compiled."""
        stop = None
        now = taylor.before_series(member.now)
        for piece in runge_kutta.integrate(member.system, now, member.left, runge_kutta.FINEST):
            if piece.times.size:
                member.samples.append(member.now.law.record(member.system, piece.times, piece.states))
            stop, member.reached = piece.stop, member.reached + piece.times.size
        return member.goes_on(stop)


class _Lanes:
    """Members that follow one law, one in each lane of an integrator; who is done makes room for the next.

    Each has its own times and its own steps. Where a lane breaks down, the others go back to where their legs began.
    """

    def __init__(self, integrator: Any, name: str, lowered: Lowered, law: Law) -> None:
        self.integrator, self.name = integrator, name
        self.lowered, self.pieces = lowered, _Pieces(law, lowered.chart)
        self.count = integrator.batch_size
        self.members: list[Member | None] = [None] * self.count
        self.times = np.zeros(self.count)  # since each leg began; given to the integrator before it steps
        self.pace = math.nan  # about how far a step leads, s
        self.known: dict[int, tuple[float, list[float]]] = {}  # parameters, and from when: many may share one system

    def follow(self, waiting: deque[Member]) -> Iterator[tuple[Member | None, ZeroCrossing | Exception | None]]:
        """Yield each member at the end of its stretch, with its stop or what broke it, and in between no member."""
        while True:
            for lane in range(self.count):
                while self.members[lane] is None and waiting:
                    yield from self._enter(lane, waiting.popleft())
            if not any(self.members):
                return
            yield from self._advance()
            yield None, None

    def _enter(self, lane: int, member: Member) -> Iterator[tuple[Member, ZeroCrossing | Exception | None]]:
        """Let a member go on in a lane: by its next leg, if it has one."""
        self.members[lane] = None
        try:
            while member.next_leg():
                self._begin(lane, member)
                if member.end > member.begin:
                    self.members[lane] = member
                    return
                row, count = member.first + member.reached, member.instants.size  # the instant at which it begins
                path = np.repeat(self.integrator.state[None, :, [lane]], count, axis=0)
                self.pieces.add(Piece([member.index], row, path))
                member.reached += count
            yield member, None
        except (ArithmeticError, ValueError) as error:
            yield member, error

    def _begin(self, lane: int, member: Member) -> None:
        """Set state and parameters of a member at the beginning of its leg, from which its time counts."""
        time, values = self.known.get(id(member.given), (math.nan, []))
        if time != member.begin:
            values = self.lowered.values(member.given, member.begin)
            if not all(map(math.isfinite, values[: self.lowered.parameters])):
                raise ArithmeticError("no numbers")
            if member.given is member.numbers:
                self.known[id(member.given)] = member.begin, values
        state = self.lowered.chart.reduced(self.lowered.tidy([0.0, *member.state.tolist(), *values]))
        if not all(map(math.isfinite, state)):
            raise ArithmeticError("no numbers")
        integrator = self.integrator
        integrator.pars[:, lane], integrator.state[:, lane] = values[: self.lowered.parameters], state
        self.times[lane] = 0.0
        if self.lowered.event_functions:
            integrator.reset_cooldowns(lane)

    def _advance(self) -> Iterator[tuple[Member, ZeroCrossing | Exception | None]]:
        """Take some steps, to the ends of the legs or to the first stop of anybody."""
        integrator, before = self.integrator, self.times
        looks, longest = self._looks()
        given: dict[str, Any] = {"max_steps": 1, "max_delta_t": longest} if np.isfinite(longest).any() else {}
        path = integrator.propagate_grid(_grid(looks, self.count), **{"max_steps": self._steps(), **given})[-1]
        self.times, results = integrator.time.copy(), integrator.propagate_res
        steps = sum(int(results[lane][3]) for lane in looks)
        if steps:
            self.pace = sum(float(self.times[lane] - before[lane]) for lane in looks) / steps
        stops = {lane: self._stop(lane, results[lane][0]) for lane in looks}
        failed = {lane for lane in looks if _failed(results[lane][0])}
        if not failed:  # else nobody takes a step
            failed = {lane for lane in looks if self.times[lane] == before[lane] and not stops[lane]}
        if failed:
            yield from self._start_again(failed)
            return
        self._sample(path, looks, stops)
        for lane, member in self._on_the_way():
            if stops.get(lane) is not None:
                self.members[lane] = None
                yield member, stops[lane]
            elif self.times[lane] == member.end - member.begin:
                member.state = integrator.state[:, lane].copy()
                yield from self._enter(lane, member)
            else:
                yield from self._wait(lane, member, int(results[lane][3]))

    def _steps(self) -> int:
        """Return how many steps to take: until the first lane is about to be done, for another member to follow."""
        left = min(member.end - member.begin - float(self.times[lane]) for lane, member in self._on_the_way())
        if not left < _STEPS * self.pace:
            return _STEPS
        return min(max(math.ceil(left / self.pace), _FEWEST // self.lowered.cost), _STEPS)

    def _on_the_way(self) -> list[tuple[int, Member]]:
        return [(lane, member) for lane, member in enumerate(self.members) if member is not None]

    def _looks(self) -> tuple[dict[int, _Looks], Array]:
        """Return when to look at each lane, and how long a step of it may be; a lane that is free repeats another."""
        integrator, longest = self.integrator, np.full(self.count, math.inf)
        looks: dict[int, _Looks] = {}
        times = self.times.copy()
        for lane, member in self._on_the_way():
            looks[lane] = member.looks(float(times[lane]))
            longest[lane] = member.longest(member.begin + float(times[lane]))
        one = next(iter(looks))
        for lane in set(range(self.count)).difference(looks):
            integrator.state[:, lane], integrator.pars[:, lane] = integrator.state[:, one], integrator.pars[:, one]
            times[lane] = times[one]
        integrator.set_time(times)
        return looks, longest

    def _start_again(self, failed: set[int]) -> Iterator[tuple[Member, Exception]]:
        """Leave those out that broke down; the others go back to where their legs began."""
        for lane, member in self._on_the_way():
            if lane in failed:
                self.members[lane] = None
                yield member, ArithmeticError("broke down")
            else:
                member.reached = member.leg_from
                self._begin(lane, member)

    def _stop(self, lane: int, outcome: Any) -> ZeroCrossing | None:
        """Return the stop to which a lane has come."""
        member, event = self.members[lane], self._event(lane, outcome)
        if member is None or event is None:
            return None
        time = member.begin + float(self.times[lane])
        state = taylor.to_law(self.lowered.chart, member.system, np.array([time]), self.integrator.state[None, :, lane])
        return ZeroCrossing(time, self.lowered.event_functions[event], state[0].copy())

    def _event(self, lane: int, outcome: Any) -> int | None:
        """Return which event a lane has come to; in the last of the steps that it may take only its cooldown tells."""
        import heyoka

        if -1000 < int(outcome) < 0:
            return -int(outcome) - 1
        if outcome != heyoka.taylor_outcome.step_limit or not self.lowered.event_functions:
            return None
        cooldowns = enumerate(self.integrator.te_cooldowns[lane])
        return next((i for i, since in cooldowns if since is not None and since[0] == 0.0), None)

    def _sample(self, path: Array, looks: Mapping[int, _Looks], stops: Mapping[int, ZeroCrossing | None]) -> None:
        """Keep the states at the instants that have been passed."""
        for lane, member in self._on_the_way():
            stop, done = stops[lane], member.reached - member.leg_from
            if stop is not None:
                upto = int(member.instants.searchsorted(stop.time))
            elif self.times[lane] == member.end - member.begin:
                upto = member.instants.size
            else:
                upto = int(member.leg.since.searchsorted(self.times[lane], "right"))
            if upto > done:
                places, row = looks[lane].places[: upto - done], member.first + member.reached
                self.pieces.add(Piece([member.index], row, path[places, :, lane, None]))
                member.reached += upto - done

    def _wait(self, lane: int, member: Member, steps: int) -> Iterator[tuple[Member, Exception]]:
        """Let a member go on in its leg, unless it hardly gets on."""
        try:
            member.patience.after(steps, member.begin + float(self.times[lane]))
        except TrundleError as error:
            self.members[lane] = None
            yield member, error


@dataclass(frozen=True)
class _Looks:
    """Times, since its reference, at which heyoka is to look at a lane: where it is first, its instants, and others."""

    times: Array
    places: NDArray[np.int64]  # where the instants are among them

    @staticmethod
    def of(leg: _Leg, passed: int, now: float) -> _Looks:
        """Return the time now, and the instants of a leg that are ahead."""
        ahead = leg.since[passed:]
        if not ahead.size:
            return _Looks(np.array([now, leg.end - leg.begin]), np.empty(0, dtype=np.int64))
        times = np.concatenate([[now], ahead])
        if leg.apart and ahead[0] > now:
            return _Looks(times, np.arange(1, times.size))
        times, places = np.unique(times, return_inverse=True)  # since a reference, two may be one by rounding
        return _Looks(times, places[1:])

    def filled_up(self, count: int) -> _Looks:
        """Return so many: more before the first that is ahead, or in the widest gap if that one is too narrow."""
        more = count - self.times.size
        if more == 0:
            return self
        times, after = self.times, 1
        if not times[1] - times[0] > _NARROW * times[-1]:
            after += int(np.argmax(times[1:] - times[:-1]))
        filled = np.empty(count)
        filled[:after], filled[after + more :] = times[:after], times[after:]
        begin, end = float(times[after - 1]), float(times[after])
        filled[after : after + more] = begin + np.arange(1, more + 1) * ((end - begin) / (more + 1))
        return _Looks(filled, self.places + more * (self.places >= after))


@dataclass(frozen=True)
class _Leg:
    """A part of a stretch with one reference of time; members that begin together share it."""

    begin: float
    instants: Array  # none where it only leads on
    end: float

    @cached_property
    def since(self) -> Array:
        """Its instants, since it began."""
        return self.instants - self.begin

    @cached_property
    def apart(self) -> bool:
        """Whether rounding has left no two of them one."""
        return bool((self.since[1:] > self.since[:-1]).all())

    @cached_property
    def looks(self) -> _Looks:
        """When to look at who begins it."""
        return _Looks.of(self, 0, 0.0)


def _grid(looks: dict[int, _Looks], lanes: int) -> Array:
    """Return the times (looks, lanes) of all lanes, as many for each; one that is free repeats another."""
    count = max(look.times.size for look in looks.values())
    for lane, look in looks.items():
        looks[lane] = look.filled_up(count)
    some = next(iter(looks.values()))
    return np.stack([looks.get(lane, some).times for lane in range(lanes)], axis=1)


def _failed(outcome: Any) -> bool:
    """Tell whether a lane broke down."""
    import heyoka

    return int(outcome) >= 0 or outcome == heyoka.taylor_outcome.err_nf_state


def _legs(times: Array, begin: float, first: int) -> list[_Leg]:
    """Return the legs of a stretch that begins at a time and holds the instants from the first on."""
    legs = []
    for part in taylor.chunks(times[first:], _MOST_CHUNKS, AT_ONCE // LANES):
        while part[0] - begin > taylor.LONGEST:
            legs.append(_Leg(begin, part[:0], begin + taylor.LONGEST))
            begin += taylor.LONGEST
        legs.append(_Leg(begin, part, float(part[-1])))
        begin = float(part[-1])
    return legs


def _compile(lowered: Lowered, tolerance: float, unrolled: bool, lanes: int) -> Any:
    import heyoka

    equations, stops = lowered.heyoka()
    falling = heyoka.event_direction.negative
    return heyoka.taylor_adaptive_batch(
        equations,
        np.zeros((len(equations), lanes)),
        pars=np.zeros((lowered.parameters, lanes)),
        tol=tolerance,
        compact_mode=not unrolled,
        t_events=[heyoka.t_event_batch(stop, direction=falling) for stop in stops],
    )
