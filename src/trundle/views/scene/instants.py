"""At which instants a run is shown: near enough to each other that a viewer can go from one to the next by slerp."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...solve.samples import FLIGHT, Samples

if TYPE_CHECKING:
    from ...simulation.trajectory import Trajectory

Array = NDArray[np.float64]

MOST = 10_000  # samples, unless another number is asked for
TURN = 0.5  # rad that body and support should turn by at most from one sample to the next
_TOO_FAR = 1.5  # times that, and the run is sampled anew
_MOST_EVENTS = 100  # that are given samples of their own


def shown(run: Trajectory, most: int) -> Samples:
    """Return a run's samples as they are to be shown: at most so many, close enough, and with its events."""
    own = run.samples
    wanted = wanted_times(run, own, most)
    if wanted is not None:
        return with_events(run, run.at(wanted).samples)
    if own.time.size > most:
        own = own.part(np.unique(np.linspace(0, own.time.size - 1, most).round().astype(int)))
    return with_events(run, own)


def wanted_times(run: Trajectory, own: Samples, most: int) -> Array | None:
    """Return new instants where a run's own are too far apart to be played, ascending; None where they are not."""
    if own.time.size < 2:
        return None
    step = np.diff(own.time)
    turning = np.linalg.norm(own.angular_velocity, axis=1)
    first, last = float(own.time[0]), float(own.time[-1])
    fastest = max(float(run.system.support.motion.fastest_rate_within(first, last)), 0.0)
    rate = np.maximum(np.maximum(turning[:-1], turning[1:]), fastest)
    if own.time.size <= most and float(np.max(rate * step)) <= _TOO_FAR * TURN:
        return None
    parts = np.maximum(rate * step / TURN, 1.0)  # samples that each step asks for
    if own.time.size > most and float(np.max(rate * step)) * own.time.size / most <= _TOO_FAR * TURN:
        return None  # leaving some out is enough
    count = int(min(np.ceil(np.sum(parts)) + 1, most))
    if count <= own.time.size and own.time.size <= most:
        return None  # no more can be had
    grown = np.concatenate([[0.0], np.cumsum(parts)])
    times = np.interp(np.linspace(0.0, grown[-1], count), grown, own.time)
    times[0], times[-1] = first, last
    return times


def with_events(run: Trajectory, at: Samples) -> Samples:
    """Return samples with those of the events among them whose state is known, so that a path has its kinks."""
    known = [
        (event.after, event.contact)
        for event in run.events
        if event.contact is not None and at.time[0] < event.time < at.time[-1] and event.time not in at.time
    ]
    if not known or len(known) > _MOST_EVENTS:
        return at
    states, contacts = zip(*known, strict=True)
    times = np.array([state.time for state in states])
    behind = at.part(np.searchsorted(at.time, times))
    rows: dict[str, Any] = {
        name: np.array([getattr(state, name) for state in states])
        for name in ("position", "velocity", "angular_velocity", "orientation")
    }
    own = np.array([state.support for state in states], dtype=float).reshape(len(states), -1)
    new = replace(behind, time=times, support_coordinates=own, contact=np.array(contacts), **rows)
    both = Samples.joined([at, new], at.events)
    return both.part(np.argsort(both.time, kind="stable"))


def flying(at: Samples) -> NDArray[np.bool_]:
    """Return at which samples nothing touches."""
    return np.asarray(at.phase == FLIGHT)
