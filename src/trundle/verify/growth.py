"""What a motion does to a small difference: runs from starts changed by a known little, each in the phase of the start.

A numerical method errs a little at each step, about one a radian, or more where it begins anew often; these errors add
up as a random walk, and the motion magnifies them. How much, the runs from starts changed in every way show, divided by
the change: their linear response. As they are all that can change, they say of an error made at any later instant, too,
what becomes of it: it is at that instant a sum of theirs, and so it is ever after. Where the response is no longer
small, two honest runs may be anywhere, and no comparison says anything.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial, reduce

import numpy as np
from numpy.typing import NDArray

from ..errors import SolverError
from ..mechanics.algebra import Quaternion
from ..mechanics.system import RollingSystem, State
from ..solve.contact_state import moment
from ..solve.dense import Dense
from ..solve.methods import Method
from ..solve.samples import FLIGHT, Event, Samples
from .bounds import A_STEP, SOLVER, Array, largest, own_sizes
from .nudging import nudged

MOST = 1e-2  # of the size of a quantity: beyond it nothing is told
_NUDGE = 1e-10  # of the largest Ω: small beside a motion that magnifies it a millionfold, large beside rounding
_OVER_TOLERANCE = 100.0  # and so many times the method's tolerance
_MOST_NUDGE = 1e-4
_FLOOR = 1e-4  # of the largest change: of less, rounding is part
_INSTANTS = 200
_INSTANT = 1e-6  # of the time in which the motion changes
NEAR_THE_END = 1e-6  # of a run, by which what ends it may come later


@dataclass(frozen=True)
class Growth:
    """How many times larger than in the start a small change shows later in a motion."""

    times: Array  # (n,): s
    # (n,): the most up to each of them, of a change in the start or at any instant since: as shares of the sizes for
    # each share of Ω
    magnified: Array
    shifted: Array  # (k,): the same of the times of the first k events, as shares of the run
    until: float  # s, up to which the response is small and as large as the change; beyond it nothing can be told
    carried: float = 0.0  # by how much two runs differ already where this begins, as a share
    skipped: int = 0  # how many events lie before that

    def widened(self, bound: float, steps: float, magnified: Array) -> Array:
        """Return a bound by what the motion makes of a method's errors in so many steps, and of what was before."""
        grows = A_STEP * np.sqrt(max(steps, 1.0)) / SOLVER + self.carried / bound
        return np.minimum(MOST, bound * np.maximum(1.0, grows * magnified))

    def at(self, times: Array) -> Array:
        """Return how many times larger a change shows by then."""
        return self.magnified[np.clip(np.searchsorted(self.times, times), 0, self.times.size - 1)]

    def told_until(self, bound: float, steps: float) -> float:
        """Return up to when a bound so widened is small enough to tell anything, s."""
        lost = self.times[self.widened(bound, steps, self.magnified) >= MOST]
        return min(self.until, float(lost[0])) if lost.size else self.until


def alike(ours: Samples, theirs: Samples) -> NDArray[np.bool_]:
    """Return which of the samples of two runs at the same times have as many events behind them in both."""
    counts = (np.searchsorted([event.time for event in run.events], run.time, side="right") for run in (ours, theirs))
    mine, other = counts
    return mine == other


def at_the_same_times(ours: Samples, theirs: Samples) -> tuple[Samples, Samples]:
    """Return the samples of two runs at the times that both have: one may have ended sooner."""
    _, mine, others = np.intersect1d(ours.time, theirs.time, assume_unique=True, return_indices=True)
    return ours.part(mine), theirs.part(others)


def same_events(ours: tuple[Event, ...], theirs: tuple[Event, ...]) -> int:
    """Return how many events of two runs are of the same kinds, from the first on.

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
    system: RollingSystem,
    start: State,
    at: Samples,
    method: Method,
    sizes: dict[str, float],
    kept: Dense | None = None,
) -> Growth:
    """Return what a motion does to a small change of its state, at its start or at any instant since."""
    method = numerical(method)
    solve = partial(method.solve, system) if kept is None else kept.like_it
    times = np.union1d(at.time[:: max(1, at.time.size // _INSTANTS)], at.time[-1:])
    span = max(float(times[-1] - start.time), 1e-300)
    share = min(max(_NUDGE, _OVER_TOLERANCE * method.tolerance), _MOST_NUDGE)
    slowest = 1 / max(span, _INSTANT * moment(system, start))  # rad/s: of a body at rest, and of a run of no length
    change = share * max(largest(at.angular_velocity), slowest)
    first, starts, others = solve(start, times), [], []
    for begin in nudged(system, start, change, share, share * sizes["position"]):
        with suppress(SolverError):  # a changed start may come to where no law goes on
            others.append(solve(begin, times))
            starts.append(begin)
    until = min([float(times[-1]), *(parted(first, other) for other in others)])
    count = min([len(first.events), *(same_events(first.events, other.events) for other in others)])
    end, times = times[-1], reduce(np.intersect1d, (run.time for run in [first, *others]), times)
    if not others or not times.size:
        return Growth(times, np.zeros(times.size), np.zeros(0), until)
    pairs = [at_the_same_times(first.part(np.isin(first.time, times)), other) for other in others]
    told = np.all([alike(*pair) for pair in pairs], axis=0)
    if times[-1] < end <= until:  # where some of them have ended already
        lasts = _lasts(solve, end, [(start, first), *zip(starts, others, strict=True)])
        if all(len(other.time) for _, other in lasts):  # asked for other instants, one may end sooner
            pairs = [
                (Samples.joined([one, its_last]), Samples.joined([other, other_last]))
                for (one, other), (its_last, other_last) in zip(pairs, lasts, strict=True)
            ]
            times, told = np.append(times, end), np.append(told, True)
    state, shown = _responses(system, pairs, sizes)
    with np.errstate(over="ignore"):  # beside a motion of 1e-30 m
        large = np.linalg.norm(shown, axis=2).max(axis=(1, 2)) > MOST
    nonlinear = times[told & large]
    until = min(until, float(nonlinear[0])) if nonlinear.size else until
    lags = np.array([[other.events[i].time - first.events[i].time for other in others] for i in range(count)]) / span
    at_events = np.array([event.time for event in first.events[:count]])
    magnified, shifted = np.zeros(times.size), np.zeros(count)
    for i in np.flatnonzero(told & (times <= until)):  # of an error made then, what shows at each instant since
        back = _back(state[i])
        later = np.linalg.norm(shown[i:] @ back, axis=(2, 3)).max(axis=1)
        magnified[i:] = np.maximum(magnified[i:], later * told[i:])
        if count:
            shifted = np.maximum(shifted, np.linalg.norm(lags @ back, axis=1) * (at_events >= times[i]))
    return Growth(times, np.maximum.accumulate(magnified), shifted, until)


def _lasts(
    solve: Callable[[State, Array], Samples], end: float, runs: list[tuple[State, Samples]]
) -> list[tuple[Samples, Samples]]:
    """Return the first run and each of the others at the last instant that both have."""
    ends = [min([end, *(event.time for event in run.events if event.final)]) for _, run in runs]
    times = np.minimum(ends[0], ends[1:])
    firsts = solve(runs[0][0], np.unique(times))
    # Asked for other instants, a run may end a rounding sooner, or at an event behind them.
    rows = np.minimum(np.searchsorted(firsts.time, times), firsts.time.size - 1)
    return [
        (firsts.part([row]), solve(start, np.array([time])).part(slice(1)))
        for row, time, (start, _) in zip(rows, times, runs[1:], strict=True)
    ]


def _responses(
    system: RollingSystem, pairs: list[tuple[Samples, Samples]], sizes: dict[str, float]
) -> tuple[Array, Array]:
    """Return how changed runs differ, as shares.

    First in what a method follows (n, rows, runs), then in each quantity that is compared (n, fields, 3, runs).
    """

    def apart(field: str) -> Array:
        return np.stack([getattr(other, field) - getattr(one, field) for one, other in pairs], axis=-1)

    turns = np.stack([_turned(*pair) for pair in pairs], axis=-1)
    fields = {field: apart(field) / max(size, 1e-300) for field, size in sizes.items()}
    coordinates = apart("support_coordinates") / own_sizes(system, pairs[0][0], sizes)[:, None]
    own = [np.pad(coordinates[:, [i]], ((0, 0), (0, 2), (0, 0))) for i in range(coordinates.shape[1])]
    moving = np.stack([_followed(system, other) - _followed(system, one) for one, other in pairs], axis=-1)
    followed = [fields["position"], moving / max(sizes["velocity"], 1e-300), fields["angular_velocity"]]
    return np.concatenate([*followed, turns, coordinates], axis=1), np.stack([*fields.values(), turns, *own], axis=1)


def _followed(system: RollingSystem, at: Samples) -> Array:
    """Return V in flight, else the slip: of what touches, V follows from Ω, and may be less sharp."""
    V, turning, u = (np.broadcast_to(v.array(), at.position.shape) for v in at.speeds(system))
    return np.where((at.phase == FLIGHT)[:, None], V, V + turning - u)


def _turned(ours: Samples, theirs: Samples) -> Array:
    """Return by what small rotation the orientations of two runs differ, rad."""
    apart = Quaternion.of(theirs.orientation) * Quaternion.of(ours.orientation).conjugate
    w, *vector = apart.array().T
    return 2 * np.sign(w)[:, None] * np.stack(vector, axis=1)


def _back(state: Array) -> Array:
    """Return which combination of the changed starts shows at an instant as a given change of the state (runs, rows).

    What the motion has made too small beside the largest, of which rounding is part, is not divided by less.
    """
    U, S, V = np.linalg.svd(state, full_matrices=False)
    return np.asarray((V.T / np.maximum(S, _FLOOR * S[0] + 1e-300)) @ U.T)


def numerical(method: Method) -> Method:
    """Return a method that follows any start: itself, or beside a closed form the finest that there is."""
    from ..solve.taylor import available

    return method if method.name != "exact" else Method.of("taylor" if available() else "runge-kutta")


def parted(ours: Samples, theirs: Samples, end: float = -math.inf) -> float:
    """Return when two runs first meet different events, s, before the later of their ends; infinite where never."""
    known = same_events(ours.events, theirs.events)
    rest = [run.events[known].time for run in (ours, theirs) if len(run.events) > known]
    end = float(max(ours.time[-1], theirs.time[-1], end))
    near = NEAR_THE_END * (end - float(min(ours.time[0], theirs.time[0])))
    return min((time for time in rest if time < end - near), default=float("inf"))
