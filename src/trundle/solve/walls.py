"""The end of a run where another part of the body comes to the support: no law of one contact sees a second wall."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..mechanics.algebra import Quaternion, Vector
from ..mechanics.overlap import TOUCHING, depths, fits_anywhere
from ..mechanics.system import RollingSystem
from .phases import ended_in_words
from .samples import Array, Event, Samples

WALL = "wall"
_LOOKS = 256  # at a run, evenly in its time
_SHORT = 0.5  # of the time asked for, before which a run that ends has been looked at too seldom
_PARTS, _PASSES = 17, 14  # into which the time between two of them is cut, again and again
_AT_ONCE = 64  # instants, at each of which hundreds of points of the body are looked at
_CLOSE = 1e-13  # of a run's time, by which what is found from other looks may be another instant
_COARSER = 100.0  # times a method's tolerance, by which the contact itself may lie beside the surface


@dataclass(frozen=True)
class UpToWall:
    """A run that ends where another part of the body comes to the support.

    Parameters
    ----------
    run : callable
        Takes ascending instants, s, and returns the samples of one and the same run, whatever the body runs into.
    system : RollingSystem
        What moves.
    begin, end : float
        Of the run, s.
    tolerance : float
        Of the method.

    Examples
    --------
    A ball of 2 cm in a valley of two walls that meet at a right angle:

    >>> import trundle as tr
    >>> valley = tr.Support(tr.HeightField("sqrt(x**2 + 1e-12)"))
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.02, 1.0), valley)
    >>> (event,) = tr.simulate(system, system.place((-0.05, 0.0)), 1.0, 0.1).events
    >>> event.kind, [round(x, 6) + 0.0 for x in event.before.position]
    ('wall', [0.0, 0.0, 0.028284])
    """

    run: Callable[[Array], Samples]
    system: RollingSystem
    begin: float
    end: float
    tolerance: float

    def __call__(self, times: Array) -> Samples:
        """Return the samples at ascending instants, s, none before the start."""
        wall = self.wall
        if wall is None or not times.size or times[-1] < wall - _CLOSE * (self.end - self.begin):
            return self.run(times)
        found = self.run(np.append(times[times < wall], wall))
        state, contact = found.state(-1), tuple(found.contact[-1].tolist())
        event = Event(wall, WALL, ended_in_words(self.system, WALL, wall), state, state, contact)
        return replace(found, events=(*found.events, event))

    @cached_property
    def wall(self) -> float | None:
        """When it comes there, s; None where it does not."""
        clear, reached, between = self.begin, None, looks(self.begin, self.end)
        for _ in range(0 if fits_anywhere(self.system) else _PASSES):
            at = self.run(between)
            if reached is None and self.is_short(at):
                at = self.run(looks(self.begin, float(at.time[-1])))
            over = np.flatnonzero(self.runs_into(at))
            if not over.size:
                break
            clear = float(at.time[over[0] - 1]) if over[0] else clear
            reached = float(at.time[over[0]])
            inside = np.linspace(clear, reached, _PARTS + 1)[1:-1]
            between = np.append(inside[(inside > clear) & (inside < reached)], reached)
        return reached

    def is_short(self, at: Samples) -> bool:
        """Tell whether a run is over so soon that looks at all of the time asked for are few."""
        return bool(at.time[-1] - self.begin < _SHORT * (self.end - self.begin))

    def runs_into(self, at: Samples) -> NDArray[np.bool_]:
        """Tell where another part of the body is below the surface."""
        return reach(self.system, at) > slack(self.tolerance)


def slack(tolerance: float) -> float:
    """Return how far a part may be below the surface, as a share of the size: the contact is as far beside it."""
    return max(TOUCHING, _COARSER * tolerance)


def looks(begin: float, end: float) -> Array:
    """Return when a run is looked at, s."""
    return np.unique(np.linspace(begin, end, _LOOKS + 1))


def reach(system: RollingSystem, at: Samples) -> Array:
    """Return how far the deepest part of a body is below the surface at some instants, as a share of its size."""
    parts = (at.part(slice(first, first + _AT_ONCE)) for first in range(0, at.time.size, _AT_ONCE))
    return np.concatenate(
        [_below(system, part) / np.linalg.norm(part.contact - part.position, axis=1) for part in parts]
    )


def _below(system: RollingSystem, at: Samples) -> Array:
    time, *coordinates = (column[:, None] for column in (at.time, *at.support_columns))
    centre, q = Vector(*at.position.T[..., None]), Quaternion(*at.orientation.T[..., None])
    return depths(system, system.support.motion.at(time, *coordinates), centre, q)[0]
