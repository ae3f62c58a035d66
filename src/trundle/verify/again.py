"""The method run a second time, at instants of the card's own choice: short windows for slopes, and all events."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import SolverError
from ..mechanics.kinks import Kink, kinks
from ..mechanics.system import RollingSystem, State
from ..solve.dense import Dense
from ..solve.methods import Method
from ..solve.samples import FLIGHT, RESTING, ROLLING, SLIPPING, Samples
from .bounds import EXACT, SOLVER, Array
from .card import CardFigure, checked
from .events import instants_of
from .law import Residuals, narrowed, residuals, roughness, window_sizes
from .stretches import SmoothSegment, stretches

_RUN_AGAIN = 2000  # samples
_MOST_STRETCHES = 200  # looked at
_NARROWINGS = 10  # of windows in which the motion changes faster than its samples show
_SMOOTH = 0.1  # of the bound: of what a polynomial may leave of a slope
_SEEN = 3.0  # rad in a window: a polynomial follows no more
_LATER = 1e-6  # of the run
_SHORTEST = 1e-9  # of what the clock shows: in less, instants have too few digits


@dataclass(frozen=True)
class Again:
    """A run followed once more by its own method.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("off-the-rim").run()
    >>> again = Again(run.system, run.start, run.samples, Method.of("exact"))
    >>> [figure.name for figure in again.figures()][:2]
    ['no slip', 'velocity is the slope of the path']
    """

    system: RollingSystem  # what moved
    start: State  # where it started
    at: Samples  # the run
    method: Method  # that made it

    @cached_property
    def _run(self) -> Callable[[Array], Samples]:
        """The second run, gone through once: all looks are at the same motion."""
        return self.method.dense(self.system, self.start, self._end)

    @property
    def kept(self) -> Dense | None:
        """The same where a numerical method made it."""
        return self._run if isinstance(self._run, Dense) else None

    @property
    def _ended(self) -> bool:
        return any(event.final for event in self.at.events)

    @property
    def _end(self) -> float:
        """Up to when it is followed, s: what ended may end a rounding later."""
        end = float(self.at.time[-1])
        return end + _LATER * (end - self.start.time) if self._ended else end

    @cached_property
    def itself(self) -> Samples:
        """The second run where the first was sampled: where a rounding grows, its events are others in the end."""
        times = self.at.time[: -1 if self._ended else None]
        return self._run(np.unique([self.start.time, *times, self._end]))

    @cached_property
    def stretches(self) -> list[SmoothSegment]:
        """What lies between its events, and between kinks of its formulas."""
        return stretches(self.system, self.start.time, self.itself)

    @cached_property
    def kinks(self) -> list[Kink]:
        """Where the velocity of the support may jump."""
        return kinks(self.system.support.motion, self.start.time, float(self.at.time[-1]))

    @cached_property
    def windows(self) -> Array:
        """Instants of short windows, spread over the stretches that are long enough to have slopes."""
        return self._followed[0]

    @cached_property
    def _first_windows(self) -> Array:
        total = sum(stretch.length for stretch in self.stretches)
        least = _SHORTEST * max(abs(self.start.time), abs(float(self.at.time[-1])))
        long = [stretch for stretch in self.stretches if stretch.length > max(least, 2 * stretch.settling)]
        long = long or self.stretches
        return np.vstack([stretch.windows(stretch.length / total) for stretch in long[:_MOST_STRETCHES]])

    @cached_property
    def _followed(self) -> tuple[Array, Samples]:
        """The windows, each so narrow that a polynomial follows the motion through it, and the second run."""
        first = best = self._first_windows
        found = self._solve(first)
        looked_at = _at(found, first.ravel())
        sizes = window_sizes(self.system, looked_at, first, self.bound)
        windows, least = first.copy(), roughness(looked_at, first, sizes)
        rest = least.copy()
        for _ in range(_NARROWINGS):
            rough = rest > _SMOOTH * self.bound
            if not rough.any():
                break
            windows[rough] = narrowed(windows[rough])
            own = tuple(size[rough] for size in sizes)
            rest[rough] = roughness(self.follow(windows[rough].ravel()), windows[rough], own)
            best = np.where((rest < least)[:, None], windows, best)  # elsewhere it is rounding that is rough
            least = np.minimum(rest, least)
        return best, found if best is first else self._solve(best)

    @cached_property
    def sampled(self) -> Samples:
        """The samples that are compared with the second run."""
        return self.at.part(slice(None, None, max(1, self.at.time.size // _RUN_AGAIN)))

    @property
    def samples(self) -> Samples:
        """The second run: at the windows, the samples, both ends and the events."""
        return self._followed[1]

    def _solve(self, windows: Array) -> Samples:
        """Run the method at these windows, the samples, both ends and the events."""
        ends = np.array([self.start.time, self.at.time[-1]])
        times = np.concatenate([windows.ravel(), self.sampled.time, ends])
        events = self.itself.events
        for _ in range(2):  # what was gone through again, not kept, may have its events a rounding aside
            now = np.unique(np.concatenate([times, instants_of(events, self.start.time, self.kinks)]))
            found = self._run(now[now <= ends[1]])
            if [event.time for event in found.events] == [event.time for event in events]:
                break
            events = found.events
        return found

    def places(self, wanted: Array) -> Samples:
        """Return the second run at some of its instants; the last one for what a run's end left out."""
        return _at(self.samples, wanted)

    def follow(self, times: Array) -> Samples:
        """Follow the run to other instants, ascending, s."""
        there = self._run(np.unique(times))
        return there.part(np.minimum(np.searchsorted(there.time, times), there.time.size - 1))

    @property
    def bound(self) -> float:
        """Of a slope: taken over a third of a radian of turning, it multiplies a method's own error by some tens."""
        return max(EXACT * 10, 100 * SOLVER * self.method.tolerance)

    @cached_property
    def _looked_at(self) -> tuple[Residuals, Any]:
        looked_at = self.places(self.windows.ravel())
        return residuals(self.system, looked_at, self.windows, self.bound), set(looked_at.phase.tolist())

    @cached_property
    def _turns_too_fast(self) -> bool:
        """Whether the clock has too few digits to show how the body turns, in any window: nothing narrower is told."""
        Omega = self.places(self.windows.ravel()).angular_velocity.reshape(*self.windows.shape, 3)
        turned = np.linalg.norm(Omega, axis=2).max(axis=1) * np.ptp(self.windows, axis=1)
        return bool((turned > _SEEN).all())

    def _of_orientation(self, name: str, value: float, note: str) -> CardFigure:
        """Return a figure of the slopes of the orientation; without a verdict where they cannot be seen."""
        if self._turns_too_fast:
            return CardFigure(name, value, note=f"{note}; between two instants it turns too far to tell: no verdict")
        return checked(name, value, self.bound, note)

    @cached_property
    def broken(self) -> str:
        """Why the second run comes to no end where the first did; empty where it does."""
        try:
            _ = self.samples
        except SolverError as error:
            return str(error)
        return ""

    def figures(self) -> Iterator[CardFigure]:
        """Yield what the slopes in the windows say: how it moves, and by which law."""
        if self.broken:
            yield checked("the method run again", math.inf, self.bound, f"it does not come through: {self.broken}")
            return
        (found, phases), bound, count = self._looked_at, self.bound, len(self.windows)
        if phases - {FLIGHT}:
            held, slips = bool(phases & {ROLLING, RESTING}), SLIPPING in phases
            said = " and ".join(["move alike"] * held + ["apart as s while it slips"] * slips)
            note = f"the two points that touch {said}; slopes of position, orientation and support"
            yield self._of_orientation("no slip" if held else "slip", found.slip, note)
        yield checked(
            "velocity is the slope of the path", found.path, bound, f"at {count} instants, share of the speed"
        )
        yield self._of_orientation("Ω is the slope of the orientation", found.turning, "2 q̇ q* against Ω, share of Ω")
        yield checked(
            "law of motion",
            found.law,
            bound,
            "Newton, Euler and the constraint as one 9×9 system, T2 not used; loads as given",
        )
        if ROLLING in phases:
            note = "over the admissible velocities (d'Alembert)"
            yield checked("virtual power of the reaction", found.virtual_power, bound, note)

    @property
    def can_be_followed(self) -> bool:
        """Whether its events are few, and its stretches slow, enough for a quadrature over all of it."""
        few = len(self.at.events) < _MOST_STRETCHES
        return few and all(stretch.resolved for stretch in self.stretches)


def _at(samples: Samples, wanted: Array) -> Samples:
    """Return some of the instants of a run; the last one for what its end left out."""
    return samples.part(np.minimum(np.searchsorted(samples.time, wanted), samples.time.size - 1))
