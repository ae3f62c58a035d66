"""The stretches of a run between events and kinks of its formulas, and the instants at which each is looked at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..mechanics.kinks import kinks
from ..mechanics.system import RollingSystem
from ..solve.contact_state import moment
from ..solve.samples import SLIPPING, Samples
from .bounds import Array, pace_of
from .law import WINDOWS, window_times

_MARGIN = 0.02  # of a stretch that is left out at its ends: slip turns faster and faster before it ends
_PHASE_A_PANEL = 1.5  # rad of the fastest rotation
_WIDE = 16  # how many of these a panel holds at first
_MOST_PANELS = 8000
_QUARTERINGS = 11
_FIRST = 2e-6  # of the time in which a motion changes: twice what the first moment of slip takes
_ASIDE = 1e-6  # of a stretch, at its ends, over which the energy is not balanced


@dataclass(frozen=True)
class SmoothSegment:
    """A part of a run in which one law holds, smooth in the time."""

    begin: float  # s
    end: float  # s
    pace: float  # the fastest rate in it, 1/s
    slips: bool = False  # whether the body slips in it
    damped: bool = False  # whether something acts that may have done most of its work in the first moments
    settling: float = 0.0  # how long its first moment lasts, in which slip may begin, s

    @property
    def length(self) -> float:
        """How long it lasts, s."""
        return self.end - self.begin

    def windows(self, share: float) -> Array:
        """Return short windows for slopes, a share of all of them."""
        count = max(1, round(WINDOWS * share))
        inset = _MARGIN * self.length if share < 1 else 0.0
        first = self.begin + max(inset, min(self.settling, 0.5 * self.length))
        times = window_times(first, self.end - inset, self.pace)
        return times[:: max(1, WINDOWS // count)][:count]

    def panels(self) -> Array:
        """Return the beginning and end of each panel that a quadrature over it begins with, (panels, 2), s.

        Of a ball's own turning its power mostly knows nothing, so they are wide; what is rough in them is cut.
        """
        count = int(np.clip(np.ceil(self.length * self.pace / (_WIDE * _PHASE_A_PANEL)), 1, _MOST_PANELS))
        # In a run followed anew an event may lie a little sooner or later.
        aside = min(max(_ASIDE * self.length, self.settling), 0.25 * self.length)
        begin, end = self.begin + aside, self.end - _ASIDE * self.length
        edges = np.linspace(begin, end, count + 1)
        nearer = (end - begin) * 0.25 ** np.arange(1, _QUARTERINGS)
        if self.slips or self.damped:  # closer and closer to where it begins
            edges = np.union1d(edges, begin + nearer)
        if self.slips:  # and towards its end, where the slip turns fast
            edges = np.union1d(edges, end - nearer)
        return np.stack([edges[:-1], edges[1:]], axis=1)

    @property
    def resolved(self) -> bool:
        """Whether the panels are enough to follow all of it."""
        return self.length * self.pace / _PHASE_A_PANEL <= _MOST_PANELS


def stretches(system: RollingSystem, begin: float, samples: Samples) -> list[SmoothSegment]:
    """Cut a run at its events, and where a formula in the time has a kink.

    Examples
    --------
    >>> import trundle as tr
    >>> run = tr.Scenario.load("off-the-rim").run()
    >>> [round(stretch.end, 3) == round(run.events[0].time, 3) for stretch in stretches(run.system, 0.0, run.samples)]
    [True]
    """
    end = float(samples.time[-1])
    going_on = [event for event in samples.events if not event.final]
    settling = {
        event.time: _FIRST * moment(system, event.after, event.contact) for event in going_on if event.after is not None
    }
    if samples.phase[0] == SLIPPING:
        settling.setdefault(begin, _FIRST * moment(system, samples.state(0)))
    happenings = [event.time for event in samples.events] + [kink.time for kink in kinks(system, begin, end)]
    edges = sorted({begin, *(time for time in happenings if begin < time < end), end})
    damped = bool(system.loads) or system.support.motion.free
    found: list[SmoothSegment] = []
    first, settles = begin, settling.get(begin, 0.0)
    for last in edges[1:]:
        if last - first <= 1e-12 * (end - begin):  # one and the same instant
            settles = max(settles, settling.get(last, 0.0))
            continue
        inside = np.flatnonzero((samples.time >= first) & (samples.time <= last))
        part = samples.part(inside) if inside.size > 2 else samples
        pace = pace_of(system, part) + 1 / (last - first)
        slips = bool((part.phase == SLIPPING).any())
        found.append(SmoothSegment(first, last, pace, slips, damped, settles))
        first, settles = last, settling.get(last, 0.0)
    return found
