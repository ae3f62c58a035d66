"""A run gone through once, from which samples at any instants are read."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from ..mechanics.kinks import kinks
from ..mechanics.system import RollingSystem, State
from . import phases
from .following import Next, Stop
from .laws import Law
from .phases import Integrate, Stretch, cut
from .samples import Array, Progress, Samples

_MOST_STEPS = 50_000  # kept, of some two or three kilobytes each


@dataclass(frozen=True)
class Leg:
    """One law's part of a run.

    Parameters
    ----------
    states : callable
        Takes instants of it, ascending, s; returns the states, (n, variables).
    stop : Stop or None
        Where it ended; None at the end of the run.
    steps : int
        That are kept for it.
    """

    states: Callable[[Array], Array]
    stop: Stop | None
    steps: int


Keep = Callable[[RollingSystem, Next, float, float, int], Leg | None]


class Dense:
    """A run gone through once: each stretch, and what follows it, is worked out when it is first asked for.

    Parameters
    ----------
    keep : callable
        A method's way through one stretch to its stop or the run's end, of which it keeps all steps if they are not
        too many.
    integrate : callable
        The same method's way to given instants, for stretches of too many steps.
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
        integrate: Integrate,
        system: RollingSystem,
        start: State,
        end: float,
        tolerance: float,
    ) -> None:
        self.keep, self.integrate = keep, integrate
        self.system, self.start, self.end, self.tolerance = system, start, end, tolerance
        self.bends = kinks(system, start.time, end)
        self.legs: list[Leg | None] = []
        self.follows: dict[int, Next] = {}
        self.left = _MOST_STEPS

    def __call__(self, times: Array) -> Samples:
        """Return the samples at ascending instants, s, none before the start."""
        self.passed = 0
        known: Any = {"after": self._after, "bends": self.bends}
        return phases.solve(self._through, self.system, self.start, times, self.tolerance, **known)

    def _through(
        self, system: RollingSystem, now: Next, times: Array, tolerance: float, progress: Progress | None
    ) -> Iterator[Stretch]:
        """Read a stretch off what is kept of it."""
        if self.passed == len(self.legs):
            end = next((bend for bend in self.bends if bend > now.time), self.end)
            leg = self.keep(system, now, end, tolerance, self.left)
            self.legs.append(leg)
            self.left -= self.left if leg is None else leg.steps
        leg, self.passed = self.legs[self.passed], self.passed + 1
        if leg is None:
            yield from self.integrate(system, now, times, tolerance, progress)
            return
        stop = leg.stop if times.size and leg.stop is not None and leg.stop.time <= times[-1] else None
        here = times if stop is None else cut(times, stop.time)[0]
        yield Stretch(here, leg.states(here), stop)

    def _after(self, system: RollingSystem, law: Law, stop: Stop) -> Next:
        """Return what follows the stretch just passed."""
        if self.passed not in self.follows:
            self.follows[self.passed] = phases.following_stop(system, law, stop)
        return self.follows[self.passed]
