"""Rolling, slipping, flight and rest: which follows which, and when (theory page, section 4).

A run is a chain of stretches, each by one law to its first stop. What comes next is read off the state there: the gap,
the slip, the normal force, the friction cone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterator, Sequence
from copy import copy
from dataclasses import replace
from functools import partial
from typing import Any, Protocol

import numpy as np

from ..errors import SolverError
from ..mechanics.algebra import ZERO, Quaternion, Vector
from ..mechanics.kinks import Kink, kinks_and_jolts
from ..mechanics.records import frozen_record
from ..mechanics.slipping import slip
from ..mechanics.system import RollingSystem, State
from . import corners, focal, transitions
from .contact_state import ContactState
from .laws import CORNER, Law, RollingLaw, SlippingLaw
from .patience import Patience
from .samples import AT_ONCE, FLIGHT, RESTING, ROLLING, SLIPPING, Array, Event, Progress, Recording, Samples
from .transitions import JOLT, PhaseStart, ZeroCrossing

_MOST_EVENTS = 10_000
# Stops that are no events, as where slip has turned by a right angle: a minute or two, and some seconds.
PATIENCE: dict[str, Any] = {"steps": 1e5, "spare": 500, "name": "The run"}
_AT_ONE_INSTANT = 20  # events: more means that no phase goes on
# Events, and the share of the time in which the motion changes: no bounces are so close, nor for so long.
_CHATTER = (50, 1e-3), (1000, 0.3)
ENDS = {
    "rim": "ran off the rim ({rim:g} m from the axis)",
    "end": "came to {end}",
    "edge": "{left}, which its shape does not cover",
    "curved": "came where the support is as hollow as the body is round: 1 + C S is singular",
    "spot": "stopped on the spot while it still spins about the normal, which is not covered",
    "wall": "touched the support in a second place, which is not covered",
}


_BREAKS = ("lift", "slip", "start", "jam")  # stops that forces decide
_CLOSE = 1e-14  # of an instant: a stop found so shortly before a kink is of the kink


class SegmentCompleter(Protocol):
    """What completes the states of a method that knows more than a law's numbers; of several stretches at once."""

    def joins(self, other: Any) -> bool:
        """Tell whether the stretch that follows can be completed with this one."""

    def record(self, system: RollingSystem, stretches: list[Segment]) -> Samples:
        """Return the samples of stretches of which each goes on with the next, this one's first."""


@frozen_record()
class Segment:
    """One law's part of a run, or a piece of it: states at the times before its stop, if it came to one."""

    times: Array
    states: Array
    stop: ZeroCrossing | None
    known: SegmentCompleter | None = None  # what completes the states, if not the law


Integrate = Callable[[RollingSystem, PhaseStart, Array, float, Progress | None], Iterator[Segment]]
# What follows a stop: None where the run ends
Follows = Callable[[], PhaseStart | None]
Remember = Callable[[Follows, Law, ZeroCrossing], PhaseStart | None]
Course = Generator[tuple[PhaseStart, Array], tuple[ZeroCrossing | None, int], tuple[Event, ...]]


def solve(
    integrate: Integrate,
    system: RollingSystem,
    start: State,
    times: Array,
    tolerance: float,
    progress: Progress | None = None,
    *,
    in_steps: bool = True,
    remember: Remember = lambda follows, *_: follows(),
    bends: list[Kink] | None = None,
) -> Samples:
    """Follow a body through its phases and return its samples with all events.

    Parameters
    ----------
    integrate : callable
        A method's way through one stretch, in pieces: only the last may have a stop.
    system : RollingSystem
        Any system.
    start : State
        Any state on or over the support.
    times : array (n,)
        Ascending, s, none before the start.
    tolerance : float
        Of the method.
    progress : callable, optional
        Told the fraction done.
    in_steps : bool
        Whether the method takes steps: none may then lead across a kink of a formula in the time, and slip whose
        direction settles at once is a phase of its own; to a closed form it is slip.
    remember : callable, optional
        Takes what works out what follows a stop (None at the run's end), the law and the stop; returns that, or the
        same if it is known.
    bends : list of Kink, optional
        The kinks of its formulas, if they are known already.

    Returns
    -------
    Samples
        At `times`, cut where the run ends early.

    Raises
    ------
    SolverError
        If the method breaks down, or events follow each other without end.
    """
    record = _Record(system, times.size + 1)  # an event that ends a run is sampled, too
    begin = corners.beyond if in_steps else transitions.slipping
    if bends is None:
        bends = kinks_and_jolts(system, start.time, float(times[-1])) if times.size else []
    steps_between, told = bends if in_steps else [], _telling(progress, times)

    def follow(now: PhaseStart, left: Array) -> tuple[ZeroCrossing | None, int]:
        stop, taken = None, 0
        for piece in _between_kinks(integrate, system, now, left, steps_between, tolerance, told):
            record.take(now.law, piece)
            stop, taken = piece.stop, taken + piece.times.size
        return stop, taken

    way = course(system, start, times, record.put, begin, bends, remember)
    try:
        stretch = next(way)
        while True:
            stretch = way.send(follow(*stretch))
    except StopIteration as done:
        return record.samples(done.value)


def course(
    system: RollingSystem,
    start: State | PhaseStart,
    times: Array,
    put: Callable[[Samples], None],
    begin: Callable[[RollingSystem, PhaseStart], PhaseStart] = corners.beyond,
    bends: Sequence[Kink] = (),
    remember: Remember = lambda follows, *_: follows(),
    sampled: Callable[[float], bool] = lambda _: True,
) -> Course:
    """Lead a body through its phases: say which law is to be followed over which times, be told how far it held.

    Parameters
    ----------
    system : RollingSystem
        Any system.
    start : State or PhaseStart
        Any state on or over the support, or the phase in which it is.
    times : array (n,)
        Ascending, s, none before the start.
    put : callable
        Given the samples of instants that no stretch holds: those in the short steps across events, and the end.
    begin : callable
        What a method makes of a phase that begins.
    bends : list of Kink
        The kinks of its formulas in the time.
    remember : callable, optional
        As of `solve`.
    sampled : callable, optional
        Whether a sample is wanted at the instant at which the run ends. Without one its event knows no state.

    Yields
    ------
    (PhaseStart, array)
        What to follow next, and the instants that are left. Send its stop, if it came to one, and how many of the
        instants were before that.

    Returns
    -------
    tuple of Event
        All that happened.
    """
    events: list[Event] = []
    passed: list[float] = []  # corners
    left = times
    patience = Patience(start.time, float(times[-1]) if times.size else start.time, **PATIENCE)

    def behind(now: PhaseStart) -> PhaseStart:
        return _behind_it(system, begin(system, now), bends)

    if isinstance(start, PhaseStart):
        now = start
    else:
        now = behind(transitions.at_start(system, start))
        events += now.events
        if now.time > start.time:  # it slips from rest: its first moment is behind it
            held = RollingLaw()
            rolls = ZeroCrossing(start.time, "", np.array(held.pack(system, start)))
            left = _across(system, held, rolls, now, left, put)
    while True:
        law = now.law
        stop, taken = yield now, left
        if stop is None:
            return tuple(events)
        stop = _on_kink(system, law, stop, bends)
        follows = remember(partial(_following, system, law, stop, behind), law, stop)
        if follows is None:
            if not sampled(stop.time):
                return (*events, _end(system, stop))
            samples = law.record(system, np.array([stop.time]), stop.state_vector[None])
            put(samples)
            return (*events, _end(system, stop, samples))
        now = follows
        events += now.events
        _check_count(system, events)
        if stop.name.startswith(CORNER):
            passed.append(stop.time)
            corners.check_count(system, passed, now)
        elif not now.events and stop.name != JOLT:
            patience.after(1, stop.time)
        left = _across(system, law, stop, now, left[taken:], put)


def _following(
    system: RollingSystem, law: Law, stop: ZeroCrossing, behind: Callable[[PhaseStart], PhaseStart]
) -> PhaseStart | None:
    """Return what follows a stop, None where the run ends."""
    if focal.is_focal(law, stop):
        follows = focal.past_it(system, law, stop)
        return None if follows is None else behind(follows)
    ends = stop.name in ENDS or _spinning_on(system, law, stop)
    return None if ends else behind(following_stop(system, law, stop))


def _between_kinks(
    integrate: Integrate,
    system: RollingSystem,
    now: PhaseStart,
    times: Array,
    bends: list[Kink],
    tolerance: float,
    progress: Progress | None,
) -> Iterator[Segment]:
    """Follow one law to its first stop, and begin anew behind each kink on the way: no step is to lead across it."""
    for kink in bends:
        if not (now.time < kink.behind and kink.time <= times[-1:].max(initial=-np.inf)):
            continue
        here, times = cut(times, kink.behind)
        before, there = cut(here, kink.time)[0].size, np.array(now.state_vector)
        for piece in integrate(system, now, np.append(here, kink.behind), tolerance, progress):
            if piece.stop is not None and not _is_of(kink, piece.stop):
                yield piece
                return
            count = min(piece.times.size, before)
            yield replace(piece, times=piece.times[:count], states=piece.states[:count], stop=None)
            here, before = here[count:], before - count
            there = (
                piece.stop.state_vector if piece.stop is not None else piece.states[-1] if piece.times.size else there
            )
        stop = _at_kink(system, now, kink, there)
        rest = here if stop is None else cut(here, kink.time)[0]
        yield Segment(rest, np.broadcast_to(there, (rest.size, there.size)), stop)
        if stop is not None:
            return
        now = transitions.later(system, now, kink.behind, there)
    yield from integrate(system, now, times, tolerance, progress)


def _at_kink(system: RollingSystem, now: PhaseStart, kink: Kink, numbers: Array) -> ZeroCrossing | None:
    """Return the stop of a law at a kink under a body that touches: the velocity of the support jumps, or forces do.

    Where the acceleration of the support jumps, forces do, and may break what the contact can bear.
    """
    if now.law.code == FLIGHT or kink.time <= now.time:
        return None
    if kink.jolts:
        return ZeroCrossing(kink.time, JOLT, numbers, transitions.jolted(system, now.law, kink, numbers))
    stops = now.law.event_functions(system, kink.behind, numbers.tolist(), now.event_parameters)
    broken = next((name for name, left in stops.items() if name in _BREAKS and left < 0), None)
    return None if broken is None else ZeroCrossing(kink.time, broken, numbers)


def _is_of(kink: Kink, stop: ZeroCrossing) -> bool:
    """Tell whether forces seem to have broken a contact just before a kink, as they have just behind it."""
    return stop.name in _BREAKS and kink.before - stop.time <= _CLOSE * abs(kink.time)


def _on_kink(system: RollingSystem, law: Law, stop: ZeroCrossing, bends: Sequence[Kink]) -> ZeroCrossing:
    """Return a stop by forces that jump at a kink, found a rounding before it, as it is on the kink."""
    kink = next((kink for kink in bends if stop.time < kink.time and _is_of(kink, stop)), None)
    if kink is None:
        return stop
    known = stop.at(system, law)
    known = ContactState.of(system, replace(known.state, time=kink.time), known.contact.point)
    return replace(stop, time=kink.time, known=known)


def _behind_it(system: RollingSystem, now: PhaseStart, bends: Sequence[Kink]) -> PhaseStart:
    """Return what begins on a kink as it is just behind it, where every method evaluates its formulas alike."""
    wait = next((kink.behind - now.time for kink in bends if kink.time <= now.time < kink.behind), 0.0)
    return corners.advanced(system, now, wait) if wait else now


class _Record:
    """The samples of a run as its pieces come in; many small ones by one law are completed together.

    Parameters
    ----------
    system : RollingSystem
        What moves.
    most : int
        How many samples there may be.
    """

    def __init__(self, system: RollingSystem, most: int) -> None:
        self.system, self.recording, self.form = system, Recording(most), None
        self.waiting: list[tuple[Law, Segment] | Samples] = []
        self.rows = 0  # of what waits

    def take(self, law: Law, piece: Segment) -> None:
        """Take a piece of a stretch, to be completed with others."""
        if not piece.times.size and piece.known is None and self.recording.most > 1:
            return  # to complete nothing takes as long as to complete a sample
        self._wait((law, piece), piece.times.size)

    def put(self, samples: Samples) -> None:
        """Take samples that are complete."""
        self._wait(samples, samples.time.size)

    def samples(self, events: tuple[Event, ...]) -> Samples:
        """Return all of them."""
        self._complete()
        return self.recording.samples(events, self.form)

    def _wait(self, part: tuple[Law, Segment] | Samples, rows: int) -> None:
        if self.waiting and self.rows + rows > AT_ONCE:
            self._complete()
        self.waiting.append(part)
        self.rows += rows

    def _complete(self) -> None:
        """Complete what waits, each group at once, and put it in the order of time."""
        groups: dict[Any, list[int]] = {}
        for i in range(len(self.waiting)):
            groups.setdefault(self._group(i, next(reversed(groups), None)), []).append(i)
        found = [self._completed([self.waiting[i] for i in group]) for group in groups.values()]
        places = [np.repeat(group, [_rows(self.waiting[i]) for i in group]) for group in groups.values()]
        self.waiting, self.rows = [], 0
        if found and self.form is None:
            self.form = found[0].form
        if len(found) == 1:
            self.recording.add(found[0])
        elif found:
            self.recording.add(Samples.joined(found).part(np.argsort(np.concatenate(places), kind="stable")))

    def _group(self, place: int, last: Any) -> Any:
        """Return what is the same for pieces that are completed together, given that of the latest new one.

        Numbers of a law of its own, such as where it began, may be others in each. What knows more than its law is
        completed with its neighbours.
        """
        part = self.waiting[place]
        if isinstance(part, Samples):
            return place
        law, piece = part
        if piece.known is not None:
            before = self.waiting[place - 1] if place else None
            known = before[1].known if isinstance(before, tuple) else None
            return last if known is not None and known.joins(piece.known) else place
        structure = type(law), tuple((name, value) for name, value in vars(law).items() if not isinstance(value, float))
        try:
            hash(structure)
        except TypeError:  # a part of one's own that cannot be hashed
            return "law", id(law)
        return structure

    def _completed(self, parts: list[Any]) -> Samples:
        """Return the samples of a group."""
        if isinstance(parts[0], Samples):
            return parts[0]
        law, pieces = parts[0][0], [piece for _, piece in parts]
        if pieces[0].known is not None:
            return pieces[0].known.record(self.system, pieces)
        if len(pieces) == 1:
            return law.record(self.system, pieces[0].times, pieces[0].states)
        times, states = (np.concatenate([getattr(piece, name) for piece in pieces]) for name in ("times", "states"))
        together, counts = copy(law), [piece.times.size for piece in pieces]
        for name, value in vars(law).items():
            own = [vars(one)[name] for one, _ in parts]
            if isinstance(value, float) and own.count(value) < len(own):
                setattr(together, name, np.repeat(own, counts))
        return together.record(self.system, times, states)


def _rows(part: tuple[Law, Segment] | Samples) -> int:
    return part.time.size if isinstance(part, Samples) else part[1].times.size


def _across(
    system: RollingSystem,
    law: Law,
    stop: ZeroCrossing,
    follows: PhaseStart,
    left: Array,
    put: Callable[[Samples], None],
) -> Array:
    """Add the samples in the short step across an event, and return the times after it."""
    if follows.across is not None:  # something struck, or slip ended, before slip begins
        left = _across(system, law, stop, follows.across, left, put)
        law, stop = follows.across.law, ZeroCrossing(follows.across.time, "", np.array(follows.across.state_vector))
    early, left = cut(left, follows.time)
    if early.size:
        samples = law.record(system, early, _short_of_it(system, law, stop, early))
        gives_way = follows.law.code == SLIPPING and law.code in (ROLLING, RESTING)
        put(_giving_way(system, samples, follows) if gives_way else samples)
    return left


def _short_of_it(system: RollingSystem, law: Law, stop: ZeroCrossing, times: Array) -> Array:
    """Return the states between a stop and its event: straight where slip or turning ends, for beyond no law holds."""
    if focal.is_focal(law, stop):
        return focal.flown(system, law, stop, times)
    numbers = stop.state_vector.tolist()
    if stop.name.removeprefix("near ") in ("grip", "stop"):
        rates = np.array([float(rate) for rate in law.rates(system, stop.time, numbers)])
        return stop.state_vector + (times - stop.time)[:, None] * rates
    return np.array([law.rk4_step(system, stop.time, numbers, t - stop.time) for t in times.tolist()])


def _giving_way(system: RollingSystem, at: Samples, follows: PhaseStart) -> Samples:
    """Return samples in which slip has begun, all but zero: the contact force is that of slipping."""
    place = Vector.of(at.contact), Quaternion.of(at.orientation), Vector.of(at.angular_velocity)
    direction = follows.law.direction(system, follows.time, follows.state_vector)
    held = isinstance(follows.law, SlippingLaw) and follows.law.held
    R = slip(system, at.time, *place, ZERO, at.support_columns, direction, held=held).reaction
    force = np.broadcast_to(R.array(), at.position.shape).copy()
    return replace(at, contact_force=force, phase=np.full(at.time.size, SLIPPING, dtype=np.int8))


def _telling(progress: Progress | None, times: Array) -> Progress | None:
    """Return what tells the fraction of the whole run, given an instant."""
    if progress is None:
        return None
    first, span = float(times[0]), max(float(times[-1] - times[0]), 1e-300)
    return lambda t: progress(min(1.0, max(0.0, (t - first) / span)))


def _spinning_on(system: RollingSystem, law: Law, stop: ZeroCrossing) -> bool:
    ends = stop.name.endswith("stop") if law.code == ROLLING else law.turning == "held" and stop.name.endswith("grip")
    return ends and transitions.spins_on(system, law, stop)


def _end(system: RollingSystem, stop: ZeroCrossing, samples: Samples | None = None) -> Event:
    """Return the event with which a run ends, given the sample there."""
    name = "spot" if stop.name.endswith(("stop", "grip")) else stop.name
    said = ended_in_words(system, name, stop.time)
    if samples is None:
        return Event(stop.time, name, said)
    state, contact = samples.state(0), tuple(samples.contact[0].tolist())
    return Event(state.time, name, said, state, state, contact)


def ended_in_words(system: RollingSystem, name: str, time: float) -> str:
    """Return what happened where an event of a name ended a run."""
    said = ENDS[name].format(
        rim=float(system.support.surface.rim or 0.0),
        end=system.support.surface.domain_end,
        left=system.body.shape.validity_end,
    )
    return f"{said} at t = {time:.9g} s"


def following_stop(system: RollingSystem, law: Law, stop: ZeroCrossing) -> PhaseStart:
    """Return what follows a stop, or say that nothing can be worked out there."""
    try:
        past = focal.past_it(system, law, stop) if focal.is_focal(law, stop) else None
        return transitions.after(system, law, stop) if past is None else past
    except (ArithmeticError, ValueError) as error:
        raise SolverError(
            f"What follows at t = {stop.time:.9g} s cannot be worked out ({error}): the contact is singular there."
        ) from None


def _check_count(system: RollingSystem, events: list[Event]) -> None:
    """Refuse what would go on for ever."""
    if len(events) > _MOST_EVENTS:
        raise SolverError(
            f"More than {_MOST_EVENTS} events by t = {events[-1].time:.9g} s: the contact chatters. Ask for a shorter "
            "run, or give the landing a smaller restitution."
        )
    recent = events[-_AT_ONE_INSTANT:]
    if len(recent) == _AT_ONE_INSTANT and recent[-1].time - recent[0].time <= 1e-14 * abs(recent[-1].time):
        kinds = ", ".join(dict.fromkeys(event.kind for event in recent))
        raise SolverError(
            f"No phase goes on at t = {recent[-1].time:.9g} s ({kinds}): rigid contact has no answer there. Change the "
            "friction, or round the body off."
        )
    for count, share in _CHATTER:
        if len(events) >= count and _within(system, events[-count:], share):
            kinds = ", ".join(dict.fromkeys(event.kind for event in events[-count:]))
            last, span = events[-1].time, events[-1].time - events[-count].time
            raise SolverError(
                f"The contact chatters at t = {last:.9g} s: {count} events ({kinds}) within {span:.2g} s. Does a "
                "couple that acts while they touch throw the body off, and its absence let it come back?"
            )


def _within(system: RollingSystem, events: Sequence[Event], share: float) -> bool:
    """Tell whether events come within a share of the time in which the motion changes."""
    span, last = events[-1].time - events[0].time, events[-1].after
    if last is None:
        return False
    contact = events[-1].contact
    reach = math.dist(last.position, contact or last.position)
    if contact and span * math.hypot(*last.velocity) >= share * reach:
        return False  # as at nearly every event: then the time in which the motion changes need not be worked out
    return bool(span < share * transitions.moment(system, last, contact))


def cut(times: Array, end: float) -> tuple[Array, Array]:
    """Part ascending instants where something ends.

    Examples
    --------
    >>> [part.tolist() for part in cut(np.array([0.0, 1.0, 2.0]), 1.0)]
    [[0.0], [1.0, 2.0]]
    """
    count = int(times.searchsorted(end))
    return times[:count], times[count:]
