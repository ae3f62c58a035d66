"""A run gone through once, from which samples at any instants are read."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..mechanics.kinks import kinks_and_jolts
from ..mechanics.system import RollingSystem, State
from . import phases, transitions
from .phases import Follows, Integrate, Segment, cut
from .samples import Array, Progress, Samples
from .transitions import PhaseStart, ZeroCrossing
from .walls import UpToWall

_MOST_STEPS = 100_000  # kept, of some two or three kilobytes each
_MARKS = 10_000  # states on the way through a stretch of more
_OF_AN_EVENT = 1e7  # products that take as long as an event


@dataclass(frozen=True)
class Leg:
    """One law's part of a run."""

    states: Callable[[Array], Array]  # takes instants of it, ascending, s; returns the states, (n, variables)
    stop: ZeroCrossing | None  # where it ended; None at the end of the run
    steps: int  # that it took
    work: float  # that they took, products: counted, never timed
    begins: Array  # of the steps, s; none where they are not known


@dataclass(frozen=True)
class TooMany:
    """A stretch of more steps than are kept."""

    states: Callable[[Array], Array]  # takes instants up to where the kept steps led, as `Leg` does
    steps: int  # so many
    work: float  # as of `Leg`
    begins: Array
    time: float  # how far they led, s
    state_vector: Array  # there


Keep = Callable[[RollingSystem, PhaseStart, float, float, int], Leg | TooMany]


class Dense:
    """A run gone through once: each stretch, and what follows it, is worked out when it is first asked for.

    Parameters
    ----------
    keep : callable
        A method's way through one stretch to its stop or the run's end, of which it keeps all steps if they are not
        too many.
    beside : callable
        Returns the same method's way to given instants, for stretches of too many steps and for runs beside this one.
    system : RollingSystem
        What moves.
    start : State
        From where.
    end : float
        Of the run, s.
    tolerance : float
        Of the method.
    """

    def __init__(
        self,
        keep: Keep,
        beside: Callable[[], Integrate],
        system: RollingSystem,
        start: State,
        end: float,
        tolerance: float,
    ) -> None:
        self.keep, self.beside = keep, beside
        self.system, self.start, self.end, self.tolerance = system, start, end, tolerance
        self.bends = kinks_and_jolts(system, start.time, end)
        self.up_to_wall = UpToWall(self._sampled, system, start.time, end, tolerance)
        self.legs: list[Leg] = []
        self.steps = 0  # about how many they took
        self.ends: list[float] = []  # of the legs, s
        self.follows: dict[int, PhaseStart | None] = {}

    def __call__(self, times: Array) -> Samples:
        """Return the samples at ascending instants, s, none before the start."""
        return self.up_to_wall(times)

    def _sampled(self, times: Array) -> Samples:
        """Return the same, whatever the body runs into."""
        self.passed = 0
        known: Any = {"remember": self._remember, "bends": self.bends}
        return phases.solve(self._through, self.system, self.start, times, self.tolerance, **known)

    def like_it(self, start: State, times: Array) -> Samples:
        """Return the samples of a run from another start, with what this one has found worth compiling with care."""
        return phases.solve(self.beside(), self.system, start, times, self.tolerance)

    @property
    def work(self) -> float:
        """About how much work it took, products."""
        return sum(_OF_AN_EVENT + leg.work for leg in self.legs)

    def work_until(self, times: Array) -> Array:
        """Return about how much work it took from its start to some instants, products."""
        edges, taken, before = [np.array([self.start.time])], [np.zeros(1)], 0.0
        for leg, end in zip(self.legs, self.ends, strict=True):
            edges.append(np.append(leg.begins, end))
            taken.append(before + np.linspace(0.0 if leg.begins.size else leg.work, leg.work, leg.begins.size + 1))
            before += _OF_AN_EVENT + leg.work
        return np.interp(times, np.concatenate(edges), np.concatenate(taken))

    def _through(
        self, system: RollingSystem, now: PhaseStart, times: Array, tolerance: float, progress: Progress | None
    ) -> Iterator[Segment]:
        """Read a stretch off what is kept of it."""
        if self.passed == len(self.legs):
            leg = self._leg(system, now, times, tolerance, progress)
            self.legs.append(leg)
            self.steps += leg.steps
            self.ends.append(self._end_after(now) if leg.stop is None else leg.stop.time)
        leg, self.passed = self.legs[self.passed], self.passed + 1
        stop = leg.stop if times.size and leg.stop is not None and leg.stop.time <= times[-1] else None
        here = times if stop is None else cut(times, stop.time)[0]
        yield Segment(here, leg.states(here) if here.size else np.empty((0, len(now.state_vector))), stop)

    def _leg(
        self, system: RollingSystem, now: PhaseStart, times: Array, tolerance: float, progress: Progress | None
    ) -> Leg:
        """Go through a stretch, and keep its steps, or where they are too many, some states on its way."""
        end, left = self._end_after(now), _MOST_STEPS - self.steps
        kept = self.keep(system, now, end, tolerance, left) if left > 0 else None
        if isinstance(kept, Leg):
            return kept
        first = now if kept is None else transitions.later(system, now, kept.time, kept.state_vector)
        instants = np.linspace(first.time, end, 2 + _MARKS // (1 + len(self.legs)))
        instants = np.union1d(times[times > first.time], instants)
        parts = list(self.beside()(system, first, instants, tolerance, progress))
        stop, marks = parts[-1].stop, _Marks(self.beside, system, first, tolerance, parts)
        if kept is None:
            return Leg(marks.states, stop, 0, 0.0, np.zeros(0))
        share = (kept.time - now.time) / ((end if stop is None else stop.time) - now.time)

        def states(at: Array) -> Array:
            before, behind = cut(at, kept.time)
            return np.vstack([kept.states(before), marks.states(behind)])

        longer = 1 / max(share, 1e-6)
        steps = max(kept.steps, int(kept.steps * longer))
        return Leg(states, stop, steps, kept.work * max(1.0, longer), np.zeros(0))

    def _end_after(self, now: PhaseStart) -> float:
        """Return up to when a law may be followed: the next kink, or the end, s."""
        return next((kink.behind for kink in self.bends if kink.behind > now.time), self.end)

    def _remember(self, follows: Follows, *_: Any) -> PhaseStart | None:
        """Return what follows the stretch just passed."""
        if self.passed not in self.follows:
            self.follows[self.passed] = follows()
        return self.follows[self.passed]


class _Marks:
    """A stretch of too many steps, of which the states at some instants are kept: from there it is gone on with.

    Parameters
    ----------
    beside : callable
        As of `Dense`.
    system, now, tolerance
        As it takes them, from the stretch's beginning.
    parts : list of Stretch
        What came of all of it.
    """

    def __init__(
        self,
        beside: Callable[[], Integrate],
        system: RollingSystem,
        now: PhaseStart,
        tolerance: float,
        parts: list[Segment],
    ) -> None:
        self.beside, self.system, self.tolerance = beside, system, tolerance
        self.begin = now
        self.times = np.concatenate([[now.time], *(part.times for part in parts)])
        self.known = np.vstack([np.asarray(now.state_vector, dtype=float)[None], *(part.states for part in parts)])

    def states(self, times: Array) -> Array:
        """Return the states at some instants before the stop, ascending, s."""
        which = np.searchsorted(self.times, times, side="right") - 1
        found = self.known[which]
        off = times > self.times[which]
        for mark in np.unique(which[off]).tolist():
            rows = np.flatnonzero(off & (which == mark))
            parts = list(self.beside()(self.system, self._from(mark), times[rows], self.tolerance, None))
            states = np.vstack([part.states for part in parts])
            found[rows[: len(states)]] = states
            if len(states) < rows.size and parts[-1].stop is not None:  # a rounding sooner
                found[rows[len(states) :]] = parts[-1].stop.state_vector
        return found

    def _from(self, mark: int) -> PhaseStart:
        """Return the law as it goes on from an instant."""
        return transitions.later(self.system, self.begin, float(self.times[mark]), self.known[mark])
