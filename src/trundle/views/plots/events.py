"""What happened on the way: stretches of rolling, slipping and flight, and the events between them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from trundle.wording import with_unit

from .scales import Array

if TYPE_CHECKING:
    from trundle.simulation.trajectory import Trajectory

ROLLING, SLIPPING, FLIGHT, RESTING = range(4)
FEW = 6  # events of a kind that are all marked; of more, the first few and the last
_FINAL = {
    "rim": "ran off the rim",
    "end": "reached the end of the surface",
    "curved": "no longer fitted the surface",
    "spot": "had to stop",
    "wall": "touched in a second place",
}
_SAID = {
    "slip": "began to slip",
    "grip": "gripped and rolled",
    "lift": "came off the support",
    "land": "landed",
    "bounce": "bounced",
    "settle": "settled from its bounces",
    "jolt": "was jolted by the support",
    "stop": "came to rest",
    "off": "began to move",
}
KINDS = (*_SAID, "event")  # in the order of the legend; "event" ended the run
_AFTERWARDS = {"slip": SLIPPING, "grip": ROLLING, "lift": FLIGHT, "bounce": FLIGHT, "stop": RESTING, "off": ROLLING}


@dataclass(frozen=True)
class PhaseInterval:
    """A time through which the phase of contact stayed the same."""

    start: float
    end: float
    phase: int


@dataclass(frozen=True)
class EventMarks:
    """All events of one kind: when, which of them are marked, and the words for the legend."""

    kind: str
    times: Array
    marked: Array
    text: str


def kind_of(event: Any) -> str:
    """Return the kind of mark that an event gets.

    Examples
    --------
    >>> from trundle.solve.samples import Event
    >>> kind_of(Event(1.0, "rim", "ran off the rim")), kind_of(Event(1.0, "land", "landed and bounced"))
    ('event', 'bounce')
    """
    if event.kind == "land" and "bounced" in event.text:
        return "bounce"
    if event.kind == "start":
        return "off"  # "start" is the mark where the run begins
    return event.kind if event.kind in _SAID else "event"


def happenings_of(run: Trajectory) -> list[EventMarks]:
    """Group the events of a run by kind."""
    first, last = (float(run.data["time"].values[i]) for i in (0, -1))
    events = [event for event in run.events if first <= event.time <= last]
    found = []
    for kind in KINDS:
        times = np.array([event.time for event in events if kind_of(event) == kind], dtype=float)
        if not len(times):
            continue
        if kind == "event":
            event = events[-1]
            said = _FINAL.get(event.kind, event.text.split(" (")[0].split(" at ")[0].split(", which")[0])
        else:
            said = _SAID[kind]
        found.append(_grouped(kind, times, said))
    return found


def _grouped(kind: str, times: Array, said: str) -> EventMarks:
    if len(times) == 1:
        return EventMarks(kind, times, times, f"{said}, {with_unit(float(times[0]), 'time')}")
    times_said = "twice" if len(times) == 2 else f"{len(times)} times"
    text = f"{said} {times_said}, up to {with_unit(float(times[-1]), 'time')}"
    if len(times) <= FEW:
        return EventMarks(kind, times, times, text)
    marked = np.append(times[: FEW - 2], times[-1])
    return EventMarks(kind, times, marked, f"{text} ({FEW - 1} marked)")


def stretches_of(run: Trajectory) -> list[PhaseInterval]:
    """Return the phases of a run in order: from its samples, and between samples from its events."""
    time = np.asarray(run.data["time"].values, dtype=float)
    phase = np.asarray(run.data["phase"].values) if "phase" in run.data else np.zeros(len(time), dtype=int)
    events = [event for event in run.events if time[0] < event.time < time[-1] and kind_of(event) != "event"]
    edges = [float(time[0]), *(float(event.time) for event in events), float(time[-1])]
    stretches: list[PhaseInterval] = []
    for i, (start, end) in enumerate(pairwise(edges)):
        if end <= start and len(edges) > 2:
            continue
        inside = phase[np.searchsorted(time, start, "right") : np.searchsorted(time, end, "left")]
        if len(inside):
            now = int(np.bincount(np.asarray(inside, dtype=int)).argmax())
        else:
            now = _AFTERWARDS.get(kind_of(events[i - 1]), int(phase[0])) if i else int(phase[0])
        if stretches and stretches[-1].phase == now:
            stretches[-1] = PhaseInterval(stretches[-1].start, end, now)
        else:
            stretches.append(PhaseInterval(start, end, now))
    return stretches


def part_in(stretches: Sequence[PhaseInterval], phase: int, time: Array) -> np.ndarray[Any, np.dtype[np.bool_]]:
    """Tell which instants lie in stretches of a phase, their ends included.

    Examples
    --------
    >>> part_in([PhaseInterval(0.0, 1.0, 0), PhaseInterval(1.0, 3.0, 2)], 2, np.array([0.5, 1.0, 2.0])).tolist()
    [False, True, True]
    """
    chosen = np.zeros(len(time), dtype=bool)
    for stretch in stretches:
        if stretch.phase == phase:
            chosen |= (time >= stretch.start) & (time <= stretch.end)
    return chosen


def with_events(run: Trajectory) -> Trajectory:
    """Return a run whose samples also hold the states just before and just after its events.

    A line through them has its kinks where they happened. What an event does not know, the forces, is taken from the
    sample before.
    """
    time = np.asarray(run.data["time"].values, dtype=float)
    states = [
        (event, state)
        for event in run.events
        if getattr(event, "contact", None) is not None and time[0] < event.time < time[-1]
        for state in (event.before, event.after)
        if state is not None
    ]
    if not states:
        return run
    import xarray

    at = np.array([event.time for event, _ in states])
    rows = run.data.isel(time=np.maximum(np.searchsorted(time, at, "right") - 1, 0)).copy(deep=True)
    for name in ("position", "velocity", "angular_velocity", "orientation"):
        if name in rows:
            rows[name].values[...] = np.array([getattr(state, name) for _, state in states])
    if "contact" in rows:
        rows["contact"].values[...] = np.array([event.contact for event, _ in states])
    for i, name in enumerate(run.system.support.motion.coordinates):
        if f"support_{name}" in rows:
            rows[f"support_{name}"].values[...] = np.array([state.support[i] for _, state in states])
    every = np.concatenate([time, at])
    order = np.argsort(every, kind="stable")
    plain = [data.drop_vars("time") for data in (run.data, rows)]
    both = xarray.concat(plain, "time", data_vars="minimal", coords="minimal", compat="override", join="override")
    return replace(run, data=both.isel(time=order).assign_coords(time=every[order]))
