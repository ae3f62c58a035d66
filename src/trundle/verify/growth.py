"""What a motion does to a small difference: runs from starts changed by a known little, each in the phase of the start.

A numerical method errs a little at each step, about one a radian; these errors add up as a random walk, and the motion
magnifies them. How much, the change of a run from a changed start shows, divided by that change: its linear response.
Where that response is no longer small, two honest runs may be anywhere, and no comparison says anything.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..errors import SolverError
from ..mechanics.algebra import E_X, E_Z, Quaternion, Vector
from ..mechanics.contact import Contact, settle
from ..mechanics.placing import SLIP_TOLERANCE
from ..mechanics.system import RollingSystem, State
from ..solve.methods import Method
from ..solve.samples import Event, Samples
from .bounds import SOLVER, Array, largest

MOST = 1e-2  # of the size of a quantity: beyond it nothing is told
_NUDGE = 1e-10  # of the largest Ω: small beside a motion that magnifies it a millionfold, large beside rounding
_OVER_TOLERANCE = 100.0  # and so many times the method's tolerance
_MOST_NUDGE = 1e-4
_A_STEP = 10.0  # times its tolerance that a method may err in a step
_FLOOR = 1e-4  # of the change: of less, rounding is part
_INSTANTS = 200


@dataclass(frozen=True)
class Growth:
    """How many times larger than in the start a small change shows later in a motion.

    Parameters
    ----------
    times : array (n,)
        s.
    magnified : array (n,)
        The most up to each of them, of a change in the start or at any instant since: as shares of the sizes for each
        share of Ω.
    shifted : array (k,)
        The same of the times of the first k events, as shares of the run.
    until : float
        s, up to which the response is small and as large as the change; beyond it nothing can be told.
    """

    times: Array
    magnified: Array
    shifted: Array
    until: float

    def widened(self, bound: float, turned: float, magnified: Array) -> Array:
        """Return a bound by what the motion makes of a method's errors in so many radians."""
        return np.minimum(MOST, bound * np.maximum(1.0, _A_STEP * magnified * np.sqrt(max(turned, 1.0)) / SOLVER))

    def at(self, times: Array) -> Array:
        """Return how many times larger a change shows by then."""
        return self.magnified[np.clip(np.searchsorted(self.times, times), 0, self.times.size - 1)]

    def told_until(self, bound: float, turned: float) -> float:
        """Return up to when a bound so widened is small enough to tell anything, s."""
        lost = self.times[self.widened(bound, turned, self.magnified) >= MOST]
        return min(self.until, float(lost[0])) if lost.size else self.until


def alike(ours: Samples, theirs: Samples) -> NDArray[np.bool_]:
    """Return which of the samples of two runs at the same times have as many events behind them in both.

    Parameters
    ----------
    ours, theirs : Samples
        At the same times; an event may lie a rounding sooner in one.

    Returns
    -------
    array (n,) of bool
        Where they can be compared: what lies between the same event in both is another phase in each.
    """
    counts = (np.searchsorted([event.time for event in run.events], run.time, side="right") for run in (ours, theirs))
    mine, other = counts
    return mine == other


def at_the_same_times(ours: Samples, theirs: Samples) -> tuple[Samples, Samples]:
    """Return the samples of two runs at the times that both have: one may have ended sooner, at an instant of its own.

    Parameters
    ----------
    ours, theirs : Samples
        Ascending.

    Returns
    -------
    tuple of Samples
        As long as each other.
    """
    _, mine, others = np.intersect1d(ours.time, theirs.time, assume_unique=True, return_indices=True)
    return ours.part(mine), theirs.part(others)


def same_events(ours: tuple[Event, ...], theirs: tuple[Event, ...]) -> int:
    """Return how many events of two runs are of the same kinds, from the first on.

    Parameters
    ----------
    ours, theirs : tuple of Event
        Of two runs.

    Returns
    -------
    int
        The number.

    Examples
    --------
    >>> same_events((Event(0.1, "lift", ""), Event(0.2, "land", "")), (Event(0.1, "lift", ""), Event(0.2, "rim", "")))
    1
    """
    count = 0
    for mine, other in zip(ours, theirs, strict=False):
        if mine.kind != other.kind:
            break
        count += 1
    return count


def growth(
    system: RollingSystem, start: State, at: Samples, method: Method, difference: Callable[[Samples, Samples], Array]
) -> Growth:
    """Return what a motion does to a small change of its start.

    Parameters
    ----------
    system : RollingSystem
        What moves.
    start : State
        Where it starts.
    at : Samples
        Of the run: its times and how fast it turns.
    method : Method
        Follows the changed starts.
    difference : callable
        Takes two runs at the same times, returns their difference as a share of the sizes, (n,).

    Returns
    -------
    Growth
        The most that any of the changes shows.
    """
    method = numerical(method)
    times = np.union1d(at.time[:: max(1, at.time.size // _INSTANTS)], at.time[-1:])
    span = max(float(times[-1] - start.time), 1e-300)
    share = min(max(_NUDGE, _OVER_TOLERANCE * method.tolerance), _MOST_NUDGE)
    change = share * max(largest(at.angular_velocity), 1 / span)
    first, others = method.solve(system, start, times), []
    for begin in nudged(system, start, change):
        with suppress(SolverError):  # a changed start may come to where no law goes on
            others.append(method.solve(system, begin, times))
    until, found, shifted = float(times[-1]), np.zeros(times.size), np.zeros(len(first.events))
    for other in others:
        one, changed = at_the_same_times(first, other)
        where = np.minimum(np.searchsorted(times, one.time), times.size - 1)
        # Of a change in a direction between those tried, no more shows than their squares add up to.
        found[where] = np.hypot(found[where], np.where(alike(one, changed), difference(one, changed), 0.0))
        for i in range(same_events(first.events, other.events)):
            shifted[i] = np.hypot(shifted[i], (first.events[i].time - other.events[i].time) / span)
        until = min(until, parted(first, other))
    nonlinear = times[found > MOST]
    until = min(until, float(nonlinear[0])) if nonlinear.size else until
    # An error is made at any instant: what counts is the growth since the response was least.
    least = np.minimum.accumulate(np.clip(found / share, _FLOOR, 1.0))
    return Growth(times, np.maximum.accumulate(found / share / least), shifted / share, until)


def numerical(method: Method) -> Method:
    """Return a method that follows any start: itself, or beside a closed form the finest that there is.

    Parameters
    ----------
    method : Method
        Any.

    Returns
    -------
    Method
        Taylor's or Runge-Kutta.
    """
    from ..solve.taylor import available

    return method if method.name != "exact" else Method.of("taylor" if available() else "runge-kutta")


def parted(ours: Samples, theirs: Samples) -> float:
    """Return when two runs first meet different events, s; infinite where they do not.

    Parameters
    ----------
    ours, theirs : Samples
        Two runs over the same time.

    Returns
    -------
    float
        An event that one meets within a millionth of the run's end, the other may meet beyond it.
    """
    known = same_events(ours.events, theirs.events)
    rest = [run.events[known].time for run in (ours, theirs) if len(run.events) > known]
    end = float(max(ours.time[-1], theirs.time[-1]))
    near = 1e-6 * (end - float(min(ours.time[0], theirs.time[0])))
    return min((time for time in rest if time < end - near), default=float("inf"))


def nudged(system: RollingSystem, start: State, change: float) -> list[State]:
    """Return starts that move a little differently, in the phase in which the start finds itself.

    A body that rolls, rolls differently; one that slips, turns and slips differently along the support; one that flies,
    or is about to strike, turns and moves differently. A cylinder changes only what keeps it straight.

    Parameters
    ----------
    system : RollingSystem
        What moves.
    start : State
        Touching the support or over it.
    change : float
        Of Ω, rad/s; of V as much times |ρ|.

    Returns
    -------
    list of State
        One for each way in which a body can turn.

    Examples
    --------
    What slips backwards goes on slipping so:

    >>> import trundle as tr
    >>> cloth = tr.Support(tr.Plane(), friction=0.2)
    >>> system = tr.RollingSystem(tr.Body.solid_sphere(0.0286, 0.17), cloth)
    >>> start = system.place(velocity=(2.0, 0.3), angular_velocity=(5.0, -60.0, 20.0))
    >>> max(abs(state.velocity[0] - 2.0) for state in nudged(system, start, 1e-8)) < 1e-9
    True
    """
    q, V, Omega = Quaternion(*start.orientation), Vector(*start.velocity), Vector(*start.angular_velocity)
    contact = settle(system, start.time, Vector(*start.position), q, start.support)
    n, axis = contact.normal, system.body.shape.axis
    first = n.cross(E_X if abs(n.x) < 0.9 else E_Z)
    first = first / first.norm()
    along = first if axis is None else n.cross(q.matrix() @ axis)
    turns = (first, n.cross(first), n) if axis is None else (q.matrix() @ axis,)
    found = []
    for i, way in enumerate(turns):
        aside = (along, n.cross(along), along + n.cross(along))[i] if axis is None else along
        moved = _speed(system, start, contact, V, Omega, Omega + way * change, aside * (change * contact.offset.norm()))
        found.append(replace(start, velocity=_floats(moved), angular_velocity=_floats(Omega + way * change)))
    return found


def _speed(
    system: RollingSystem, start: State, contact: Contact, V: Vector, was: Vector, now: Vector, aside: Vector
) -> Vector:
    """Return V for a changed Ω in the phase of a start."""
    slip, gap = contact.slip_velocity(V, was), Vector(*start.position) + contact.offset - contact.point
    off, over = float(slip.dot(contact.normal)), float(gap.dot(contact.normal))
    speed = max(float(part.norm()) for part in (V, was.cross(contact.offset), V - slip))
    flies = over > SLIP_TOLERANCE * contact.offset.norm() or abs(off) > SLIP_TOLERANCE * speed
    if flies:  # its height may change at another rate, too
        return V + aside + contact.normal * aside.norm()
    slides = float((slip - contact.normal * off).norm()) > SLIP_TOLERANCE * speed
    keeps = slip + aside if slides and system.support.friction is not None else None
    return contact.rolling_velocity(now) + (
        keeps - contact.normal * off if keeps is not None else Vector(0.0, 0.0, 0.0)
    )


def _floats(v: Vector) -> tuple[float, float, float]:
    x, y, z = map(float, v)
    return x, y, z
