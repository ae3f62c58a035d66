"""Rolling, slipping, flight and rest: which follows which, and when (theory page, section 4).

A run is a chain of stretches, each by one law to its first stop. What comes next is read off the state there: the gap,
the slip, the normal force, the friction cone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import zip_longest
from typing import Any, Protocol

import numpy as np

from ..errors import SolverError
from ..mechanics.algebra import ZERO, Quaternion, Vector
from ..mechanics.slipping import slip
from ..mechanics.system import RollingSystem, State
from . import following
from .following import Next, Stop
from .laws import Law, RollingLaw
from .samples import SLIPPING, Array, Event, Progress, Samples

_MOST_EVENTS = 10_000
_AT_ONCE = 20  # events at one instant: more means that no phase goes on
_MANY, _MANY_WITHIN = 50, 1e-3  # events, and the share of the time in which the motion changes: no bounces are so close
_ENDS = {
    "rim": "ran off the rim ({rim:g} m from the axis)",
    "end": "came to {end}",
    "edge": "{left}, which its shape does not cover",
    "curved": "came where the support is as hollow as the body is round: 1 + C S is singular",
    "spot": "stopped rolling while it still spins about the normal, which is not covered",
}


class Known(Protocol):
    """What completes the states of a method that knows more than a law's numbers; of several stretches at once."""

    def goes_on(self, other: Any) -> bool:
        """Tell whether the stretch that follows can be completed with this one."""

    def record(self, system: RollingSystem, stretches: list[Stretch]) -> Samples:
        """Return the samples of stretches of which each goes on with the next, this one's first."""


@dataclass(frozen=True)
class Stretch:
    """One law's part of a run: states at the times before its stop, if it came to one."""

    times: Array
    states: Array
    stop: Stop | None
    known: Known | None = None  # what completes the states, if not the law
    samples: Samples | None = None  # completed already


Part = Samples | tuple[Law, Stretch]  # of a run: known, or to be completed
Integrate = Callable[[RollingSystem, Next, Array, float, Progress | None], Stretch]


def solve(
    integrate: Integrate,
    system: RollingSystem,
    start: State,
    times: Array,
    tolerance: float,
    progress: Progress | None = None,
    *,
    creeps: bool = True,
) -> Samples:
    """Follow a body through its phases and return its samples with all events.

    Parameters
    ----------
    integrate : callable
        A method's way through one stretch.
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
    creeps : bool
        Whether slip whose direction settles at once is a phase of its own to the method; to a closed form it is slip.

    Returns
    -------
    Samples
        At `times`, cut where the run ends early.

    Raises
    ------
    SolverError
        If the method breaks down, or events follow each other without end.
    """
    events: list[Event] = []
    parts: list[Part] = []
    begin = _same if creeps else following.slipping
    now = begin(system, following.at_start(system, start))
    events += now.events
    left, told = times, _telling(progress, times)
    if now.time > start.time:  # it slips from rest: its first moment is behind it
        held = RollingLaw()
        left = _across(system, held, Stop(start.time, "", np.array(held.pack(system, start))), now, left, parts)
    while True:
        stretch = integrate(system, now, left, tolerance, told)
        parts.append((now.law, stretch) if stretch.samples is None else stretch.samples)
        if stretch.stop is None:
            break
        stop, law = stretch.stop, now.law
        if stop.name in _ENDS or _spinning_on(system, law, stop):
            samples, event = _ended(system, law, stop)
            parts.append(samples)
            events.append(event)
            break
        now = begin(system, _following(system, law, stop))
        events += now.events
        _check_count(system, events)
        left = _across(system, law, stop, now, left[left >= stop.time], parts)
    recorded = _recorded(system, parts)
    kept = [part for part in recorded if part.time.size] or recorded[:1]
    form = next((part.form for part in recorded if part.form is not None), None)
    return replace(Samples.joined(kept, tuple(events)), form=form)


def _same(system: RollingSystem, now: Next) -> Next:  # noqa: ARG001
    return now


def _recorded(system: RollingSystem, parts: list[Part]) -> list[Samples]:
    """Return all parts as samples; those that follow each other in one and the same way are completed together."""
    found: list[Samples] = []
    waiting: list[Stretch] = []
    for part, ahead in zip_longest(parts, parts[1:]):
        if isinstance(part, Samples):
            found.append(part)
            continue
        waiting.append(part[1])
        if isinstance(ahead, tuple) and _goes_on(part, ahead):
            continue
        found.append(_completed(system, part[0], waiting))
        waiting = []
    return found


def _goes_on(part: tuple[Law, Stretch], ahead: tuple[Law, Stretch]) -> bool:
    known = part[1].known
    return part[0] is ahead[0] if known is None else known.goes_on(ahead[1].known)


def _completed(system: RollingSystem, law: Law, stretches: list[Stretch]) -> Samples:
    if stretches[0].known is not None:
        return stretches[0].known.record(system, stretches)
    times = np.concatenate([one.times for one in stretches])
    return law.record(system, times, np.concatenate([one.states for one in stretches]))


def _across(system: RollingSystem, law: Law, stop: Stop, follows: Next, left: Array, parts: list[Part]) -> Array:
    """Add the samples in the short step across an event, and return the times after it."""
    early = left[left < follows.time]
    if early.size:
        steps = [law.advanced(system, stop.time, stop.numbers.tolist(), t - stop.time) for t in early.tolist()]
        samples = law.record(system, early, np.array(steps))
        parts.append(_giving_way(system, samples, follows) if follows.law.code == SLIPPING else samples)
    return left[early.size :]


def _giving_way(system: RollingSystem, at: Samples, follows: Next) -> Samples:
    """Return samples in which slip has begun, all but zero: the contact force is that of slipping."""
    place = Vector.of(at.contact), Quaternion.of(at.orientation), Vector.of(at.angular_velocity)
    direction = follows.law.direction(system, follows.time, follows.numbers)
    R = slip(system, at.time, *place, ZERO, at.support_own, direction).reaction
    force = np.broadcast_to(R.array(), at.position.shape).copy()
    return replace(at, contact_force=force, phase=np.full(at.time.size, SLIPPING, dtype=np.int8))


def _telling(progress: Progress | None, times: Array) -> Progress | None:
    """Return what tells the fraction of the whole run, given an instant."""
    if progress is None:
        return None
    first, span = float(times[0]), max(float(times[-1] - times[0]), 1e-300)
    return lambda t: progress(min(1.0, max(0.0, (t - first) / span)))


def _spinning_on(system: RollingSystem, law: Law, stop: Stop) -> bool:
    return stop.name.endswith("stop") and following.spins_on(system, law, stop)


def _ended(system: RollingSystem, law: Law, stop: Stop) -> tuple[Samples, Event]:
    samples = law.record(system, np.array([stop.time]), stop.numbers[None])
    name = "spot" if stop.name.endswith("stop") else stop.name
    surface, state, contact = system.support.surface, samples.state(0), tuple(samples.contact[0].tolist())
    said = _ENDS[name].format(rim=float(surface.rim or 0.0), end=surface.end, left=system.body.shape.left)
    return samples, Event(state.time, name, f"{said} at t = {state.time:.9g} s", state, state, contact)


def _following(system: RollingSystem, law: Law, stop: Stop) -> Next:
    """Return what follows a stop, or say that nothing can be worked out there."""
    try:
        return following.after(system, law, stop)
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
    recent = events[-_AT_ONCE:]
    if len(recent) == _AT_ONCE and recent[-1].time - recent[0].time <= 1e-14 * abs(recent[-1].time):
        kinds = ", ".join(dict.fromkeys(event.kind for event in recent))
        raise SolverError(
            f"No phase goes on at t = {recent[-1].time:.9g} s ({kinds}): rigid contact has no answer there. Change the "
            "friction, or round the body off."
        )
    many = events[-_MANY:]
    if len(many) < _MANY or many[-1].after is None:
        return
    span = many[-1].time - many[0].time
    if span < _MANY_WITHIN * following.moment(system, many[-1].after):
        kinds = ", ".join(dict.fromkeys(event.kind for event in many))
        raise SolverError(
            f"The contact chatters at t = {many[-1].time:.9g} s: {_MANY} events ({kinds}) within {span:.2g} s. Does a "
            "couple that acts while they touch throw the body off, and its absence let it come back?"
        )


def upto(stop: Stop, times: Array, states: Array) -> Stretch:
    """Return a stretch up to its stop.

    Parameters
    ----------
    stop : Stop
        Where it ended.
    times : array (n,)
        Those asked for, ascending, s.
    states : array (m, ...)
        At the first m of them; there may be more than come before the stop, since a method counts from an instant of
        its own and rounding joins what lies close together.

    Returns
    -------
    Stretch
        With the times before the stop.

    Examples
    --------
    >>> stop = Stop(1.5, "lift", np.ones(1))
    >>> upto(stop, np.array([0.0, 1.0, 1.6, 2.0]), np.zeros((3, 1))).times.tolist()
    [0.0, 1.0]
    """
    before = times[times < stop.time]
    return Stretch(before, states[: before.size], stop)
